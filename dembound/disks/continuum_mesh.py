"""Snapshots of the continuum round the disks for ParaView: cells between its nodes, moved by their displacement.

| name | unit | shape | what |
|---|---|---|---|
| ``linVelVec`` | m/s | (m, 3) | velocity, z = 0 |
| ``speed`` | m/s | (m,) | its length |
| ``displacement`` | m | (m, 3) | since the start of the run, z = 0 |
| ``stress`` | Pa | (m, 6) | XX, YY, ZZ, XY, YZ, XZ, tension positive, with Z 0 |
| ``absorbs`` | 1 | (m,) | 1 in the layer that absorbs, where motion is no longer that of the ground |
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dembound.motion.state import Arrays
from dembound.results.vtk import in_space, shown

if TYPE_CHECKING:
    import meshio


def continuum_mesh(columns: Arrays, snapshot: Arrays) -> meshio.Mesh:
    """One snapshot as quadrilaterals with the point data of this module's table."""
    import meshio

    displacement, velocity = (snapshot[f"continuum/{name}"][:, :2] for name in ("displacement", "velocity"))
    plane = snapshot["continuum/stress"]
    stress = np.zeros((len(plane), 6))
    stress[:, [0, 1, 3]] = plane
    data = {
        "linVelVec": in_space(velocity),
        "speed": np.hypot(*velocity.T),
        "displacement": in_space(displacement),
        "stress": stress,
        "absorbs": columns["continuum/absorbs"],
    }
    points = in_space(columns["continuum/position"] + displacement)
    return meshio.Mesh(points, [("quad", columns["continuum/cell"].astype(np.int32))], point_data=shown(data))
