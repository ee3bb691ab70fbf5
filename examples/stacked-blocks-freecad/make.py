"""Writes blocks.FCStd: the stacked blocks as one constrained sketch. Run it with the Python for which FreeCAD is built:
`/usr/bin/python3 make.py [FILE]`.

Nothing here knows the gap's formula: the sketch says what lies on what, and FreeCAD's solver finds where.
"""

import math
import pathlib
import sys

sys.path += ["/usr/lib/freecad-python3/lib", "/usr/lib/freecad/lib"]

import FreeCAD
import Part
import Sketcher
from FreeCAD import Vector
from Sketcher import Constraint

NOMINAL = {"a": 10.0, "b": 30.0, "c": 31.9, "e": 55.0, "f": 75.0, "R": 40.0, "r": 10.0, "th": math.radians(17.0)}
ORIGIN, START, END, CENTRE = -1, 1, 2, 3


def main(path):
    document = FreeCAD.newDocument("blocks")
    sketch = document.addObject("Sketcher::SketchObject", "Blocks")
    n = NOMINAL
    # A drawing that is about right; the solver makes it exact. Points as they lie in the assembly.
    along, up = Vector(math.cos(n["th"]), math.sin(n["th"])), Vector(-math.sin(n["th"]), math.cos(n["th"]))
    corner = Vector(n["b"], n["c"])
    cylinder = Vector(20, 60)
    round_centre = Vector(-1.7, 79.7)
    foot = round_centre - up * n["R"]
    touching = round_centre - up * n["e"]
    geometry = [
        Part.LineSegment(Vector(n["a"], 0), Vector(n["a"], 75)),  # 0 the frame's wall
        Part.LineSegment(touching, corner),  # 1 the frame's slope, from under the round to the corner at b, c
        Part.LineSegment(round_centre, touching),  # 2 square to the slope, e long: the block's height
        Part.ArcOfCircle(  # 3 the block's round, from the wall to the right
            Part.Circle(round_centre, Vector(0, 0, 1), n["R"]), math.radians(-73), 0.0
        ),
        Part.Circle(cylinder, Vector(0, 0, 1), n["r"]),  # 4 the cylinder
        Part.LineSegment(Vector(n["a"], n["f"]), Vector(60, n["f"])),  # 5 the frame's ceiling
        Part.LineSegment(cylinder, cylinder + Vector(0, n["r"])),  # 6 up to the cylinder's top
        Part.LineSegment(round_centre, round_centre + (foot - round_centre)),  # 7 the round's radius that ends at the wall
    ]
    for index, one in enumerate(geometry):
        sketch.addGeometry(one, index in (2, 6, 7))

    def add(name, *constraint, driving=True):
        index = sketch.addConstraint(Constraint(*constraint))
        if name:
            sketch.renameConstraint(index, name)
        if not driving:
            sketch.setDriving(index, False)

    add(None, "Vertical", 0)
    add(None, "PointOnObject", 0, START, -1)
    add("a", "DistanceX", ORIGIN, START, 0, START, n["a"])
    add("b", "DistanceX", ORIGIN, START, 1, END, n["b"])
    add("c", "DistanceY", ORIGIN, START, 1, END, n["c"])
    add("th", "Angle", 1, n["th"])
    add(None, "Coincident", 2, END, 1, START)
    add(None, "Perpendicular", 2, 1)
    add(None, "Coincident", 2, START, 3, CENTRE)
    add("e", "Distance", 2, n["e"])
    add("R", "Radius", 3, n["R"])
    add(None, "Coincident", 7, START, 3, CENTRE)
    add(None, "Coincident", 7, END, 3, START)
    add(None, "PointOnObject", 7, END, 2)
    add(None, "PointOnObject", 7, END, 0)
    add(None, "Horizontal", 3, CENTRE, 3, END)
    add("r", "Radius", 4, n["r"])
    add(None, "Tangent", 4, 0)
    add(None, "Tangent", 4, 3)
    add(None, "Horizontal", 5)
    add(None, "Coincident", 5, START, 0, END)
    add("f", "DistanceY", ORIGIN, START, 5, END, n["f"])
    add("ceiling", "Distance", 5, 50.0)
    add(None, "Vertical", 6)
    add(None, "Coincident", 6, START, 4, CENTRE)
    add(None, "PointOnObject", 6, END, 4)
    add("gap", "DistanceY", 6, END, 5, END, 6.0, driving=False)
    document.recompute()
    if sketch.solve() != 0 or not sketch.FullyConstrained:
        raise SystemExit("the sketch does not solve")
    document.saveAs(str(path))
    print(f"{path}: gap {sketch.getDatum('gap').Value:.9f} mm")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).with_name("blocks.FCStd"))
