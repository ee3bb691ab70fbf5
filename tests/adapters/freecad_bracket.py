"""Writes a PartDesign document: `/usr/bin/python3 freecad_bracket.py FILE`. A plate (pad) with three blind holes (pocket and
linear pattern), and a ring (revolution). No constraint has a name, as in most documents."""

import sys

sys.path += ["/usr/lib/freecad-python3/lib", "/usr/lib/freecad/lib", "/usr/share/freecad/Mod"]

import FreeCAD
import Part
import PartDesign
import Sketcher
from FreeCAD import Vector
from Sketcher import Constraint

ORIGIN, START, END, CENTRE = -1, 1, 2, 3


def sketch(body, name, plane, lift=0.0):
    found = body.newObject("Sketcher::SketchObject", name)
    found.Support = (next(one for one in body.Origin.OriginFeatures if one.Name.startswith(plane)), [""])
    found.MapMode = "FlatFace"
    found.AttachmentOffset = FreeCAD.Placement(Vector(0, 0, lift), FreeCAD.Rotation())
    return found


def rectangle(found, x, y, width, height):
    """Constraints 8 to 11: left, bottom, width, height."""
    corners = [Vector(x, y), Vector(x + width, y), Vector(x + width, y + height), Vector(x, y + height)]
    for i in range(4):
        found.addGeometry(Part.LineSegment(corners[i], corners[(i + 1) % 4]))
    for i in range(4):
        found.addConstraint(Constraint("Coincident", i, END, (i + 1) % 4, START))
    for i in range(4):
        found.addConstraint(Constraint("Horizontal" if i % 2 == 0 else "Vertical", i))
    found.addConstraint(Constraint("DistanceX", ORIGIN, START, 0, START, x))
    found.addConstraint(Constraint("DistanceY", ORIGIN, START, 0, START, y))
    found.addConstraint(Constraint("DistanceX", 0, START, 0, END, width))
    found.addConstraint(Constraint("DistanceY", 1, START, 1, END, height))


document = FreeCAD.newDocument("bracket")
plate = document.addObject("PartDesign::Body", "Plate")
outline = sketch(plate, "Outline", "XY_Plane")
rectangle(outline, 5.0, 5.0, 60.0, 30.0)
pad = plate.newObject("PartDesign::Pad", "Pad")
pad.Profile, pad.Length = outline, 10.0
document.recompute()
# The holes are drilled upwards from the ground, so that the plate's thickness does not move them.
hole = sketch(plate, "Hole", "XY_Plane")
hole.addGeometry(Part.Circle(Vector(15, 20), Vector(0, 0, 1), 4))
hole.addConstraint(Constraint("Radius", 0, 4.0))
hole.addConstraint(Constraint("DistanceX", ORIGIN, START, 0, CENTRE, 15.0))
hole.addConstraint(Constraint("DistanceY", ORIGIN, START, 0, CENTRE, 20.0))
pocket = plate.newObject("PartDesign::Pocket", "Pocket")
pocket.Profile, pocket.Length, pocket.Reversed = hole, 6.0, True
document.recompute()
pattern = plate.newObject("PartDesign::LinearPattern", "LinearPattern")
pattern.Originals, pattern.Direction = [pocket], (outline, ["H_Axis"])
pattern.Length, pattern.Occurrences = 30.0, 3
plate.Tip = pattern
document.recompute()
ring = document.addObject("PartDesign::Body", "Ring")
profile = sketch(ring, "Profile", "XZ_Plane")
rectangle(profile, 20.0, 0.0, 3.0, 5.0)
revolution = ring.newObject("PartDesign::Revolution", "Revolution")
revolution.Profile, revolution.ReferenceAxis, revolution.Angle = profile, (profile, ["V_Axis"]), 360.0
document.recompute()
broken = [one.Name for one in document.Objects if "Invalid" in one.State]
if broken:
    raise SystemExit(f"does not recompute: {broken}")
document.saveAs(sys.argv[1])
