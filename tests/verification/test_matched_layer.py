"""A matched layer beyond an end of a bar returns next to nothing, only takes energy, and leaves the step limit alone.

The reference is a bar so long that nothing comes back from its far end. A cosine pulse of 20 spacings is sharp: at 5
spacings in a wavelength its spectrum still has a per cent. Returned amplitudes are bounded by those of
docs/evidence/bar_ends.md, measured at three nodes over four passages; a wrong sign, rate or stiffness of any bond
returns a thousand times as much.
"""

import numpy as np
import pytest

from dembound.errors import RunError
from dembound.exact import courant_limit
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


def motion(scene, step: float, steps: int) -> np.ndarray:
    return Simulation(scene, step, (0, CELLS // 2, CELLS)).advance(steps)[:, :, 3]


def difference(rock, horizon: int, end: dict, share: float, **words) -> float:
    """Largest difference of velocity from an endless bar over the peak, at three nodes while waves run five lengths."""
    endless = bar(rock, horizon, cells=4 * CELLS, **words)
    step = share * endless.step_limit()
    steps = int(5 * CELLS * SPACING / rock.speed / step)
    expected = motion(endless, step, steps)
    got = motion(bar(rock, horizon, boundary={"right": end}, **words), step, steps)
    return float(np.abs(got - expected).max() / np.abs(expected).max())


@pytest.mark.parametrize(
    ("horizon", "nodes", "most", "share", "alpha"),
    [(1, 80, 1e-7, 0.5, 0.0), (3, 40, 1.3e-6, 0.9, 0.0), (3, 40, 7e-7, 0.9, 0.5), (8, 80, 4e-6, 0.9, 0.0)],
)
def test_next_to_nothing_returns(rock, horizon, nodes, most, share, alpha):
    """Attenuation goes on in the layer: without the springs to the ground a per cent comes back."""
    assert difference(rock, horizon, layer(nodes), share, attenuation=alpha) < most


def test_the_step_limit_is_that_of_a_longer_bar(rock):
    """And so at least that of an endless one, of which it is a part."""
    scene = bar(rock, 3, own={"type": "peridynamics", "horizon": 3}, boundary={"left": layer(), "right": layer()})
    assert scene.step_limit() * rock.speed / SPACING >= courant_limit(3) * (1.0 - 1e-9)


def test_rates_too_large_for_the_proof_bound_the_step(rock):
    """A layer of four nodes with R0 = 1e-12 has d = 4·27.6/8 c/Δx at its last one: the step is 4/d."""
    scene = bar(rock, 1, boundary={"right": layer(4, reflection=1e-12)})
    assert scene.step_limit() * rock.speed / SPACING == pytest.approx(4.0 * 8.0 / (4.0 * np.log(1e12)), rel=1e-12)


@pytest.mark.parametrize("own", [{"type": "peridynamics", "horizon": 3}, {"type": "patch", "horizon": 3}], ids=str)
def test_the_ledger_closes_and_all_that_came_is_absorbed(lab, rock, own):
    """To rounding, and to the echo of the horizon's own dispersion; by the right end, as the left one is free."""
    scene = bar(rock, 1, own=own, load=False, boundary={"left": layer(wave_p="pulse"), "right": layer()}, strength=1e9)
    simulation = Simulation(scene, 0.9 * scene.step_limit(), side_stride=1)
    ledger = lab.ledger(simulation, 50)
    simulation.run(50 * int(20 * CELLS / 50) + 1)
    last, peak = ledger.entries[-1], max(entry.outside for entry in ledger.entries)
    assert max(abs(entry.error) for entry in ledger.entries) < 1e-11 * peak
    (came, kept, _), (_, let_go, _) = ledger.side_columns[-1]
    assert came == pytest.approx(peak, rel=0.02)  # the right end has taken nothing yet when all has come
    assert kept + let_go == pytest.approx(came, rel=1e-3)
    assert let_go > 0.97 * came
    assert last.kinetic < 1e-3 * peak


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


@pytest.mark.parametrize(
    ("horizon", "attenuation", "steps"),
    [(3, 0.5, 20_000), *(pytest.param(m, 0.0, 1_000_000, marks=pytest.mark.slow) for m in (1, 3, 8))],
)
def test_noise_dies_away(rock, horizon, attenuation, steps):
    """Kinetic energy at the end of a run just below the limit over that at the start."""
    ends = {"left": layer(16), "right": layer(20, reflection=1e-8)}
    scene = bar(rock, horizon, cells=40, load=False, boundary=ends, attenuation=attenuation)
    simulation = Simulation(scene, 0.9999 * scene.step_limit())
    velocity = np.zeros((3, scene.count))
    velocity[0] = np.random.default_rng(0).standard_normal(scene.count)
    simulation.state.velocity = velocity
    simulation.run(steps)
    start, end = (float(np.sum(scene.mass * v[0] ** 2)) for v in (velocity, simulation.state.velocity))
    assert end < 1e-3 * start
