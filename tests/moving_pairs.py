"""Pairs in motion, for tests of their forces and energies."""

from itertools import pairwise

import numpy as np
import pytest

from dembound.kernels.common import CHUNKS
from dembound.kernels.contacts import BONDED, LOST, REFERENCE, UPDATED, push_each
from dembound.kernels.single_pairs import push
from dembound.kernels.tables import Contacts
from dembound.laws.law import Limits

PARTICLES, PAIRS = 25, 60
STEP = 0.1
UNBREAKABLE = Limits(friction=0.5, tension=np.inf, cohesion=np.inf, tan_fa=0.0, geometry=UPDATED)
GEOMETRIES = pytest.mark.parametrize("geometry", [UPDATED, BONDED, REFERENCE])


def motion(steps: int, size: float = 0.3) -> list[tuple[np.ndarray, np.ndarray]]:
    """(u, v) (3, n) of a smooth random motion, v the mean velocity since the step before."""
    rng = np.random.default_rng(2)
    swing, rate, phase = rng.uniform(-size, size, (3, 3, PARTICLES))
    times = STEP * np.arange(steps + 1)
    path = [swing * np.sin(10.0 * rate * t + phase) - swing * np.sin(phase) for t in times]
    return [(after, (after - before) / STEP) for before, after in pairwise(path)]


def pushed(pairs: Contacts, limits: Limits, u: np.ndarray, v: np.ndarray, number: int = 0) -> np.ndarray:
    """Push once by the kernel; returns the energies taken by friction, cracks, and opening and closing."""
    lost = np.full((CHUNKS, LOST), np.nan)
    if limits.geometry == REFERENCE:  # which the loop has at rest only
        lost[:] = 0.0
        push_each(np.arange(len(pairs.first), dtype=np.uint32), u, v, STEP, number, pairs, limits, lost[0])
    else:
        push(u, v, STEP, number, pairs, limits, lost)
    return lost.sum(axis=0)[:3]


def two(x: float = 0.0, y: float = 0.0, turn: float = 0.0) -> np.ndarray:
    """Motion (3, 2) of a pair of which the second disk moves."""
    return np.array([[0.0, x], [0.0, y], [0.0, turn]])
