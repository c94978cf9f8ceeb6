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

So do layers in strongly anisotropic ground. With σ across and pσ along a layer, motion e^(λt) of wave numbers k_x, k_y
obeys det(Γ(k_x/(λ + σ), k_y/(λ + pσ)) + ρ) = 0. If it is short, λ is small beside ck, and the ratio t of both arguments
that of static fields, det Γ(1, t) = 0 (Stroh 1958, Phil. Mag. 3, 625–646): with w = (λ + pσ)/(λ + σ) = k_y/(k_x t),
λ = σ(w − p)/(1 − w). The length of w is free, its argument that of ±t: φ from the real axis. So none grows if
cos φ ≤ 2√p/(1 + p), or p ≥ tan²(45° − φ/2). Computed λ of all wave numbers grow with 0.9 of it and decay with 1.1 of
it, also where group velocities run against slownesses, which needs less (Bécache, Fauqueux & Joly 2003, J. Comput.
Phys. 188, 399–433). It is the same for layers across x and across y. Isotropic media have t = ±i and p = 0; the square
lattice, c11 = c22 and c12 = 0, has cos²φ = ½ − c11/(4 c66) where that is positive, and p < 0.1716.
"""

from dataclasses import dataclass

import numpy as np

from dembound.continuum.medium import Medium, vertical_slownesses


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


QUIET, MORE = 0.08, 1.3
"""p (`along_needed`) of media up to which layers need not be stretched along, and the part over q of σ along layers in
others, over p.

Noise on the square lattice: not stretched it decays for 40,000 steps with 16 elements up to p = 0.089, and for 100,000
with 8 up to 0.107; it grows with 16 at 0.107, with 8 at 0.127, and with 4 at 0.138. Stretched it decays up to 0.160
(k_n/k_s = 0.05). There a part over q² of 1.3 p would not suffice, and a constant one would return twice as much.
"""

RETURNED = 0.03
"""Motion that layers stretched along return: 1.1 to 3.4 % of all motion after a blow in pieces of square lattices with
p = 0.11 to 0.16, 80 m × 60 m with three to eight elements of 10 m; usual layers 0.1 to 0.5 %.
"""


def along_needed(medium: Medium) -> float:
    """The part p of σ along layers with which nothing grows in a medium whose σ across them is uniform, 0 … 1."""
    root = vertical_slownesses(medium, 1.0, inertia=0.0)
    angle = np.arccos(min(float((np.abs(root.real) / np.abs(root)).max()), 1.0))
    return float(np.tan(0.25 * np.pi - 0.5 * angle) ** 2)


def along_in(medium: Medium) -> float:
    """The part over q of σ along layers in a medium; 0 where it needs none."""
    needed = along_needed(medium)
    return MORE * needed if needed > QUIET else 0.0


@dataclass(frozen=True)
class Profile:
    """The layer at one side.

    Attributes
    ----------
    thickness : L, m. speed : c_p along its normal, m/s. inner : L_inner, m, the larger side of what lies within all
    layers. settings : of the layer. guides : whether the ground across which it lies is layered. along : part of σ over
    q, for derivatives along it, that its media need, see `along_in`.
    """

    thickness: float
    speed: float
    inner: float
    settings: Absorption = USUAL
    guides: bool = False
    along: float = 0.0

    @property
    def strongest(self) -> float:
        """σ0 (1/s), at the outer edge."""
        return -1.5 * self.speed * float(np.log(self.settings.reflection)) / self.thickness

    def damping(self, q: np.ndarray) -> np.ndarray:
        """σ (1/s) at depths q of the thickness, any shape."""
        return self.strongest * q**2

    @property
    def is_stretched_along(self) -> bool:
        """Whether derivatives along it are stretched, too, whatever the mesh."""
        return self.guides or self.along > 0.0

    def part_along(self, q: np.ndarray) -> np.ndarray:
        """The part of σ for derivatives along it at depths q."""
        return np.maximum(self.settings.guided * self.guides * q**2, self.along * q)

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
