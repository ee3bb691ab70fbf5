"""Installs a wheel and an archive without a compiler on the path, uses both as a newcomer does, and prints a table of sizes and seconds."""

from __future__ import annotations

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import time
import urllib.request
import venv

#: Programs that must not be on the path of an installation.
COMPILERS = ("cargo", "rustc", "cc", "gcc", "clang", "zig", "maturin", "make")
#: The most bytes of a wheel: 12.4 MB were measured, and the page of the workbench adds 1.1 MB.
MOST_WHEEL = 14e6
#: The most milliseconds that the import takes over an empty interpreter.
MOST_IMPORT = 25.0
#: Starts of the interpreter of which the fastest counts.
STARTS = 21
#: Seconds after which a step counts as stuck.
PATIENCE = 600
STUDY = "engine-balance/study.toml"
#: The same engine at the speed with which the paper computed.
EXACT = "engine-balance/exact-speed.toml"


class Place:
    """An environment of its own: a folder, and a path that holds nothing else than the programs in it."""

    def __init__(self, folder: pathlib.Path, programs: pathlib.Path) -> None:
        self.folder = folder
        kept = {name: value for name, value in os.environ.items() if name.startswith(("PIP_", "SSL_")) or name.lower().endswith("_proxy")}
        self.environment = {**kept, "PATH": str(programs), "HOME": str(folder), "LC_ALL": "C.UTF-8"}
        for name in COMPILERS:
            if shutil.which(name, path=str(programs)):
                sys.exit(f"packaging/measure.py: {name} is on the path, and an installation must not need it")

    def run(self, *command: object) -> tuple[float, str]:
        """Runs a command and returns its seconds and its output."""
        begun = time.monotonic()
        done = subprocess.run(
            [str(word) for word in command], cwd=self.folder, env=self.environment, text=True, capture_output=True, timeout=PATIENCE
        )
        if done.returncode:
            sys.exit(f"packaging/measure.py: {command} ended with {done.returncode}\n{done.stdout}{done.stderr}")
        return time.monotonic() - begun, done.stdout

    def page(self, *command: object) -> float:
        """Starts `sensitol serve` over the examples, and returns the seconds to the page."""
        begun = time.monotonic()
        words = [*map(str, command), "serve", "engine-balance", "--port", "0"]
        server = subprocess.Popen(words, cwd=self.folder, env=self.environment, text=True, stdout=subprocess.PIPE)
        try:
            address = None
            while address is None:
                line = server.stdout.readline()
                if not line:
                    sys.exit("packaging/measure.py: `sensitol serve` printed no address")
                address = re.search(r"http://\S+", line)
            with urllib.request.urlopen(address[0], timeout=PATIENCE) as answer:
                text = answer.read().decode()
            if "sensitol" not in text or len(text) < 10_000:
                sys.exit("packaging/measure.py: the page of `sensitol serve` is none")
            return time.monotonic() - begun
        finally:
            server.terminate()
            server.wait(PATIENCE)


def checked(output: str) -> None:
    """Holds the result of the main job: the nominal force of the engine as the paper prints it, 12556.9373 N, to its rounding."""
    report = json.loads(output)
    names = {one["name"]: one for one in report["characteristics"]}
    if abs(names["F"]["nominal"] - 12556.9373) > 5e-5:
        sys.exit(f"packaging/measure.py: the nominal force is {names['F']['nominal']}")


def jobs(place: Place, command: list[object]) -> dict[str, float]:
    """Copies the example, analyses it and opens the page."""
    place.run(*command, "examples", "copy", "engine-balance")
    first, _ = place.run(*command, "analyze", STUDY)
    _, output = place.run(*command, "analyze", EXACT, "--json", "-q")
    checked(output)
    return {"first result": first, "page": place.page(*command)}


def imported(place: Place, python: pathlib.Path) -> float:
    """Returns the least milliseconds of processor time of the import in fresh interpreters, which other work on the machine hardly changes."""
    code = "import time; begun = time.process_time(); import sensitol; print(1e3 * (time.process_time() - begun))"
    return min(float(place.run(python, "-I", "-c", code)[1]) for _ in range(STARTS))


def of_wheel(wheel: pathlib.Path, notebook: pathlib.Path, folder: pathlib.Path) -> dict[str, float]:
    environment = folder / "venv"
    begun = time.monotonic()
    venv.create(environment, with_pip=True, symlinks=True)
    programs = environment / "bin"
    place, python = Place(folder, programs), programs / "python"
    place.run(python, "-m", "pip", "install", "-q", "--only-binary", ":all:", wheel)
    found = {"install": time.monotonic() - begun}
    found.update(jobs(place, [programs / "sensitol"]))
    place.run(python, "-m", "sensitol", "--version")
    place.run(python, "-m", "pip", "install", "-q", "--only-binary", ":all:", "nbclient", "ipykernel", "matplotlib", "pandas")
    shutil.copy(notebook, folder / "notebook.ipynb")
    runs = "import nbclient, nbformat; nbclient.NotebookClient(nbformat.read('notebook.ipynb', 4), timeout=300).execute()"
    found["notebook"] = place.run(python, "-c", runs)[0]
    found["import ms"] = imported(place, python)
    return found


def of_archive(archive: pathlib.Path, folder: pathlib.Path) -> dict[str, float]:
    begun = time.monotonic()
    with tarfile.open(archive) as packed:
        packed.extractall(folder, **({"filter": "data"} if hasattr(tarfile, "data_filter") else {}))
    (program,) = folder.glob("sensitol-*/bin/sensitol")
    found = {"install": time.monotonic() - begun, "size of program": program.stat().st_size}
    head = subprocess.run(["readelf", "-d", str(program)], text=True, capture_output=True) if shutil.which("readelf") else None
    if head and "NEEDED" in head.stdout:
        sys.exit("packaging/measure.py: the program is not static")
    found.update(jobs(Place(folder, program.parent), [program]))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--wheel", required=True, type=pathlib.Path)
    parser.add_argument("--archive", required=True, type=pathlib.Path)
    parser.add_argument("--notebook", required=True, type=pathlib.Path)
    asked = parser.parse_args()
    wheel, archive, notebook = (path.resolve() for path in (asked.wheel, asked.archive, asked.notebook))
    with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
        from_wheel = of_wheel(wheel, notebook, pathlib.Path(one))
        from_archive = of_archive(archive, pathlib.Path(other))
    print("\n| artifact | size | installed in | first result in | page in | notebook in |\n|---|--:|--:|--:|--:|--:|")
    for name, path, found in (("wheel", wheel, from_wheel), ("archive with the static program", archive, from_archive)):
        times = [f"{found[key]:.1f} s" if key in found else "-" for key in ("install", "first result", "page", "notebook")]
        print(f"| {name} | {path.stat().st_size / 1e6:.1f} MB | {' | '.join(times)} |")
    print(f"\nimport over an empty interpreter: {from_wheel['import ms']:.1f} ms of processor time")
    print(f"static program alone: {from_archive['size of program'] / 1e6:.1f} MB")
    if wheel.stat().st_size > MOST_WHEEL:
        sys.exit(f"packaging/measure.py: the wheel is larger than {MOST_WHEEL / 1e6:g} MB")
    if from_wheel["import ms"] > MOST_IMPORT:
        sys.exit(f"packaging/measure.py: the import takes longer than {MOST_IMPORT:g} ms")


if __name__ == "__main__":
    main()
