"""A FreeCAD document as a model: `python3 sensitol_freecad.py DECLARATION.toml`, see README.md.
`python3 sensitol_freecad.py --list FILE.FCStd` prints a declaration of what a document holds.

Sketches go back to the geometry of the file before every point and all their constraints are set at once: a solver that
starts from the last point, or passes through half of a new one, may settle in a mirrored assembly and call it solved.
"""

import math
import os
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))

from freecad_document import add_workbenches, constraint_words, follows, list_document, open_document, valued
from sensitol_adapter import Adapter, Declaration, NoValue, load

VERSION = "1"
INSTALL = "apt-get install --no-install-recommends freecad-python3"
PLACES = [("/usr/lib/freecad-python3/lib", "/usr/bin/python3"), ("/usr/lib/freecad/lib", "/usr/bin/python3")]

DIMENSION = ("constraint", "cell", "property", "unit")
MEASURE = ("constraint", "cell", "property", "from", "to", "along", "unit")
GUARD = (*MEASURE, "above", "below")
KEYS = ("document", "name", "version", "dimensions", "characteristics", "guards", "restore", "reset")
ENDS = {"start": 1, "end": 2, "center": 3, "centre": 3}
ON_SKETCH = re.compile(r"(?P<sketch>[^.]+)\.Geometry\[(?P<index>\d+)\]\.(?P<end>\w+)")
NUMBERED = re.compile(r"Constraints\[(\d+)\]")
# The error that a solver may leave of a driving constraint, in mm or radians.
SOLVED = 1e-6


class Model:
    """One document, opened, and what of it is asked."""

    def __init__(self, declaration):
        self.declared = declaration
        self.dimensions = declaration.section("dimensions", DIMENSION)
        self.characteristics = declaration.section("characteristics", MEASURE)
        self.guards = declaration.section("guards", GUARD, needed=False)
        for entry, table in self.dimensions.items():
            self._one_of(entry, table, ("constraint", "cell", "property"))
        for entry, table in {**self.characteristics, **self.guards}.items():
            self._one_of(entry, table, ("constraint", "cell", "property", "from"))
            if "from" in table and not ("to" in table and "along" in table):
                raise declaration.fault(entry, "a distance needs `from`, `to` and `along`, which makes it signed")
        self.reset = declaration.table.get("reset", True)
        self.document = None

    def _one_of(self, entry, table, keys):
        if sum(key in table for key in keys) != 1:
            raise self.declared.fault(entry, f"exactly one of {', '.join(keys)} says what it is")

    def open(self, asked):
        """Opens the document, remembers its start, and finds everything that is named."""
        if self.document is not None:
            FreeCAD.closeDocument(self.document.Name)
            self.document = None
        self.document = open_document(FreeCAD, self.declared.document)
        self.sketches = {
            sketch.Name: (sketch.Geometry, sketch.Constraints)
            for sketch in self.document.findObjects("Sketcher::SketchObject")
        }
        restored = [self._path(text) for text in self.declared.table.get("restore", ())]
        self.start = [(self.object(name), names, _copy(_get(self.object(name), names))) for name, names in restored]
        self.units = {}
        self.setters = {entry: self._setter(entry, table) for entry, table in self.dimensions.items()}
        self.getters = {
            entry: self._getter(entry, self.characteristics[entry]) for entry in asked if entry in self.characteristics
        }
        self.checks = {entry: self._getter(entry, table) for entry, table in self.guards.items()}

    def object(self, name):
        """An object of the document by its name or, where that is unique, its label."""
        found = self.document.getObject(name)
        labelled = [found] if found is not None else self.document.getObjectsByLabel(name)
        if len(labelled) != 1:
            names = ", ".join(one.Name for one in self.document.Objects)
            raise ValueError(f"{self.declared.path}: the document has no object `{name}`; there are {names}")
        return labelled[0]

    def _path(self, text):
        """`Object.Property.Part` as the object's name and the names below it."""
        name, *names = text.split(".")
        if not names:
            raise ValueError(f"{self.declared.path}: `{text}` is no Object.Property")
        return name, names

    def _setter(self, entry, table):
        factor = self._factor(entry, table)
        self.units[entry] = table.get("unit")
        if "constraint" in table:
            sketch, index = self._constraint(entry, table["constraint"])
            angle = sketch.Constraints[index].Type == "Angle"
            self.units[entry] = table.get("unit", "deg" if angle else "mm")
            if not sketch.Constraints[index].Driving:
                raise self.declared.fault(entry, f"{table['constraint']} is a reference: it follows and cannot be set")
            if follows(sketch, f"Constraints.{sketch.Constraints[index].Name}", f"Constraints[{index}]"):
                raise self.declared.fault(entry, f"{table['constraint']} follows an expression; name what that reads")
            if factor is None:
                factor = math.radians(1) if angle else 1.0
            return ("constraint", sketch.Name, index, factor)
        if "cell" in table:
            sheet, cell = self._cell(entry, table["cell"])
            unit = self.units[entry] = table.get("unit") or self._unit_of(entry, sheet.get(cell))
            return ("cell", sheet, cell, unit)
        name, names = self._path(table["property"])
        owner = self.object(name)
        self._value(entry, owner, names)
        if follows(owner, ".".join(names)):
            raise self.declared.fault(entry, f"{table['property']} follows an expression; name what that reads")
        return ("property", owner, names, 1.0 if factor is None else factor)

    def _getter(self, entry, table):
        factor = self._factor(entry, table)
        if "constraint" in table:
            sketch, index = self._constraint(entry, table["constraint"])
            if factor is None:
                factor = math.radians(1) if sketch.Constraints[index].Type == "Angle" else 1.0
            return lambda: sketch.Constraints[index].Value / factor
        if "cell" in table:
            sheet, cell = self._cell(entry, table["cell"])
            return lambda: _number(sheet.get(cell), factor, table["cell"])
        if "property" in table:
            name, names = self._path(table["property"])
            owner = self.object(name)
            self._value(entry, owner, names)
            return lambda: _number(_get(owner, names), factor, table["property"])
        start, end = self._point(entry, table["from"]), self._point(entry, table["to"])
        along = self._direction(entry, table["along"])
        return lambda: (end() - start()).dot(along()) / (factor or 1.0)

    def _factor(self, entry, table):
        unit = table.get("unit")
        if unit is None:
            return None
        try:
            quantity = FreeCAD.Units.Quantity(f"1 {unit}")
        except Exception:
            raise self.declared.fault(entry, f"FreeCAD does not know the unit `{unit}`") from None
        angle = quantity.Unit == FreeCAD.Units.Angle
        # Constraints hold angles in radians, everything else in degrees.
        return math.radians(quantity.Value) if angle and "constraint" in table else quantity.Value

    def _constraint(self, entry, text):
        name, _, constraint = text.partition(".")
        sketch = self.object(name)
        if not sketch.isDerivedFrom("Sketcher::SketchObject"):
            raise self.declared.fault(entry, f"`{name}` is no sketch")
        names = [one.Name for one in sketch.Constraints]
        numbered = NUMBERED.fullmatch(constraint)
        index = int(numbered[1]) if numbered else None
        if constraint in names:
            index = names.index(constraint)
        if index in valued(sketch):
            return sketch, index
        known = [f"{names[one] or f'Constraints[{one}]'} ({constraint_words(sketch, one)})" for one in valued(sketch)]
        what = "has no constraint"
        if index is not None and index < len(names):
            what = f"has a constraint of type {sketch.Constraints[index].Type}, which has no value, at"
        shown = ", ".join(known) or "none with a value"
        raise self.declared.fault(entry, f"sketch `{name}` {what} `{constraint}`; there are {shown}")

    def _cell(self, entry, text):
        name, _, cell = text.partition(".")
        sheet = self.object(name)
        if not sheet.isDerivedFrom("Spreadsheet::Sheet"):
            raise self.declared.fault(entry, f"`{name}` is no spreadsheet")
        try:
            sheet.get(cell)
        except Exception:
            raise self.declared.fault(entry, f"spreadsheet `{name}` has no cell or alias `{cell}` with a value") from None
        return sheet, cell

    def _unit_of(self, entry, value):
        """What a number for this cell is in: mm or deg, None for plain numbers. How FreeCAD shows it says nothing."""
        if not hasattr(value, "Unit") or value.Unit == FreeCAD.Units.Unit():
            return None
        for unit, kind in (("mm", FreeCAD.Units.Length), ("deg", FreeCAD.Units.Angle)):
            if value.Unit == kind:
                return unit
        raise self.declared.fault(entry, f"the cell holds {value.UserString}; state the `unit` that the study uses")

    def _value(self, entry, owner, names):
        try:
            return _number(_get(owner, names), None, ".".join(names))
        except (AttributeError, NoValue):
            raise self.declared.fault(entry, f"`{owner.Name}` has no number `{'.'.join(names)}`") from None

    def _point(self, entry, text):
        """A function that gives a point: of a sketch's geometry, a vertex, or the middle of an edge or face."""
        matched = ON_SKETCH.fullmatch(text)
        if matched:
            sketch, index, end = self.object(matched["sketch"]), int(matched["index"]), matched["end"]
            if end not in ENDS or not sketch.isDerivedFrom("Sketcher::SketchObject") or index >= len(sketch.Geometry):
                raise self.declared.fault(entry, f"`{text}` is no start, end or centre of a sketch's geometry")
            return lambda: sketch.getPoint(index, ENDS[end])
        owner, element = self._element(entry, text)
        return lambda: _middle(_sub_shape(owner, element))

    def _direction(self, entry, text):
        """A function that gives a unit vector: numbers, or the outward normal of a face as it lies at the point."""
        if isinstance(text, str):
            owner, element = self._element(entry, text)
            return lambda: _normal(_sub_shape(owner, element))
        if not (isinstance(text, list) and len(text) in (2, 3) and any(text)):
            raise self.declared.fault(entry, "`along` is [x, y], [x, y, z] or `Object.FaceN`")
        vector = FreeCAD.Vector(*text)
        vector.normalize()
        return lambda: vector

    def _element(self, entry, text):
        name, _, element = text.partition(".")
        owner = self.object(name)
        try:
            _sub_shape(owner, element)
        except Exception:
            raise self.declared.fault(entry, f"`{name}` has no vertex, edge or face `{element}`") from None
        return owner, element

    def evaluate(self, values):
        """The asked characteristics at these dimensions."""
        try:
            return self._evaluate(values)
        except Exception:
            # Nothing of a failed point may reach the next one.
            if self.reset:
                self.open(list(self.getters))
            raise

    def _evaluate(self, values):
        constraints = {}
        if self.reset:
            for owner, names, value in self.start:
                _set(owner, names, _copy(value))
        for entry, value in values.items():
            kind, owner, where, scale = self.setters[entry]
            if kind == "constraint":
                constraints.setdefault(owner, []).append((where, value * scale))
            elif kind == "cell":
                owner.set(where, f"={value!r} {scale}".rstrip() if scale else f"={value!r}")
            else:
                _set(owner, where, value * scale)
        if self.reset:
            for name, (geometry, start) in self.sketches.items():
                sketch = self.document.getObject(name)
                sketch.Geometry = geometry
                # Those of the file too: the solver starts from the last value of a reference dimension as well.
                sketch.Constraints = _changed(start, constraints.get(name, ()))
        else:
            for name, pairs in constraints.items():
                for index, value in pairs:
                    self.document.getObject(name).setDatum(index, value)
        self.document.recompute()
        self._solved()
        for entry, measure in self.checks.items():
            value, table = measure(), self.guards[entry]
            if not table.get("above", -math.inf) <= value <= table.get("below", math.inf):
                raise NoValue(f"guard `{entry}` is {value:.6g}: the parts have settled in another way")
        found = {}
        for entry, measure in self.getters.items():
            try:
                found[entry] = measure()
            except Exception as error:
                found[entry] = NoValue(str(error))
        return found

    def _solved(self):
        for one in self.document.Objects:
            if "Invalid" in one.State:
                raise NoValue(f"{one.Label} does not recompute: {one.getStatusString()}")
        for name in self.sketches:
            sketch = self.document.getObject(name)
            for index, constraint in enumerate(sketch.Constraints):
                if constraint.Driving and constraint.IsActive:
                    left = abs(sketch.calculateConstraintError(index))
                    # FreeCAD 0.20 has no number for the angle of a single line.
                    if left > SOLVED:
                        named = constraint.Name or f"{index + 1} ({constraint.Type})"
                        raise NoValue(f"{sketch.Label} does not solve: constraint {named} is off by {left:.3g}")


def _changed(constraints, pairs):
    """The constraints with some values replaced; FreeCAD has no way to set several at once but to set them all."""
    constraints = list(constraints)
    for index, value in pairs:
        old = constraints[index]
        new = Sketcher.Constraint(old.Type, 0, value)
        for attribute in ("First", "FirstPos", "Second", "SecondPos", "Third", "ThirdPos", "Name"):
            setattr(new, attribute, getattr(old, attribute))
        constraints[index] = new
    return constraints


def _get(owner, names):
    for name in names:
        owner = getattr(owner, name)
    return owner


def _set(owner, names, value):
    """Sets a nested attribute and everything above it: a placement is handed out as a copy."""
    name, *rest = names
    if rest:
        part = getattr(owner, name)
        _set(part, rest, value)
        value = part
    elif isinstance(value, float) and type(getattr(owner, name)) is int:
        # A count, such as the occurrences of a pattern.
        if not value.is_integer():
            raise NoValue(f"{owner.Name}.{name} is a count: {value!r} is not possible")
        value = int(value)
    setattr(owner, name, value)


def _copy(value):
    return value.copy() if hasattr(value, "copy") else value


def _number(value, factor, what):
    value = getattr(value, "Value", value)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise NoValue(f"{what} holds {value!r}, which is not a number")
    return value / (factor or 1.0)


def _sub_shape(owner, element):
    shape = owner.getSubObject(element)
    if shape is None or not hasattr(shape, "ShapeType"):
        raise NoValue(f"{owner.Label} has no {element}")
    return shape


def _middle(shape):
    return shape.Point if shape.ShapeType == "Vertex" else shape.CenterOfMass


def _normal(face):
    if face.ShapeType != "Face":
        raise NoValue("a direction is the normal of a face")
    return face.normalAt(*face.Surface.parameter(face.CenterOfMass))


def main():
    global FreeCAD, Sketcher
    faults, model, name, version = [], None, "FreeCAD", VERSION
    try:
        if len(sys.argv) != 2:
            raise ValueError("sensitol_freecad.py takes one argument, the declaration: a .toml or .json file")
        FreeCAD = load("FreeCAD", places=PLACES, install=INSTALL)
        add_workbenches(FreeCAD)
        Sketcher = load("Sketcher", places=PLACES, install=INSTALL)
        declaration = Declaration(sys.argv[1], KEYS)
        model = Model(declaration)
        name = declaration.table.get("name", f"{declaration.document.name} in FreeCAD")
        release = ".".join(FreeCAD.Version()[:3])
        version = f"{declaration.table.get('version', VERSION)}; adapter {VERSION}, FreeCAD {release}"
    except ValueError as error:
        faults.append(error)

    def setup(hello):
        if faults:
            raise faults[0]
        model.open(hello["characteristics"])
        served.units = model.units

    def evaluate(**values):
        return model.evaluate(values)

    served = Adapter(
        evaluate,
        name=name,
        version=version,
        inputs=list(model.dimensions) if model else [],
        outputs=list(model.characteristics) if model else None,
        window=1,
        setup=setup,
    )
    served.serve()


def show(arguments):
    """Prints the declaration of a document; what FreeCAD prints meanwhile goes to stderr."""
    try:
        if len(arguments) != 1:
            raise ValueError("--list takes one argument, the document: a .FCStd file")
        freecad = load("FreeCAD", places=PLACES, install=INSTALL)
        sys.stdout.flush()
        answers = os.dup(1)
        os.dup2(2, 1)
        add_workbenches(freecad)
        text = list_document(freecad, arguments[0])
        with os.fdopen(answers, "w", encoding="utf-8") as out:
            out.write(text)
    except ValueError as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--list"]:
        show(sys.argv[2:])
    else:
        main()
