"""The forces of an endless packing under a stress at which contacts slide or open, beside bonds that hold.

Contacts are loaded at once, from no force: each bears k_n of its compression and none of a gap, and k_s of its shear up
to friction; what it would bear more has slid. Bonds bear their stretch, shear and rotation. Newton's method finds the
mean strain and the motions of the brick's disks at which all disks are in balance under the mean stress.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dembound.disks.material.homogenise import Network, free_columns

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix

ENOUGH = 1e-11
"""Force out of balance over the largest one at which the iteration ends."""

ROUNDS = 40
"""Rounds after which no balance is found; with bonds some six are enough."""

WITHIN = 1e-9
"""Part of a force or strain that is rounding where contacts are at their friction."""


def within_friction(contacts: np.ndarray, bonds: np.ndarray, friction: float, forces: np.ndarray) -> bool:
    """Whether contacts neither slide nor open under elastic forces (3, b) of contacts and bonds together.

    contacts, bonds : (3, b) stiffnesses, see `Law.stiffnesses`.
    """
    stretch, sheared, _ = strains_of(forces, contacts + bonds)
    push, shear, least = -contacts[0] * stretch, contacts[1] * sheared, WITHIN * np.abs(forces[:2]).max(initial=0.0)
    return bool((push >= -least).all() and (np.abs(shear) <= friction * push + least).all())


def strains_with_slip(forces: np.ndarray, contacts: np.ndarray, bonds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Strains (3, b) of contacts and bonds under forces (4, b), see `sliding_forces`, and the slip (b,) m of contacts.

    contacts, bonds : (3, b) stiffnesses.
    """
    strains = strains_of(forces[:3], bonds + np.where(forces[0] < 0.0, contacts, 0.0))
    elastic = strains_of(forces[3], contacts[1])
    strains[1] = np.where(bonds[1] > 0.0, strains_of(forces[1] - forces[3], bonds[1]), elastic)
    slides = (contacts[1] > 0.0) & (np.abs(strains[1] - elastic) > WITHIN * np.abs(strains[1]))
    return strains, np.where(slides, strains[1] - elastic, 0.0)


def sliding_forces(
    network: Network,
    contacts: np.ndarray,
    bonds: np.ndarray,
    friction: float,
    stress: np.ndarray,
    held: tuple[int, ...],
    area: float,
) -> np.ndarray | None:
    """Normal, shear and bending forces of contacts and bonds together, and shear forces of contacts, (4, b).

    contacts, bonds : (3, b) stiffnesses, see `Law.stiffnesses`. stress : (3,) xx, yy, xy in Pa, tension positive. held
    : components that do not move. area : m², of the network's period. None if no balance is found, as where friction
    alone cannot bear the stress.
    """
    from scipy.sparse import coo_matrix, csc_matrix, diags, hstack
    from scipy.sparse.linalg import splu

    if not stress.any():
        return np.zeros((4, contacts.shape[1]))
    normal, number = contacts[0], np.arange(contacts.shape[1])
    gradients = network.gradient_matrix() @ [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5], [0.0, 0.0, 0.5]]
    ways = hstack([csc_matrix(gradients), network.motion_matrix()[:, free_columns(network.disks, held)]]).tocsc()
    applied = np.zeros(ways.shape[1])
    applied[:3] = area * stress
    slope: csc_matrix = diags((contacts + bonds).ravel(), format="csc")
    motion, lacking = np.zeros_like(applied), applied
    for _ in range(ROUNDS):
        try:
            motion += splu((ways.T @ slope @ ways).tocsc()).solve(lacking)
        except RuntimeError:  # raised by SuperLU for a singular matrix
            return None
        strain = (ways @ motion).reshape(3, -1)
        push = normal * np.maximum(-strain[0], 0.0)
        stuck = contacts[1] * strain[1]
        slides = np.abs(stuck) > friction * push
        shear = np.where(slides, np.copysign(friction * push, stuck), stuck)
        forces = bonds * strain
        forces[0] -= push
        forces[1] += shear
        lacking = applied - ways.T @ forces.ravel()
        whole, single = np.abs(lacking[:3]).max(), np.abs(lacking[3:]).max(initial=0.0)
        off = whole / np.abs(applied).max(), single / np.abs(forces).max()
        if not np.isfinite(off).all():
            return None
        if max(off) <= ENOUGH:
            return np.vstack([forces, shear])
        kept = bonds.copy()
        kept[0] += np.where(strain[0] < 0.0, normal, 0.0)
        kept[1] += np.where(slides, 0.0, contacts[1])
        drawn = np.where(slides & (strain[0] < 0.0), -np.copysign(friction * normal, stuck), 0.0)
        crossed = coo_matrix((drawn, (len(number) + number, number)), shape=slope.shape)
        slope = (diags(kept.ravel()) + crossed).tocsc()
    return None


def strains_of(forces: np.ndarray, springs: np.ndarray) -> np.ndarray:
    """Strains of springs under forces of the same shape; 0 without a spring."""
    return np.divide(forces, springs, out=np.zeros_like(forces), where=springs > 0.0)
