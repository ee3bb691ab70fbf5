#!/usr/bin/env python3
"""Compares the reports of two programs over all examples: `tests/compare_reports.py OLD NEW`.

Text, JSON, CSV and HTML of `analyze`, and JSON of `plan`, `simulate`, `sweep` and `allocate`, must be the same bytes apart from times and
the version. Examples whose evaluator is not installed are compared by their error; what OLD itself prints otherwise a second time is named
and not counted. A refactoring that promises the same figures runs it."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
COMMANDS = [
    ["analyze", "-v"],
    ["analyze", "--json"],
    ["plan", "--json"],
    ["simulate", "--json", "--samples", "2000", "--seed", "1"],
    ["allocate", "--json", "--confirm", "0"],
]
# Times of a run, and the version of the program.
VARYING = [
    (re.compile(r'"(wall_s|in_model_s|engine_s|cpu_s|seconds|time_s)": *[-0-9.e+]+'), r'"\1": 0'),
    (re.compile(r'"sensitol": *"[^"]*"'), '"sensitol": ""'),
    (re.compile(r"sensitol \d+\.\d+\.\d+|(?<=<dt>sensitol</dt><dd>)[0-9.]+"), "sensitol"),
    (re.compile(r"\b[0-9][-0-9.e]* (ms|s|us|µs|min)\b"), "TIME"),
    # Comments of a page's scripts, and the hash of a script that changes with them.
    (re.compile(r"sha256-[A-Za-z0-9+/=]+"), "sha256"),
    (re.compile(r"^(<script>)?\s*//.*$", re.M), ""),
]


def output(program, arguments, folder):
    """What a command prints and writes, without what varies."""
    done = subprocess.run([program, *arguments], cwd=ROOT, capture_output=True, text=True, timeout=600)
    texts = {"exit": str(done.returncode), "stdout": done.stdout, "stderr": done.stderr}
    for file in sorted(folder.rglob("*")):
        if file.is_file():
            texts[str(file.relative_to(folder))] = file.read_text(errors="replace")
    for name, text in texts.items():
        text = text.replace(str(folder), "FOLDER")
        for pattern, replacement in VARYING:
            text = pattern.sub(replacement, text)
        texts[name] = text
    return texts


def run(program, study, command):
    """Output of a command on a study, with the files that it writes."""
    with tempfile.TemporaryDirectory() as folder:
        written = ["--csv", f"{folder}/csv", "--html", f"{folder}/page.html"] if command == ["analyze", "-v"] else []
        arguments = [command[0], str(study.relative_to(ROOT)), *command[1:], *written]
        if command[0] != "plan":
            arguments += ["--journal", "none"]
        return output(program, arguments, Path(folder))


def main():
    old, new = (str(Path(program).resolve()) for program in sys.argv[1:3])
    compared, different, varying = 0, [], []
    for study in sorted((ROOT / "examples").rglob("*.toml")):
        for command in COMMANDS:
            found = [run(program, study, command) for program in (old, new)]
            compared += 1
            parts = [part for part in sorted({*found[0], *found[1]}) if found[0].get(part) != found[1].get(part)]
            again = run(old, study, command) if parts else {}
            for part in parts:
                lines = [text.get(part, "").splitlines() for text in found]
                first = next((pair for pair in zip(*lines) if pair[0] != pair[1]), ("(length)", "(length)"))
                by_itself = again.get(part) != found[0].get(part)
                text = f"{study.relative_to(ROOT)}: {' '.join(command)}: {part}\n  old {first[0][:200]}\n  new {first[1][:200]}"
                (varying if by_itself else different).append(text)
    print(*(f"varies by itself: {text}" for text in varying), sep="\n")
    print(f"{compared} commands, {len(different)} differences", *different, sep="\n")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
