"""Two disks that collide head on touch for π√(m*/k_n), press with v√(k_n m*) at most and part as fast as they met.

While they touch the overlap x swings with ω² = k_n/m*, and central differences have a solution for such a swing: a
sine of Ω with sin(½ΩΔt) = ½ωΔt. Let h = ωΔt, and sΔt, 0 ≤ s ≤ 1, be the time from the last step without force to the
touch. The steps' invariant w² + ω²xₙxₙ₊₁, w the velocity between them, is v²[1 − s(1 − s)h²] from then on.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from dembound.kernels.contacts import CLOSING
from dembound.motion.simulation import Simulation

RADII = np.array([0.2, 0.3])
SPEED = 0.5
H = 0.05
HIGHER = 1.0 + H**2  # covers what the bounds, all in h², leave out


@dataclass(frozen=True)
class Impact:
    """Masses and approach of a collision, and what came of it; all along the line of centres."""

    reduced_mass: float
    stiffness: float
    contact_time: float
    peak_force: float
    speeds: np.ndarray  # (2,) after
    expected_speeds: np.ndarray  # (2,) of a perfectly elastic impact

    @property
    def frequency(self) -> float:
        return np.sqrt(self.stiffness / self.reduced_mass)


@pytest.fixture(scope="module", params=[0.05, 0.5, 0.95])
def impact(request, lab) -> Impact:
    """A collision on a slanting line; the disks touch at different fractions of a step."""
    normal = np.array([0.6, 0.8])
    material = {"emod": 1e9, "pb_emod": 0.0, "law": "linearpbond"}
    stiffness = material["emod"]
    mass = lab.density * (2.0 * RADII) ** 2
    reduced = float(np.prod(mass) / mass.sum())
    step = H * np.sqrt(reduced / stiffness)
    gap = (3.0 + request.param) * step * SPEED
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
    touching = np.flatnonzero(np.array(overlaps) > 0.0)
    first, last = touching[0] - 1, touching[-1]
    x = np.array(overlaps)
    crossings = [k + x[k] / (x[k] - x[k + 1]) for k in (first, last)]
    common = mass @ before / mass.sum()
    return Impact(
        reduced,
        stiffness,
        step * (crossings[1] - crossings[0]),
        max(forces),
        normal @ simulation.state.velocity[:2],
        2.0 * common - before,
    )


def test_contact_time(impact):
    # half a turn takes π/Ω = (π/ω)(1 − h²/24 …). The touch is read off a chord of the sine from phase −a to b, whose
    # zero is off by ab(a − b)/6 < 0.017h³, at either end. The first push, at phase fh < h, is c − 1 times too strong
    # and takes (c − 1)fh² of the speed, which turns the phase by (c − 1)f²h³
    expected = np.pi / impact.frequency
    third_order = 2.0 * 0.017 + (CLOSING - 1.0)
    assert impact.contact_time == pytest.approx(expected, rel=(H**2 / 24.0 + third_order * H**3 / np.pi) * HIGHER)
    assert impact.contact_time < expected


def test_peak_force(impact):
    # the invariant gives the sine an amplitude of (v/ω)√[(1 − s(1 − s)h²)/(1 − h²/4)], from 1 to 1 + h²/8; the step
    # next to its crest is at most ½ΩΔt off it, where the cosine is √(1 − h²/4)
    expected = SPEED * np.sqrt(impact.stiffness * impact.reduced_mass)
    assert impact.peak_force == pytest.approx(expected, rel=H**2 / 8.0 * HIGHER)


def test_restitution_is_one(impact):
    # they part at another s', so that v'²[1 − s'(1 − s')h²] = v²[1 − s(1 − s)h²]; s(1 − s) is at most ¼
    apart = np.diff(impact.speeds)[0]
    assert apart == pytest.approx(SPEED, rel=H**2 / 8.0 * HIGHER)
    # the common velocity stays as it is to rounding, so each disk is off by its share of the same error
    np.testing.assert_allclose(impact.speeds, impact.expected_speeds, atol=SPEED * H**2 / 8.0 * HIGHER)
