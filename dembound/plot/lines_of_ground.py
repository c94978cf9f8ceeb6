"""Lines of the ground in a record: layers of each side, joints, groups, later holes, and the foot of its columns."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import h5py
import numpy as np

from dembound.casefile.reader import parsed
from dembound.errors import CaseError
from dembound.plot.disks import GROUP, is_scattered
from dembound.plot.outlines import read_holes
from dembound.results.reader import text_of

POINTS = 257
"""Points at which the outline of a hole is drawn: every corner of up to eight even sides."""

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


def areas_in(file: h5py.File) -> dict[str, np.ndarray]:
    """Corners (k, 2) m of the groups, and points on the holes made during the run, by name; none without a case."""
    areas = dict[str, np.ndarray]()
    try:
        for group in parsed(text_of(file.attrs.get("case", ""))).get("group", []):
            if "region" in group:
                x0, y0, x1, y1 = group["region"]
                group["points"] = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
            areas[str(group["name"])] = np.array(group["points"], dtype=float).reshape(-1, 2)
    except (CaseError, KeyError, TypeError, ValueError):
        return {}
    for hole in read_holes(file):
        if hole.stage == "run" and hole.outline is not None:
            areas[hole.name] = hole.outline.at(np.linspace(0.0, hole.outline.period, POINTS))
    return areas


def gone_at(file: h5py.File) -> np.ndarray | None:
    """Time (n,) s at which each disk of a record vanishes, infinite for most; None if none does."""
    holes = [hole for hole in read_holes(file) if hole.stage == "run"]
    if not holes:
        return None
    positions = file["particles/position"][:]
    time, span = np.full(len(positions), np.inf), float(np.ptp(positions, axis=0).max())
    for hole in holes:
        time[hole.takes(positions, span)] = hole.time
    time[: int(file.attrs.get("column", 0))] = np.inf
    return time


def foot_in(file: h5py.File) -> float | None:
    """Height (m) below which motion of the continuum is without the free field: what the body adds; None if none is."""
    if GROUP not in file or not is_scattered(file):
        return None
    lacking = ~file[f"{GROUP}/total"][:].astype(bool)
    return float(file[f"{GROUP}/position"][:][lacking, 1].max()) if lacking.any() else None
