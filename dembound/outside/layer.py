"""The absorbing layer: a convolutional perfectly matched layer with a complex frequency shift (CFS-PML).

In a layer of thickness L a derivative along its normal is divided by s = κ + σ/(α + iω), at depth q = 0 … 1 of L with

    κ = 1,  σ = σ0 q²,  σ0 = 3 c_p ln(1/R0)/(2L),  α = α0 (1 − q),  α0 = 0.3 c_p/(2 L_inner)

(Roden & Gedney 2000, Microw. Opt. Technol. Lett. 27, 334–339; Komatitsch & Martin 2007, Geophysics 72, SM155–SM167). In
time ∂u becomes ∂u/κ + ψ with a convolution variable ψ ← Bψ + A∂u at every step,

    B = exp(−(σ/κ + α)Δt),  A = σ(B − 1)/(κ(σ + κα)).

With spectral elements motion in such a layer grows slowly. It decays if gradients are those of u + τv, with τ = kΔt q².
In periodic meshes, in which nothing absorbs along the period, waves of the length of the period still grow slowly.
There derivatives along the layer are stretched, too, with a part of σ (Meza-Fajardo & Papageorgiou 2008, Bull. Seism.
Soc. Am. 98, 1811–1836), which does not affect waves at normal incidence.

Layers across layered ground need this, too: a slow layer guides waves some of which run against their energy, and these
grow in a layer that stretches one axis only (Skelton, Adams & Craster 2007, Wave Motion 44, 573–592). A part of σ that
begins as q² returns less of the guided waves than a constant part. Both axes are stretched alike at all heights, so
that joints return nothing.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Absorption:
    """Settings of a layer.

    Attributes
    ----------
    reflection : R0, amplitude that a P wave keeps on its way through the layer and back at normal incidence, in the
        continuum. shift : α0 over c_p/(2 L_inner). delay : k in τ = kΔt q²; with 0 motion grows in long runs. along :
        the part of σ for derivatives along layers of periodic meshes. guided : that part over q², for layers across
        layered ground; with half of it noise may grow (slow between fast layers), with 0.1 it decays at ratios of
        speeds up to 10 with c_p/c_s up to 2.5, and up to 3.5 with c_p/c_s up to 5.
    """

    reflection: float = 1e-4
    shift: float = 0.3
    delay: float = 0.1
    along: float = 0.02
    guided: float = 0.1


USUAL = Absorption()
"""Settings with which waves of all angles up to 60° are absorbed, and noise decays."""

LONG_WAVES = 0.01
"""The shift for layers that waves only reach at normal incidence: long waves are reflected less, and a body settles
later.
"""


@dataclass(frozen=True)
class Profile:
    """The layer at one side.

    Attributes
    ----------
    thickness : L, m. speed : c_p along its normal, m/s. inner : L_inner, m, the larger side of what lies within all
    layers. settings : of the layer. guides : whether the ground across which it lies is layered.
    """

    thickness: float
    speed: float
    inner: float
    settings: Absorption = USUAL
    guides: bool = False

    @property
    def strongest(self) -> float:
        """σ0 (1/s), at the outer edge."""
        return -1.5 * self.speed * float(np.log(self.settings.reflection)) / self.thickness

    def damping(self, q: np.ndarray) -> np.ndarray:
        """σ (1/s) at depths q of the thickness, any shape."""
        return self.strongest * q**2

    def shift(self, q: np.ndarray) -> np.ndarray:
        """α (1/s) at depths q."""
        return self.settings.shift * 0.5 * self.speed / self.inner * (1.0 - q)

    def decay(self, q: np.ndarray, step: float, part: float | np.ndarray = 1.0) -> np.ndarray:
        """B at depths q for time steps of `step` (s), with a part of σ."""
        return np.exp(-(part * self.damping(q) + self.shift(q)) * step)

    def gain(self, q: np.ndarray, step: float, part: float | np.ndarray = 1.0) -> np.ndarray:
        """A at depths q for time steps of `step` (s), with a part of σ."""
        damping = part * self.damping(q)
        total = damping + self.shift(q)
        moved = np.expm1(-total * step)
        return np.divide(damping * moved, total, out=np.zeros_like(total), where=total > 0.0)

    def delay(self, q: np.ndarray, step: float) -> np.ndarray:
        """τ (s) at depths q for time steps of `step` (s)."""
        return self.settings.delay * step * q**2

    def expected_reflection(self, frequency: float, angle: float = 0.0, speed: float | None = None) -> float:
        """|R| ≤ R0^(cos θ·g·c_p/c) of a plane wave of a frequency (Hz) at θ (degrees) from the normal, in a continuum.

        speed : c of the wave, m/s; by default c_p. g = ∫σ ω²/(ω² + α²)/∫σ over the depth. Elements add some 0.1 % if
        there are eight nodes to a wavelength.
        """
        x, weights = np.polynomial.legendre.leggauss(40)
        q, omega = 0.5 * (1.0 + x), 2.0 * np.pi * frequency
        passed = omega**2 / (omega**2 + self.shift(q) ** 2)
        share = float(np.sum(weights * self.damping(q) * passed) / np.sum(weights * self.damping(q)))
        slower = 1.0 if speed is None else self.speed / speed
        return float(self.settings.reflection ** (np.cos(np.radians(angle)) * share * slower))
