"""Snapshots of the continuum round the disks for ParaView: cells between its nodes, moved by their displacement.

| name | unit | shape | contents |
|---|---|---|---|
| ``linVelVec`` | m/s | (m, 3) | velocity, z = 0 |
| ``speed`` | m/s | (m,) | length of ``linVelVec`` |
| ``displacement`` | m | (m, 3) | since the start of the run, z = 0 |
| ``stress`` | Pa | (m, 6) | XX, YY, ZZ, XY, YZ, XZ, tension positive, with Z 0 |
| ``absorbs`` | 1 | (m,) | 1 in the absorbing layer, where motion is no longer that of the ground |
| ``scattered`` | m | (m, 3) | beside a free-field column or under an oblique wave: displacement without theirs |
| ``scatteredVelocity`` | m/s | (m, 3) | velocity without theirs |
| ``total`` | 1 | (m,) | 1 where the other fields contain the motion of the ground, 0 below that of a column |
| ``peakVelocity`` | m/s | (m,) | largest speed in the whole run, in every file; if the case asks for it |

Nodes on the first side of a periodic continuum are repeated on the opposite side, which the last cells reach.

``linVelVec``, ``speed``, ``displacement``, ``stress`` and ``peakVelocity`` have the names of those of disks. Where
there is ``scattered``, ``stress`` and ``peakVelocity`` are those of the scattered motion.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dembound.disks.reports.mesh import tensors
from dembound.motion.state import Arrays
from dembound.results.vtk import in_space, shown

if TYPE_CHECKING:
    import meshio


def continuum_mesh(columns: Arrays, snapshot: Arrays) -> meshio.Mesh:
    """One snapshot as quadrilaterals with the point data of this module's table."""
    import meshio

    displacement, velocity = (snapshot[f"continuum/{name}"][:, :2] for name in ("displacement", "velocity"))
    data = {
        "linVelVec": in_space(velocity),
        "speed": np.hypot(*velocity.T),
        "displacement": in_space(displacement),
        "stress": tensors(snapshot["continuum/stress"]),
        "absorbs": columns["continuum/absorbs"],
    }
    if "continuum/total" in columns:
        data["scattered"], data["scatteredVelocity"] = (
            in_space(snapshot[f"continuum/scattered_{name}"][:, :2]) for name in ("displacement", "velocity")
        )
        data["total"] = columns["continuum/total"]
    if "continuum/peak_velocity" in columns:
        data["peakVelocity"] = columns["continuum/peak_velocity"]
    across = Across.of(columns)
    points = np.concatenate([columns["continuum/position"], across.place])
    node = np.concatenate([np.arange(len(displacement)), across.node])
    cells = np.concatenate([columns["continuum/cell"], across.cell]).astype(np.int32)
    shift = in_space(points + displacement[node])
    return meshio.Mesh(shift, [("quad", cells)], point_data=shown({name: each[node] for name, each in data.items()}))


class Across(NamedTuple):
    """Nodes and cells of a periodic continuum across its period.

    node : (k,) nodes that are repeated. place : (k, 2) m, their places one period on. cell : (c, 4) corners of the
    cells between the last nodes and the repeated ones, which are numbered after all nodes.
    """

    node: np.ndarray
    place: np.ndarray
    cell: np.ndarray

    @classmethod
    def of(cls, columns: Arrays) -> Across:
        """Points of a record's continuum that meet across a period; empty for one that is not periodic."""
        position, node = columns["continuum/position"], columns["continuum/node"].astype(np.int64)
        low, high = (columns["continuum/element"][:, None, None, end] for end in (slice(0, 2), slice(2, 4)))
        is_last = np.zeros((1, *node.shape[1:], 2), dtype=np.bool_)
        is_last[:, :, -1, 0] = is_last[:, -1, :, 1] = True
        place = position[node]
        wraps = is_last & (place < 0.5 * (low + high))  # the last line of points is the first one of the mesh
        place = np.where(wraps, high, place)
        of_node = wraps.any(axis=3)
        kept = np.column_stack([node[of_node], wraps[of_node]])
        chosen, first, number = np.unique(kept, axis=0, return_index=True, return_inverse=True)
        corner = node.copy()
        corner[of_node] = len(position) + number.ravel()
        cells = np.stack([corner[:, :-1, :-1], corner[:, :-1, 1:], corner[:, 1:, 1:], corner[:, 1:, :-1]], axis=3)
        cells = cells.reshape(-1, 4)
        return cls(chosen[:, 0], place[of_node][first], cells[(cells >= len(position)).any(axis=1)])
