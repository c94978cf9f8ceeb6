"""Memory of a continuum, from numbers that are known without its arrays."""

import numpy as np
import pytest
from meshes import stepped

from dembound.continuum.mesh import Around, Mesh
from dembound.continuum.sizing import GridSizes

BOX = (0.0, 0.0, 40.0, 20.0)
MESHES = {
    "three sides": Mesh.around(BOX, (5.0, 5.0), 4, margin=Around(2, 2, 2), layer=Around(3, 3, 3)),
    "four sides": Mesh.around(BOX, (10.0, 5.0), 3, margin=Around(1, 2, 1, 2), layer=Around(3, 4, 3, 2)),
    "a corner": Mesh.around(BOX, (5.0, 10.0), 5, margin=Around(0, 1, 1, 0), layer=Around(0, 3, 3, 0)),
    "two sides": Mesh.around(BOX, (20.0, 20.0), 6, margin=Around(1, 1), layer=Around(2, 2)),
    "lower beside it": stepped(),
    "lower at one side": Mesh.around(
        BOX, (5.0, 5.0), 4, margin=Around(0, 2, 1), layer=Around(0, 3, 3), rows=(8.0, 6.0, 6.0), levels=(3, 1)
    ),
    "periodic": Mesh.uniform(order=4, element=(5.0, 5.0), cells=(7, 9), periodic=(True, False), layer=Around(top=3)),
}


@pytest.mark.parametrize("name", MESHES)
def test_numbers_are_those_of_the_arrays(name: str) -> None:
    mesh = MESHES[name]
    sizes = GridSizes.of(mesh)

    assert sizes.nodes == mesh.count
    assert sizes.elements == len(mesh.elements)
    assert sizes.absorbing == np.count_nonzero(mesh.absorbs.any(axis=1))
