"""Delay of waves that enter disks, relative to waves through the plane of a side."""

from typing import Any

import numpy as np
import pytest
from small_cases import small

from dembound.accuracy.runner import measure
from dembound.disks.scene import build
from dembound.formulas.disks.entry import entries_of, late_by
from dembound.running import Progress

D = 0.5
PERIODIC = {"type": "periodic"}
ROW = {
    "packing": {"pattern": "A", "size": [2.0, 40.0], "radius": 0.5 * D},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
    "boundary": {"left": PERIODIC, "right": PERIODIC},
    "wave": {"w": {"type": "cosine", "amplitude": 1.0, "period": 0.04}},
    "run": {"duration": 0.05},
}
"""A column of an isotropic lattice, the wave 80 disks long."""


def driven(side: str = "bottom", motion: str = "p", **table: Any) -> dict[str, Any]:
    """The column, turned for a side across x, whose waves enter as a table says."""
    sideways = side in ("left", "right")
    around = dict.fromkeys(("bottom", "top") if sideways else ("left", "right"), PERIODIC)
    size = [40.0, 2.0] if sideways else [2.0, 40.0]
    packing = ROW["packing"] | {"size": size}
    return ROW | {"packing": packing, "boundary": {**around, side: {f"wave_{motion}": "w", **table}}}


def late(tables: dict[str, Any], side: str = "bottom", motion: str = "p") -> float:
    return entries_of(build(small(tables)))[side][motion].late


@pytest.mark.parametrize("side", ["left", "right", "bottom", "top"])
def test_p_waves_enter_a_lattice_at_centres_and_dashpots_move_the_row_outside_of_these(side: str) -> None:
    """Half of a row of whole disks lies outside its centres, so half of D/2 remains; for half cells nothing remains."""
    assert late(driven(side, type="velocity"), side) == pytest.approx(-D / 2, abs=1e-5)
    assert late(driven(side, type="viscous_input"), side) == pytest.approx(-D / 4, abs=1e-5)
    assert late(driven(side, type="viscous_input", half_mass=True), side) == pytest.approx(-D / 2, abs=1e-5)


@pytest.mark.parametrize("side", ["right", "bottom"])
def test_the_time_is_the_same_wherever_the_scene_is(side: str) -> None:
    tables = driven(side, type="velocity")
    moved = tables | {"packing": tables["packing"] | {"origin": [-3.5, 61.25]}}
    assert late(moved, side) == pytest.approx(late(tables, side), abs=1e-9)  # rounding of 100 m


def test_disks_of_a_driven_row_turn_less_so_that_s_waves_enter_farther_inside() -> None:
    """Without bending they turn half as far, and the row shears by 7/4 F/k in place of 2 F/k: 1/8 D farther.

    With the bending of the bonds it is a little more, and a row of half cells turns as those inside.
    """
    found = late(driven("bottom", "s", type="velocity"), motion="s")
    assert -0.65 * D < found < -0.625 * D
    assert late(driven("bottom", "s", type="viscous_input"), motion="s") == pytest.approx(0.5 * found, rel=1e-4)
    half = driven("bottom", "s", type="viscous_input", half_mass=True)
    assert late(half, motion="s") == pytest.approx(-0.5 * D, abs=1e-3 * D)


def test_soft_dashpots_leave_the_mass_outside_of_them_behind() -> None:
    """(Z s + Z′ m)/(Z + Z′) with m = 0: Z/(Z + Z′) of D/2, a tenth with a ninth of the matched factor."""
    soft = driven("bottom", type="viscous_input", beta_p=1.0 / 9.0)
    assert late(soft) == pytest.approx(-0.1 * D / 2, rel=0.01)  # the homogenised β0 is 1 within 1 %


@pytest.mark.parametrize(("kind", "motion"), [("velocity", "s"), ("viscous_input", "p"), ("outside", "p")])
def test_a_wave_comes_as_much_later_as_it_enters(kind: str, motion: str) -> None:
    """Beside v(t − (y + late)/c), of a wave 57 to 80 disks long.

    After 7 m of the lattice it lags by (2πD/λ)²/24 of that, 3.5 mm, and changes its form; the entry is 0 to 315 mm.
    """
    tables = driven("bottom", motion, type=kind) | {"monitor": [{"name": "inside", "position": [1.25, 7.25]}]}
    case = small(tables)
    scene = build(case)
    entry = entries_of(scene)["bottom"][motion]
    own = measure(case, Progress())[0].motions["inside"]
    velocity = own.velocity[:, 1 if motion == "p" else 0]
    wave, y = case.wave["w"], float(own.place[1])
    rest = [
        float(np.linalg.norm(velocity - wave.velocity(own.time - (y + at) / entry.speed)) / np.linalg.norm(velocity))
        for at in (entry.late - 0.02, entry.late, entry.late + 0.02)
    ]
    assert rest[1] < min(rest[0], rest[2])  # within 10 mm
    assert late_by(scene) == pytest.approx(entry.late / entry.speed)


def test_through_a_continuum_waves_enter_where_it_ends() -> None:
    """Beyond the row of pattern C, whose disks are centred on the side: half of a row later."""
    packing = {"pattern": "C", "size": [4.0, 8.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
    tables = driven("bottom", type="outside") | {"packing": packing | {"edge_radius": 0.25, "seed": 1}}
    scene = build(small(tables))
    found = entries_of(scene)["bottom"]["p"]
    assert found.late == pytest.approx(-scene.outside.box[1])
    assert found.late == pytest.approx(0.25, abs=0.02)  # D/2 of a row
    assert found.delay == pytest.approx(found.late / scene.ground.wave_speeds(1)[0])
