"""What peridynamic bars go wrong by: each of these shortcuts has a price that is known.

Under a strain ε a bond pulls with c_m ε V² w_p, whatever its length, and as δ = mΔx and V = AΔx all those that cross a
plane make up the stress E ε (2/m²) Σ w_p; p of each length do, hence E itself with Σ p w_p = m²/2.
"""

import numpy as np
import pytest

from dembound.kernels.bar import plane_force
from dembound.laws.peridynamic import families, volume_factor
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Rod
from dembound.motion.simulation import Simulation

HORIZONS = [1, 2, 3, 5, 8]
NODES = 60


def stiffness(pairs: np.ndarray, horizon: int) -> float:
    """E_eff/E in the middle of a bar with these bonds (b, 2), each with its volume factor."""
    first, second = np.sort(pairs, axis=1).T
    across = (first < NODES // 2) & (second >= NODES // 2)
    factor = volume_factor(second - first, horizon)
    return 2.0 / horizon**2 * factor[across].sum()


def within(places: np.ndarray, reach: float) -> np.ndarray:
    """Pairs (b, 2) of nodes at places (n,) m whose distance is not above the reach (m): the obvious way."""
    return np.argwhere(np.triu(np.abs(places[:, None] - places) <= reach, k=1))


@pytest.mark.parametrize("horizon", HORIZONS)
def test_whole_outermost_neighbours_are_too_stiff(horizon):
    """Without their half factor Σ p w_p is m(m + 1)/2, and E_eff/E is 1 + 1/m."""
    rod = Rod.uniform(NODES, spacing=0.01, section=1.0, modulus=20e9)
    bonds = Bonds(rod, horizon)
    bonds.add_zone(0, NODES)
    strain = 1e-4
    u = strain * rod.positions
    stress = 20e9 * strain
    arrays = bonds.arrays(np.zeros(0, dtype=np.int64), 1e-6)
    assert plane_force(NODES // 2, u, arrays) == pytest.approx(stress, rel=1e-12)
    arrays.bond[-1] *= 2.0
    assert plane_force(NODES // 2, u, arrays) == pytest.approx(stress * (1 + 1 / horizon), rel=1e-12)


@pytest.mark.parametrize("horizon", HORIZONS)
def test_families_by_distance_lose_pairs(horizon):
    """Differences of rounded places are above mΔx as often as not; by index offset none is missed."""
    whole = families(NODES, horizon).pairs
    assert len(whole) == sum(NODES - p for p in range(1, horizon + 1))
    assert stiffness(whole, horizon) == pytest.approx(1.0, rel=1e-12)
    spacing = 1e-3
    found = within(spacing * np.arange(NODES), horizon * spacing)
    lost = len(whole) - len(found)
    assert lost > 0
    assert {tuple(pair) for pair in found} < {tuple(pair) for pair in whole.tolist()}
    # all that are lost are outermost ones
    assert lost == np.sum(np.diff(whole)[:, 0] == horizon) - np.sum(np.diff(found)[:, 0] == horizon)


@pytest.mark.parametrize("horizon", HORIZONS)
def test_families_by_current_places_lose_tension(horizon):
    """Under any tension the outermost neighbours have left, and took 2w_m m/m² = 1/m of the stiffness along."""
    places = np.arange(NODES, dtype=float)  # whole numbers have no rounding
    assert stiffness(within(places * (1.0 - 1e-6), horizon), horizon) == pytest.approx(1.0, rel=1e-12)
    assert stiffness(within(places * (1.0 + 1e-6), horizon), horizon) == pytest.approx(1 - 1 / horizon, abs=1e-12)


@pytest.fixture
def torn(rock):
    """Finds whether a pressure of so many strengths tears the end it acts on, before any tension can come back.

    L section 3.2: spacings of 5 mm, steps of 1 µs, a pulse of 0.12 ms.
    """

    def tears(horizon: int, strengths: float, nodes: int) -> bool:
        scene = rock.scene(
            {"type": "peridynamics", "horizon": horizon},
            spacing=5e-3,
            strength=rock.strength,
            load={"pressure": strengths * rock.strength, "nodes": nodes},
            wave=rock.triangle(0.12e-3),
        )
        simulation = Simulation(scene, 1e-6)
        simulation.advance(int(rock.length / rock.speed / 1e-6))
        cracks = simulation.system.take_cracks(simulation.state.step)
        return bool(np.any(cracks.position[:, 0] < 0.1 * rock.length))

    return tears


@pytest.mark.parametrize(("horizon", "strengths"), [(3, 7.7), (4, 4.5), (5, 1.7), (8, 1.0)])
def test_load_on_one_node_tears_the_end(torn, horizon, strengths):
    """The soft end springs back: the more softly the larger m is. Spread over m nodes the same load does nothing.

    A pressure of 7.66 strengths does it for m = 3, 4.43 for 4, 1.60 for 5, 0.81 for 8, and 5 times as much
    if spread is borne by all.
    """
    assert torn(horizon, strengths, nodes=1)
    assert not torn(horizon, 0.75 * strengths, nodes=1)
    assert not torn(horizon, 4.5 * strengths, nodes=horizon)
