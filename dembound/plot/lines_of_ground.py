"""Lines of the ground in a record: layers of each side, joints, and the foot of its columns."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import h5py
import numpy as np

from dembound.plot.disks import GROUP, is_scattered
from dembound.results.reader import text_of

OPEN = 3
"""State of a segment of a joint whose faces are apart, see `JointTie.segments`."""


class LayersOfSide(NamedTuple):
    """Layers from the surface down: their names, the heights of their joints, and from which x to which they are, m."""

    names: tuple[str, ...]
    joints: tuple[float, ...]
    low: float = -math.inf
    high: float = math.inf


def layers_in(file: h5py.File) -> Iterator[LayersOfSide]:
    """The layers of the ground in an open record, see `Disks`."""
    names = tuple(map(text_of, file.attrs.get("layer_names", ())))
    if "meet" not in file.attrs:
        if names:
            yield LayersOfSide(names, tuple(map(float, file.attrs["joints"])))
        return
    meet = float(file.attrs["meet"])
    for side, low, high in (("left", -math.inf, meet), ("right", meet, math.inf)):
        own = tuple(names[int(number) - 1] for number in file.attrs[f"{side}_layers"])
        yield LayersOfSide(own, tuple(map(float, file.attrs[f"{side}_joints"])), low, high)


class Segments(NamedTuple):
    """Parts of joints that lie opposite each other: ends (s, 2, 2) m, slip (s,) m, and whether they are open (s,)."""

    ends: np.ndarray
    slip: np.ndarray
    is_open: np.ndarray


def segments_in(snapshot: h5py.Group, exaggerate: float = 0.0) -> Segments | None:
    """The segments of joints in a snapshot of an open record, moved by exaggerated displacements; None without any."""
    if "joints" not in snapshot:
        return None
    joints = {name: dataset[:] for name, dataset in snapshot["joints"].items()}
    moved = exaggerate * snapshot["displacement"][:][joints["particles"][:, 0], None, :2]
    return Segments(joints["ends"].reshape(-1, 2, 2) + moved, joints["slip"], joints["state"] == OPEN)


def foot_in(file: h5py.File) -> float | None:
    """Height (m) below which motion of the continuum is without the free field: what the body adds; None if none is."""
    if GROUP not in file or not is_scattered(file):
        return None
    lacking = ~file[f"{GROUP}/total"][:].astype(bool)
    return float(file[f"{GROUP}/position"][:][lacking, 1].max()) if lacking.any() else None
