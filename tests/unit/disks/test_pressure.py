"""Pressures on walls of holes and on sides: forces and moments on disks, resultants, work."""

import numpy as np
import pytest
from scene_tables import ISOTROPIC
from small_cases import BODY, GRAINS, PUSHED, problems_of, small

from dembound.disks.pressure import in_run, membranes_of
from dembound.disks.scene import DiskScene, build
from dembound.disks.supports import forces_of
from dembound.errors import CaseError
from dembound.kinds.disks.facts import disk_facts

P = 2e6
CENTRE = (6.1, 5.2)
CIRCLE = {"type": "circle", "centre": CENTRE, "radius": 2.3}
HOLES = {
    "circle": CIRCLE,
    "ellipse": {"type": "ellipse", "centre": CENTRE, "semi_axes": [3.4, 1.3], "angle": 25.0},
    "horseshoe": {"type": "polygon", "points": [[4, 3], [8, 3], [8, 6], [6.5, 7.5], [5.5, 7.5], [4, 6]]},
    "clockwise": {"type": "polygon", "points": [[4, 6], [5.5, 7.5], [6.5, 7.5], [8, 6], [8, 3], [4, 3]]},
}
LATTICE = {"pattern": "A", "size": [12.0, 10.0], "radius": 0.25}
RANDOM = GRAINS["packing"] | {"size": [12.0, 12.0]}


def pressed(packing: dict, hole: dict, changes: dict | None = None, **load: object) -> DiskScene:
    """A body with a hole in it and a pressure on its wall."""
    tables = {"packing": packing, "material": ISOTROPIC, "run": PUSHED["run"]}
    blast = {"hole": [{"name": "h", **hole}], "load": [{"name": "p", "pressure": P, "hole": "h", **load}]}
    return build(small(tables | blast, changes=changes))


def resultants(scene: DiskScene, number: int = 0) -> tuple[np.ndarray, float]:
    """Sum of the forces (2,) N of a load, and their moment about the origin, N·m."""
    nodes, forces = forces_of(scene.case.load[number], scene)
    x, y = scene.positions[nodes].T
    return forces[:, :2].sum(axis=0), float(np.sum(x * forces[:, 1] - y * forces[:, 0] + forces[:, 2]))


@pytest.mark.parametrize(
    ("name", "packing", "on"),
    [
        ("circle", LATTICE, "outline"),
        ("ellipse", RANDOM, "outline"),
        ("horseshoe", RANDOM, "bonds"),
        ("clockwise", LATTICE, "outline"),
    ],
)
def test_a_pressure_in_a_closed_hole_is_in_balance_and_pushes_outwards(packing: dict, name: str, on: str) -> None:
    scene = pressed(packing, HOLES[name], on=on)
    nodes, forces = forces_of(scene.case.load[0], scene)
    away = scene.positions[nodes] - CENTRE
    force, moment = resultants(scene)
    largest = P * 20.0  # of a perimeter of less than 20 m

    # rounding errors, for bonds those of the linear solve of the homogenisation
    np.testing.assert_allclose(force, 0.0, atol=(1e-12 if on == "outline" else 1e-9) * largest)
    assert abs(moment) < (1e-12 if on == "outline" else 1e-9) * largest * 10.0
    assert len(np.unique(nodes)) == len(nodes) > 20
    # ∫ p x·n ds is twice p times the area; the disks lie up to two diameters of 0.6 m behind the outline
    area = {"circle": np.pi * 2.3**2, "ellipse": np.pi * 3.4 * 1.3}.get(name, 15.75)
    assert area < np.sum(forces[:, :2] * away) / (2.0 * P) < area + 0.5 * 1.2 * 20.0


def test_in_a_lattice_every_cut_bond_has_p_times_d() -> None:
    scene = pressed(LATTICE, CIRCLE, on="bonds")
    nodes, forces = forces_of(scene.case.load[0], scene)
    disks = {(round(float(x), 3), round(float(y), 3)) for x, y in scene.positions}
    for node, force in zip(nodes, forces, strict=True):
        x, y = scene.positions[node]
        cut = [
            (dx, dy)
            for dx, dy in ((0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5))
            if (round(float(x + dx), 3), round(float(y + dy), 3)) not in disks
            and np.hypot(x + dx - CENTRE[0], y + dy - CENTRE[1]) < 2.3
        ]
        np.testing.assert_allclose(force, [*(-P * np.sum(cut, axis=0)), 0.0], atol=1e-8 * P)


def test_half_a_hole_beside_a_mirror_has_the_pressure_on_its_opening() -> None:
    """Only the outline within the body counts: the resultant is p times the opening, a diameter of 4.6 m."""
    half = CIRCLE | {"centre": [0.0, 5.2]}
    scene = pressed(LATTICE, half, {"boundary.left": {"type": "symmetry"}})
    force, moment = resultants(scene)

    np.testing.assert_allclose(force, [P * 4.6, 0.0], rtol=1e-12, atol=1e-9 * P)
    assert moment == pytest.approx(-P * 4.6 * 5.2, rel=1e-12)
    assert "of wall of hole h, (9.2, 0) MN/m in all, on" in dict(disk_facts(scene))["load p"]


@pytest.mark.parametrize(("x", "is_near"), [(2.7, True), (2.9, False)])
def test_a_hole_that_cuts_bonds_across_a_periodic_side_is_refused(x: float, is_near: bool) -> None:
    """Radius 2.3 m, disks of 0.5 m: less than a bond from the side, where forces would not be in balance."""
    sides = {"boundary.left": {"type": "periodic"}, "boundary.right": {"type": "periodic"}}
    scene = pressed(LATTICE, CIRCLE | {"centre": (x, 5.2)}, sides, on="bonds")
    if is_near:
        with pytest.raises(CaseError, match=r'load\.p\.hole: "h" is so near a periodic side that it cuts bonds'):
            forces_of(scene.case.load[0], scene)
    else:
        total, moment = resultants(scene)
        np.testing.assert_allclose([*total, moment], 0.0, atol=1e-6)  # of forces of 1e6 N


CELL = 1e6
ALL = {"name": "cell", "pressure": CELL, "sides": ["left", "right", "bottom", "top"]}
GRAINY = {"packing": GRAINS["packing"], "material": GRAINS["material"], "run": {"duration": 0.01}}
CRACKED = GRAINY | {"material": GRAINS["material"] | {"law": "linearpbond", "pb_ten": 1e5, "pb_coh": 1e5}}


def balance_of(scene, displacement: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Sums of the forces (3, n) along x and y, and of their torques."""
    x, y = scene.positions.T + displacement[:2]
    return np.array([force[0].sum(), force[1].sum(), (x * force[1] - y * force[0] + force[2]).sum()])


def test_membranes_on_opposite_sides_are_in_balance_as_built() -> None:
    scene = build(small(GRAINY | {"load": [ALL | {"sides": ["left", "right"]}]}))
    force = scene.steady_load
    left = next(membranes_of(scene.case.load[0], scene))
    width, height = scene.size

    assert np.abs(balance_of(scene, np.zeros_like(force), force)).max() < 1e-9 * CELL * width * height
    assert left.forces(scene.positions, np.zeros_like(force))[:, 0].sum() == pytest.approx(CELL * height, rel=1e-12)


def test_a_closed_membrane_is_in_balance_wherever_its_disks_are() -> None:
    scene = build(small(CRACKED | {"load": [ALL]}))
    displacement = np.random.default_rng(1).uniform(-0.1, 0.1, (3, scene.count))
    force = in_run(scene, displacement, scene.steady_load)
    width, height = scene.size

    assert np.abs(balance_of(scene, displacement, force)).max() < 1e-9 * CELL * width * height
    # its work is the pressure times the area that the polygon of its disks loses
    each = {membrane.side: membrane.nodes for membrane in membranes_of(scene.case.load[0], scene)}
    ring = np.concatenate([each["bottom"], each["right"][1:], each["top"][-2::-1], each["left"][-2:0:-1]])
    change = np.random.default_rng(2).uniform(-0.1, 0.1, (2, scene.count))

    def area(sign: float) -> float:
        x, y = (scene.positions.T + displacement[:2] + sign * change)[:, ring]
        return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))

    loss = 0.5 * (area(-1.0) - area(1.0))  # of the second degree, so that this is exact
    assert float(np.sum(force[:2] * change)) == pytest.approx(CELL * loss, rel=1e-9)


def test_a_membrane_ends_at_platens_and_does_not_follow_an_elastic_body() -> None:
    platens = {"top": {"type": "roller"}, "bottom": {"type": "roller"}}
    scene = build(small(CRACKED | {"load": [ALL], "boundary": platens}))
    still, rng = np.zeros((3, scene.count)), np.random.default_rng(1)
    sides = build(small(CRACKED | {"load": [ALL | {"sides": ["left", "right"]}]})).steady_load
    assert np.allclose(in_run(scene, still, scene.steady_load), sides, atol=1e-9 * CELL)

    elastic = build(small(GRAINY | {"load": [ALL]}))
    moved = in_run(elastic, rng.uniform(-0.1, 0.1, still.shape), elastic.steady_load)
    assert np.allclose(moved, elastic.steady_load, atol=1e-9 * CELL)


@pytest.mark.parametrize(
    ("tables", "problem"),
    [
        ('sides = ["left"]\nhole = "h"', "hole: is not allowed together with sides"),
        ('sides = ["left"]\nwave = "w"', "wave: is not allowed together with sides, on which a pressure is steady"),
        ('sides = ["left", "left"]', "sides: names a side twice"),
        ("", "hole: is missing; a pressure needs the name of a hole, or sides"),
        (
            'sides = ["left"]\n[boundary.left]\ntype = "outside"',
            'sides: names left, "outside", where the body goes on;',
        ),
        ('sides = ["left"]\n[static]\n', 'nothing holds the body along x against load[1, cell]; give a side "fixed"'),
    ],
)
def test_pressures_that_cannot_act_are_refused(tables: str, problem: str) -> None:
    wave = '[wave.w]\ntype = "constant"\namplitude = 1.0\n'
    found = problems_of(f'{BODY}{wave}[[load]]\nname = "cell"\npressure = 1e6\n{tables}')
    assert [line for line in found if problem in line], found


def test_at_a_side_of_half_cells_the_wall_ends_at_their_centres() -> None:
    half_cells = {"type": "viscous", "half_mass": True}
    opening = {"type": "rectangle", "corners": [-1.0, 3.0, 2.0, 7.0]}
    for side, edge in (({"type": "viscous"}, 0.0), (half_cells, 0.25)):
        scene = pressed(LATTICE, opening, {"boundary.left": side})
        _, forces = forces_of(scene.case.load[0], scene)
        upper = forces[:, 1] > 0.0
        assert forces[upper, 1].sum() == pytest.approx(P * (2.0 - edge), rel=1e-9)
    # of bonds along the side half
    scene = pressed(LATTICE, opening, {"boundary.left": half_cells}, on="bonds")
    _, forces = forces_of(scene.case.load[0], scene)
    upper = forces[:, 1] > 1e-9 * P
    assert forces[upper, 1].sum() == pytest.approx(P * (2.0 - 0.25), rel=1e-9)
