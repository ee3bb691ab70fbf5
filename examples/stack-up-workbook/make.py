"""Writes stack-up.xlsx: an axial stack-up as engineers keep it. Needs LibreOffice: `/usr/bin/python3 make.py [FILE]`."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "adapters" / "spreadsheet"))

import uno
import sensitol_spreadsheet as adapter

# Name, part, dimension, direction, nominal, half band, expansion in 1/K.
ROWS = [
    ("housing_depth", "housing", "depth to the cover's face", 1, 84.60, 0.10, 23.0e-6),
    ("cover_lip", "cover", "lip into the housing", -1, 4.00, 0.05, 23.0e-6),
    ("bearing_left", "bearing 6206", "width", -1, 15.94, 0.06, 11.5e-6),
    ("shoulder", "shaft", "between the shoulders", -1, 30.00, 0.05, 11.5e-6),
    ("gear", "gear", "hub", -1, 18.50, 0.04, 11.5e-6),
    ("bearing_right", "bearing 6206", "width", -1, 15.94, 0.06, 11.5e-6),
]
HEAD = ["", "part", "dimension", "direction", "nominal", "±", "expansion 1/K", "at work", "±²"]


def main(path):
    office = adapter.Office()
    book = office.desktop.loadComponentFromURL("private:factory/scalc", "_blank", 0, (adapter.property_value("Hidden", True),))
    sheet = book.Sheets.getByIndex(0)
    sheet.Name = "Stack"

    def put(cell, content):
        found = sheet.getCellRangeByName(cell)
        if isinstance(content, str):
            found.Formula = content
        else:
            found.Value = content

    def name(word, cell):
        here = uno.createUnoStruct("com.sun.star.table.CellAddress")
        book.NamedRanges.addNewByName(word, f"$Stack.${cell[0]}${cell[1:]}", here, 0)

    put("A1", "Axial play of the gear shaft")
    put("B2", "temperature at work, °C")
    put("E2", 60.0)
    name("temperature", "E2")
    for column, word in enumerate(HEAD):
        sheet.getCellByPosition(column, 3).Formula = word
    for row, (word, part, dimension, direction, nominal, half, expansion) in enumerate(ROWS, 5):
        for column, content in zip("ABCDEFG", (row - 4, part, dimension, direction, nominal, half, expansion)):
            put(f"{column}{row}", content)
        put(f"H{row}", f"=E{row}*(1+G{row}*($E$2-20))")
        put(f"I{row}", f"=F{row}^2")
        name(word, f"E{row}")
    last = 4 + len(ROWS)
    results = [
        ("play", "axial play at 20 °C", f"=SUMPRODUCT(D5:D{last};E5:E{last})"),
        ("play_at_work", "axial play at work", f"=SUMPRODUCT(D5:D{last};H5:H{last})"),
        ("worst_case", "± worst case", f"=SUM(F5:F{last})"),
        ("rss", "± root of the sum of squares", f"=SQRT(SUM(I5:I{last}))"),
        ("travel_per_play", "travel of 0.5 mm per play", "=0.5/E12"),
    ]
    for row, (word, text, formula) in enumerate(results, last + 2):
        put(f"B{row}", text)
        put(f"E{row}", formula)
        name(word, f"E{row}")
    store = (adapter.property_value("FilterName", "Calc MS Excel 2007 XML"),)
    book.storeToURL(path.resolve().as_uri(), store)
    book.close(True)
    office.keeper.stdin.close()
    office.keeper.wait()


if __name__ == "__main__":
    adapter.uno = uno
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).with_name("stack-up.xlsx"))
