"""Studies of one folder as tools of the Model Context Protocol: ``sensitol mcp FOLDER``."""

from __future__ import annotations

import argparse
import difflib
import json
import os
import re
import sys
from typing import TYPE_CHECKING, Any, Sequence

from . import _core

if TYPE_CHECKING:
    from mcp.server import MCPServer

#: Seconds after which a run ends with what is known, unless the caller asks for less or more.
_SECONDS = 60.0
#: The most seconds that a caller may ask for: a server answers one agent, and a longer run belongs to a command line.
_MOST_SECONDS = 600.0
#: The most points of a simulation for the same reason.
_MOST_SAMPLES = 10_000_000
#: The most studies that are listed.
_LISTED = 500
_INSTRUCTIONS = (
    "Statistical tolerance analysis. A study is a TOML file with dimensions, tolerances and characteristics. Call `check` after each change of "
    "a study, then `analyze`. Every warning has a code that `explain_warning` explains. Nothing is written: change files with your own tools."
)


class Refused(Exception):
    """A request that is not carried out; its text is the answer."""


class Folder:
    """A folder of studies. Nothing outside it is read, by whatever name."""

    def __init__(self, root: str, allow_external: bool = False) -> None:
        self.root = os.path.realpath(root)
        self.allow_external = allow_external
        if not os.path.isdir(self.root):
            raise NotADirectoryError(f"{root} is no folder of studies")

    def path(self, study: str) -> str:
        """Returns the real path of a study of the folder. `study` is relative to it."""
        parts = study.replace("\\", "/").split("/")
        if os.path.isabs(study) or os.path.splitdrive(study)[0] or ".." in parts or "\0" in study:
            raise Refused(f"`{study}` is outside the folder of studies: name a study by its path from the folder")
        path = os.path.realpath(os.path.join(self.root, study))
        if os.path.commonpath([self.root, path]) != self.root:
            raise Refused(f"`{study}` is a link to a place outside the folder of studies")
        if not path.endswith((".toml", ".json")):
            raise Refused(f"`{study}` is no study: its name ends with .toml or .json")
        if not os.path.isfile(path):
            near = difflib.get_close_matches(study, self.studies(), n=3)
            raise Refused(f"there is no study `{study}`" + (f"; near it: {', '.join(near)}" if near else ""))
        return path

    def studies(self) -> list[str]:
        """Lists the paths of TOML files with dimensions, from the folder. Links are not followed."""
        found: list[str] = []
        for place, folders, files in os.walk(self.root):
            folders[:] = sorted(name for name in folders if not name.startswith(".") and name != "__pycache__")
            for name in sorted(files):
                path = os.path.join(place, name)
                if name.endswith(".toml") and not os.path.islink(path) and _has_dimensions(path):
                    found.append(os.path.relpath(path, self.root).replace(os.sep, "/"))
                if len(found) >= _LISTED:
                    return found
        return found

    def run(
        self,
        study: str,
        asked: dict[str, Any] | None,
        *,
        form: str = "text",
        analysis: dict[str, Any] | None = None,
        characteristics: Sequence[str] = (),
        configuration: str | None = None,
        seconds: float = _SECONDS,
    ) -> dict[str, Any]:
        """Carries out a task and returns the answer of the engine. Without `asked` nothing is evaluated."""
        path = self.path(study)
        if not 0 < seconds <= _MOST_SECONDS:
            raise Refused(f"seconds must lie above 0 and not above {_MOST_SECONDS:g}, got {seconds:g}")
        try:
            with open(path, encoding="utf-8") as file:
                text = file.read()
        except (OSError, UnicodeDecodeError) as error:
            raise Refused(f"`{study}` cannot be read: {error}") from None
        task: dict[str, Any] = {"text": text, "format": path.rpartition(".")[2], "name": study, "forms": [form]}
        task["asked"], task["configuration"], task["characteristics"] = asked, configuration, list(characteristics)
        if analysis:
            task["analysis"] = analysis
        told = json.dumps(task)
        limits = (os.path.dirname(path), self.root, self.allow_external, asked is None, seconds)
        answer: dict[str, Any] = json.loads(_core.run_confined(told, *limits))
        return answer


def _has_dimensions(path: str) -> bool:
    try:
        with open(path, encoding="utf-8") as file:
            return re.search(r"^\s*\[?dimensions\b", file.read(), re.MULTILINE) is not None
    except (OSError, UnicodeDecodeError):
        return False


def _faults(answer: dict[str, Any]) -> list[dict[str, Any]] | None:
    """Returns the errors of an answer, each with message, line, column, key and advice; None if there is none."""
    if "faults" in answer:
        return [
            {"message": one["fault"], "line": one["line"], "column": one["column"], "key": one["key"], "advice": one["help"]}
            for one in answer["faults"]
        ]
    if "error" in answer:
        return [{"message": answer["error"], "line": None, "column": None, "key": None, "advice": " ".join(answer["advice"]) or None}]
    return None


def _explained(code: str) -> str:
    """Returns the section of the page on warnings about this code."""
    sections = re.split(r"^### `([a-z0-9-]+)`\n", _core.warnings_page(), flags=re.MULTILINE)
    known = dict(zip(sections[1::2], sections[2::2]))
    if code in known:
        return f"{code}\n" + re.split(r"^#", known[code], flags=re.MULTILINE)[0].strip()
    near = difflib.get_close_matches(code, known, n=3)
    raise Refused(f"there is no warning `{code}`" + (f"; near it: {', '.join(near)}" if near else ""))


def server(folder: Folder) -> MCPServer[Any]:
    """Makes the server with its tools."""
    from mcp.server import MCPServer
    from mcp.server.mcpserver.exceptions import ToolError

    made: MCPServer[Any] = MCPServer("sensitol", instructions=_INSTRUCTIONS, version=_core.__version__, log_level="ERROR")

    def answered(study: str, asked: dict[str, Any], as_json: bool, **more: Any) -> str:
        try:
            answer = folder.run(study, asked, form="json" if as_json else "text", **more)
        except (Refused, ValueError) as refusal:
            raise ToolError(str(refusal)) from None
        if answer.get("program") and not folder.allow_external:
            raise ToolError("the model of this study is a program, and this server starts none: it was started without --allow-external")
        faults = _faults(answer)
        if faults is not None:
            raise ToolError(json.dumps({"errors": faults}, ensure_ascii=False))
        text = str(answer["json" if as_json else "text"])
        if asked["command"] == "allocate" and not as_json and answer.get("study"):
            text += f"\nThe study with these tolerances:\n\n{answer['study']}"
        return text

    @made.tool()
    def list_studies() -> list[str]:
        """Lists the studies of the folder by their paths from it."""
        return folder.studies()

    @made.tool()
    def check(study: str) -> dict[str, Any]:
        """Validates a study; evaluates nothing. Each error has message, line, column, key and advice.

        Args:
            study: path of the study from the folder of studies
        """
        try:
            answer = folder.run(study, None)
        except Refused as refusal:
            raise ToolError(str(refusal)) from None
        faults = _faults(answer)
        return {"valid": faults is None, "errors": faults or [], "program": answer.get("program")}

    @made.tool()
    def analyze(
        study: str,
        method: str | None = None,
        accuracy: float | None = None,
        characteristics: list[str] | None = None,
        configuration: str | None = None,
        seconds: float = _SECONDS,
        as_json: bool = False,
    ) -> str:
        """Yield, Cpk, moments and contributions of every characteristic, with error estimates and warnings.

        Args:
            study: path of the study from the folder of studies
            method: one of the methods, such as full or six-n; auto without it
            accuracy: wanted relative error of sigma, such as 0.001
            characteristics: names to ask for; all without it
            configuration: a name of the study's configurations
            seconds: time limit; the report then has what is known
            as_json: the report with every figure as JSON instead of text
        """
        keys = {"method": method, "accuracy": accuracy}
        analysis = {key: value for key, value in keys.items() if value is not None}
        more = {"characteristics": characteristics or (), "configuration": configuration, "seconds": seconds}
        return answered(study, {"command": "analyze"}, as_json, analysis=analysis, **more)

    @made.tool()
    def simulate(
        study: str,
        samples: int = 100_000,
        configuration: str | None = None,
        seconds: float = _SECONDS,
        as_json: bool = False,
    ) -> str:
        """Monte Carlo: the model itself at random points, with standard errors.

        Args:
            study: path of the study from the folder of studies
            samples: number of points
            configuration: a name of the study's configurations
            seconds: time limit; the report then has what is known
            as_json: the report with every figure as JSON instead of text
        """
        if not 2 <= samples <= _MOST_SAMPLES:
            raise ToolError(f"samples must lie between 2 and {_MOST_SAMPLES}, got {samples}")
        asked = {"command": "simulate", "samples": samples}
        return answered(study, asked, as_json, configuration=configuration, seconds=seconds)

    @made.tool()
    def allocate(study: str, seconds: float = _SECONDS, as_json: bool = False) -> str:
        """The cheapest tolerances that keep what the study requires, and the study with them. Nothing is written.

        Args:
            study: path of the study from the folder of studies, with [costs]
            seconds: time limit; the report then has what is known
            as_json: the report with every figure as JSON instead of text
        """
        return answered(study, {"command": "allocate"}, as_json, seconds=seconds)

    @made.tool()
    def explain_warning(code: str) -> str:
        """Cause of a warning, its consequence for the result, and what to try.

        Args:
            code: the code in brackets behind the word warning, such as unused-dimension
        """
        try:
            return _explained(code)
        except Refused as refusal:
            raise ToolError(str(refusal)) from None

    return made


def main(arguments: Sequence[str]) -> int:
    """Serves the studies of a folder over stdin and stdout until the client ends it."""
    parser = argparse.ArgumentParser(
        prog="sensitol mcp",
        description="Serves the studies of one folder as tools of the Model Context Protocol, over stdin and stdout.",
    )
    parser.add_argument("folder", metavar="FOLDER", help="the folder of studies; nothing outside it is read")
    parser.add_argument("--allow-external", action="store_true", help="start the programs that studies name, with the rights of the user")
    asked = parser.parse_args(arguments)
    try:
        made = server(Folder(asked.folder, asked.allow_external))
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except ImportError as error:
        print(f"error: the protocol needs the package mcp and Python 3.10 or newer ({error}): pip install 'sensitol[mcp]'", file=sys.stderr)
        return 2
    made.run("stdio")
    return 0
