"""P and SV waves at an angle in a stack of layers on a half-space, after Thomson, Haskell and Kennett.

With e^{+iωt} and one horizontal slowness p below all critical ones, the motion of a layer is that of four plane waves

    u = Σ m_j a_j e^{−iω(p x + s_j (y − y_j))},  two that run up and two that run down, with real slownesses s_j;

y_j is the layer's lower end for the former, its upper end for the latter. On planes y = const their tractions are
−iω Σ t_j a_j. At the free surface, maybe with a mass, the falling waves follow from the rising ones; displacement and
traction are continuous at an interface, which from above down gives the falling waves at the top of each layer, R a,
and from below up the rising ones. All factors are of waves on their way, so that nothing overflows.

(Haskell, The dispersion of surface waves on multilayered media, BSSA 43, 1953; Kennett, Seismic Wave Propagation in
Stratified Media, 1983, chapter 6.)
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from dembound.exact.transform import Histories

FINER = 4
"""Fine samples in a sample of the incident wave."""


@dataclass(frozen=True)
class Bed:
    """A layer with its plane waves of one horizontal slowness: two that run up, then two that run down.

    Attributes
    ----------
    thickness : m; of the half-space unused. slowness : (4,) s/m along y. motion : (2, 4) along x and y. traction : (2,
    4) Pa·s/m along x and y on planes facing up, per unit of −ġ.
    """

    thickness: float
    slowness: np.ndarray
    motion: np.ndarray
    traction: np.ndarray

    def late(self, frequencies: np.ndarray) -> np.ndarray:
        """Factors (k, 4) of waves on their way through the layer, at frequencies (k,) Hz."""
        return np.asarray(np.exp(-2j * math.pi * np.outer(frequencies, self.thickness * np.abs(self.slowness))))


def amplitudes(
    beds: Sequence[Bed], incident: np.ndarray, frequencies: np.ndarray, mass: float | None = 0.0
) -> list[np.ndarray]:
    """Amplitudes (k, 4) of the waves of each layer from the surface down, at frequencies (k,) Hz, which may be complex.

    Those that run up are at the lower end of the layer, in the half-space at its top, those that run down at the upper.

    incident : (2,) amplitudes of the incident waves at the top of the half-space. mass : on the free surface, kg/m²;
    None: the uppermost layer goes on above, and nothing comes back from there.
    """
    returned, gained = [np.zeros((len(frequencies), 2, 2), dtype=complex)], []
    if mass is not None:  # Σ t a = iω m Σ m a on the surface
        balance = beds[0].traction - 2j * math.pi * mass * frequencies[:, None, None] * beds[0].motion
        returned = [-np.linalg.solve(balance[:, :, 2:], balance[:, :, :2])]
    stiff = max(np.abs(bed.traction).max() for bed in beds)
    fields = [np.concatenate([bed.motion, bed.traction / stiff]) for bed in beds]
    for bed, above, below in zip(beds[:-1], fields[:-1], fields[1:], strict=True):
        late = bed.late(frequencies)
        back = late[:, 2:, None] * returned[-1] * late[:, None, :2]
        leaving = np.broadcast_to(-below[:, 2:], (len(frequencies), 4, 2))
        both = np.linalg.solve(np.concatenate([above[:, :2] + above[:, 2:] @ back, leaving], axis=2), below[:, :2])
        gained.append(both[:, :2])
        returned.append(both[:, 2:])
    rising = [np.broadcast_to(incident.astype(complex), (len(frequencies), 2))]
    tops = rising[:]  # of the rising waves
    for bed, gain in zip(beds[-2::-1], gained[::-1], strict=True):
        rising.insert(0, np.einsum("kij,kj->ki", gain, tops[0]))
        tops.insert(0, rising[0] * bed.late(frequencies)[:, :2])
    falling = [np.einsum("kij,kj->ki", back, top) for back, top in zip(returned, tops, strict=True)]
    return [np.concatenate(each, axis=1) for each in zip(rising, falling, strict=True)]


class ObliqueMotion:
    """The motion of layers in time under an incident wave.

    Parameters
    ----------
    beds, incident, mass : as of `amplitudes`. velocity : m/s of the incident wave at times in s, at the top of the
    half-space. begin : time (s) before which it is zero. until : last time (s); later ones double the window.
    """

    def __init__(
        self,
        beds: Sequence[Bed],
        incident: np.ndarray,
        mass: float | None,
        velocity: Callable[[np.ndarray], np.ndarray],
        begin: float,
        until: float,
    ) -> None:
        self.ends = [0.0]
        """Times (s) from the incident wave at the top of the half-space to the first motion of the planes above it,
        ascending: from the surface down those of the upper ends of all layers."""
        for bed in beds[-2::-1]:
            self.ends.insert(0, self.ends[0] + bed.thickness * float(bed.slowness[:2].min()))
        self._beds, self._incident, self._mass = beds, incident, mass
        self._histories = Histories(velocity, begin, until)

    def largest(self, layer: int) -> np.ndarray:
        """Largest amplitudes (4,) of the waves of a layer."""
        return np.asarray(np.abs(self._amplitudes()[layer]).max(axis=0))

    def at(self, of: Literal["displacement", "velocity"], layer: int, wave: int, times: np.ndarray) -> np.ndarray:
        """The history of a wave at times (any shape) s after the first motion of the plane at which it begins.

        That is the lower end of the layer for waves that run up, and the upper one for others.
        """
        self._histories.reach(times)
        derivatives = int(of == "velocity")
        samples, slopes = (self._samples(layer, wave, number) for number in (derivatives, derivatives + 1))
        return self._histories.by_slopes(samples, slopes, FINER, times)

    def _samples(self, layer: int, wave: int, derivatives: int) -> np.ndarray:
        """Fine samples (n,) of a derivative in time of a history."""
        window, plane = self._histories.window, min(layer + (wave < 2), len(self.ends) - 1)

        def find() -> np.ndarray:
            early = np.exp(2j * math.pi * self.ends[plane] * window.frequencies)
            return window.sampled(window.derived(derivatives) * early * self._amplitudes()[layer][:, wave], FINER)

        return self._histories.kept((layer, wave, derivatives), find)

    def _amplitudes(self) -> np.ndarray:
        """The amplitudes (l, k, 4) of all layers in the window."""
        known = self._beds, self._incident, self._histories.window.frequencies, self._mass
        return self._histories.kept("amplitudes", lambda: np.array(amplitudes(*known)))


@dataclass(frozen=True)
class History:
    """The history of one plane wave in layers: displacement and velocity at times in s, see `ObliqueMotion.at`."""

    of: ObliqueMotion
    layer: int
    wave: int

    def displacement(self, t: np.ndarray) -> np.ndarray:
        """Metres at times t, s; same shape as t."""
        return self.of.at("displacement", self.layer, self.wave, t)

    def velocity(self, t: np.ndarray) -> np.ndarray:
        """Velocity, m/s, at times t, s; same shape as t."""
        return self.of.at("velocity", self.layer, self.wave, t)
