"""adapters/spreadsheet against the arithmetic of its workbooks, written here again."""

import glob
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import tempfile
import time

from harness import EXAMPLES, ROOT, client, failed, journal, refused, report, run, sensitol, shown

ADAPTER = ROOT / "adapters/spreadsheet/sensitol_spreadsheet.py"
EXAMPLE = EXAMPLES / "stack-up-workbook"
STUDY = EXAMPLE / "study.toml"
NOMINAL = {
    "housing_depth": 84.60, "cover_lip": 4.00, "bearing_left": 15.94, "shoulder": 30.00,
    "gear": 18.50, "bearing_right": 15.94, "temperature": 60.0,
}  # fmt: skip
# Sums of six numbers below 100: some units in the last place.
CLOSE = 1e-12

MAKE = """
import json, pathlib, sys
sys.path.insert(0, sys.argv[1])
import uno, sensitol_spreadsheet as adapter
adapter.uno = uno
office = adapter.Office()
for path, content in json.loads(sys.argv[2]).items():
    hidden = (adapter.property_value("Hidden", True),)
    book = office.desktop.loadComponentFromURL("private:factory/scalc", "_blank", 0, hidden)
    sheet = book.Sheets.getByIndex(0)
    sheet.Name = "Calc"
    def put(cell, content, name=None):
        found = sheet.getCellRangeByName(cell)
        if isinstance(content, str):
            found.Formula = content
        else:
            found.Value = content
        if name:
            here = uno.createUnoStruct("com.sun.star.table.CellAddress")
            book.NamedRanges.addNewByName(name, f"$Calc.${cell[0]}${cell[1:]}", here, 0)
    options = {}
    exec(content)
    store = tuple(adapter.property_value(*one) for one in options.items())
    book.storeToURL(pathlib.Path(path).resolve().as_uri(), store)
    book.close(True)
office.keeper.stdin.close()
office.keeper.wait()
"""


def made(books):
    """Writes workbooks: lines of Python for each file."""
    command = ["/usr/bin/python3", "-c", MAKE, str(ADAPTER.parent), json.dumps(books)]
    subprocess.run(command, check=True, capture_output=True, timeout=100)


def play(temperature, **widths):
    """The axial play at 20 °C and at work."""
    aluminium, steel = 23.0e-6, 11.5e-6
    grown = {
        name: width * (1 + (aluminium if name in ("housing_depth", "cover_lip") else steel) * (temperature - 20))
        for name, width in widths.items()
    }
    return tuple(lengths["housing_depth"] - sum(v for k, v in lengths.items() if k != "housing_depth") for lengths in (widths, grown))


def workbook(file, nominal=NOMINAL, names=("play", "play_at_work"), folder=EXAMPLE):
    return client(["python3", ADAPTER, file], folder, [None] * len(nominal), nominal, list(names))


def gone(pids):
    """Whether these processes end within some seconds."""
    for _ in range(100):
        if not any(os.path.exists(f"/proc/{pid}") and "Z" not in state(pid) for pid in pids):
            return True
        time.sleep(0.1)
    return False


def state(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except OSError:
        return "Z"


def below(pid):
    """The processes that this one has started, and theirs."""
    children = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True, check=False)
    direct = [int(word) for word in children.stdout.split()]
    return direct + [one for child in direct for one in below(child)]


def it_passes_the_probe():
    sensitol("probe", STUDY)


def every_point_is_that_of_the_arithmetic():
    with tempfile.TemporaryDirectory() as folder:
        kept = pathlib.Path(folder) / "kept.sqlite"
        sensitol("simulate", STUDY, "--samples", "200", "--journal", kept)
        rows = journal(kept)
        assert len(rows) >= 200
        for row in rows:
            expected = play(**{name: row[name] for name in NOMINAL})
            assert abs(row["play"] - expected[0]) < CLOSE and abs(row["play_at_work"] - expected[1]) < CLOSE, row


def the_order_does_not_matter():
    chance = random.Random(5)
    points = [{name: value * (1 + 0.01 * chance.uniform(-1, 1)) for name, value in NOMINAL.items()} for _ in range(40)]
    with workbook("stack-up.xlsx") as model:
        assert [model.point(**p)["y"] for p in points] == [model.point(**p)["y"] for p in points[::-1]][::-1]


def the_stack_of_the_workbook_is_that_of_the_report():
    with workbook("stack-up.xlsx", names=("worst_case", "rss")) as model:
        worst, rss = model.point(**NOMINAL)["y"]
    found = report("analyze", STUDY, "--method", "rss", "--journal", "none")[0]["characteristics"][0]
    low, high = found["worst_case"]["linear"]
    # Slopes by differences of numbers of 1e2 over steps of 1e-2.
    assert abs((high - low) / 2 - worst) < 1e-9 and abs(found["rss"] - rss) < 1e-9, (found["worst_case"], found["rss"], worst, rss)


def a_cell_with_an_error_is_named():
    with workbook("stack-up.xlsx", names=("play", "travel_per_play")) as model:
        right = model.point(**NOMINAL)["y"]
        stuck = {**NOMINAL, "housing_depth": 84.375, "cover_lip": 4.0, "bearing_left": 16.0, "bearing_right": 16.0, "gear": 18.375}
        answer = model.point(**stuck)
        assert answer["y"] == [0.0, None], answer
        failed(answer, "Stack.E16", "#DIV/0!")
        assert model.point(**NOMINAL)["y"] == right
    with tempfile.TemporaryDirectory() as folder:
        content = """
put("A1", 2.0, "a")
put("B1", "=IF(A1>5;B2;A1)")
put("B2", "=B1+1")
put("B3", "=SQRT(A1)")
put("B4", "=B3*2", "root")
put("B5", "=B2*10", "loop")
put("B6", '=IF(A1>7;"too long";A1)', "text")
"""
        made({f"{folder}/wrong.ods": content})
        with workbook("wrong.ods", {"a": 2.0}, ("root", "loop", "text"), folder) as model:
            assert model.point(a=4.0)["y"] == [4.0, 50.0, 4.0]
            answer = model.point(a=6.0)
            assert answer["y"][1] is None
            failed({"errors": {"loop": answer["errors"]["loop"]}}, "Calc.B5", "522", "from Calc.B")
            answer = model.point(a=-1.0)
            assert answer["y"][1:] == [0.0, -1.0]
            failed(answer, "Calc.B4", "from Calc.B3")
            failed(model.point(a=8.0), "Calc.B6", "too long")
            assert model.point(a=4.0)["y"] == [4.0, 50.0, 4.0]


def a_declaration_names_cells_without_names():
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(EXAMPLE / "stack-up.xlsx", folder)
        path = pathlib.Path(folder) / "stack.toml"
        path.write_text(
            'document = "stack-up.xlsx"\nname = "stack"\nversion = "2"\n'
            '[dimensions]\n"D1@Hub" = "Stack.E9"\n[characteristics]\nfree = { cell = "Stack.E12" }\n'
        )
        with workbook(path, {"D1@Hub": 18.5}, ("free",), folder) as model:
            assert model.ready["name"] == "stack" and model.ready["version"].startswith("2; adapter"), model.ready
            for hub in (18.5, 18.25):
                assert abs(model.point(**{"D1@Hub": hub})["y"][0] - play(**{**NOMINAL, "gear": hub})[0]) < CLOSE
        path.write_text(path.read_text().replace("Stack.E9", "Stock.E9"))
        with workbook(path, {"D1@Hub": 18.5}, ("free",), folder) as model:
            refused(model, "Stock.E9", "housing_depth")


UNNAMED = """
put("A1", "width"); put("B1", 2.0)
put("A2", "height"); put("B2", 3.0)
put("A4", "area"); put("B4", "=B1*B2")
put("B5", "=B4*2")
put("D9", 7.0)
"""


def a_workbook_without_names_works_by_addresses():
    with tempfile.TemporaryDirectory() as folder:
        made({f"{folder}/plain.ods": UNNAMED})
        nominal = {"B1": 2.0, "Calc.B2": 3.0}
        with workbook("plain.ods", nominal, ("Calc.B4", "B5"), folder) as model:
            assert model.point(**{"B1": 2.0, "Calc.B2": 3.0})["y"] == [6.0, 12.0]
            assert model.point(**{"B1": 2.5, "Calc.B2": 4.0})["y"] == [10.0, 20.0]
        for name, words in [("B4", ["`B4`", "is a formula"]), ("C7", ["Calc.C7", "nothing"]), ("A1", ["Calc.A1", "width"])]:
            with workbook("plain.ods", {name: 2.0}, ("B5",), folder) as model:
                refused(model, *words)
        # The whole way, with a study.
        path = pathlib.Path(folder) / "study.toml"
        path.write_text(
            f'[model]\ncommand = ["python3", {json.dumps(str(ADAPTER))}, "plain.ods"]\nfiles = ["plain.ods"]\n'
            '[dimensions]\nB1 = { nominal = 2.0, tolerance = 0.1 }\nB2 = { nominal = 3.0, tolerance = 0.1 }\n'
            "[characteristics]\nB4 = {}\n"
        )
        found = report("analyze", path, "--method", "full", "--journal", "none")[0]["characteristics"][0]
        # A product's mean is the product of the means; differences of numbers of 6 over steps of 0.1.
        assert abs(found["mean"] - 6.0) < 1e-9, found


def a_workbook_without_names_shows_a_declaration():
    with tempfile.TemporaryDirectory() as folder:
        made({f"{folder}/plain.ods": UNNAMED, f"{folder}/words.ods": 'put("A1", "no number at all")'})
        with workbook("plain.ods", {"w": 2.0, "h": 3.0}, ("area",), folder) as model:
            refused(model, "plain.ods", "`w`", "Calc.B1", "no names")
            error = model.ready["error"]
        declared = error[error.index("document = ") :]
        # A cell that no formula reads is not a dimension.
        assert "D9" not in declared, declared
        pathlib.Path(folder, "plain.toml").write_text(declared)
        with workbook("plain.toml", {"width": 2.0, "height": 3.0}, ("area", "Calc_B5"), folder) as model:
            assert model.point(width=4.0, height=2.5)["y"] == [10.0, 20.0]
        with workbook("words.ods", {"w": 2.0}, ("area",), folder) as model:
            refused(model, "words.ods", "no cell with a formula")


def what_cannot_be_opened_is_said_once():
    with tempfile.TemporaryDirectory() as folder:
        with workbook("missing.xlsx", folder=folder) as model:
            refused(model, "missing.xlsx", "no workbook")
        two = 'put("A1", 2.0, "a"); put("A2", "=A1", "b"); '
        locked, secret = two + 'sheet.protect("")', two + 'options["Password"] = "tight"'
        made({f"{folder}/secret.ods": secret, f"{folder}/locked.ods": locked})
        with workbook("secret.ods", {"a": 2.0}, ("b",), folder) as model:
            refused(model, "secret.ods", "does not open")
        with workbook("locked.ods", {"a": 2.0}, ("b",), folder) as model:
            refused(model, "`a`", "Calc.A1", "locked")
        pathlib.Path(folder, "noise.xlsx").write_bytes(bytes(range(256)) * 9)
        with workbook("noise.xlsx", {"a": 2.0}, ("b",), folder) as model:
            refused(model, "noise.xlsx")
    with workbook("stack-up.xlsx", {"hub": 1.0}, ("play",)) as model:
        refused(model, "`hub`", "housing_depth")
    with workbook("stack-up.xlsx", names=("flush",)) as model:
        refused(model, "`flush`", "play_at_work")


def the_office_ends_with_the_adapter():
    for end in (lambda model: model.process.stdin.close(), lambda model: os.killpg(model.process.pid, signal.SIGKILL)):
        before = set(glob.glob(f"{tempfile.gettempdir()}/sensitol-office-*"))
        with workbook("stack-up.xlsx") as model:
            pids = below(model.process.pid)
            assert len(pids) >= 2, pids
            mine = set(glob.glob(f"{tempfile.gettempdir()}/sensitol-office-*")) - before
            end(model)
            assert gone(pids), pids
        deadline = time.monotonic() + 10
        while any(map(os.path.exists, mine)) and time.monotonic() < deadline:
            time.sleep(0.1)
        assert mine and not any(map(os.path.exists, mine)), mine


def the_readme_shows_it():
    shown("stack-up-workbook")


if __name__ == "__main__":
    run([
        it_passes_the_probe,
        every_point_is_that_of_the_arithmetic,
        the_order_does_not_matter,
        the_stack_of_the_workbook_is_that_of_the_report,
        a_cell_with_an_error_is_named,
        a_declaration_names_cells_without_names,
        a_workbook_without_names_works_by_addresses,
        a_workbook_without_names_shows_a_declaration,
        what_cannot_be_opened_is_said_once,
        the_office_ends_with_the_adapter,
        the_readme_shows_it,
    ])  # fmt: skip
