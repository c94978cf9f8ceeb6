"""Ranges of a bar that only touch: impacts, and transmission of pressure and tension by contacts.

At ν = 1 finite differences are d'Alembert's solution, so fronts are steps from one node to the next. An impact of two
nodes of masses m/2 at the relative speed v, half cells of equal bars, takes mv²/8: 1/(4N) of the energy of a striker of
N cells.
"""

import numpy as np
import pytest

from dembound.api import case
from dembound.bar.scene import build_bar
from dembound.bar.stability import choose_step, unit_step
from dembound.errors import RunError
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

DENSITY, SPEED, SPACING, STRIKER, VELOCITY = 8000.0, 5000.0, 0.005, 50, 10.0
CENTRAL = {"type": "finite_difference"}


class Impact:
    """A run of two bars: simulation, its record at both gauges, its ledger."""

    def __init__(
        self,
        duration: float,
        *,
        velocity: float = VELOCITY,
        interface: str = "contact",
        gap: float = 0.0,
        method: dict = CENTRAL,
        pressure: float = 1e-6,
        courant: float = 1.0,
    ) -> None:
        bar = {"name": "bar", "length": 1.0, "interface": interface} | ({"gap": gap} if interface == "contact" else {})
        ranges = [{"name": "striker", "length": 0.25, "velocity": velocity}, bar]
        self.scene = build_bar(
            case(
                bar={"spacing": SPACING, "density": DENSITY, "wave_speed": SPEED, "range": ranges},
                method=method,
                load=[{"name": "push", "pressure": pressure, "wave": "pulse"}],
                wave={"pulse": {"type": "triangle", "amplitude": 1.0, "rise": 2e-5, "fall": 1e-5}},
                monitor=[{"name": "striker", "position": 0.125}, {"name": "bar", "position": 0.75}],
                run={"duration": 1.0, "courant": courant},
            )
        )
        self.step = courant * unit_step(self.scene)  # at ν = 1 bars of one ρcA may touch without swings
        self.simulation = Simulation(self.scene, self.step, self.scene.probes)
        self.ledger = Ledger(self.simulation, 11)
        self.simulation.track(self.ledger)
        self.record = self.simulation.advance(round(duration / self.step))


def test_a_striker_makes_a_pulse_of_half_its_velocity_and_twice_its_length() -> None:
    run = Impact(3.4e-4)
    stress = run.record[:, 1, 6]
    amplitude = 0.5 * DENSITY * SPEED * VELOCITY

    back = round(1.5 / SPEED / run.step)
    # half a metre from the contact; nodes carry the front as a step, with one mean value on either side of it
    arrival, over = round(0.5 / SPEED / run.step), round((0.5 + 2.0 * 0.25) / SPEED / run.step)
    np.testing.assert_allclose(stress[arrival + 2 : over - 1], -amplitude, rtol=1e-11)
    # the tail of the pulse and, after its reflection at the far end, its tension, of the same shape
    assert np.abs(stress[: arrival - 1]).max() < 1e-11 * amplitude
    assert np.abs(stress[over + 2 : back - 1]).max() < 1e-11 * amplitude
    np.testing.assert_allclose(stress[back + 2 : back + 98], amplitude, rtol=1e-11)
    # equal impedances leave the striker at rest
    assert np.abs(run.simulation.state.v[0, : STRIKER + 1]).max() < 1e-11 * VELOCITY


@pytest.mark.parametrize("method", [CENTRAL, {"type": "peridynamics", "horizon": 3}], ids=["fd", "pd"])
def test_an_impact_keeps_momentum_and_its_ledger_closes(method: dict) -> None:
    """A gap of 0.5 mm delays it by 50 µs at 10 m/s."""
    run = Impact(3.9e-4, method=method, courant=0.5, gap=0.0005)
    entries, last = run.ledger.entries, run.ledger.entries[-1]
    mass, energy = DENSITY * 0.25, 0.5 * DENSITY * 0.25 * VELOCITY**2

    assert run.scene.positions[STRIKER + 1, 0] - run.scene.positions[STRIKER, 0] == pytest.approx(0.0005, rel=1e-9)
    struck = run.step * np.argmax(run.record[:, 1, 6] < -0.25 * DENSITY * SPEED * VELOCITY)
    assert struck == pytest.approx(0.0005 / VELOCITY + 0.5 / SPEED, abs=5.0 * SPACING / SPEED)
    momentum = float(np.sum(run.scene.mass * run.simulation.state.v[0]))
    assert momentum == pytest.approx(mass * VELOCITY, rel=1e-12)
    assert last.supplied == pytest.approx(energy, rel=1e-9)
    assert max(abs(entry.error) for entry in entries) < 1e-12 * energy
    # of velocities in the middle of steps, though they change their sign within the step of an impact, whose front of
    # one step then swings
    assert all(0.0 <= entry.kinetic <= energy * (1.0 + 1e-12) for entry in entries)
    swings = min(entry.stepping for entry in entries)
    assert -0.02 * energy < swings < (-1e-4 * energy if method is CENTRAL else 0.0)
    assert max(entry.stepping for entry in entries) <= 0.0
    # friction is what impacts took: the first one, and less than a fifth of it where both come apart
    assert 1.0 - 1e-9 <= last.friction / (energy / (4.0 * STRIKER)) < 1.2


@pytest.mark.parametrize("courant", [0.5, 1.0])
def test_pressure_passes_a_contact_as_a_bonded_interface(courant: float) -> None:
    runs = [
        Impact(1.5e-4, velocity=0.0, pressure=1e7, interface=interface, courant=courant)
        for interface in ("contact", "bonded")
    ]
    touching, bonded = (run.record[..., 6] for run in runs)

    # before the pulse has passed, a contact opens where dispersion makes tension; at ν = 1 there is none
    passed = round((0.25 / SPEED + 1.5e-5) / runs[0].step) if courant < 1.0 else None
    np.testing.assert_allclose(touching[:passed], bonded[:passed], rtol=0.0, atol=1e-12 * 1e7)
    last = runs[0].ledger.entries[-1]
    assert last.friction < 1e-9 * last.supplied if courant == 1.0 else True


def test_tension_does_not_pass_a_contact() -> None:
    run = Impact(1.5e-4, velocity=0.0, pressure=-1e7)
    striker, beyond = run.record[:, 0, 6], run.record[:, 1, 6]

    assert not beyond.any()
    # the pull is back from the open contact as pressure of the same shape
    there, back = (round(way / SPEED / run.step) for way in (0.125, 0.375))
    shape = striker[there : there + 30]
    assert shape.max() == pytest.approx(1e7, rel=0.05)
    np.testing.assert_allclose(striker[back : back + 30], -shape, atol=1e-9 * 1e7)


STEEL, POLYMER = {"density": 7800.0, "wave_speed": 5000.0}, {"density": 1200.0, "wave_speed": 2000.0}
UNLIKE = {
    "soft on hard": [POLYMER | {"velocity": 4.0}, STEEL],
    "thin on thick": [STEEL | {"section": 1.0, "velocity": 4.0}, STEEL | {"section": 3.0}],
    "as long": [STEEL | {"velocity": 4.0}, STEEL],
}


def colliding(name: str, method: dict, step: float | None = None, **run: float) -> Simulation:
    """Two bars of 20 cells, whose Δx/c is 1 µs, that collide again and again, with a ledger."""
    ranges = [
        {"name": str(k), "length": 20e-6 * each["wave_speed"], "spacing": 1e-6 * each["wave_speed"]} | each
        for k, each in enumerate(UNLIKE[name])
    ]
    ranges[1]["interface"] = "contact"
    scene = build_bar(case(bar={**STEEL, "spacing": 5e-3, "range": ranges}, method=method, run={"duration": 1.0} | run))
    simulation = Simulation(scene, choose_step(scene)[0] if step is None else step)
    simulation.track(Ledger(simulation, 100))
    return simulation


@pytest.mark.parametrize("method", [CENTRAL, {"type": "patch", "horizon": 3}, {"type": "peridynamics", "horizon": 3}])
@pytest.mark.parametrize("name", UNLIKE)
def test_bars_that_collide_at_the_longest_step_stay_within_what_waves_do(name: str, method: dict) -> None:
    """A way to and fro takes 40 steps, and a contact that opens leaves 3.5/20 of a front, 3 % of its energy."""
    key = "safety" if method["type"] == "peridynamics" else "courant"
    simulation = colliding(name, method, **{key: 1.0})
    simulation.advance(5000)
    ledger = next(each for each in simulation.trackers if isinstance(each, Ledger))

    assert max(-entry.stepping for entry in ledger.entries) < 0.1 * ledger.entries[-1].supplied


def test_a_run_that_swings_from_step_to_step_stops() -> None:
    """At the limit the motion of both samples of a bar differs by 1/20 of a front more in every step."""
    with pytest.raises(
        RunError, match=r"swing from step to step .* stepping and contact and bond of the energy ledger"
    ):
        colliding("as long", CENTRAL, step=1e-6).advance(2000)
