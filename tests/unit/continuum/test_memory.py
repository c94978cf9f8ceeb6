"""Memory of a continuum, from numbers that are known without its arrays."""

import numpy as np
import pytest
from meshes import stepped

from dembound.continuum.medium import Medium
from dembound.continuum.mesh import Around, Mesh
from dembound.continuum.part import GridBody
from dembound.continuum.sizing import GridSizes
from dembound.motion.memory import total

ROCK = Medium.isotropic(2500.0, 1000.0, 600.0)
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


@pytest.mark.parametrize(("name", "order"), [("three sides", 4), ("a corner", 3)])
def test_bytes_are_those_of_the_arrays(name: str, order: int) -> None:
    """For a mesh with so many elements that those which fill the blocks up do not matter."""
    side = MESHES[name].layer
    mesh = Mesh.around(
        BOX, (0.5, 0.5), order, margin=Around(*(5 * (s > 0) for s in side)), layer=Around(*(9 * (s > 0) for s in side))
    )
    body, sizes = GridBody(mesh=mesh, medium=ROCK), GridSizes.of(mesh)
    body.fill_forces(np.zeros((3, body.blocks.end)), np.zeros((3, body.blocks.end)))
    law = body.law(1e-4)
    memories = law.absorber.strain_memory.nbytes + law.absorber.force_memory.nbytes
    held = [*vars(mesh).values(), *vars(body.blocks).values(), *vars(body).values(), body.mass, body._elastic.force]
    held += [each for bundle in (body.blocks.bundle, law.absorber) for each in bundle]
    held += [mesh.positions, mesh.depth, law.force, mesh.areas, mesh.crossing]
    arrays = {id(each): each.nbytes for each in held if isinstance(each, np.ndarray)}
    lines = sum(each.nbytes for each in mesh._element_lines)
    in_scene = 48.0 * sizes.nodes  # positions, mass, inertia, slot and node of the scene's layout

    assert total(sizes.counts, "layers") == pytest.approx(memories, rel=0.03)
    assert total(sizes.counts, "mesh", "layers") == pytest.approx(sum(arrays.values()) + lines + in_scene, rel=0.1)
