"""The jump between the waves at both sides of ground of two heights under a wave at an angle.

Left and right of the slit of the continuum (kernels/jump.py) the undisturbed ground has the same incident wave, but
waves reflected by surfaces of unlike heights, which only run down. At the top of the slit the jump D is their
difference in closed form. Below it D is the motion of the elements beside the slit under this motion of their top,
with the stretched derivatives of their absorbing layer and its end at rest (continuum/layer.py), and with the steps of
the run. All its parts have one slowness p along x, so that derivatives along x are −p ∂/∂t of it, and elements of one
dimension suffice: at each frequency, with nodes U_j, strains ε = (S ∂_y A_y − iωp A_x) L U and mass m,

    −(2/Δt sin ½ωΔt)² m U = −∫ (S ∂_y A_y − iωp A_x)ᴴ σ dy,

where S is the transform of the convolution in a layer, L that of u + τv. The traction on x = const is σ(D)·x̂.

The rotations of the nodes on the slit, which elements do not have, carry dD/dt: its x component that of the nodes left
of the slit, its y component that of their copies.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from dembound.boundaries.support import SupportBuilder
from dembound.continuum.medium import strain_of, vertical_slownesses
from dembound.continuum.part import GridBody
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.ground_waves import UnlikeWaves
from dembound.disks.surroundings.jump import depths_on_slit, elements_on_slit, weights_on_slit
from dembound.exact.transform import Histories
from dembound.waves.wave import Wave

PER_TURN = 24
"""Frequencies per turn of the phase of waves that run down the slit, at which its elements are solved.

Splines between them are exact to (2π/24)⁴/384 = 1e-5. Below the first one they are `CLOSER` to each other, as a layer
is soft for slow motion.
"""

CLOSER, LEAST = 2.0**0.125, 0.1
"""Ratio of such neighbouring frequencies, and the lowest one over the decay of signals in the window."""

FAINT = 1e-5
"""Amplitude over the largest one of a wave above whose last frequency with it nothing jumps."""


@dataclass(frozen=True, eq=False)
class SlitElements:
    """The elements beside a slit, n nodes from the bottom, whose motion has one slowness along x.

    Attributes
    ----------
    body : the continuum. slowness : p, s/m. time_step : Δt of the run, s.
    """

    body: GridBody
    slowness: float
    time_step: float

    def below(self, omega: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Motion (k, n, 2, 2) and nodal traction across x, N/m, of all nodes per unit of motion at their top.

        omega : (k,) rad/s, which may be complex.
        """
        mesh = self.body.mesh
        stiff, pull = self._matrices(omega)
        count = pull.shape[1] // 2
        mass = self.body.ground.only.density * weights_on_slit(self.body)
        stepped = (2.0 / self.time_step * np.sin(0.5 * omega * self.time_step)) ** 2
        stiff -= stepped[:, None, None] * np.diag(np.repeat(mass, 2))
        top = slice(2 * count - 2, 2 * count)
        free = np.repeat(~mesh.held[mesh.doubled[0]], 2)
        free[top] = False
        moved = np.zeros((len(omega), 2 * count, 2), dtype=complex)
        moved[:, top] = np.eye(2)
        moved[:, free] = np.linalg.solve(stiff[:, free][:, :, free], -stiff[:, free, top])
        shape = len(omega), count, 2, 2
        return moved.reshape(shape), (pull @ moved).reshape(shape)

    def _factors(self, omega: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of derivatives along y and x in the absorbing layer, and u + τv over u, (k, n) each at the nodes."""
        q, profile = depths_on_slit(self.body.mesh), self.body.profile("bottom")
        up, along, later = np.ones((3, len(omega), len(q)), dtype=complex)
        if profile is None:
            return up, along, later
        back = np.exp(-1j * omega * self.time_step)[:, None]  # a step earlier

        def stretched(part: float | np.ndarray) -> np.ndarray:
            gain, decay = (of(q, self.time_step, part) for of in (profile.gain, profile.decay))
            return np.asarray(1.0 + gain / (1.0 - decay * back))

        up = stretched(1.0)
        if profile.is_stretched_along:
            along = stretched(profile.part_along(q))
        return up, along, 1.0 + profile.delay(q, self.time_step) * (1.0 - back) / self.time_step

    def _matrices(self, omega: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Matrices (k, 2n, 2n) from nodal motion to nodal forces against it, and to nodal traction across x."""
        mesh, across, rising = self.body.mesh, strain_of(1.0, 0.0), strain_of(0.0, 1.0)
        of_x, of_y = across.T @ self.body.ground.only.matrix, rising.T @ self.body.ground.only.matrix
        up, along, later = self._factors(omega)
        aside = -1j * omega[:, None] * self.slowness * along  # ∂/∂x
        stiff, pull = np.zeros((2, *up.shape, 2, up.shape[1], 2), dtype=complex)
        for element in elements_on_slit(mesh):
            height, row = float(mesh.element_sizes[element, 1]), int(mesh.elements[element, 1])
            own = slice(mesh.order * row, mesh.order * (row + 1) + 1)
            weight, slope = 0.5 * self.body.thickness * height * mesh.rule.weights, 2.0 / height * mesh.rule.derivative
            s, x, late = up[:, own], aside[:, own], later[:, None, own]
            along_x, along_y = x[:, :, None] * np.eye(mesh.order + 1) * late, s[:, :, None] * slope * late
            x_stress, y_stress = (
                np.einsum("i,ab,kij->kiajb", weight, c @ across, along_x)
                + np.einsum("i,ab,kij->kiajb", weight, c @ rising, along_y)
                for c in (of_x, of_y)
            )
            pull[:, own, :, own] += x_stress
            stiff[:, own, :, own] += (
                np.einsum("ki,qi,kqajb->kiajb", s, slope, y_stress) - x[:, :, None, None, None] * x_stress
            )
        shape = len(omega), 2 * up.shape[1], 2 * up.shape[1]
        return stiff.reshape(shape), pull.reshape(shape)


class ObliqueJump:
    """D and its traction at the nodes of a slit in time.

    Parameters
    ----------
    outside : the continuum with the slit. ground : the motion at both sides. until : last time, s.
    """

    def __init__(self, outside: Surroundings, ground: UnlikeWaves, until: float) -> None:
        body = self._body = outside.body
        self.moving = np.flatnonzero(~body.mesh.held[body.mesh.doubled[0]])
        """(m,) nodes of the slit that move, from the bottom."""
        corner = body.mesh.positions[body.mesh.doubled[0][-1:]]
        reflected = [
            (sign * np.array(wave.motion), float(wave.delays(corner)[0]))
            for sign, side in ((1.0, ground), (-1.0, ground.right))
            for wave in side.waves[1:]  # the incident one is in both
        ]
        self._motions = np.array([motion for motion, _ in reflected])
        delays = np.array([delay for _, delay in reflected])
        self._first = float(delays.min())
        self._delays, self._slowness = delays - self._first, ground.waves[0].slowness[0]
        signal = ground.signals[0]
        assert isinstance(signal, Wave)
        self._histories = Histories(signal.velocity, signal.begin(), until - self._first)

    def at(self, of: Literal["rate", "pull"], times: np.ndarray, time_step: float) -> np.ndarray:
        """Rates dD/dt (k, 2m) m/s half a step after times (k,) s, or forces −T, N, at them; first all along x."""
        late = times - self._first
        self._histories.reach(late)
        samples = self._histories.kept((of, time_step), lambda: self._sampled(of, time_step))
        return self._histories.between(samples, late)

    def _sampled(self, of: Literal["rate", "pull"], time_step: float) -> np.ndarray:
        """Samples (s, 2m) of rates or forces."""
        from scipy.interpolate import CubicSpline

        window = self._histories.window
        size = np.abs(window.spectrum)
        last = int(np.flatnonzero(size >= FAINT * size.max()).max(initial=0)) + 1
        frequencies = window.frequencies[:last]
        frequencies = frequencies[frequencies.real < 0.5 / time_step]  # steps have no higher ones
        omega = 2.0 * np.pi * frequencies
        top = window.derived(0)[: len(omega), None] * np.exp(-1j * np.outer(omega, self._delays)) @ self._motions
        factors = -np.ones_like(omega) if of == "pull" else (np.exp(1j * omega * time_step) - 1.0) / time_step
        few = self._few(frequencies)
        column = SlitElements(self._body, self._slowness, time_step)
        slow = 1j * frequencies[0].imag
        solved = self._histories.kept(time_step, lambda: np.stack(column.below(2.0 * np.pi * (few + slow))))
        samples = []
        for node in self.moving:
            each = CubicSpline(few, solved[int(of == "pull")][:, node])(frequencies.real)
            samples += [window.sampled(factors * along) for along in np.einsum("kab,kb->ak", each, top)]
        return np.stack([*samples[::2], *samples[1::2]], axis=1)

    def _few(self, frequencies: np.ndarray) -> np.ndarray:
        """Real parts (k,) Hz of few frequencies that span those of a window."""
        mesh = self._body.mesh
        depth = float(np.ptp(mesh.positions[mesh.doubled[0], 1]))
        steepest = float(np.abs(vertical_slownesses(self._body.ground.only, self._slowness)).max())
        apart = 1.0 / (PER_TURN * depth * steepest)
        even = np.arange(8.0 * apart, float(frequencies[-1].real) + 9.0 * apart, apart)
        closer = np.log(even[0] / (LEAST * -float(frequencies[0].imag))) / np.log(CLOSER)
        return np.concatenate([[0.0], even[0] / CLOSER ** np.arange(np.ceil(closer), 0.0, -1.0), even])


@dataclass(frozen=True)
class JumpSignals:
    """Rates or forces of a jump as signals: two for each node, first all along x."""

    jump: ObliqueJump
    of: Literal["rate", "pull"]

    @property
    def count(self) -> int:
        """Number of signals."""
        return 2 * len(self.jump.moving)

    def __call__(self, times: np.ndarray, half_step: float) -> np.ndarray:
        """Values (k, count) at times (k,) s of steps, rates half a step later."""
        return self.jump.at(self.of, times, 2.0 * half_step)


def let_jump(outside: Surroundings, ground: UnlikeWaves, until: float, builder: SupportBuilder) -> None:
    """Add the jump between both sides of a slit, and its traction, until a time (s) to the support table."""
    jump = ObliqueJump(outside, ground, until)
    nodes, copies = (outside.first + each[jump.moving] for each in outside.body.mesh.doubled)
    builder.side = ""
    builder.add_motion(np.concatenate([nodes, copies]), 2, JumpSignals(jump, "rate"))
    builder.add_forces(np.tile(nodes, 2), np.repeat([0, 1], len(nodes)), JumpSignals(jump, "pull"))
