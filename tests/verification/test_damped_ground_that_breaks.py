"""Ground that can break and has a quality factor: arms in its bonds damp it as memories do, and break with them.

A bond is k_R d + Σ w k_U a, with k_R = k_U(1 − Σw) and lags a ← e a + ½(1 + e)Δd, of which the contact has the share α.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import tomli_w

from dembound.boundaries.support import SupportBuilder
from dembound.casefile.disks import DiskCase
from dembound.damping import Mechanisms, fitted
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.disks.trials import trials_of_disks
from dembound.kinds import loads, with_changes
from dembound.kinds.disks.kind import Disks
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.studies.stability import short_run

BREAKS = {"law": "linearpbond", "fric": 0.5, "pb_ten": 2e4, "pb_coh": 4e4, "pb_fa": 30.0}
STRONG = {"pb_ten": 1e9, "pb_coh": 1e9}
LATTICE: dict[str, Any] = {
    "packing": {"pattern": "A", "bricks": [2, 40], "radius": 0.25},
    "material": {"density": 2000.0, "p_wave_speed": 400.0, "quality_factor": 20.0, "fric": 0.5},
    "damping": {"band": [1.0, 10.0]},
    "boundary": {
        "left": {"type": "periodic"},
        "right": {"type": "periodic"},
        "bottom": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"},
    },
    "wave": {"pulse": {"type": "ricker", "amplitude": 1e-4, "frequency": 10.0}},
    "run": {"duration": 0.25},
}
GRAINS = LATTICE | {
    "packing": {"pattern": "B", "size": [8.0, 8.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [8.0, 4.0]},
    "material": LATTICE["material"] | BREAKS,
    "boundary": {side: {"type": "free_field"} for side in ("left", "right")}
    | {"bottom": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}},
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "static": {"ratio": 1e-8, "boundary": {"bottom": {"type": "fixed"}}},
    "wave": {"pulse": {"type": "ricker", "amplitude": 0.3, "frequency": 8.0}},
}
"""Random disks under their weight, whose bonds break where a wave comes from below."""


def case(tables: dict, changes: dict) -> DiskCase:
    return with_changes(loads(tomli_w.dumps(tables)), changes)


def settled(scene: DiskScene, step: float) -> Simulation:
    beginning = Disks().begin(scene, step, None)
    return Simulation(scene, step, list(scene.monitors.values()), system=beginning.system, datum=beginning.datum)


@pytest.mark.parametrize("geometry", [pytest.param("reference", marks=pytest.mark.slow), "updated"])
def test_until_contacts_open_it_moves_as_elastic_ground_of_the_same_quality(geometry):
    """Both are the same filter of the same forces, apart from rounding; contacts stay closed under 1 kPa.

    A wave of ρc v = 80 Pa changes stresses by less. Where the geometry follows, stresses of 1 kPa over moduli of
    160 MPa change it by 1e-5, of some waves' way.
    """
    tables = LATTICE | {"static": {"stress": [-1e3, -1e3, 0.0], "ratio": 1e-12}, "run": {"time_step": 2e-4}}
    tables |= {"monitor": [{"name": "up", "position": [0.25, 15.25]}], "run": {"duration": 0.25, "time_step": 2e-4}}
    laws = ({"law": "elastic"}, {"law": "linearpbond", "geometry": geometry} | STRONG)
    both = []
    for law in laws:
        simulation = settled(build(case(tables | {"material": LATTICE["material"] | law}, {})), 2e-4)
        both.append(simulation.advance(1250)[:, 0, 3:])
        assert simulation.system.law_name == law["law"]
    elastic, broken = both
    assert np.abs(elastic[:, :2]).max(axis=0).min() > 5e-5
    assert np.abs(broken - elastic).max() < (1e-10 if geometry == "reference" else 1e-4) * np.abs(elastic).max()


@pytest.mark.slow  # arms between layers have kernels of their own
def test_between_layers_of_unlike_quality_a_bond_is_damped_by_both():
    """Its halves are in series, with weights by their compliance: 9e-4, and 2e-2 with those of its first disk alone.

    With half of each it would be 5e-3, as the softer half has 4 times the compliance.
    """
    layer = [{"name": "soft", "thickness": 8.0, "p_wave_speed": 250.0, "quality_factor": 10.0}, {"name": "stiff"}]
    both = []
    for law in ("elastic", "linearpbond"):
        changes = {"material.law": law, "material.contact_share": 0.0, "layer": layer, "material.quality_factor": 100.0}
        scene = build(case(LATTICE, changes | {"monitor": [{"name": "up", "position": [0.25, 15.25]}]}))
        both.append(Simulation(scene, 2e-4, list(scene.monitors.values())).advance(1500)[:, 0, 3:])
    elastic, broken = both
    assert np.abs(broken - elastic).max() < 1e-3 * np.abs(elastic).max()


def test_plane_waves_lose_by_the_quality_factor():
    """1/Q = Im(1/k²)/Re(1/k²), with e^(−ik·100 m) between two disks, of P and S waves over the band, within 3 %.

    Mechanisms are within 1 % of a constant 1/Q. The shortest wave, of S at 10 Hz, is 57 disks long: its speed is
    (2π/57)²/24 = 5e-4 too low, and 1/Q as much. Bonds alone bear the waves, of which nothing opens or slides.
    """
    below, apart, quality = 50.25, 100.0, 20.0
    changes = {
        "packing.bricks": [1, 800],
        "material.law": "linearpbond",
        "material.contact_share": 0.0,
        "wave.pulse.frequency": 4.0,
        "monitor": [{"name": name, "position": [0.25, y]} for name, y in (("a", below), ("b", below + apart))],
    }
    scene = build(case(LATTICE, changes))
    step = choose_step(scene)[0]
    record = Simulation(scene, step, list(scene.monitors.values())).advance(round(1.5 / step))
    frequencies = np.array([2.0, 3.0, 4.0, 6.0, 8.0, 10.0])
    times = step * np.arange(len(record))
    for component in (4, 3):
        lower, upper = (
            np.exp(-2j * np.pi * np.outer(frequencies, times)) @ record[:, node, component] for node in (0, 1)
        )
        speed = 400.0 if component == 4 else 400.0 / np.sqrt(2.0)
        way = np.log(np.abs(upper / lower)), np.angle(upper / lower * np.exp(2j * np.pi * frequencies * apart / speed))
        k = 2.0 * np.pi * frequencies / speed + (1j * way[0] - way[1]) / apart
        found = (1.0 / k**2).imag / (1.0 / k**2).real
        np.testing.assert_allclose(found, 1.0 / quality, rtol=0.03)


def test_the_step_limit_is_that_of_unrelaxed_springs():
    changes = {"packing.bricks": [8, 12], "boundary": {}, "wave": {}, "material.quality_factor": 5.0}
    changes |= {"material.law": "linearpbond", "material.contact_share": 0.0}
    trial = trials_of_disks(case(LATTICE, changes), full=True)[0][1]

    assert not short_run(trial, 0.998 * trial.limit).is_growing
    assert short_run(trial, 1.002 * trial.limit).is_growing


def test_books_close_while_bonds_break_and_nothing_is_given_back():
    """Errors of the ledger are of second order in the step; arms and cracks only take."""
    scene = build(case(GRAINS, {}))
    simulation = settled(scene, choose_step(scene)[0])
    ledger = Ledger(simulation, 20)
    simulation.track(ledger)
    simulation.run(801)
    entries = ledger.entries
    assert len(simulation.system.take_cracks(simulation.state.step).step) > 30
    assert max(abs(entry.error) for entry in entries) < 1e-4 * entries[-1].supplied
    for name in ("damping", "friction", "crack"):
        assert np.diff([getattr(entry, name) for entry in entries]).min() >= 0.0
    assert entries[-1].damping > 0.02 * entries[-1].supplied


def test_settled_ground_stays_at_rest():
    scene = build(case(GRAINS, {"wave.pulse.amplitude": 1e-30}))
    simulation = settled(scene, choose_step(scene)[0])
    simulation.run(1000)
    state = simulation.state
    assert np.abs(state.displacement - state.datum).max() < 1e-14
    assert np.abs(state.datum).max() > 1e-3


@pytest.mark.parametrize("law", [{"law": "elastic"}, {"law": "linearpbond"} | STRONG])
def test_damped_ground_has_the_stress_asked_for(law):
    """Tractions are 10 and 20 kPa whatever the springs are; strains of 6e-5 change the geometry by as much."""
    changes = {"packing.bricks": [8, 8], "boundary": {}, "wave": {}, "output.stress": True, "run.time_step": 1e-4}
    changes |= {"static": {"stress": [-1e4, -2e4, 0.0], "ratio": 1e-9}} | {f"material.{k}": v for k, v in law.items()}
    simulation = settled(build(case(LATTICE, changes)), 1e-4)
    simulation.advance(2)
    stress = simulation.system.stress(simulation.state.displacement)
    inside = (np.abs(simulation.scene.positions - 2.0) < 1.5).all(axis=1)  # others have contacts on one side only
    np.testing.assert_allclose(stress[inside, :2], np.tile([-1e4, -2e4], (36, 1)), rtol=1e-3)


def test_twins_beside_a_free_field_move_as_it_does():
    """Ground without a hole moves as its column does, whose bonds have arms, too, until bonds break."""
    changes = {"packing.bricks": [8, 12], "material.law": "linearpbond", "boundary": GRAINS["boundary"]}
    scene = build(case(LATTICE, changes))
    simulation = Simulation(scene, choose_step(scene)[0])
    simulation.advance(400)
    body, moved = np.arange(scene.column_count, scene.disk_count), simulation.state.displacement
    apart = np.abs(moved[:, body] - moved[:, scene.seams[0].twin[body]]).max()
    assert apart < 1e-9 * np.abs(moved).max()


QUALITY = fitted(25.0, (0.3, 10.0), 1.73, 3)
COUNT, TIMES = 10_000, {"fast": 0.01, "slow": 20.0}
"""Steps of a gripped pair, and their times (s): well below and above those of relaxation, 0.014 to 0.57 s."""


def gripped(lab, motion: tuple[float, float], duration: float, mechanisms: Mechanisms | None, **strength) -> Simulation:
    """Two bonded disks side by side, of which one is moved by `motion` (m) along x and y in `COUNT` steps."""
    radius, step = 0.25, duration / COUNT
    material = {"law": "linearpbond", "emod": 1e9, "pb_emod": 1e9, "fric": 5.0} | strength
    scene = lab.disks(np.array([[0.0, 0.0], [2.0 * radius, 0.0]]), np.full(2, radius), [(0, 1)], material=material)
    grip = SupportBuilder()
    for component, way in enumerate([*motion, 0.0]):
        grip.add(np.array([0]), component, prescribed=True)
        grip.add(np.array([1]), component, drive=way / duration, signal=np.ones_like, prescribed=True)
    scene = replace(scene, ground=replace(scene.ground, mechanisms=mechanisms), supports=grip.table())
    return Simulation(scene, step, np.zeros(0))


def force_at_break(simulation: Simulation) -> np.ndarray:
    """The force (2,) N of the pair in the last step before its bond breaks."""
    contacts, force = simulation.system.contacts["body"], np.zeros(2)
    for _ in range(COUNT):
        simulation.advance(1)
        if len(contacts.take_cracks()) > 0:
            return force
        force = contacts.force[0, :2].copy()
    raise AssertionError("the bond did not break")


@pytest.mark.parametrize("motion", [(6e-5, 0.0), (-3e-5, 1e-4)])
def test_strength_does_not_depend_on_the_rate(lab, motion):
    """Pulled with an open contact, and sheared with a closed one that sticks: forces grow by 2e-4 in a step."""
    found = {
        name: force_at_break(gripped(lab, motion, duration, QUALITY, pb_ten=5e4, pb_coh=1e5))
        for name, duration in TIMES.items()
    }
    component = 0 if motion[0] > 0.0 else 1
    fast, slow = found["fast"][component], found["slow"][component]
    assert fast == pytest.approx(slow, rel=1e-3)


@pytest.mark.slow
def test_what_is_cut_off_flies_by_the_energy_of_its_bonds_alone(lab):
    """A chain is pulled for 2 s, until the bond of its small first disk breaks, beside a disk that is free.

    That disk is then driven by the bond that is left, and gets its energy at most. Memories of forces on it would push
    on for as long as it was pulled.
    """
    radii, step, duration = np.array([0.2, 0.25, 0.25]), 2e-4, 2.4
    places = np.array([[0.0, 0.0], [0.45, 0.0], [0.95, 0.0]])
    material = {"law": "linearpbond", "emod": 1e9, "pb_emod": 1e9, "pb_ten": 2e5}
    scene = lab.disks(places, radii, [(0, 1), (1, 2)], material=material)
    grip, speed = SupportBuilder(), 1e-4
    for component in range(3):
        grip.add(np.array([0]), component, prescribed=True)
        drive = speed if component == 0 else 0.0
        grip.add(np.array([2]), component, drive=drive, signal=np.ones_like, prescribed=True)
    scene = replace(scene, ground=replace(scene.ground, mechanisms=QUALITY), supports=grip.table())
    simulation = Simulation(scene, step, np.zeros(0))
    part = simulation.system.recorded_parts[-1]
    stored, fastest, broken_at = [], 0.0, None
    for number in range(round(duration / step)):
        simulation.advance(1)
        stored.append(part.stored(simulation.state.u))
        if broken_at is None and len(simulation.system.contacts["body"].take_cracks()) > 0:
            broken_at = number
        elif broken_at is not None:
            fastest = max(fastest, abs(float(simulation.state.velocity[0, 1])))
    assert broken_at is not None
    assert 1.5 < broken_at * step < 2.2
    energy = sum(stored[broken_at - 2])
    assert 0.05 * energy < 0.5 * scene.mass[1] * fastest**2 < energy
