"""Sets `cargo bench --bench lists` beside HiGHS, one thread, gap 0, in one run; needs highspy (pip)."""

import json
import pathlib
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).parent.parent


def times(command):
    """Milliseconds by seed."""
    printed = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    pairs = (line.split() for line in printed.splitlines() if line and line[0].isdigit())
    return {int(seed): float(took) for seed, took in pairs}


def main():
    """A row for every kind of problem."""
    ours = times(["cargo", "bench", "--bench", "lists", *sys.argv[1:]])
    theirs = times([sys.executable, "tests/data/generators/allocation_lists.py", "--time"])
    problems = json.loads((ROOT / "tests/data/allocation-lists.json").read_text())["problems"]
    groups = {}
    for problem in problems:
        groups.setdefault((problem["rows"], problem["proportional"]), []).append(problem["seed"])
    print("| rows | problems | sensitol median, most | HiGHS median, most | least ratio | not faster |")
    print("|---|--:|--:|--:|--:|--:|")
    for (rows, proportional), seeds in groups.items():
        own, other = [ours[seed] for seed in seeds], [theirs[seed] for seed in seeds]
        ratios = [b / a for a, b in zip(own, other)]
        name = f"{rows}{', proportional' if proportional else ''}"
        print(f"| {name} | {len(seeds)} | {statistics.median(own):.2g}, {max(own):.2g} | "
              f"{statistics.median(other):.3g}, {max(other):.3g} | {min(ratios):.2g} | {sum(r < 1 for r in ratios)} |")


if __name__ == "__main__":
    main()
