"""Stress and strain at the sides of a record, from the histories of their forces and displacements."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dembound.errors import CaseError
from dembound.results.reader import finite, is_line, open_record, require_run

OPPOSITE = {"left": "right", "right": "left", "bottom": "top", "top": "bottom"}


@dataclass(frozen=True)
class SideHistory:
    """The motion of one side as a whole, and the stress on it.

    Attributes
    ----------
    time : (k,) s.
    displacement : (k, 2) m, mean of its particles along x and y since the start.
    stress : (k, 2) Pa, along the normal, tension positive, and shear stress xy.
    strain : (k,) change of the distance to the opposite side over the distance, extension positive; None if there is no
    such side.
    """

    time: np.ndarray
    displacement: np.ndarray
    stress: np.ndarray
    strain: np.ndarray | None


def read_side_history(path: Path, side: str) -> SideHistory:
    """The history of a side of a run; raises CaseError if the file has none, RecordError as `finite`."""
    with open_record(path) as file:
        require_run(file)
        there = {name: group for name, group in file.get("boundaries", {}).items() if "force" in group}
        if side not in there:
            raise CaseError([f"{path}: has no history of side {side}, sides there: {', '.join(there) or 'none'}"])
        group, axis = there[side], 0 if side in ("left", "right") else 1
        area = group["diameter"][0] if is_line(file.attrs["size"]) else group.attrs["body_length"]
        outward = 1.0 if side in ("right", "top") else -1.0
        traction = outward * finite(group["force"]) / area
        displacement, strain = finite(group["displacement"])[:, :2], None
        if (other := there.get(OPPOSITE[side])) is not None:
            column = file.attrs.get("column", 0)
            means = [each["position"][:][each["particle"][:] >= column, axis].mean() for each in (group, other)]
            strain = (displacement[:, axis] - finite(other["displacement"])[:, axis]) / (means[0] - means[1])
        stress = np.stack([traction[:, axis], traction[:, 1 - axis]], axis=1)
        return SideHistory(finite(group["time"]), displacement, stress, strain)
