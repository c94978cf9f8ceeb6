"""Snapshots of the continuum round the disks for ParaView: cells between its nodes, moved by their displacement.

| name | unit | shape | what |
|---|---|---|---|
| ``linVelVec`` | m/s | (m, 3) | velocity, z = 0 |
| ``speed`` | m/s | (m,) | its length |
| ``displacement`` | m | (m, 3) | since the start of the run, z = 0 |
| ``stress`` | Pa | (m, 6) | XX, YY, ZZ, XY, YZ, XZ, tension positive, with Z 0 |
| ``absorbs`` | 1 | (m,) | 1 in the layer that absorbs, where motion is no longer that of the ground |
| ``scattered`` | m | (m, 3) | beside a free-field column: displacement without that of the column |
| ``scatteredVelocity`` | m/s | (m, 3) | the same of velocity |
| ``total`` | 1 | (m,) | 1 where the other fields contain the column's motion, 0 below the ground it stands for |
| ``peakVelocity`` | m/s | (m,) | largest speed in the whole run, in every file; if the case asks for it |

``linVelVec``, ``speed``, ``displacement``, ``stress`` and ``peakVelocity`` have the names of those of disks. Beside a
free-field column ``stress`` and ``peakVelocity`` are those of the scattered motion.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dembound.disks.mesh import tensors
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
    points = in_space(columns["continuum/position"] + displacement)
    return meshio.Mesh(points, [("quad", columns["continuum/cell"].astype(np.int32))], point_data=shown(data))
