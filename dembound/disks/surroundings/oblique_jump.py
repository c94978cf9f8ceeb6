"""The jump between the waves at both sides of ground of two heights under a wave at an angle, in closed form.

Left and right of the slit of the continuum (kernels/jump.py) the undisturbed ground has the same incident wave, but
waves reflected by surfaces of unlike heights, which only run down. So D is their difference; in an absorbing layer
(continuum/layer.py) a wave with the vertical slowness p_y is filtered by exp(−|p_y| ∫ σ iω/(α + iω) dy), and the
traction of a wave with the motion m and the displacement g is −ġ C(m, p)·x̂.

The rotations of the nodes on the slit, which elements do not have, carry dD/dt: its x component that of the nodes left
of the slit, its y component that of their copies.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dembound.boundaries.support import Incident, SupportBuilder
from dembound.continuum.layer import Profile
from dembound.continuum.medium import ElasticPlaneWave, Medium
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.ground_waves import UnlikeWaves
from dembound.disks.surroundings.jump import depths_on_slit, weights_on_slit
from dembound.waves.wave import Wave

SAMPLES = 64
"""Samples of filtered velocities per period of the highest frequency of a wave; straight lines join them."""

MOST = 1e4
"""Largest frequency (Hz) that is sampled for, of waves that jump."""

SETTLED = 8.0
"""Time after a run, in 1/α, over which the spectrum of a filtered velocity goes on, so that its end is not met."""

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(24)
"""Of the integral over the depth of a layer."""


class Filtered:
    """ġ of a wave at depths of an absorbing layer.

    Parameters
    ----------
    wave : of the case. slowness : |p_y|, s/m. profile : of the layer. depths : (d,) over its thickness. until : s.
    """

    def __init__(self, wave: Wave, slowness: float, profile: Profile, depths: np.ndarray, until: float) -> None:
        from scipy.fft import next_fast_len

        step = 1.0 / (SAMPLES * min(wave.highest_frequency(), MOST))
        longest = until + SETTLED / float(profile.shift(np.zeros(1))[0])
        self._times = wave.begin() + step * np.arange(next_fast_len(int(np.ceil((longest - wave.begin()) / step)) + 1))
        spectrum = np.fft.rfft(wave.velocity(self._times))
        omega = 2j * np.pi * np.fft.rfftfreq(len(self._times), step)
        q = 0.5 * depths[:, None] * (1.0 + POINTS)
        share = 0.5 * depths[:, None] * WEIGHTS * profile.thickness * profile.damping(q)
        passed = np.einsum("dp,dpf->df", share, omega / (profile.shift(q)[:, :, None] + omega))
        self._values = np.fft.irfft(spectrum * np.exp(-slowness * passed), len(self._times))

    @property
    def count(self) -> int:
        """Number of depths."""
        return len(self._values)

    def at(self, times: np.ndarray) -> np.ndarray:
        """ġ (k, d) at times (k, d) s, of each depth."""
        each = zip(times.T, self._values, strict=True)
        return np.stack([np.interp(t, self._times, values, left=0.0) for t, values in each], axis=1)


class JumpSignals:
    """A sum of plane waves at the nodes of a slit, as signals: factors times ġ at their delays.

    Parameters
    ----------
    factors : (w, 2) of each wave, along x and y; shares : (n,) of each node. delays : (w, n) s. signals : of each wave;
    filtered : the same at the first nodes, in an absorbing layer, as many as it has depths; none without a layer.
    ahead : whether values are those half a step later, as of prescribed velocities.
    """

    def __init__(
        self,
        factors: np.ndarray,
        shares: np.ndarray,
        delays: np.ndarray,
        signals: Sequence[Incident],
        filtered: Sequence[Filtered],
        *,
        ahead: bool,
    ) -> None:
        self._factors, self._shares, self._delays = factors, shares, delays
        self._signals, self._filtered, self._ahead = signals, filtered, ahead

    @property
    def count(self) -> int:
        """Number of signals: two for each node, first all along x."""
        return 2 * self._delays.shape[1]

    def __call__(self, times: np.ndarray, half_step: float) -> np.ndarray:
        """Values (k, 2n) at times (k,) s of steps."""
        at = times[:, None] + half_step * self._ahead
        values = np.zeros((2, len(times), self._delays.shape[1]))
        for number, (factor, delays, signal) in enumerate(zip(self._factors, self._delays, self._signals, strict=True)):
            own = signal.velocity(at - delays)
            if self._filtered:
                late = self._filtered[number].at(at - delays[: self._inside])
                own[:, : self._inside] = late
            values += factor[:, None, None] * own
        return np.concatenate(list(values * self._shares), axis=1)

    @property
    def _inside(self) -> int:
        """Number of nodes in an absorbing layer."""
        return self._filtered[0].count if self._filtered else 0


def let_jump(outside: Surroundings, ground: UnlikeWaves, until: float, builder: SupportBuilder) -> None:
    """Add the jump between both sides of a slit, and its traction, until a time (s) to the support table."""
    body, mesh = outside.body, outside.body.mesh
    own, copies = mesh.doubled
    moving = np.flatnonzero(~mesh.held[own])
    places, weight = mesh.positions[own[moving]], weights_on_slit(body)[moving]
    profile, q = body.profile("bottom"), depths_on_slit(mesh)[moving]
    inside = q[q > 0.0]
    motions, tractions, delays, waves, filtered = [], [], [], [], []
    for sign, side in ((1.0, ground), (-1.0, ground.right)):
        for wave, signal in zip(side.waves[1:], side.signals[1:], strict=True):  # the incident one is in both
            motions.append(sign * np.array(wave.motion))
            tractions.append(sign * traction_across(ground.medium, wave))
            delays.append(wave.delays(places))
            waves.append(signal)
            if profile is not None:
                assert isinstance(signal, Wave)
                last = until - min(float(delays[-1].min()), 0.0)
                filtered.append(Filtered(signal, abs(wave.slowness[1]), profile, inside, last))
    of_motion, of_traction, late = np.array(motions), np.array(tractions), np.array(delays)
    rates = JumpSignals(of_motion, np.ones(len(moving)), late, waves, filtered, ahead=True)
    pulls = JumpSignals(of_traction, weight, late, waves, filtered, ahead=False)
    nodes = outside.first + own[moving]
    builder.side = ""
    builder.add_motion(np.concatenate([nodes, outside.first + copies[moving]]), 2, rates)
    builder.add_forces(np.tile(nodes, 2), np.repeat([0, 1], len(nodes)), pulls)


def traction_across(medium: Medium, wave: ElasticPlaneWave) -> np.ndarray:
    """−σ·x̂ (2,) of a plane wave per unit of ġ, Pa·s/m: with u = m g(t − p·x), ∂u_a/∂b = −m_a p_b ġ."""
    (mx, my), (px, py) = wave.motion, wave.slowness
    strain = np.array([mx * px, my * py, mx * py + my * px])
    xx, _, xy = medium.matrix @ strain
    return np.array([xx, xy])
