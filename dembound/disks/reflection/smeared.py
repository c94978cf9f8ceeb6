"""A first answer within milliseconds: the equivalent continuum with the supports of a side smeared along it.

Waves p e^{iω(t − s·x)} of the continuum with the slowness s_t along the side have along its outward normal n the
slownesses σ with (σ²Q + σ(R + Rᵀ) + T − ρ)p = 0, where Q_ac = n_b C_abcd n_d, R_ac = n_b C_abcd s_t t_d and T the same
with s_t² t t (Christoffel's equation). Of the four, two carry energy inwards or die out inwards. Their amplitudes a are
those with which the tractions −iω Σ a (σQ + R)p are −(iωc + k) Σ a p, with dashpots c and springs k per length of the
side. This neglects the disks: whole masses at the side, dispersion and scattering.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dembound.boundaries import normal_axis
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.reflection.bricks import is_outwards
from dembound.disks.reflection.meter import Kind, Reflections, contracted, homogenised_wave
from dembound.disks.scene import DiskScene

RUNS = 1e-9
"""Imaginary part of σ over its size below which a wave runs."""


class Smeared(NamedTuple):
    """Smeared supports of a side, for components along x and y.

    damping, stiffness : (2,) N·s/m and N/m per m of the side; held : (2,) whether the component is at rest.
    """

    damping: np.ndarray
    stiffness: np.ndarray
    held: np.ndarray

    @classmethod
    def of(cls, scene: DiskScene, side: str) -> Smeared:
        """The smeared supports of a scene in which only one side has any."""
        length, table = float(scene.assembly.size[1 - normal_axis(side)]), scene.supports
        each, by_axis = (table.damping, table.stiffness, table.prescribed), [table.component == axis for axis in (0, 1)]
        damping, stiffness, held = (np.array([np.sum(values[own]) for own in by_axis]) for values in each)
        return cls(damping / length, stiffness / length, held > 0)


def by_smeared_supports(
    scene: DiskScene, side: str, frequencies: Sequence[float] | np.ndarray, angles: Sequence[float]
) -> Reflections:
    """Reflections by a side of a scene at its end, see `bricks.end_scene`, at frequencies (Hz) and angles (degrees).

    Types that cannot move are left out, and so are angles but 0 where a component of motion is held.
    """
    ground, smeared, axis = scene.ground, Smeared.of(scene, side), normal_axis(side)
    if set(ground.held) & {0, 1}:
        angles = [angle for angle in angles if angle == 0.0]
    shape = 2, len(frequencies), len(angles)
    shares: dict[Kind, np.ndarray] = {}
    for kind in ("p", "s"):
        found = np.full(shape, np.nan)
        for a, angle in enumerate(angles):
            direction = np.empty(2)
            direction[axis] = is_outwards(side) * math.cos(math.radians(angle))
            direction[1 - axis] = math.sin(math.radians(angle))
            if (wave := homogenised_wave(ground, kind, direction)) is None:
                break
            for f, frequency in enumerate(frequencies):
                found[:, f, a] = _sent_back(ground, side, smeared, kind, wave.slowness, 2.0 * math.pi * frequency)
        else:
            shares[kind] = found
    every = np.array(angles), np.array(frequencies)
    return Reflections(side, *every, *({kind: found[part] for kind, found in shares.items()} for part in (0, 1)))


def _sent_back(
    ground: PackedMaterial, side: str, smeared: Smeared, kind: Kind, slowness: np.ndarray, omega: float
) -> tuple[float, float]:
    """Energies reflected as the same and as the other type."""
    axis = normal_axis(side)
    free = np.array([component for component in (0, 1) if component not in ground.held])
    normal, along = np.zeros((2, 2))
    normal[axis], along[1 - axis] = is_outwards(side), slowness[1 - axis]
    pairs = (normal, normal), (normal, along), (along, along)
    q, r, t = (contracted(ground, *pair)[np.ix_(free, free)] for pair in pairs)
    n, one = len(free), np.eye(len(free))
    falls = -np.linalg.solve(q, np.hstack([t - ground.density * one, r + r.T]))
    companion = np.block([[np.zeros((n, n)), one], [falls]])
    roots, shapes = np.linalg.eig(companion.astype(complex))
    shapes = shapes[:n] / np.linalg.norm(shapes[:n], axis=0)
    tractions = np.einsum("ac,cj->aj", q, shapes) * roots + r @ shapes  # times −iω
    flow = np.where(np.abs(roots.imag) < RUNS * np.abs(roots), np.sum(shapes.conj() * tractions, axis=0).real, 0.0)
    straight = np.abs(along[free] @ shapes + roots * (normal[free] @ shapes))
    straight /= np.sqrt(np.abs(roots) ** 2 + along @ along)
    is_p = straight > math.sqrt(0.5)

    out = np.flatnonzero((flow > 0.0) & (is_p == (kind == "p")))[0]
    back = np.flatnonzero((flow < 0.0) | ((flow == 0.0) & (roots.imag > 0.0)))
    held, resists = smeared.held[free], (smeared.damping - 1j * smeared.stiffness / omega)[free]
    condition = np.where(held[:, None], shapes, resists[:, None] * shapes - tractions)
    amplitude = np.linalg.solve(condition[:, back], -condition[:, out])
    energy = np.abs(amplitude) ** 2 * -flow[back] / flow[out]
    same = is_p[back] == is_p[out]
    return float(energy[same].sum()), float(energy[~same].sum())
