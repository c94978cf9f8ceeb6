"""The continuum beyond sides that holes reach, and round disks of layered ground."""

from typing import Any

import h5py
import numpy as np
import pytest
from scene_tables import grains
from small_cases import GRAINS, GROUND, SURROUNDED, around, problems_in, small

from dembound.boundaries.support import Edge
from dembound.continuum.medium import Layered, Medium
from dembound.disks.material.layered import LayeredGround
from dembound.disks.scene import DiskScene, build, ground_of
from dembound.disks.surroundings.cut_bonds import CutBonds
from dembound.disks.surroundings.edges import edge_without
from dembound.disks.surroundings.frequencies import frequencies_of, share_above
from dembound.disks.surroundings.media import medium_of
from dembound.kinds.disks.facts import disk_facts
from dembound.motion.simulation import Simulation
from dembound.packings.cut import cut_contacts
from dembound.results.recorder import Recorder

CASE = GROUND | {"material": GROUND["material"] | {"fric": 0.5}, "outside": {"element": 4.0}}


def scene(*points: tuple[float, float], **changes: Any) -> DiskScene:
    """30 m × 20 m of disks with a hole."""
    hole = {"name": "cut", "type": "polygon", "points": [list(point) for point in points]}
    return build(small(CASE, changes={"hole": [hole]} | changes))


def line(*points: tuple[float, float], **changes: Any) -> str:
    (only,) = problems_in(lambda: scene(*points, **changes))
    return only


def slope(height: float, end: float = 31.0, last: float | None = None) -> list[tuple[float, float]]:
    """Corners from (10, 20) m down to a floor at this height, up to x = `end`, where it may have another height."""
    return [(10.0, 21.0), (18.0, height), (end, height if last is None else last), (end, 21.0)]


@pytest.mark.parametrize("height", [11.499999999, 11.500000001, 11.7])
def test_disks_below_a_floor_remain_and_are_tied(height: float) -> None:
    """A row with centres on the floor, within rounding, is below or above it for body and continuum alike."""
    made = scene(*slope(height))
    bonds, x = made.outside.wall.bonds, made.assembly.positions
    at_right = x[x[:, 0] == 29.5, 1]
    highest = at_right.max() + 0.5

    assert highest == (12.0 if height > 11.5 - 1e-8 and 11.5 in at_right else 11.0)
    assert (bonds.side == 1).sum() == highest
    assert made.outside.levels["right"].surface == pytest.approx(highest, abs=1e-9)
    whole = made.outside.body.mesh
    assert whole.positions[whole.positions[:, 0] > 30.1, 1].max() == pytest.approx(highest, abs=1e-9)
    mass = made.outside.body.mass.sum() + made.mass[: made.disk_count].sum()
    removed = 30.0 * 20.0 - len(made.assembly.radii)
    beyond = (whole.size[0] - 30.0) / 2.0
    assert mass == pytest.approx(2500.0 * (np.prod(whole.size) - removed - beyond * (20.0 - highest)), rel=1e-9)


def test_floors_that_the_continuum_cannot_have_are_refused() -> None:
    """At the side; a pillar there stands in the last row of disks, and the hole passes before it."""
    said = "reaches boundary.right, beyond which the ground is level: beside it the hole must take all disks down to"
    assert line(*slope(12.0, last=8.0)).startswith(f"hole[1, cut]: {said} one height, over at least 4 m (now 2.25 m at")
    pillar = [*slope(12.0, 28.9)[:3], (28.9, 14.0), (31.0, 14.0), (31.0, 17.0), (28.9, 17.0), (28.9, 21.0)]
    assert "hole[1, cut]: reaches boundary.right, where the continuum has no hole" in line(*pillar)


ROCK, SOIL = Medium.isotropic(2300.0, 1400.0, 700.0), Medium.isotropic(1800.0, 400.0, 200.0)
SIDES = ("left", "right", "bottom")


GRANULAR = CASE | {"packing": grains(12.0, 18.0, 0.5, 6.0, 0), "wave": {}}
SLOW = {"density": 2000.0, "p_wave_speed": 500.0}


def test_ties_have_the_springs_of_the_layer_of_their_disk() -> None:
    """Far from the joint: half a bond is twice as stiff as the bond of the layer, with the layer's correctors."""
    layered = build(small(GRANULAR | {"layer": [SLOW | {"thickness": 9.0}, {}]}))
    ground, body = layered.ground, layered.assembly
    assert isinstance(ground, LayeredGround)
    cut = cut_contacts(ground.brick, body, SIDES)
    bonds = CutBonds.of(ground, cut, body.positions)
    for high, material in ((False, ground.layers[0].material), (True, ground.layers[1].material)):
        away = bonds.height > 9.0 + 3.0 if high else bonds.height < 9.0 - 3.0
        alone = CutBonds.of(material, cut, body.positions)
        assert away.any()
        for name in ("particle", "normal", "stiffness", "corrector", "force", "side"):
            np.testing.assert_array_equal(getattr(bonds, name)[..., away], getattr(alone, name)[..., away])


def test_media_and_densities_of_layers() -> None:
    layered = build(small(GRANULAR | {"layer": [SLOW | {"thickness": 9.0}, {}]}))
    ground = medium_of(layered.ground)
    assert isinstance(ground, Layered)
    assert ground.joints == (9.0,)
    assert [each.density for each in ground.media] == [2500.0, 2000.0]

    body = layered.outside.body
    y = body.mesh.positions[:, 1]
    density = body.mass / body.mesh.areas
    inner = (y < y.max() - 0.1) & (np.abs(y - body.ground.joints[0]) > 0.1)
    np.testing.assert_allclose(density[inner], np.where(y[inner] > body.ground.joints[0], 2000.0, 2500.0))


def beside(*sides: str, **changes: object) -> DiskScene:
    """A body of 12 m × 6 m with a continuum on some sides."""
    packing = {"packing": grains(12.0, 6.0, 0.5, 6.0, 0), "material.fric": 0.0, "wave": {}}
    return build(small(CASE | {"boundary": {}}, changes=packing | {"boundary": around("outside", *sides)} | changes))


def test_free_edges_lie_a_skin_below_the_body() -> None:
    corner = beside("right", "bottom")
    mesh, skin = corner.outside.body.mesh, corner.ground.skin
    assert corner.outside.skins == {"left": skin("left"), "top": skin("top")}
    assert 0.05 < min(skin("left"), skin("top")) < max(skin("left"), skin("top")) - 1e-3 < 0.5
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    assert (low[0], high[1]) == pytest.approx((skin("left"), 6.0 - skin("top")), abs=1e-12)
    facts = dict(disk_facts(corner))
    expected = f"{skin('left'):.3f} m inside the left side, {skin('top'):.3f} m inside the top side"
    assert facts["its free edges"] == expected
    # the sides with ties are where the mass ends, a whole number of elements from the free edges
    x, y = corner.ground.brick.mass_offset
    left, right, lower, upper = mesh.sides
    assert (left, right, lower, upper) == pytest.approx((skin("left"), 12.0 + x, y, 6.0 - skin("top")), abs=1e-12)
    sizes = (right - left) / 3, (upper - lower) / 2
    np.testing.assert_allclose(mesh.element_sizes, np.tile(sizes, (len(mesh.elements), 1)), rtol=1e-12)


def test_the_mass_up_to_where_that_of_the_packing_ends_is_kept() -> None:
    corner = beside("right", "bottom")
    mesh = corner.outside.body.mesh
    right, bottom = 4 * mesh.element_sizes[0]  # one element and three that absorb
    area = (12.0 + right) * (6.0 + bottom) - 12.0 * 6.0
    # at the corner of the two legs' outer ends nothing is doubled: edges end where elements end
    assert corner.outside.body.mass.sum() == pytest.approx(2500.0 * area, rel=1e-12)


WAVES = {
    "boundary.bottom": {"type": "outside", "wave_s": "up"},
    "wave.up": {"type": "cosine", "amplitude": 1.0, "period": 0.1},
    "output.peaks": True,
}


def test_beside_a_column_the_total_motion_is_recorded_too(tmp_path) -> None:
    """Disks in a continuum beside a column, all of which is in random motion."""
    scene = build(small(SURROUNDED, "waved", WAVES))
    simulation, rng, name = Simulation(scene, 1e-4), np.random.default_rng(3), "velocity"
    with Recorder(tmp_path / "run.h5", simulation, 2e-4) as recorder:
        simulation.state.velocity = rng.normal(size=(3, scene.count)) * scene.moves
        recorder.snapshot()
    values = simulation.state.velocity
    own = values[:, scene.beside.nodes].T
    row = scene.positions[: scene.column_count, 1]
    heights = np.unique(row)
    means = [[values[axis, : scene.column_count][row == height].mean() for height in heights] for axis in (0, 1)]
    up = scene.positions[scene.beside.nodes, 1]
    known = (up >= -1e-9)[:, None]  # the column reaches down to y = 0
    ground = np.column_stack([np.interp(up, heights, means[axis]) for axis in (0, 1)])
    with h5py.File(tmp_path / "run.h5") as file:
        beyond = file["snapshots/0000/continuum"]
        np.testing.assert_array_equal(beyond[f"scattered_{name}"][:], own)
        np.testing.assert_allclose(beyond[name][:, :2], own[:, :2] + ground * known, atol=1e-12)
    assert np.abs(ground).max() > 0.1 * np.abs(own).max()


DIAMETERS = np.array([0.4, 0.6, 0.5, 0.8, 0.7])
EDGE = Edge("right", np.array([2, 3, 5, 7, 11]), np.column_stack([np.full(5, 9.0), np.arange(5.0)]), DIAMETERS, 3.6)


def test_what_is_left_of_a_side_stands_for_its_own_share_of_the_length() -> None:
    left = edge_without(EDGE, np.array([1, 2, 4, 5, 9, 11]))

    # by diameters: 0.4 + 0.5 + 0.7 of 3.0 m, whatever the number of disks; so every one stands for as much as before,
    # 1.2 of its diameter
    assert left.length == pytest.approx(1.6 * 1.2, rel=1e-14)
    assert left.nodes.tolist() == [1, 3, 5]  # where 2, 5 and 11 stand among what is kept
    assert left.diameters.tolist() == [0.4, 0.5, 0.7]
    assert left.positions[:, 1].tolist() == [0.0, 2.0, 4.0]
    assert left.side == "right"


@pytest.mark.parametrize("bottom", ["free", "periodic"])
def test_a_side_with_a_frame_is_as_long_as_its_disks_together(bar, bottom: str) -> None:
    packing = {"pattern": "C", "size": [4.0, 8.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
    sides = {"left": {"type": "free"}, **{side: {"type": bottom} for side in ("bottom", "top")}}
    framed = {"packing": packing | {"edge_radius": 0.26}, "boundary": sides, "wave": {}, "monitor": []}
    edges = build(bar({**framed, "motion.held": []})).edges

    # eight equal disks to a brick of 4 m, each touching the next; where the frame is closed one more at the far end
    more = 0.0 if bottom == "periodic" else 0.5
    lengths = {"left": 8.0 + more, "right": 8.0 + more} | ({} if more == 0.0 else {"bottom": 4.5, "top": 4.5})
    assert {side: edge.length for side, edge in edges.items()} == pytest.approx(lengths, rel=1e-12)
    assert [edge.diameter_sum_ratio for edge in edges.values()] == pytest.approx([1.0] * len(edges), rel=1e-12)


def test_a_single_frequency_halves_the_energy() -> None:
    case = small(GRAINS)
    (wave,), (middle,) = case.wave.values(), frequencies_of(case, ground_of(case), 1)
    assert share_above(wave, middle) == pytest.approx(0.5, abs=0.15)  # one sample of so short a pulse's spectrum
