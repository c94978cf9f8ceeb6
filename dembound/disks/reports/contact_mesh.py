"""Contacts and bonds of a snapshot for ParaView: one line each, from the centre of one disk to that of the other.

Lines begin where the first disk is drawn, and end at the image of the second one where the contact crosses a periodic
side. They have these cell data:

| name | unit | shape | contents |
|---|---|---|---|
| ``normalForce`` | N/m | (b,) | force along the line, tension positive |
| ``shearForce`` | N/m | (b,) | force on the first disk across the line, to the left seen along it |
| ``bonded`` | 1 | (b,) | 1 for an intact bond, else 0 |
| ``particles`` | 1 | (b, 2) | ids of the two disks |

To see force chains in ParaView, open ``contacts.pvd``, press Apply, and choose the filters *Cell Data to Point Data*,
*Calculator* with ``abs(normalForce)``, and *Tube* with its result as scalars, *Vary Radius* by scalar and a radius
factor of 10 or so.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dembound.disks.reports.mesh import places_of
from dembound.motion.state import Arrays
from dembound.results.vtk import in_space, shown

if TYPE_CHECKING:
    import meshio


def contact_mesh(particles: Arrays, snapshot: Arrays) -> meshio.Mesh:
    """The contacts of one snapshot as lines with the cell data of this module's table."""
    import meshio  # imported here, as commands that write no files need not wait for it

    pairs = snapshot["contacts/particles"]
    begin = places_of(particles, snapshot)[pairs[:, 0]]
    end = begin + in_space(snapshot["contacts/vector"])
    data = {
        "normalForce": snapshot["contacts/normal_force"],
        "shearForce": snapshot["contacts/shear_force"],
        "bonded": snapshot["contacts/bonded"],
        "particles": pairs,
    }
    lines = np.arange(2 * len(pairs), dtype=np.int32).reshape(-1, 2)
    points = np.stack([begin, end], axis=1).reshape(-1, 3)
    return meshio.Mesh(points, [("line", lines)], cell_data={name: [values] for name, values in shown(data).items()})
