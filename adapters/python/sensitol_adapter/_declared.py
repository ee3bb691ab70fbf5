"""What the adapters for documents share: the declaration beside the document, and the interpreter that has the library."""

import difflib
import importlib
import json
import os
import pathlib
import sys

_TRIED = "SENSITOL_ADAPTER_INTERPRETERS"


class Settings:
    """A TOML or JSON file that says what an adapter is to do.

    Every fault is a `ValueError` that names the file and the key.
    """

    def __init__(self, path, keys):
        self.path = pathlib.Path(path)
        text = self._text(self.path)
        try:
            self.table = json.loads(text) if self.path.suffix == ".json" else _toml(text)
        except ValueError as error:
            raise ValueError(f"{self.path}: {error}") from None
        if not isinstance(self.table, dict):
            raise ValueError(f"{self.path}: a table of keys is expected")
        self.check(self.table, keys, "the file")

    def _text(self, path):
        try:
            return path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise ValueError(f"{path} cannot be read: {error}") from None

    def check(self, table, keys, where):
        """Every key of this table is one of these."""
        for key in table:
            if key not in keys:
                near = difflib.get_close_matches(key, keys, n=1)
                hint = f"; did you mean `{near[0]}`?" if near else f"; there are {', '.join(keys)}"
                raise ValueError(f"{self.path}: {where} has no key `{key}`{hint}")

    def section(self, name, keys, needed=True):
        """A table of tables, each with some of these keys; a plain string stands for the first key."""
        section = self.table.get(name, {})
        if not isinstance(section, dict) or (needed and not section):
            raise ValueError(f"{self.path}: [{name}] is missing or empty")
        found = {}
        for entry, table in section.items():
            if isinstance(table, str):
                table = {keys[0]: table}
            if not isinstance(table, dict):
                raise ValueError(f"{self.path}: `{entry}` in [{name}] is neither a name nor a table")
            self.check(table, keys, f"`{entry}` in [{name}]")
            found[entry] = table
        return found

    def fault(self, entry, text):
        """An error about one entry."""
        return ValueError(f"{self.path}: `{entry}`: {text}")


class Declaration(Settings):
    """A file beside a document that says what of it are dimensions and characteristics."""

    def __init__(self, path, keys):
        super().__init__(path, keys)
        document = self.table.get("document")
        if not isinstance(document, str):
            raise ValueError(f"{self.path}: `document` is missing: the file that this is about")
        self.document = self.path.parent / document
        if not self.document.is_file():
            raise ValueError(f"{self.path}: there is no document {self.document}")


def _toml(text):
    try:
        import tomllib
    except ModuleNotFoundError:
        try:
            import tomli as tomllib
        except ModuleNotFoundError:
            raise ValueError("Python before 3.11 reads no TOML; write the same as .json, or install tomli") from None
    return tomllib.loads(text)


def load(module, *, places, install):
    """Imports a library that only the system's Python may have; called before `serve`.

    After a plain import, `places` are tried: pairs of a folder with the library (or None) and the interpreter it is made
    for, which replaces this process: its descriptors stay, and nothing has been read from them. Output of the library
    while it loads goes to stderr.
    """
    sys.stdout.flush()
    answers = os.dup(1)
    os.dup2(2, 1)
    try:
        return _load(module, places, install, answers)
    finally:
        os.dup2(answers, 1)
        os.close(answers)


def _load(module, places, install, answers):
    here = os.path.realpath(sys.executable)
    tried = [here, *(path for path in os.environ.get(_TRIED, "").split(os.pathsep) if path)]
    try:
        return importlib.import_module(module)
    except ImportError as error:
        last = error
    for folder, interpreter in places:
        if folder is not None and not os.path.isdir(folder):
            continue
        other = os.path.realpath(interpreter)
        if other == here and folder is not None:
            sys.path.append(str(folder))
            try:
                return importlib.import_module(module)
            except ImportError as error:
                last = error
        elif other not in tried and os.access(interpreter, os.X_OK):
            os.environ[_TRIED] = os.pathsep.join([*tried, other])
            os.dup2(answers, 1)
            os.execv(interpreter, [interpreter, *sys.argv])
    raise ValueError(f"`{module}` does not load under {sys.executable}: {last}; install it with: {install}")
