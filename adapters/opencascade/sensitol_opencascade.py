"""Geometry on the OpenCASCADE kernel as a model, by build123d: see README.md.

    from sensitol_opencascade import b3d, along, centre, model, normal

    @model(outputs=["gap"], version="1")
    def block(height, depth):
        slot = b3d.Pos(0, 0, depth) * b3d.Box(10, 10, 1)
        ...
        return {"gap": along(centre(floor), centre(ceiling), normal(floor))}

    if __name__ == "__main__":
        block.serve()
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))

from sensitol_adapter import Adapter, NoValue, load

__all__ = ["NoValue", "along", "b3d", "centre", "model", "normal", "one", "play"]

INSTALL = "pip install build123d"


class _Kernel:
    """build123d, loaded when it is first used: by then descriptor 1 belongs to the protocol, and the kernel may print."""

    def __init__(self):
        self._module = None

    def _load(self):
        if self._module is None:
            self._module = load("build123d", places=[], install=INSTALL)
        return self._module

    def __getattr__(self, name):
        return getattr(self._load(), name)


b3d = _Kernel()


def model(**options):
    """Decorates a function that builds geometry from named dimensions and returns a dict of measures.

    The options are those of `sensitol_adapter.Adapter`; build123d's version becomes part of the model's.
    """

    def decorated(function):
        def setup():
            module = b3d._load()
            served.version = f"{options.get('version', '1')}; build123d {module.__version__}"

        # One point at a time: sentinels come as often as they can.
        served = Adapter(function, **{"window": 1, "setup": setup, **options})
        return served

    return decorated


def one(shapes, what):
    """The only shape of a list, which is how a face is picked: a selection that finds none or several is an error."""
    shapes = list(shapes)
    if len(shapes) != 1:
        raise NoValue(f"{len(shapes)} of {what} where one was expected")
    return shapes[0]


def centre(shape):
    """The point of a vertex, or the centre of mass of an edge, face or solid."""
    return shape.center(b3d.CenterOf.MASS) if not isinstance(shape, b3d.Vertex) else b3d.Vector(*shape.to_tuple())


def normal(face):
    """The outward unit normal of a plane face."""
    if face.geom_type != b3d.GeomType.PLANE:
        raise NoValue(f"a normal is asked of a face that is no plane but {face.geom_type.name.lower()}")
    return face.normal_at(centre(face))


def along(start, end, direction):
    """The signed way from one point to another along a unit vector: negative where they have changed sides.

    The kernel's least distance cannot say that: it ends at 0, and interference looks like contact.
    """
    return (end - start).dot(direction)


def play(hole, pin):
    """Radius of a cylindrical hole less that of a pin and their offset at the middle of the pin: negative where they bind.

    Both are cylindrical faces; the pin's axis is taken as parallel to the hole's.
    """
    for face in (hole, pin):
        if face.geom_type != b3d.GeomType.CYLINDER:
            raise NoValue(f"a cylinder is needed, not {face.geom_type.name.lower()}")
    axis = hole.axis_of_rotation
    offset = centre(pin) - axis.position
    across = offset - axis.direction * offset.dot(axis.direction)
    return hole.radius - pin.radius - across.length
