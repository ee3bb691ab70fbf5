"""A workbook as a model: `python3 sensitol_spreadsheet.py BOOK.xlsx` or `... DECLARATION.toml`, see README.md.

The workbook is calculated by a LibreOffice of its own, with a private profile, on a private copy of the file.
"""

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))

from sensitol_adapter import Adapter, Declaration, NoValue, load

VERSION = "1"
INSTALL = "apt-get install --no-install-recommends libreoffice-calc python3-uno"
PLACES = [
    (None, "/usr/bin/python3"),
    ("/usr/lib/python3/dist-packages", "/usr/bin/python3"),
    ("/opt/libreoffice/program", "/opt/libreoffice/program/python"),
    ("/Applications/LibreOffice.app/Contents/Resources", "/Applications/LibreOffice.app/Contents/Resources/python"),
]
OFFICES = ("/usr/lib/libreoffice/program/soffice", "/opt/libreoffice/program/soffice", "/Applications/LibreOffice.app/Contents/MacOS/soffice")
KEYS = ("document", "name", "version", "dimensions", "characteristics")
START_S = 45
ERROR_RESULT, TEXT_RESULT = 4, 2
VALUES, FORMULAS = 1, 16
# Cells of each kind that an error lists.
LISTED = 20
# B3, Sheet.B3, 'My sheet'.B3
ADDRESS = re.compile(r"(?:(?:'(?P<quoted>[^']+)'|(?P<sheet>[^'.]+))\.)?(?P<cell>[A-Z]{1,3}[1-9][0-9]*)")


class Declared:
    """What the command line says: a declaration, or a workbook whose names say it all."""

    def __init__(self, path):
        path = pathlib.Path(path)
        self.table, self.dimensions, self.characteristics = {}, None, None
        if path.suffix in (".toml", ".json"):
            declaration = Declaration(path, KEYS)
            self.table, self.document = declaration.table, declaration.document
            self.dimensions = {key: one["cell"] for key, one in declaration.section("dimensions", ("cell",)).items()}
            section = declaration.section("characteristics", ("cell",))
            self.characteristics = {key: one["cell"] for key, one in section.items()}
        elif not path.is_file():
            raise ValueError(f"there is no workbook {path}")
        else:
            self.document = path


class Office:
    """A LibreOffice of one's own. A keeper process ends it and removes its profile when this process is gone, however."""

    def __init__(self):
        program = os.environ.get("SENSITOL_SOFFICE") or shutil.which("soffice") or next(filter(os.path.exists, OFFICES), None)
        if program is None:
            raise ValueError(f"there is no LibreOffice (soffice); install it with: {INSTALL}")
        self.folder = tempfile.mkdtemp(prefix="sensitol-office-")
        pipe = os.path.basename(self.folder)
        command = [sys.executable, os.path.abspath(__file__), "--keep", self.folder, program, pipe]
        # In a session of its own: what ends this process group must not end it before it has tidied up.
        # The mark by which the engine finds what a model process leaves behind is not for it either.
        unmarked = {name: value for name, value in os.environ.items() if name != "SENSITOL_PROCESS"}
        self.keeper = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=2, start_new_session=True, env=unmarked)
        local = uno.getComponentContext()
        resolver = local.ServiceManager.createInstanceWithContext("com.sun.star.bridge.UnoUrlResolver", local)
        deadline = time.monotonic() + START_S
        while True:
            try:
                self.context = resolver.resolve(f"uno:pipe,name={pipe};urp;StarOffice.ComponentContext")
                break
            except Exception as error:
                if self.keeper.poll() is not None or time.monotonic() > deadline:
                    raise ValueError(f"{program} did not start: {error}") from None
                time.sleep(0.05)
        services = self.context.ServiceManager
        self.desktop = services.createInstanceWithContext("com.sun.star.frame.Desktop", self.context)
        settings = services.createInstanceWithContext("com.sun.star.configuration.ConfigurationProvider", self.context)
        where = property_value("nodepath", "/org.openoffice.Setup/Product")
        access = settings.createInstanceWithArguments("com.sun.star.configuration.ConfigurationAccess", (where,))
        self.release = access.getByName("ooSetupVersion")

    def workbook(self, path):
        """Opens a copy, so that no lock lies beside the file and nobody else's is in the way; no macro is run."""
        copy = shutil.copy(path, self.folder)
        options = [("Hidden", True), ("MacroExecutionMode", 0), ("UpdateDocMode", 0), ("Silent", True)]
        try:
            url = uno.systemPathToFileUrl(os.path.realpath(copy))
            book = self.desktop.loadComponentFromURL(url, "_blank", 0, tuple(property_value(*one) for one in options))
        except Exception as error:
            raise ValueError(f"{path} does not open: {error}") from None
        if book is None:
            raise ValueError(f"{path} does not open: it is protected by a password, or no workbook")
        if not book.supportsService("com.sun.star.sheet.SpreadsheetDocument"):
            raise ValueError(f"{path} is no workbook")
        return book


def keep(folder, program, pipe):
    """Starts the office and ends it when the process that asked for it is gone: its end of the pipe closes, even by kill."""
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    url = pathlib.Path(folder, "profile").as_uri()
    options = ["--headless", "--norestore", "--nologo", "--nodefault", "--nolockcheck", "--nofirststartwizard"]
    command = [program, f"-env:UserInstallation={url}", *options, f"--accept=pipe,name={pipe};urp;"]
    office = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=2, start_new_session=True)
    while sys.stdin.buffer.read(1):
        pass
    os.killpg(office.pid, signal.SIGKILL)
    office.wait()
    shutil.rmtree(folder, ignore_errors=True)


def property_value(name, value):
    found = uno.createUnoStruct("com.sun.star.beans.PropertyValue")
    found.Name, found.Value = name, value
    return found


class Model:
    def __init__(self, declared):
        self.declared = declared

    def open(self):
        office = Office()
        self.office = office
        self.book = office.workbook(self.declared.document)
        # A loop that is iterated starts from the last values: answers would depend on the points before.
        self.book.IsIterationEnabled = False
        self.book.enableAutomaticCalculation(False)
        self.cells = self._named()
        if self.declared.dimensions is None:
            self.dimensions = {name: cell for name, cell in self.cells.items() if cell.Type.value == "VALUE"}
            self.characteristics = {name: cell for name, cell in self.cells.items() if cell.Type.value == "FORMULA"}
        else:
            self.dimensions = {name: self._cell(where) for name, where in self.declared.dimensions.items()}
            self.characteristics = {name: self._cell(where) for name, where in self.declared.characteristics.items()}

    def take(self, hello):
        """Finds what the study names, where nothing is declared also by the address of a cell; says what there is if it is not there."""
        optional = set(hello.get("optional", ()))
        dimensions = [*hello["dimensions"], *hello.get("constants", ())]
        if self.declared.dimensions is None:
            # A constant of the study's formulas must not land in the cell that happens to be called so.
            for name in dimensions:
                if name not in self.cells and name not in optional and (cell := self._addressed(name)) is not None:
                    self.dimensions[name] = cell
            for name in hello["characteristics"]:
                if name not in self.cells and (cell := self._addressed(name)) is not None:
                    self.characteristics[name] = cell
            missing = [name for name in dimensions if name not in self.dimensions and name not in optional]
            missing += [name for name in hello["characteristics"] if name not in self.characteristics]
            if missing and not self.cells:
                raise ValueError(self._undeclared(missing[0]))
        self._check(dimensions)

    def _addressed(self, name):
        """The cell with this address, on the first sheet where none is named; None where it is no address."""
        matched = ADDRESS.fullmatch(name)
        if matched is None:
            return None
        sheets = self.book.Sheets
        sheet = matched["quoted"] or matched["sheet"]
        if sheet is not None and not sheets.hasByName(sheet):
            return None
        try:
            return (sheets.getByName(sheet) if sheet else sheets.getByIndex(0)).getCellRangeByName(matched["cell"]).getCellByPosition(0, 0)
        except Exception:
            return None

    def _undeclared(self, missing):
        """What to do about a workbook without names, with a declaration that is ready to use."""
        numbers, formulas = self._contents()
        path = self.declared.document
        if not formulas or not numbers:
            return f"{path} has no cell with a formula that reads a number: nothing in it can be calculated"
        taken = set()

        def lines(cells):
            for cell in cells[:LISTED]:
                name = label(cell)
                while name in taken:
                    name += "_"
                taken.add(name)
                yield f"{name} = {json.dumps(address(cell))}  # {cell.String}"
            if len(cells) > LISTED:
                yield f"# and {len(cells) - LISTED} more"

        declared = [f"document = {json.dumps(path.name)}", "[dimensions]", *lines(numbers), "[characteristics]", *lines(formulas)]
        return (
            f"no cell of {path} has the name `{missing}`: the workbook has no names. Name its cells, or use addresses such as"
            f" `{address(numbers[0])}` as names in the study, or write this to {path.stem}.toml, with the names that the study"
            " uses, and put that file into `command` and `files`:\n" + "\n".join(declared) + "\n"
        )

    def _contents(self):
        """Cells with numbers that formulas read, and cells with formulas whose results are numbers."""
        numbers, formulas = [], []
        for sheet in (self.book.Sheets.getByIndex(i) for i in range(self.book.Sheets.Count)):
            for cell in iterate(sheet.queryContentCells(VALUES | FORMULAS).Cells.createEnumeration()):
                if cell.Type.value == "FORMULA" and cell.FormulaResultType2 != TEXT_RESULT:
                    formulas.append(cell)
                elif cell.Type.value == "VALUE" and cell.queryDependents(False).queryContentCells(FORMULAS).Count:
                    numbers.append(cell)
        return numbers, formulas

    def _check(self, asked):
        """Cells that will be written must hold numbers and be writable."""
        for name in asked:
            cell = self.dimensions.get(name)
            if cell is None:
                continue
            if cell.Type.value == "FORMULA":
                raise ValueError(f"`{name}` ({address(cell)}) is a formula, which a dimension would overwrite")
            if cell.Type.value != "VALUE":
                held = repr(cell.String) if cell.String else "nothing"
                raise ValueError(f"`{name}` ({address(cell)}) holds {held}, where a dimension needs a number")
            if cell.Spreadsheet.isProtected() and cell.CellProtection.IsLocked:
                sheet = cell.Spreadsheet.Name
                raise ValueError(f"`{name}` ({address(cell)}) is locked: take the protection off sheet {sheet}, or unlock the cell")

    def _named(self):
        """Single cells with a name, of the workbook and of its sheets."""
        found = {}
        for owner in [self.book, *(self.book.Sheets.getByIndex(i) for i in range(self.book.Sheets.Count))]:
            names = owner.NamedRanges
            for name in names.ElementNames:
                area = names.getByName(name).getReferredCells()
                if area is not None and area.Rows.Count == 1 and area.Columns.Count == 1:
                    found.setdefault(name, area.getCellByPosition(0, 0))
        return found

    def _cell(self, where):
        if where in self.cells:
            return self.cells[where]
        sheet, dot, cell = where.rpartition(".")
        if dot and self.book.Sheets.hasByName(sheet):
            try:
                return self.book.Sheets.getByName(sheet).getCellRangeByName(cell).getCellByPosition(0, 0)
            except Exception:
                pass
        names = ", ".join(self.cells) or "none"
        raise ValueError(f"{self.declared.document} has no cell `{where}`: neither a name nor Sheet.B3; names are {names}")

    def evaluate(self, asked, values):
        for name, value in values.items():
            self.dimensions[name].setValue(value)
        self.book.calculateAll()
        return {name: self._value(name, self.characteristics[name]) for name in asked if name in self.characteristics}

    def _value(self, name, cell):
        if cell.getError():
            origin = self._origin(cell)
            where = "" if address(origin) == address(cell) else f", from {address(origin)}"
            return NoValue(f"{address(cell)} is {words(cell)}{where}")
        if cell.Type.value in ("EMPTY", "TEXT") or (cell.Type.value == "FORMULA" and cell.FormulaResultType2 == TEXT_RESULT):
            return NoValue(f"{address(cell)} holds {cell.String!r}, which is not a number")
        return cell.Value

    def _origin(self, cell):
        """Where an error began: follows cells with errors until one reads none."""
        seen = set()
        while address(cell) not in seen:
            seen.add(address(cell))
            wrong = cell.queryPrecedents(False).queryFormulaCells(ERROR_RESULT).Cells.createEnumeration()
            step = next((one for one in iterate(wrong) if address(one) not in seen), None)
            if step is None:
                break
            cell = step
        return cell


def iterate(enumeration):
    while enumeration.hasMoreElements():
        yield enumeration.nextElement()


def address(cell):
    return cell.AbsoluteName.replace("$", "")


def label(cell):
    """A name for a cell: the text to its left or above it, or else its address."""
    sheet, where = cell.Spreadsheet, cell.CellAddress
    for column, row in ((where.Column - 1, where.Row), (where.Column, where.Row - 1)):
        beside = sheet.getCellByPosition(column, row) if column >= 0 and row >= 0 else None
        if beside is not None and beside.Type.value == "TEXT":
            found = re.sub(r"\W+", "_", beside.String, flags=re.ASCII).strip("_")
            if re.match(r"[A-Za-z]", found):
                return found
    return re.sub(r"\W+", "_", address(cell), flags=re.ASCII).strip("_")


def words(cell):
    return {522: "circular (Err:522)", 523: "an iteration without end (Err:523)"}.get(cell.getError(), cell.String)


def main():
    global uno
    faults, model = [], None
    try:
        if len(sys.argv) != 2:
            raise ValueError("sensitol_spreadsheet.py takes one argument: a workbook, or a declaration (.toml, .json)")
        model = Model(Declared(sys.argv[1]))
        uno = load("uno", places=PLACES, install=INSTALL)
    except ValueError as error:
        faults.append(error)
    asked = []

    def setup(hello):
        if faults:
            raise faults[0]
        model.open()
        model.take(hello)
        asked.extend(hello["characteristics"])
        served.inputs, served.outputs = list(model.dimensions), list(model.characteristics)
        table = model.declared.table
        served.name = table.get("name", model.declared.document.name)
        served.version = f"{table.get('version', VERSION)}; adapter {VERSION}, LibreOffice {model.office.release}"

    def evaluate(**values):
        return model.evaluate(asked, values)

    served = Adapter(evaluate, name="workbook", inputs=[], window=4, setup=setup)
    served.serve()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--keep"]:
        keep(*sys.argv[2:])
    else:
        main()
