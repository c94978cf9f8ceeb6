"""Bonds with strengths of their own break at these, whatever computes them and in whatever order."""

import numpy as np
import pytest

from dembound.casefile.disks.targets import Scatter
from dembound.disks.material.constants import LEAST, bond_factors, drawn
from dembound.disks.scene import build
from dembound.disks.stepping.load_factor import LoadFactor
from dembound.kernels.contacts import INTACT
from dembound.kinds import with_changes
from dembound.motion import memory
from dembound.motion.simulation import Simulation

STEPS = 250
BRITTLE = {"law": "linearpbond", "pb_ten": 4e5, "pb_coh": 6e5, "pb_fa": 20.0, "fric": 0.5, "geometry": "reference"}
SCATTER = {"pb_scatter": {"type": "weibull", "shape": 2.0}}
SIDES = {"left": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}, "right": "viscous"}


def run(lab, size: tuple[float, float] = (40.0, 4.0), steps: int = STEPS, number: int = 1, **material) -> Simulation:
    """A run of grains that pulses break, with so many threads."""
    words = {"held": (), "boundary": SIDES, "wave": lab.pulse(0.01), "brick": (4.0, 4.0)}
    return lab.advanced(lab.simulation(lab.scene("B", size, **words, material=BRITTLE | material)), steps, number)


def shares_of_strength(simulation: Simulation, u: np.ndarray) -> np.ndarray:
    """Tension and shear (2, b) of all pairs as bonds at small displacements u (3, n) over the strengths of each."""
    (contacts,) = simulation.system.contacts.values()
    constants, factor = contacts._constants[contacts.of("contact_type")], contacts.limits.factor[contacts.live]
    first, second = contacts.pairs
    (nx, ny), rest = (constants[:, :2] / constants[:, 2:3]).T, constants[:, 2]
    arm, turn = 0.5 * rest + constants[:, 4], u[2, second] - u[2, first]
    dx, dy = u[:2, second] - u[:2, first]
    normal = constants[:, 7] * (nx * dx + ny * dy) * constants[:, 10]
    shear = constants[:, 8] * (nx * dy - ny * dx - arm * u[2, first] - (rest - arm) * u[2, second]) * constants[:, 10]
    tension = normal + np.abs(constants[:, 9] * turn) * constants[:, 11]
    cohesion = factor * BRITTLE["pb_coh"] - normal * np.tan(np.radians(BRITTLE["pb_fa"]))
    return np.stack([tension / (factor * BRITTLE["pb_ten"]), np.abs(shear) / cohesion])


@pytest.mark.parametrize(
    "size", [pytest.param((40.0, 4.0), marks=pytest.mark.slow), (8.0, 4.0)], ids=["rows of copies", "one by one"]
)
def test_every_bond_breaks_when_its_own_strength_is_reached(lab, size):
    simulation = run(lab, size, 0, **SCATTER, elastic_start=False)
    (contacts,) = simulation.system.contacts.values()
    assert (contacts.rows is not None) == (size == (40.0, 4.0))
    broken = 0
    for _ in range(50):
        u, intact = simulation.state.displacement.copy(), contacts.of("state") == INTACT
        reached = (shares_of_strength(simulation, u) >= 1.0)[:, intact]
        simulation.advance(1)
        after = contacts.of("state")[intact]
        assert np.array_equal(after != INTACT, reached.any(axis=0))
        broken += np.count_nonzero(after != INTACT)
    assert broken > 20


def test_the_same_breaks_by_any_threads_after_a_cut_and_after_an_elastic_start(lab, hold_in_order, monkeypatch):
    hold_in_order()
    monkeypatch.setattr(memory, "PARTICLES_PER_THREAD", 1)
    one, two, cut, at_once = (
        run(lab, **SCATTER), run(lab, number=2, **SCATTER), run(lab, steps=0, **SCATTER),
        run(lab, **SCATTER, elastic_start=False),
    )  # fmt: skip
    assert [name for name, _ in one.state.laws] == ["elastic", "linearpbond"]
    part = run(lab, steps=STEPS // 2, **SCATTER)
    cut.state.take(part.state.arrays())
    cut.advance(STEPS - STEPS // 2)
    first, *others = (each.system.take_cracks(STEPS) for each in (one, two, cut, at_once))
    assert len(first) > 100
    for other in others:
        assert all(np.array_equal(getattr(first, name), getattr(other, name)) for name in ("pair", "step", "shear"))
    for other in (two, cut):
        assert np.array_equal(one.state.velocity, other.state.velocity)
    (contacts,) = one.system.contacts.values()
    broken = contacts.of("state") > INTACT
    factors = contacts.limits.factor[contacts.live]
    assert factors[broken].mean() < 0.9 * factors[contacts.of("contact_type") < contacts.own_types].mean()


def test_energy_of_bonds_that_break_at_their_own_strengths_closes(lab, hold_in_order):
    hold_in_order()
    simulation = run(lab, steps=0, **SCATTER)
    ledger = lab.ledger(simulation, 10)
    simulation.run(STEPS)
    last = ledger.entries[-1]
    assert last.crack > 1e-3 * last.supplied
    assert abs(last.error) < 3e-5 * last.supplied  # normals of loose pairs rotate: 5e-6


def test_the_first_bond_breaks_at_the_load_factor(lab, hold_in_order):
    """Without contacts (`contact_share` 0) nothing else ends the elastic law."""
    hold_in_order()
    bonds = BRITTLE | {"contact_share": 0.0, "fric": 0.0} | SCATTER

    def breaking(scale: float, **changes) -> Simulation:
        wave = lab.pulse(0.01) | {"amplitude": 0.5 * scale}
        case = lab.case("A", (10.0, 2.5), held=(), boundary=SIDES, wave=wave, material=bonds)
        return lab.simulation(build(with_changes(case, changes)))

    elastic = breaking(1.0, **{"material.law": "elastic", "material.geometry": None, "output.load_factor": True})
    tracker = LoadFactor(elastic.scene.case, elastic.system)
    elastic.track(tracker)
    elastic.run(STEPS)
    factor = tracker.factor
    below, above = (breaking(factor * (1.0 + more)) for more in (-1e-6, 1e-6))
    for each in (below, above):
        each.advance(STEPS)
    assert len(below.system.take_cracks(STEPS)) == 0
    first = above.system.take_cracks(STEPS).pair[0]
    assert sorted(first) == sorted(tracker.describe(elastic)["particles"])


def test_a_bond_keeps_its_strength_in_a_larger_body_and_without_its_neighbours(lab):
    """Strengths go with places: the same in a body that begins two bricks further left, and with a hole."""
    small, large = (
        lab.scene("B", (8.0 + more, 4.0), material=BRITTLE | SCATTER, brick=(4.0, 4.0), origin=(-more, 0.0))
        for more in (0.0, 8.0)
    )
    found = []
    for scene in (small, large):
        first = scene.assembly.pairs[:, 0]
        middle = scene.positions[first] + 0.5 * scene.ground.brick.vectors[scene.assembly.contact_type]
        factors = bond_factors(scene.case, scene.ground, scene.assembly).at(first, scene.assembly.contact_type)
        found.append({tuple(np.round(place, 6)): factor for place, factor in zip(middle, factors, strict=True)})
    shared = found[0].keys() & found[1].keys()
    assert len(shared) == len(found[0])
    assert all(found[0][place] == found[1][place] for place in shared)
    # copies of a bond differ
    assert len(set(found[1].values())) == len(found[1])


@pytest.mark.parametrize(
    ("words", "deviation"),
    [
        ({"type": "normal", "deviation": 0.3}, 0.3 * 0.9866),  # cut at three deviations
        ({"type": "weibull", "shape": 5.0}, 0.2291),
        ({"type": "weibull", "shape": 1.0}, 1.0 / 1.05),  # exponential above 0.05
    ],
)
def test_factors_have_mean_one_and_their_deviation(words, deviation):
    scatter = Scatter(**words)
    factors = drawn(scatter, (np.arange(100_000) + 0.5) / 100_000)
    assert factors.mean() == pytest.approx(1.0, abs=2e-4)
    assert factors.std() == pytest.approx(deviation, rel=2e-3)
    assert factors.min() >= 0.9 * LEAST
