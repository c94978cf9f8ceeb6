"""Hertz and Mindlin's contacts: impacts in closed form, and the speed of waves under pressure."""

import numpy as np
import pytest
from scipy.special import gamma
from small_cases import small

from dembound.disks.loose import RESERVE, reserve
from dembound.disks.rest.stage import settle
from dembound.disks.scene import build, ground_of
from dembound.disks.small_motion import small_motion
from dembound.disks.stability import step_limit
from dembound.errors import CaseError, RunError
from dembound.motion.simulation import Simulation
from dembound.running import plan

G, NU, RADIUS, MASS = 1e9, 0.25, 0.25, 625.0
GRAINS = {"law": "hertz", "hz_shear": G, "hz_poiss": NU, "fric": 0.5}
STIFF = 2.0 * G * np.sqrt(2.0 * RADIUS) / (3.0 * (1.0 - NU))
"""N = STIFF a^1.5 between equal disks, by hand: R̄ = R."""

RATIO = 2.0 * (1.0 - NU) / (2.0 - NU)
"""Stiffness in shear over the normal one."""


SLOW = 1e-3
"""Speed (m/s) of each disk along the line of centres: slow, so that the line turns by less than 3e-4 in an impact."""


def contact_time() -> float:
    """Duration (s) of a head-on impact of two disks (K. L. Johnson, eq. 11.25)."""
    deepest = (1.25 * 0.5 * MASS * (2.0 * SLOW) ** 2 / STIFF) ** 0.4
    return float(2.0 * np.sqrt(np.pi) * gamma(1.4) / gamma(0.9) * deepest / (2.0 * SLOW))


def rebound(lab, across: float, steps: int = 400):
    """The end of an impact of two disks with velocities ±across along the contact: the run, its ledger and step."""
    scene = lab.disks([[0.0, 0.0], [0.5, 0.0]], [RADIUS] * 2, held=(), material=GRAINS)
    step = contact_time() / steps
    simulation = lab.simulation(scene, step=step)
    simulation.state.velocity = np.array([[SLOW, -SLOW], [across, -across], [0.0, 0.0]])
    ledger = lab.ledger(simulation, 1)
    simulation.run(int(1.2 * steps))
    return simulation, ledger, step


def test_an_impact_lasts_as_long_as_hertz_found_and_loses_nothing(lab):
    simulation, ledger, step = rebound(lab, 0.0)
    pushed = np.count_nonzero([each.contact > 0.0 for each in ledger.entries])

    assert pushed * step == pytest.approx(contact_time(), abs=1.5 * step)  # the first and the last step are cut
    # the push of the first step is raised by CLOSING, and it is small: (1/400)^1.5 of the largest one
    assert simulation.state.velocity[0] == pytest.approx([-SLOW, SLOW], rel=5e-6)


def test_at_grazing_incidence_contacts_slide_all_the_time(lab):
    """The impulses are then in the ratio of friction, whatever the stiffness."""
    simulation, ledger, _ = rebound(lab, across=5.0 * SLOW)
    (vx, _), (vy, _), (spin, _) = simulation.state.velocity
    normal = MASS * (SLOW - vx)

    # the line of centres turns by 1.3e-3
    assert MASS * (5.0 * SLOW - vy) == pytest.approx(GRAINS["fric"] * normal, rel=5e-3)
    assert -0.5 * MASS * RADIUS**2 * spin == pytest.approx(GRAINS["fric"] * normal * RADIUS, rel=5e-3)
    lost = MASS * (26.0 * SLOW**2 - vx**2 - vy**2) - 0.5 * MASS * RADIUS**2 * spin**2
    assert ledger.entries[-1].friction == pytest.approx(lost, rel=1e-4)


def speed_after(across: float) -> float:
    """Velocity (m/s) along the contact after an impact by the definition of the law, integrated apart."""
    mass, inertia = 0.5 * MASS, 0.5 * MASS * RADIUS**2
    light = 1.0 / (1.0 / mass + 2.0 * RADIUS**2 / inertia)  # against motion of the surfaces, both disks turning

    def rates(_, now):
        a, da, _, ds, force, _ = now
        a = max(a, 0.0)
        change = 1.5 * STIFF * RATIO * np.sqrt(a) * ds + (force * da / (2.0 * a) if da < 0.0 < a else 0.0)
        if abs(force) >= GRAINS["fric"] * STIFF * a**1.5 and change * np.sign(force) > 0.0:
            change = np.sign(force) * GRAINS["fric"] * 1.5 * STIFF * np.sqrt(a) * da
        return [da, -STIFF * a**1.5 / mass, ds, -force / light, change, force]

    step, now = contact_time() / 20000, np.array([1e-12, 2.0 * SLOW, 0.0, 2.0 * across, 0.0, 0.0])
    while now[0] > 0.0:  # midpoints; friction bounds the force after each
        middle = now + 0.5 * step * np.array(rates(0.0, now))
        now = now + step * np.array(rates(0.0, middle))
        most = GRAINS["fric"] * STIFF * max(now[0], 0.0) ** 1.5
        now[4] = np.clip(now[4], -most, most)
    return float(across - now[5] / MASS)


@pytest.mark.parametrize(
    "across", [pytest.param(0.2, marks=pytest.mark.slow), 1.0, pytest.param(2.0, marks=pytest.mark.slow)]
)
def test_oblique_impacts_are_those_of_the_law_integrated_apart(lab, across):
    simulation, ledger, _ = rebound(lab, across * SLOW, steps=4000)

    # steps of 1/4000 of the impact, and a line of centres that turns by up to 5e-4
    assert simulation.state.velocity[1, 0] == pytest.approx(speed_after(across * SLOW), abs=2e-3 * SLOW)
    assert max(abs(each.error) for each in ledger.entries) < 1e-3 * MASS * SLOW**2
    assert ledger.entries[-1].friction > 0.0


GROUND = {
    "packing": {"pattern": "A", "size": [10.0, 1.0], "radius": RADIUS},
    "material": {"density": 2500.0} | GRAINS,
    "boundary": {"left": "viscous", "right": "viscous", "bottom": "periodic", "top": "periodic"},
    "static": {"stress": [-1e6, -1e6, 0.0]},
    "run": {"duration": 0.3},
    "output": {"pictures": False},
}
GROUND["boundary"] = {side: {"type": name} for side, name in GROUND["boundary"].items()}


@pytest.mark.parametrize("pressure", [1e5, 1e6])
def test_waves_in_a_lattice_follow_its_pressure(pressure):
    """Each contact bears p·2R, so that C11 = k_n = 1.5 h^⅔ (2Rp)^⅓; with disks that turn C66 = k_s/2."""
    ground = ground_of(small(GROUND, changes={"static.stress": [-pressure, -pressure, 0.0]}))
    normal = 1.5 * STIFF ** (2.0 / 3.0) * (2.0 * RADIUS * pressure) ** (1.0 / 3.0)

    assert ground.wave_speeds(0) == pytest.approx(np.sqrt([normal / 2500.0, 0.5 * RATIO * normal / 2500.0]), rel=1e-9)
    assert ground.overlaps == pytest.approx((2.0 * RADIUS * pressure / STIFF) ** (2.0 / 3.0), rel=1e-9)


def test_the_step_limit_and_factors_of_sides_follow_the_tangent():
    case = small(GROUND)
    twin = small_motion(case)
    scene, elastic = build(case), build(twin)

    assert ground_of(twin).wave_speeds(0) == pytest.approx(scene.ground.wave_speeds(0), rel=1e-12)
    for name in ("damping", "stiffness"):
        assert getattr(scene.supports, name) == pytest.approx(getattr(elastic.supports, name), rel=1e-9)
    # six neighbours of the smallest disks at RESERVE times the overlap at rest
    stiff = np.sqrt(RESERVE) * scene.ground.moduli.emod * (6.0 + 24.0 * RATIO) / MASS
    assert step_limit(scene) == pytest.approx(2.0 / np.sqrt(stiff * 1.4), rel=1e-9)
    assert reserve(scene.ground) == pytest.approx(RESERVE * scene.ground.overlaps.max())


@pytest.mark.parametrize(
    ("pattern", "in_rows"), [("B", False), *(pytest.param("A", each, marks=pytest.mark.slow) for each in (False, True))]
)
def test_pressed_ground_is_at_rest_from_the_start(hold_in_order, pattern, in_rows):
    if not in_rows:
        hold_in_order()
    random = {"brick": [4.0, 4.0], "seed": 1, "radius_ratio": 1.5} if pattern == "B" else {}
    packing = {"pattern": pattern, "size": [4.0, 4.0], "radius": RADIUS} | random
    case = small(GROUND | {"packing": packing, "boundary": {}})
    settled = settle(build(case))

    # forces of the packing at the overlaps found, to their tolerance
    assert settled.steps <= 100
    assert settled.ratio < 1e-9
    if pattern == "A":  # in random packings the mean of a few disks differs
        assert settled.stress == pytest.approx([-1e6, -1e6, 0.0], rel=1e-9, abs=1.0)


def test_a_run_stops_before_its_contacts_are_too_stiff_for_the_step(hold_in_order):
    hold_in_order()
    load = {"name": "weight", "acceleration": [0.0, -9.81]}
    tables = {key: value for key, value in GROUND.items() if key != "static"} | {
        "boundary": {"bottom": {"type": "fixed"}}
    }
    planned = plan(small(tables, changes={"load": [load], "material.hz_shear": 1e6}))
    simulation = Simulation(planned.scene, planned.time_step)
    for each in planned.kind.trackers(simulation):
        simulation.track(each)

    assert np.isnan(planned.scene.ground.wave_speeds(0)).all()  # without pressure no wave runs
    with pytest.raises(RunError, match=r"too stiff for the time step.*give run.time_step = "):
        simulation.run(2000)


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"static": {"stress": [0.0, 0.0, 0.0]}}, "boundary.left: needs wave speeds"),
        ({"static.k0": 0.5}, "static.k0: material.law"),
        ({"boundary.left": {"type": "outside"}}, 'boundary.left.type: is "outside"'),
        ({"layer": [{"thickness": 0.5}, {}]}, "layer: material.law"),
    ],
)
def test_what_needs_a_stiffness_without_pressure_is_refused(changes, line):
    with pytest.raises(CaseError) as caught:
        small(GROUND, changes=changes)
    assert any(each.startswith(line) for each in caught.value.problems)


def test_a_stress_that_pulls_contacts_apart_is_refused():
    with pytest.raises(CaseError, match=r"static\.stress: is"):
        ground_of(small(GROUND, changes={"static.stress": [1e6, -1e6, 0.0]}))
