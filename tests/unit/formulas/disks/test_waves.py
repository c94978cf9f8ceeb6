"""Delays of plane waves on disks: closed forms for the square lattice."""

import math
from typing import Any

import numpy as np
import pytest
from small_cases import PUSHED, around, small

from dembound.accuracy.runner import measure
from dembound.disks.scene import DiskScene, build
from dembound.formulas.disks.entry import entries_of, late_by
from dembound.formulas.disks.near_disks import ALONG_RAY, CURVED, errors_near_loads
from dembound.formulas.disks.reflections import Reflected, Reflections, factor_for
from dembound.formulas.disks.waves import AXES, DIAGONAL, delay_of
from dembound.formulas.history import History
from dembound.running import Progress

DIAMETER, PATH = 0.5, 300.0
PHASE = 0.1
"""Wave number in radians per disk: the next terms of the expansions are smaller by PHASE²."""


def lateness(motion, directions, step=0.0, fric=0.0):
    """(c/c(q) − 1)/(qD)² at `PHASE`."""
    ground = build(small(PUSHED, changes={"material.fric": fric, "boundary": {}, "load": []})).ground
    speed = ground.wave_speeds(0)[0 if motion == "p" else 1]
    delay = delay_of(ground, motion, directions, PATH, speed, step)
    omega = np.array([PHASE * speed / DIAMETER])
    return float(delay(omega)[0] * speed / PATH / PHASE**2), speed


@pytest.mark.parametrize("axis", [0, 1])
def test_p_waves_along_an_axis_are_those_of_a_row_of_masses(axis):
    # ω = (2c/D) sin(qD/2), so c/c(q) = 1 + (qD)²/24
    assert lateness("p", [AXES[axis]])[0] == pytest.approx(1.0 / 24.0, rel=0.01)


def test_s_waves_along_an_axis_are_early_as_disks_turn():
    # With k_s = 1, R = 1/2 and bending stiffness b = k_b/(R² k_s), and the disks' inertia mR²/2, the two equations
    # ω²m = 2 − 2cos q − 4 sin² q/(6 + 2cos q + b(2 − 2cos q) − ω²m/2) give ω²m = q²/2 + q⁴(1/48 − (1/4 − b)/16).
    # Bonds alone carry shear (fric = 0): k_b = k̄_s R²/3 for k_n = k_s, where k_b belongs to the bond's area, b = 1/3.
    b = 1.0 / 3.0
    expected = -(1.0 / 48.0 - (0.25 - b) / 16.0)
    assert lateness("s", [AXES[0]])[0] == pytest.approx(expected, rel=0.02)
    assert lateness("s", [DIAGONAL])[0] > 0.0
    found = [lateness("s", [direction])[0] for direction in (AXES[0], DIAGONAL)]
    assert lateness("s", [AXES[0], DIAGONAL])[0] == max(found, key=abs)  # of several the largest delay counts


def test_a_time_step_makes_waves_earlier():
    # sin(ω'Δt/2) = ωΔt/2, so ω' = ω(1 + (ωΔt)²/24): of a row at Courant number 1 nothing is left
    _, speed = lateness("p", [AXES[0]])
    assert lateness("p", [AXES[0]], step=DIAMETER / speed)[0] == pytest.approx(0.0, abs=1e-4)
    assert lateness("p", [AXES[0]], step=0.5 * DIAMETER / speed)[0] == pytest.approx(0.75 / 24.0, rel=0.01)
    # nothing is known above the shortest wave
    ground = build(small(PUSHED, changes={"boundary": {}, "load": []})).ground
    delay = delay_of(ground, "p", [AXES[0]], PATH, 1000.0, 0.0)
    assert np.isnan(delay(np.array([0.99, 1.01]) * 2.0 * 1000.0 / DIAMETER)).tolist() == [False, True]


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
    ways = [y + entry.late + off for off in (-0.02, 0.0, 0.02)]
    rest = [np.linalg.norm(velocity - wave.velocity(own.time - way / entry.speed)) for way in ways]
    assert rest[1] < min(rest[0], rest[2])  # within 10 mm
    assert late_by(scene) == pytest.approx(entry.late / entry.speed)


STEP = 1e-4


def shares(side="right", **keys):
    boundary = around("periodic", "bottom", "top") | {"left": {"type": "velocity", "wave_p": "push"}}
    boundary |= {side: {"type": "viscous", **keys}}
    wave = {"push": {"type": "cosine", "amplitude": 0.5, "period": 0.04}}
    return Reflections().of(build(small(PUSHED | {"boundary": boundary, "wave": wave})), side, STEP)


def test_each_motion_has_its_own_factor_and_sign():
    found = shares(beta_p=0.5, beta_s=1.5, half_mass=True)
    assert found["p"].dashpots == pytest.approx(0.5 / 1.5, rel=1e-3)
    assert found["s"].dashpots == pytest.approx(-0.5 / 2.5, rel=1e-3)
    # waves have some 60 disks, of which half cells reflect tan²(qD/4) < 1e-3 more
    assert found["p"].signed == pytest.approx(1.0 / 3.0, abs=3e-3)
    assert found["s"].signed == pytest.approx(-0.2, abs=3e-3)


def test_whole_cells_reflect_out_of_phase():
    whole, half = (shares(half_mass=half)["p"] for half in (False, True))
    # tan(qD/4) of waves of 0.5 m × 1000 m/s × 0.04 s: with q = 2πf/c for the RMS of f, some 15 Hz
    assert whole.out_of_phase == pytest.approx(math.tan(2.0 * math.pi * 15.0 / 1000.0 * 0.5 / 4.0), rel=0.3)
    assert whole.out_of_phase > 20.0 * half.out_of_phase
    assert whole.dashpots == pytest.approx(0.0, abs=1e-6)
    share = Reflected(0.5, -0.3)  # parts in and out of phase make the size
    assert (share.signed, share.out_of_phase) == (-0.5, pytest.approx(0.4))
    assert Reflected(0.1, 0.3).out_of_phase == 0.0
    for reflection in (-0.4, 0.0, 0.3):
        factor = factor_for(reflection)
        assert (1.0 - factor) / (1.0 + factor) == pytest.approx(reflection)


RATE = 2.0 * np.pi * 20.0
TIME = np.linspace(0.0, 0.5, 2001)
WIDE = 0.5
"""Half a side of the region that the force acts on, m."""

SPEED = 500.0
"""Speed of S waves on a lattice whose bonds alone carry shear, m/s."""


def scene(radius: float) -> DiskScene:
    """Disks beside a force at (2, 1) m."""
    push = {"name": "push", "force": [1e5, 0.0], "region": [1.5, 0.5, 2.5, 1.5], "wave": "push"}
    packing = {"pattern": "A", "size": [10.0, 3.0], "radius": radius}
    return build(small(PUSHED, changes={"packing": packing, "boundary": {}, "load": [push]}))


def recorded(place: tuple[float, float], move: tuple[float, float]) -> History:
    """Motion of one frequency along a vector."""
    shape = np.array(move)
    values = {
        "velocity": np.outer(np.sin(RATE * TIME), shape),
        "displacement": np.outer(np.cos(RATE * TIME), -shape / RATE),
    }
    return History(np.array(place), TIME, values)


def near(diameter: float, distance: float, wide: float = WIDE) -> float:
    """The error at a distance (m) along the force."""
    return ALONG_RAY * (diameter * (RATE / SPEED + CURVED / distance) * distance / (distance + wide)) ** 2


def test_it_is_of_second_order_in_the_disks_times_the_curvature_along_the_ray() -> None:
    own = recorded((7.0, 1.0), (1.0, 0.0))
    expected = near(0.5, 5.0)
    for quantity, error in errors_near_loads(scene(0.25), own).items():
        assert error == pytest.approx(expected, rel=1e-3), quantity  # differences of TIME: (ωΔt)²/6 = 2e-4
    finer = errors_near_loads(scene(0.125), own)
    assert finer["velocity"] == pytest.approx(expected / 4.0, rel=1e-3)


def test_there_is_none_without_a_force_and_a_finite_one_at_it() -> None:
    driven = build(small(PUSHED))
    assert errors_near_loads(driven, recorded((7.0, 1.0), (1.0, 0.0))) == {"velocity": 0.0, "displacement": 0.0}
    at_it = errors_near_loads(scene(0.25), recorded((2.25, 1.0), (1.0, 0.0)))["velocity"]
    assert at_it == pytest.approx(near(0.5, 0.5) * 0.5**2, rel=1e-3)
