"""Meshes of a few elements for tests of several modules."""

from dembound.continuum.axis import Around
from dembound.continuum.mesh import Mesh

ORDER = 4


def buried() -> Mesh:
    """Round a box of 2 × 1 elements of 3 × 2 m on all four sides."""
    return Mesh.around((10.0, 20.0, 16.0, 22.0), (3.0, 2.0), ORDER, margin=Around(1, 2, 1, 1), layer=Around(2, 1, 1, 1))


def uneven() -> Mesh:
    """Columns of three widths and rows of three heights, round a box of 3 × 2 m whose corner is at (4, 5) m."""
    return Mesh(
        order=ORDER,
        widths=(1.5, 2.5, 2.0, 1.0, 2.0),
        heights=(3.0, 2.0, 2.0, 3.0, 1.0),
        origin=(0.0, 0.0),
        box=(2, 2, 4, 3),
        layer=Around(2, 1, 1, 2),
    )


def one_across() -> Mesh:
    """Below a box of 6 × 4 m that is periodic along x, of one element across."""
    return Mesh.around(
        (0.0, 0.0, 6.0, 4.0), (6.0, 2.0), ORDER, margin=Around(bottom=1), layer=Around(bottom=2), periodic=(True, False)
    )


def below() -> Mesh:
    """Round a box that reaches the free surface."""
    return Mesh.around((0.0, 0.0, 6.0, 2.0), (3.0, 2.0), ORDER, margin=Around(1, 1, 1, 0), layer=Around(1, 1, 1, 0))


def stepped() -> Mesh:
    """Round a box of 6 × 9 m at the surface; the surface is 6 m lower at the left and 4 m lower at the right."""
    return Mesh.around(
        (0.0, 0.0, 6.0, 9.0),
        (3.0, 3.0),
        ORDER,
        margin=Around(2, 1, 1, 0),
        layer=Around(1, 1, 1, 0),
        rows=(3.0, 2.0, 4.0),
        levels=(1, 2),
    )
