"""Opening FreeCAD documents so that nothing of them is lost, and what of an open one can be declared."""

import json
import math
import os
import pathlib
import re
import sys
import xml.etree.ElementTree as xml
import zipfile

# Constraints with a value; all others (Coincident, Horizontal, ..) only say what lies on what.
VALUED = ("Distance", "DistanceX", "DistanceY", "Angle", "Radius", "Diameter", "SnellsLaw", "Weight")
SIZES = ("App::PropertyLength", "App::PropertyDistance", "App::PropertyAngle", "App::PropertyQuantityConstraint")
PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def add_workbenches(freecad):
    """Puts the workbenches' folders at the end of Python's path. A bare `import FreeCAD` leaves them out where the library
    is not installed below FreeCAD's own folder, as on Debian; FreeCAD then drops every object of a workbench without a word.
    """
    homes = [freecad.getHomePath(), freecad.getResourceDir(), "/usr/share/freecad", "/usr/lib/freecad"]
    for folder in [*(os.path.join(home, "Mod") for home in homes), os.path.join(freecad.getUserAppDataDir(), "Mod")]:
        if os.path.isdir(folder):
            # The folder holds the packages, and each of its folders holds modules that stand alone.
            for path in [folder, *sorted(one.path for one in os.scandir(folder) if one.is_dir())]:
                if path not in sys.path:
                    sys.path.append(path)


def open_document(freecad, path):
    """The open document, with every object of the file.

    A `ValueError` says why it does not open, or names the objects that FreeCAD dropped.
    """
    try:
        document = freecad.openDocument(str(path), True)
    except Exception as error:
        raise ValueError(f"{path} does not open in FreeCAD: {error}") from None
    try:
        kept, scripts = _stored(path)
    except (OSError, KeyError, zipfile.BadZipFile, xml.ParseError) as error:
        raise ValueError(f"{path} has no readable Document.xml: {error}") from None
    lost = [f"`{name}` ({kind})" for name, kind in kept.items() if document.getObject(name) is None]
    for name, module in scripts.items():
        one = document.getObject(name)
        if one is not None and getattr(one, "Proxy", None) is None:
            lost.append(f"the script of `{name}` (module {module})")
    if lost:
        freecad.closeDocument(document.Name)
        shown = ", ".join(lost[:20]) + (f" and {len(lost) - 20} more" if len(lost) > 20 else "")
        raise ValueError(f"{path}: FreeCAD drops {len(lost)} of {len(kept)} objects; install the workbench of: {shown}")
    return document


def _stored(path):
    """Objects of the file with their types, and the modules of those that a script computes."""
    with zipfile.ZipFile(path) as archive:
        root = xml.fromstring(archive.read("Document.xml"))
    objects = {one.get("name"): one.get("type") for one in root.iterfind("Objects/Object")}
    scripts = {}
    for one in root.iterfind("ObjectData/Object"):
        for stored in one.iterfind("Properties/Property[@name='Proxy']/Python"):
            if stored.get("module"):
                scripts[one.get("name")] = stored.get("module")
    return objects, scripts


def constraint_words(sketch, index):
    """A constraint with a value as people read it: `DistanceX 20 mm`."""
    one = sketch.Constraints[index]
    if one.Type == "Angle":
        return f"{one.Type} {_short(math.degrees(one.Value))} deg"
    return f"{one.Type} {_short(one.Value)}" + ("" if one.Type in ("SnellsLaw", "Weight") else " mm")


def valued(sketch):
    """The indices of its constraints with a value."""
    return [index for index, one in enumerate(sketch.Constraints) if one.Type in VALUED]


def follows(owner, *paths):
    """Whether an expression of the document sets one of these properties."""
    return any(path.lstrip(".") in paths for path, *_ in owner.ExpressionEngine)


def declaration(document, path):
    """A declaration of everything that can vary or be measured, as TOML that is ready to use."""
    dimensions, characteristics, notes, taken = [], [], [], set()

    def entry(name, key, target, words):
        while name in taken:
            name += "_"
        taken.add(name)
        return f"{name if PLAIN.fullmatch(name) else json.dumps(name)} = {{ {key} = {json.dumps(target)} }}  # {words}"

    for one in document.Objects:
        if one.isDerivedFrom("Sketcher::SketchObject"):
            for index in valued(one):
                constraint = one.Constraints[index]
                where = f"Constraints.{constraint.Name}" if constraint.Name else f"Constraints[{index}]"
                target = f"{one.Name}.{constraint.Name or f'Constraints[{index}]'}"
                line = ("constraint", target, constraint_words(one, index))
                name = constraint.Name or f"{one.Name}_{index}"
                if not constraint.Driving:
                    characteristics.append(entry(name, *line))
                elif follows(one, where, f"Constraints[{index}]"):
                    notes.append(f"# {target} follows an expression: {line[2]}")
                else:
                    dimensions.append(entry(name, *line))
        elif one.isDerivedFrom("Spreadsheet::Sheet"):
            for cell, words, computed in cells(one):
                name = (one.getAlias(cell) if hasattr(one, "getAlias") else None) or f"{one.Name}_{cell}"
                line = entry(name, "cell", f"{one.Name}.{cell}", words)
                (characteristics if computed else dimensions).append(line)
        else:
            for name in sizes(one):
                target, words = f"{one.Name}.{name}", getattr(one, name).UserString
                if follows(one, name):
                    notes.append(f"# {target} follows an expression: {words}")
                else:
                    dimensions.append(entry(f"{one.Name}_{name}", "property", target, words))
        if _is_result(one):
            target = f"{one.Name}.Shape.Volume"
            characteristics.append(entry(f"{one.Name}_volume", "property", target, f"{_short(one.Shape.Volume)} mm^3"))
            notes += [
                f"# {one.Name}.Face{number}: {_kind(face)}, centre {_place(face.CenterOfMass)}, area {_short(face.Area)} mm^2"
                for number, face in enumerate(one.Shape.Faces, 1)
            ]
    notes.append('# a signed distance: gap = { from = "Body.Face1", to = "Body.Face3", along = "Body.Face1" }')
    lines = [f"document = {json.dumps(os.path.basename(path))}", "", "[dimensions]", *dimensions]
    return "\n".join([*lines, "", "[characteristics]", *characteristics, "", *notes]) + "\n"


def cells(sheet):
    """Cells that hold a number: address, the number in words, and whether it is computed from other cells."""
    table = xml.fromstring(sheet.cells.Content)
    aliases = {one.get("alias") for one in table.iter("Cell")} - {None}
    for one in table.iter("Cell"):
        address, content = one.get("address"), one.get("content") or ""
        try:
            value = sheet.get(address)
        except Exception:
            continue
        value, words = getattr(value, "Value", value), getattr(value, "UserString", None)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            yield address, words or _short(value), _reads(content, aliases)


def _reads(content, aliases):
    """Whether a cell's content names other cells, properties or functions: a number has a unit at most."""
    names = re.findall(r"[A-Za-z_]\w*", content)
    return bool(re.search(r"\b\$?[A-Z]{1,2}\$?\d+\b|[A-Za-z_]\w*\s*\(|[A-Za-z_]\w*\.[A-Za-z_]|<<", content)) or not aliases.isdisjoint(names)


def sizes(one):
    """Properties of an object that are sizes in use: not hidden, not read only, not 0."""
    for name in one.PropertiesList:
        if one.getTypeIdOfProperty(name) in SIZES and not set(one.getEditorMode(name)) & {"Hidden", "ReadOnly"}:
            if getattr(one, name).Value != 0:
                yield name


def _is_result(one):
    """A body, or a solid of its own: not the steps of which a body is made."""
    shape = getattr(one, "Shape", None)
    if shape is None or shape.isNull() or not shape.Solids:
        return False
    return one.isDerivedFrom("PartDesign::Body") or not one.isDerivedFrom("PartDesign::Feature")


def _kind(face):
    return type(face.Surface).__name__


def _place(point):
    return f"({', '.join(_short(value) for value in point)})"


def _short(value):
    # 1e-9 mm is far below what a kernel means by a place.
    return f"{round(value, 9) + 0.0:.7g}"


def list_document(freecad, path):
    """The declaration of the document at `path`."""
    if not pathlib.Path(path).is_file():
        raise ValueError(f"there is no document {path}")
    return declaration(open_document(freecad, path), path)
