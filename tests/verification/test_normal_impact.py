"""Two disks that collide head on touch for π√(m*/k_n), press with v√(k_n m*) at most and part as fast as they met.

While they touch the overlap x swings with ω² = k_n/m*, and central differences have a solution for such a swing: a
sine of Ω with sin(½ΩΔt) = ½ωΔt. Let h = ωΔt, and sΔt, 0 ≤ s ≤ 1, be the time from the last step without force to the
touch. The steps' invariant w² + ω²xₙxₙ₊₁, w the velocity between them, is v²[1 − s(1 − s)h²] from then on.
"""

import numpy as np
import pytest

from dembound.kernels.contacts import CLOSING
from dembound.motion.simulation import Simulation

RADII = np.array([0.2, 0.3])
SPEED, STIFFNESS = 0.5, 1e9
H = 0.05
HIGHER = 1.0 + H**2  # covers what the bounds, all in h², leave out


@pytest.mark.parametrize("fraction", [0.05, 0.5])  # of a step, at which the disks touch
def test_contact_time_peak_force_and_restitution(lab, fraction):
    """On a slanting line."""
    normal = np.array([0.6, 0.8])
    mass = lab.density * (2.0 * RADII) ** 2
    reduced = float(np.prod(mass) / mass.sum())
    step = H * np.sqrt(reduced / STIFFNESS)
    gap = (3.0 + fraction) * step * SPEED
    material = {"emod": STIFFNESS, "pb_emod": 0.0, "law": "linearpbond"}
    scene = lab.disks(np.outer([0.0, RADII.sum() + gap], normal), RADII, held=(), material=material)
    simulation = Simulation(scene, step, np.arange(2))
    before = np.array([0.7 * SPEED, -0.3 * SPEED])
    simulation.state.v[:2, simulation.state.layout.slot] = np.outer(normal, before)

    overlaps, forces = [], []
    for _ in range(int(1.5 * np.pi / H)):
        apart = np.diff(scene.assembly.positions + simulation.state.displacement[:2].T, axis=0)
        overlaps.append(RADII.sum() - np.hypot(*apart[0]))
        simulation.advance(1)
        forces.append(np.hypot(*simulation.system.contacts["body"].force[0, :2]))
    assert simulation.state.laws[-1][0] == "linearpbond"
    assert not simulation.state.displacement[2].any()

    # half a turn takes π/Ω = (π/ω)(1 − h²/24 …). The touch is read off a chord of the sine from phase −a to b, whose
    # zero is off by ab(a − b)/6 < 0.017h³, at either end. The first push, at phase fh < h, is c − 1 times too strong
    # and takes (c − 1)fh² of the speed, which turns the phase by (c − 1)f²h³
    x = np.array(overlaps)
    touching = np.flatnonzero(x > 0.0)
    first, last = (k + x[k] / (x[k] - x[k + 1]) for k in (touching[0] - 1, touching[-1]))
    expected = np.pi * np.sqrt(reduced / STIFFNESS)
    third_order = 2.0 * 0.017 + (CLOSING - 1.0)
    assert step * (last - first) == pytest.approx(expected, rel=(H**2 / 24.0 + third_order * H**3 / np.pi) * HIGHER)
    assert step * (last - first) < expected
    # the invariant gives the sine an amplitude of (v/ω)√[(1 − s(1 − s)h²)/(1 − h²/4)], from 1 to 1 + h²/8; the step
    # next to its crest is at most ½ΩΔt off it, where the cosine is √(1 − h²/4)
    assert max(forces) == pytest.approx(SPEED * np.sqrt(STIFFNESS * reduced), rel=H**2 / 8.0 * HIGHER)
    # they part at another s', so that v'²[1 − s'(1 − s')h²] = v²[1 − s(1 − s)h²]; s(1 − s) is at most ¼
    speeds = normal @ simulation.state.velocity[:2]
    assert np.diff(speeds)[0] == pytest.approx(SPEED, rel=H**2 / 8.0 * HIGHER)
    # the common velocity stays as it is to rounding, so each disk is off by its share of the same error
    elastic = 2.0 * (mass @ before) / mass.sum() - before
    np.testing.assert_allclose(speeds, elastic, atol=SPEED * H**2 / 8.0 * HIGHER)
