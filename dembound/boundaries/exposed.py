"""The particles of a side: those visible from outside along its normal."""

import numpy as np

from dembound.boundaries.sides import is_far, normal_axis

SAMPLES_PER_RADIUS = 100
"""Lines of sight per smallest radius: a disk that shows less than 1 % of it counts as hidden."""

DEPTH = 4.0
"""Largest distance of a side's disk from the outermost face, in largest radii.

It is large enough for every hole of a dense packing, and too small for lines of sight that pass a rough corner and
cross the whole scene.
"""

AT_ONCE = 1024
"""Disks whose lines of sight are computed together, some hundred each."""

LEVEL = 1e-6
"""Largest deviation of the centres of one row from a line, in smallest radii: rounding errors."""


def outer_row(positions: np.ndarray, radii: np.ndarray, side: str) -> np.ndarray:
    """Indices of the particles in the outermost row at `side`, sorted along it; parameters of `exposed`.

    If the disks of a side form one row, this is the whole side. `exposed` may also return disks at a corner: every
    second row of a hexagonal packing extends beyond the others.
    """
    axis = normal_axis(side)
    outward = _sign(side) * positions[:, axis]
    nodes = np.flatnonzero(outward > outward.max() - LEVEL * radii.min())
    return nodes[np.argsort(positions[nodes, 1 - axis], kind="stable")]


def exposed(positions: np.ndarray, radii: np.ndarray, side: str, period: float | None = None) -> np.ndarray:
    """Indices of the particles visible from outside `side`, sorted along it.

    A depth buffer over parallel lines of sight. positions (n, 2) and radii (n,) in m; side is left, right, bottom
    or top; period (m) is the scene's length along the side when it is periodic there, else None.
    """
    axis = normal_axis(side)
    outward, along = _sign(side) * positions[:, axis], positions[:, 1 - axis]
    front = outward + radii
    near = np.flatnonzero(front > front.max() - DEPTH * radii.max())
    near = near[np.argsort(-front[near], kind="stable")]
    spacing = radii.min() / SAMPLES_PER_RADIUS
    origin = np.min(along[near] - radii[near])
    count = int(np.ceil((np.max(along[near] + radii[near]) - origin) / spacing)) + 1
    if period is not None:
        count = int(np.ceil(period / spacing))
        spacing = period / count
    depth = np.full(count, -np.inf)
    owner = np.full(count, -1)
    for some in np.split(near, range(AT_ONCE, len(near), AT_ONCE)):
        ends = along[some] - radii[some], along[some] + radii[some]
        number, line = _lines_of_sight(*((end - origin) / spacing for end in ends))
        disk = some[number]
        reach = radii[disk] ** 2 - (origin + line * spacing - along[disk]) ** 2
        face = outward[disk] + np.sqrt(np.maximum(reach, 0.0))
        if period is not None:
            line %= count
        seen = np.flatnonzero(face > depth[line])
        disk, line, face = disk[seen], line[seen], face[seen]
        np.maximum.at(depth, line, face)
        foremost = np.flatnonzero(face == depth[line])[::-1]  # of equal ones the first in `near` is written last
        owner[line[foremost]] = disk[foremost]
    nodes = np.unique(owner[owner >= 0])
    return nodes[np.argsort(along[nodes], kind="stable")]


def _lines_of_sight(begin: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numbers (k,) of disks and of the lines of sight that meet them; ends (m,) of the disks in spacings of lines."""
    first, last = np.ceil(begin).astype(np.int64), np.floor(end).astype(np.int64)
    counts = last - first + 1
    before = np.cumsum(counts) - counts
    return np.repeat(np.arange(len(counts)), counts), np.arange(counts.sum()) + np.repeat(first - before, counts)


def _sign(side: str) -> float:
    """Direction of a side's outward normal along its axis."""
    return 1.0 if is_far(side) else -1.0
