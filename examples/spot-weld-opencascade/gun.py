"""A spot-welding gun of two arms on one frame, as solids: what the electrodes leave between them, measured on the kernel's faces.

Each arm turns on a pivot of the frame. It goes out along x, bends towards the other arm, goes on, and carries an electrode
that stands upright in the nominal gun. Lengths in mm, angles in degrees.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "adapters" / "opencascade"))

from sensitol_opencascade import along, b3d, centre, model, normal

MOUNT = 30.0  # of the electrode to the second half of its arm
WIDTH, RADIUS = 40.0, 8.0


def arm(side, x, y, z, tilt_x, tilt_z, swing, inner, bend, outer, electrode):
    """The solids of an arm in the frame, and the faces that are measured: tip of the electrode, side of the arm."""
    towards = -side  # of the other arm: the upper one's electrode points down
    pivot = b3d.Pos(x, y, z) * b3d.Rot(Z=tilt_z) * b3d.Rot(X=tilt_x) * b3d.Rot(Y=side * swing)
    elbow = pivot * b3d.Pos(X=inner) * b3d.Rot(Y=side * bend)
    mount = elbow * b3d.Pos(X=outer) * b3d.Rot(Y=-side * MOUNT)
    first = b3d.Box(inner, WIDTH, WIDTH, align=(b3d.Align.MIN, b3d.Align.CENTER, b3d.Align.CENTER))
    second = b3d.Box(outer, WIDTH, WIDTH, align=(b3d.Align.MIN, b3d.Align.CENTER, b3d.Align.CENTER))
    rod = b3d.Cylinder(RADIUS, electrode, align=(b3d.Align.CENTER, b3d.Align.CENTER, b3d.Align.MIN))
    if towards < 0:
        rod = b3d.Rot(X=180) * rod
    rod = mount * rod
    second = elbow * second
    # Where the rod is in the arm there is nothing to choose; its far end is the tip.
    tip = max(rod.faces().filter_by(b3d.GeomType.PLANE), key=lambda face: along(mount.position, centre(face), normal(face)))
    left = second.faces().sort_by(lambda face: along(elbow.position, centre(face), _y(elbow)))[-1]
    return [pivot * first, second, rod], tip, left


def _y(location):
    return location.y_axis.direction


@model(outputs=["gap", "flush_x", "flush_y"], version="1")
def gun(
    upper_x, upper_y, upper_z, upper_tilt_x, upper_tilt_z, upper_swing, upper_inner, upper_bend, upper_outer, upper_electrode,
    lower_x, lower_y, lower_z, lower_tilt_x, lower_tilt_z, lower_swing, lower_inner, lower_bend, lower_outer, lower_electrode,
):  # fmt: skip
    upper = arm(1, upper_x, upper_y, upper_z, upper_tilt_x, upper_tilt_z, upper_swing, upper_inner, upper_bend, upper_outer, upper_electrode)
    lower = arm(-1, lower_x, lower_y, lower_z, lower_tilt_x, lower_tilt_z, lower_swing, lower_inner, lower_bend, lower_outer, lower_electrode)
    start, end = centre(lower[1]), centre(upper[1])
    up, left = normal(lower[1]), normal(lower[2])
    return {
        "gap": along(start, end, up),
        "flush_x": along(start, end, left.cross(up)),
        "flush_y": along(start, end, left),
    }


if __name__ == "__main__":
    gun.serve()
