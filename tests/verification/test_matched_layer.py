"""A matched layer beyond an end of a bar returns next to nothing, only takes energy, and leaves the step limit alone.

The reference is a bar so long that nothing comes back from its far end. A cosine pulse of 20 spacings is sharp: at 5
spacings in a wavelength its spectrum still has a per cent. Returned amplitudes are bounded by those of
docs/bar_ends.md, measured at three nodes over four passages; a wrong sign, rate or stiffness of any bond returns a
thousand
times as much.
"""

from itertools import pairwise

import numpy as np
import pytest

from dembound.api import case
from dembound.bar.scene import build_bar
from dembound.boundaries import MatchedLayer
from dembound.errors import RunError
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

CELLS, SPACING = 120, 5e-3
PULSE = {"type": "cosine", "amplitude": 1.0, "period": 20 * SPACING / 2740.0}


def method(horizon: int) -> dict:
    corrected = {"type": "peridynamics", "horizon": horizon, "corrected_ends": True}
    return corrected if horizon > 1 else {"type": "finite_difference"}


def layer(nodes: int = 40, **keys) -> dict:
    return {"type": "matched_layer", "nodes": nodes} | keys


def bar(rock, horizon: int, *, cells: int = CELLS, load: bool = True, own: dict | None = None, **words):
    push = {"pressure": 1e6, "nodes": horizon} if load else None
    words = {"wave": PULSE} | words
    return rock.scene(own or method(horizon), spacing=SPACING, load=push, length=cells * SPACING, **words)


def motion(scene, step: float, steps: int, nodes=(0, CELLS // 2, CELLS)) -> np.ndarray:
    return Simulation(scene, step, nodes).advance(steps)[:, :, 3]


def difference(rock, horizon: int, end: dict, share: float, **words) -> float:
    """Largest difference of velocity from an endless bar over the peak, at three nodes while waves run five lengths."""
    endless = bar(rock, horizon, cells=4 * CELLS, **words)
    step = share * endless.step_limit()
    steps = int(5 * CELLS * SPACING / rock.speed / step)
    expected = motion(endless, step, steps)
    got = motion(bar(rock, horizon, boundary={"right": end}, **words), step, steps)
    return float(np.abs(got - expected).max() / np.abs(expected).max())


@pytest.mark.parametrize("share", [0.5, 0.9])
@pytest.mark.parametrize(
    ("horizon", "nodes", "most"),
    [(1, 40, 7e-6), (1, 80, 1e-7), (3, 40, 1.3e-6), (3, 80, 6e-8), (8, 40, 5e-5), (8, 80, 4e-6)],
)
def test_next_to_nothing_returns(rock, horizon, nodes, most, share):
    assert difference(rock, horizon, layer(nodes), share) < most


@pytest.mark.parametrize(("horizon", "most"), [(1, 2e-6), (3, 7e-7)])
def test_attenuation_goes_on_in_the_layer(rock, horizon, most):
    """Without the springs to the ground a per cent comes back."""
    assert difference(rock, horizon, layer(), 0.9, attenuation=0.5) < most


def test_dashpots_return_a_thousand_times_as_much(rock):
    assert difference(rock, 3, {"type": "viscous"}, 0.9) > 1e-2


def test_a_layer_at_the_left_is_the_mirror_image(rock):
    """To rounding of the sums, which have another order: some ε of the peak in each of 600 steps."""
    step = 0.9 * bar(rock, 3).step_limit()
    right = bar(rock, 3, boundary={"right": layer()})
    push = {"pressure": 1e6, "nodes": 3, "side": "right"}
    left = rock.scene(
        method(3), spacing=SPACING, load=push, length=CELLS * SPACING, wave=PULSE, boundary={"left": layer()}
    )
    there, here = motion(right, step, 600), -motion(left, step, 600)[:, ::-1]
    np.testing.assert_allclose(here, there, rtol=0.0, atol=600 * 1e-15 * np.abs(there).max())


@pytest.mark.parametrize("horizon", [1, 3])
def test_the_step_limit_is_that_of_a_longer_bar(rock, horizon):
    """And so at least that of an endless one, of which it is a part."""
    from dembound.exact.dispersion import courant_limit

    plain = {"type": "peridynamics", "horizon": horizon} if horizon > 1 else method(1)
    scene = bar(rock, horizon, own=plain, boundary={"left": layer(), "right": layer()})
    assert scene.step_limit() * rock.speed / SPACING >= courant_limit(horizon) * (1.0 - 1e-9)


def test_rates_too_large_for_the_proof_bound_the_step(rock):
    """A layer of four nodes with R0 = 1e-12 has d = 4·27.6/8 c/Δx at its last one: the step is 4/d."""
    scene = bar(rock, 1, boundary={"right": layer(4, reflection=1e-12)})
    assert scene.step_limit() * rock.speed / SPACING == pytest.approx(4.0 * 8.0 / (4.0 * np.log(1e12)), rel=1e-12)


class Mechanics:
    """The masses, stiffnesses and elongations of a bar and the layer beyond its right end, as dense matrices."""

    def __init__(self, scene, step: float) -> None:
        each, bonds = scene.layers["right"], scene.case.method.begin(scene.rod)
        n, reach = scene.count, len(each.inner)
        self.mass = np.concatenate([scene.mass, np.full(each.layer.nodes, each.mass)])
        self.a = 0.5 * step * np.concatenate([np.zeros(n), each.node_rates[reach:]])
        pairs = [(i, i + 1, k, 0.0) for i, k in enumerate(bonds.spring) if k > 0.0]
        pairs += [
            (i, i + p, bonds.bond[p - 1, i], 0.0)
            for p in range(1, bonds.horizon + 1)
            for i in range(n)
            if bonds.bond[p - 1, i] > 0.0
        ]
        self.inside = len(pairs)
        self.rows = [(p, i) for p in range(reach) for i in range(each.count) if each.bonds[p, i] > 0.0]
        first = n - reach
        pairs += [(first + i, first + i + p + 1, each.bonds[p, i], each.bond_rates[p, i]) for p, i in self.rows]
        i, j, self.k, rate = (np.array(column) for column in zip(*pairs, strict=True))
        self.b = 0.5 * step * rate
        self.elongation = np.zeros((len(pairs), len(self.mass)))
        self.elongation[np.arange(len(pairs)), i.astype(int)] = -1.0
        self.elongation[np.arange(len(pairs)), j.astype(int)] = 1.0
        self.h = 0.5 * step

    def forces(self, u: np.ndarray, own: np.ndarray) -> np.ndarray:
        """Forces of all bonds: of the bar's from its displacements, of the layer's from its rows."""
        inside = self.k[: self.inside] * (self.elongation[: self.inside, : len(u)] @ u)
        return np.concatenate([inside, [own[row] for row in self.rows]])

    def energy(self, v: np.ndarray, f: np.ndarray) -> float:
        """½ v̄ᵀMv̄ + ½ fᵀ(K⁻¹ − h²GM⁻¹Gᵀ)f."""
        pull = self.elongation.T @ f
        return 0.5 * float(np.sum(self.mass * v**2) + np.sum(f**2 / self.k) - self.h**2 * np.sum(pull**2 / self.mass))

    def taken(self, v: np.ndarray, f: np.ndarray) -> float:
        """½ Σ (b/k) f² + ½ Σ a (m w² + a w y + y²/m) for the sums v = w and f of two steps."""
        y = self.h * (self.elongation.T @ f)
        return 0.5 * float(
            np.sum(self.b / self.k * f**2) + np.sum(self.a * (self.mass * v**2 + self.a * v * y + y**2 / self.mass))
        )


@pytest.mark.parametrize("horizon", [1, 3])
def test_energy_is_only_taken_as_derived(rock, horizon):
    """The identity of bar/layers.py in every step, from noise: to rounding of sums of some hundred terms."""
    scene = bar(rock, horizon, cells=30, load=False, boundary={"right": layer(8, reflection=1e-4)})
    step = 0.95 * scene.step_limit()
    simulation, model = Simulation(scene, step), Mechanics(scene, step)
    (tie,) = simulation.system.ties
    noise = np.zeros((3, scene.count))
    noise[0] = np.random.default_rng(1).standard_normal(scene.count)
    simulation.state.velocity = noise

    def half_step() -> tuple[np.ndarray, np.ndarray]:
        memory = tie.memory()
        own = memory["velocity"][0, len(scene.layers["right"].inner) :]
        return np.concatenate([simulation.state.velocity[0], own]), memory["force"][0]

    found = []
    before, _ = half_step()
    for _ in range(200):
        u = simulation.state.displacement[0].copy()
        simulation.advance(1)
        after, own = half_step()
        found.append((0.5 * (before + after), model.forces(u, own)))
        before = after.copy()
    energies = np.array([model.energy(v, f) for v, f in found])
    taken = [model.taken(v + w, f + g) for (v, f), (w, g) in pairwise(found)]
    np.testing.assert_allclose(np.diff(energies), -np.array(taken), rtol=0.0, atol=1e-13 * energies[0])
    assert min(taken) >= 0.0
    assert energies[-1] < 0.5 * energies[0]


@pytest.mark.parametrize(
    "own",
    [
        method(1),
        {"type": "peridynamics", "horizon": 3},
        {"type": "patch", "horizon": 3},
        {"type": "switch", "horizon": 3},
    ],
    ids=["finite differences", "peridynamics", "patch", "switch"],
)
def test_the_ledger_closes_and_all_that_came_is_absorbed(rock, own):
    """To rounding, and to the echo of the horizon's own dispersion; by the right end, as the left one is free."""
    scene = bar(rock, 1, own=own, load=False, boundary={"left": layer(wave_p="pulse"), "right": layer()}, strength=1e9)
    simulation = Simulation(scene, 0.9 * scene.step_limit(), side_stride=1)
    ledger = Ledger(simulation, 50)
    simulation.track(ledger)
    simulation.run(50 * int(20 * CELLS / 50) + 1)
    last, peak = ledger.entries[-1], max(entry.outside for entry in ledger.entries)
    assert max(abs(entry.error) for entry in ledger.entries) < 1e-11 * peak
    (came, kept, _), (_, let_go, _) = ledger.side_columns[-1]
    assert came == pytest.approx(peak, rel=0.02)  # the right end has taken nothing yet when all has come
    assert kept + let_go == pytest.approx(came, rel=1e-3)
    assert let_go > 0.97 * came
    assert last.kinetic < 1e-3 * peak


@pytest.mark.parametrize("horizon", [1, 3])
@pytest.mark.parametrize("interface", ["bonded", "contact"])
def test_layers_continue_the_ranges_at_their_ends(rock, horizon, interface):
    """Steel before rock, each with its own spacing and impedance: as in a bar with longer ends, until these return.

    A hump of 20 nodes moves left in the rock and meets the steel in compression; to the errors of the ends above.
    """
    second = 101 if interface == "contact" else 100  # first node of the rock

    def moved(longer: int, end: dict | None, step: float) -> tuple[float, np.ndarray]:
        steel = {"name": "steel", "length": (100 + longer) * 8e-3, "spacing": 8e-3}
        steel |= {"density": 7800.0, "wave_speed": 5000.0}
        other = {"name": "rock", "length": (100 + longer) * SPACING, "interface": interface}
        material = {"spacing": SPACING, "density": rock.density, "wave_speed": rock.speed}
        scene = build_bar(
            case(
                bar=material | {"range": [steel, other]},
                method=method(horizon),
                boundary={"left": end, "right": end} if end else {},
                run={"duration": 1.0},
            )
        )
        first = longer + second
        simulation = Simulation(scene, step or 0.8 * scene.step_limit(), np.array([20, 90, second + 60]) + longer)
        velocity = np.zeros((3, scene.count))
        velocity[0, first + 20 : first + 41] = -0.5 * (1.0 - np.cos(2.0 * np.pi * np.arange(21) / 20))
        simulation.state.velocity = velocity
        return simulation.time_step, simulation.advance(int(400 * SPACING / rock.speed / simulation.time_step))[:, :, 3]

    step, expected = moved(200, None, 0.0)
    _, got = moved(0, layer(), step)
    impedance = rock.density * rock.speed
    through = impedance / (impedance + 7800.0 * 5000.0)  # of the half of the hump that runs left, twice this share
    assert np.abs(expected[:, 1]).max() == pytest.approx(through, rel=0.02)
    assert np.abs(got - expected).max() < 7e-6 * np.abs(expected).max()


def test_a_wave_enters_through_a_layer_and_nothing_comes_back(rock):
    """As a force on one node it moves that by 1/√(1 − (kΔx/2)²) too much, 1e-3 at the pulse's shortest wavelengths."""
    slow = {"type": "cosine", "amplitude": 1.0, "period": 200 * SPACING / rock.speed}
    scene = bar(rock, 1, load=False, wave=slow, boundary={"left": layer(wave_p="pulse"), "right": layer()})
    step = 0.5 * scene.step_limit()
    steps = int(1.2 * (200 + CELLS) * SPACING / rock.speed / step)
    velocity = motion(scene, step, steps)
    times = step * np.arange(steps)
    for node, got in zip((0, CELLS // 2, CELLS), velocity.T, strict=True):
        expected = scene.case.wave["pulse"].velocity(times - node * SPACING / rock.speed)
        np.testing.assert_allclose(got, expected, rtol=0.0, atol=2e-3)


def test_a_load_before_a_layer_sends_half_of_its_pressure(rock):
    whole, half = (
        motion(bar(rock, 1, boundary=ends), 0.9 * SPACING / rock.speed, 150)[:, 1].max()
        for ends in ({}, {"left": layer()})
    )
    assert half == pytest.approx(0.5 * whole, rel=2e-2)  # a force on a whole node lacks the half of its own inertia


def test_a_switch_keeps_springs_in_the_layer(rock):
    """The bar is peridynamic from its first tension on, and its seam with the layer echoes as any other.

    By (m² − 1)(kΔx)²/96 (test_patch_seam), 0.1 % of a cosine pulse of 60 spacings; at its end node by more.
    """
    own = {"type": "switch", "horizon": 3, "trigger": 0.01, "corrected_ends": True}
    words = {"own": own, "strength": 60e6}
    words["wave"] = {"type": "cosine", "amplitude": -1.0, "period": 60 * SPACING / rock.speed}
    seam = (3**2 - 1) * (2.0 * np.pi / 60) ** 2 / 96.0
    assert 0.5 * seam < difference(rock, 3, layer(), 0.9, **words) < 2.0 * seam


@pytest.mark.parametrize("cracks", [{}, {"fracture_energy": 1e4}])
def test_breaks_beside_a_layer_are_refused(rock, cracks):
    """A pull at the left end tears the bar there at once, or begins to open a crack."""
    scene = bar(rock, 3, load=False, strength=1e6, **cracks, boundary={"left": layer(wave_p="pulse"), "right": layer()})
    with pytest.raises(RunError, match=r"within 0\.015 m of its left end, where bonds reach into the matched layer"):
        Simulation(scene, 0.5 * scene.step_limit()).run(100)


def noise(rock, horizon: int, steps: int, share: float, attenuation: float) -> float:
    """Kinetic energy of noise at the end of a run over that at the start."""
    ends = {"left": layer(16), "right": layer(20, reflection=1e-8)}
    scene = bar(rock, horizon, cells=40, load=False, boundary=ends, attenuation=attenuation)
    simulation = Simulation(scene, share * scene.step_limit())
    velocity = np.zeros((3, scene.count))
    velocity[0] = np.random.default_rng(0).standard_normal(scene.count)
    simulation.state.velocity = velocity
    simulation.run(steps)
    start, end = (float(np.sum(scene.mass * v[0] ** 2)) for v in (velocity, simulation.state.velocity))
    return end / start


@pytest.mark.parametrize(("horizon", "share", "attenuation"), [(1, 0.9999, 0.0), (3, 0.9999, 0.5)])
def test_noise_dies_away(rock, horizon, share, attenuation):
    assert noise(rock, horizon, 20_000, share, attenuation) < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("horizon", [1, 3, 8])
@pytest.mark.parametrize("attenuation", [0.0, 0.5])
def test_noise_dies_away_for_a_million_steps(rock, horizon, attenuation):
    assert noise(rock, horizon, 1_000_000, 0.9999, attenuation) < 1e-3


def test_disks_have_another_outside():
    table = MatchedLayer(type="matched_layer")
    (line,) = table.problems("right", {"boundary": {}, "motion": None})
    assert line == 'boundary.right.type: is "matched_layer", which is for ends of bars; for disks take "outside"'
