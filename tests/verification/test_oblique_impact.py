"""Two disks that meet obliquely turn each other, as Coulomb friction or the two springs of the contact say.

Let v_n and v_s be the velocities with which the surfaces meet and pass, m* = m₁m₂/(m₁ + m₂), h = Δt√(k_n/m*). The
normal impulse is 2m*v_n. Against a tangential impulse a pair of disks has the mass m*/3, as R²/I = 2/m.

* While they slide the tangential impulse is μ times the normal one. They slide all the way if they would still slide
  at the end, v_s > 6μv_n, and if the tangential spring loads faster than its limit, k_s v_s > μk_n v_n.
* While they stick the tangential spring swings with ω_s² = 3k_s/m*. With k_s = k_n/3 it swings as the normal one does,
  its force stays v_s/(3v_n) of the normal force, and v_s is turned round like v_n.
"""

import numpy as np
import pytest

from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

RADII = np.array([0.2, 0.3])
NORMAL, TANGENT = np.array([0.8, 0.6]), np.array([-0.6, 0.8])
POSITIONS = np.outer([0.0, RADII.sum()], NORMAL)
APPROACH, PASSING = 1e-3, 1.5e-3  # m/s, so slow that the line of centres hardly turns
EMOD = 1e9
H = 0.02
IMPACT, STEPS = int(np.pi / H) + 1, int(4.0 / H)
EPS = np.finfo(float).eps


class Impact:
    """A collision of two disks that touch at the start, meet at `APPROACH` and pass at `PASSING`.

    before, after : velocities (3, 2); books : the ledger's entries; momenta : (STEPS + 1, 3, 6), the terms of the
    momenta along x, y and about the origin; turned : how far the line of centres turns until they part.
    """

    def __init__(self, lab, fric: float, kratio: float, **material) -> None:
        self.mass = lab.density * (2.0 * RADII) ** 2
        self.inertia = 0.5 * self.mass * RADII**2
        self.reduced = float(np.prod(self.mass) / self.mass.sum())
        material |= {"law": "linearpbond", "emod": EMOD, "pb_emod": 0.0, "fric": fric, "kratio": kratio}
        scene = lab.disks(POSITIONS, RADII, [(0, 1)], held=(), material=material)
        self.simulation = Simulation(scene, H * np.sqrt(self.reduced / EMOD))
        spin = PASSING * np.array([1.0, -2.0])
        apart = -APPROACH * NORMAL + (PASSING + RADII @ spin) * TANGENT
        share = self.mass[::-1] / self.mass.sum()
        self.simulation.state.v[:2, self.simulation.state.layout.slot] = np.outer(
            apart, [-share[0], share[1]]
        ) + np.array([[3e-3], [1e-3]])
        self.simulation.state.v[2, self.simulation.state.layout.slot] = spin
        self.turned = np.hypot(*apart) * IMPACT * self.simulation.time_step / RADII.sum()
        self.before = self.simulation.state.velocity.copy()
        ledger = Ledger(self.simulation, 1)
        self.simulation.track(ledger)
        momenta = [self._momenta()]
        for _ in range(STEPS):
            self.simulation.advance(1)
            momenta.append(self._momenta())
        self.momenta, self.books = np.array(momenta), ledger.entries
        self.after = self.simulation.state.velocity.copy()

    def _momenta(self) -> np.ndarray:
        x, y = POSITIONS.T + self.simulation.state.displacement[:2]
        p = self.simulation.state.velocity * np.stack([self.mass, self.mass, self.inertia])
        zero = np.zeros(2)
        return np.stack([[p[0], zero, zero], [p[1], zero, zero], [x * p[1], -y * p[0], p[2]]]).reshape(3, -1)

    @property
    def impulses(self) -> tuple[float, float, np.ndarray]:
        """Normal and tangential impulse (N·s) on the second disk, and angular impulses (2,) N·m·s on both."""
        change = self.after - self.before
        on_second = self.mass[1] * change[:2, 1]
        return NORMAL @ on_second, TANGENT @ on_second, self.inertia * change[2]


def surfaces(velocity: np.ndarray) -> tuple[float, float]:
    """Velocity (m/s) of the second disk's surface against the first one's, along the normal and along the tangent."""
    apart = velocity[:2, 1] - velocity[:2, 0]
    return NORMAL @ apart, TANGENT @ apart - RADII @ velocity[2]


def check_books(impact: Impact) -> None:
    """Momenta stay as they were, and what energy is missing friction has taken."""
    momenta = impact.momenta
    rounding = 4.0 * EPS * STEPS * np.abs(momenta[0]).sum(axis=1)  # a few ε each step, all to one side
    assert np.all(np.abs(momenta.sum(axis=2) - momenta[0].sum(axis=1)) < rounding)
    # a contact that closes or opens s of a step before or after the next books ½m*v_n²·s(1 − s)h² too little or too
    # much, of which ¼h² is the most. Turning normals cost their turn at the most
    met = 0.5 * impact.reduced * APPROACH**2
    errors = [abs(entry.error - impact.books[0].error) for entry in impact.books]
    assert max(errors) < met * (0.25 * H**2 + impact.turned)


def test_a_sliding_impact(lab):
    fric = 0.1
    impact = Impact(lab, fric, kratio=2.0, elastic_start=False)
    normal, tangential, turning = impact.impulses
    # what is along the turned normal and tangent is read along the first ones, and arms shrink by the overlap, which
    # is far less than the turn
    turn = 2.0 * impact.turned
    # restitution is off by h²/8 at the most, see test_normal_impact
    assert normal == pytest.approx(2.0 * impact.reduced * APPROACH, rel=H**2 / 8.0 + turn)
    assert tangential == pytest.approx(-fric * normal, abs=turn * normal)
    np.testing.assert_allclose(turning, -RADII * tangential, rtol=0.0, atol=turn * normal * RADII.max())

    # friction takes its force times the mean velocity with which the surfaces pass
    _, passing_after = surfaces(impact.after)
    assert passing_after == pytest.approx(PASSING - 6.0 * fric * APPROACH, abs=APPROACH * (H**2 / 8.0 + turn))
    taken = fric * normal * 0.5 * (PASSING + passing_after)
    assert impact.books[-1].friction == pytest.approx(taken, rel=turn)
    check_books(impact)


def test_a_sticking_impact(lab):
    impact = Impact(lab, fric=0.6, kratio=3.0, elastic_start=False)
    departing, passing_after = surfaces(impact.after)
    # both springs are at their zero at the start and make the same steps, so both directions share one restitution
    turn = impact.turned * PASSING
    assert departing == pytest.approx(APPROACH, abs=APPROACH * H**2 / 8.0 + turn)
    assert passing_after / PASSING == pytest.approx(-departing / APPROACH, abs=turn / APPROACH)
    # the last step before they part frees what the spring stores and takes what it does until they have: of both
    # together ½(m*/3)v_s²·s(1 − s)h², as for the normal spring, is booked on friction
    booked = 0.5 * impact.reduced / 3.0 * PASSING**2 * 0.25 * H**2
    assert abs(impact.books[-1].friction) < booked * (1.0 + H)
    check_books(impact)
