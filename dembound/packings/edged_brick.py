"""Pattern C: a random core framed by straight rows of equal disks."""

from dataclasses import asdict
from typing import ClassVar, Literal

import numpy as np

from dembound.packings.base import DensePacking
from dembound.packings.brick import Brick, load_or_pack
from dembound.packings.dense import RegularRows, pack_dense
from dembound.table import quantity


class EdgedBrick(DensePacking):
    """Pattern B with rows of equal disks round every brick."""

    regular_sides: ClassVar[tuple[str, ...]] = ("left", "right", "bottom", "top")

    pattern: Literal["C"] = "C"
    edge_radius: float = quantity(unit="m", means="size of a particle", gt=0.0)
    """radius of the row disks, adjusted to whole disks"""

    @property
    def edge_radii(self) -> tuple[float, float]:
        """The adjusted radii (m) of the row on x = 0 and of the row on y = 0.

        The disk at the origin belongs to the row on y = 0; the other disks of the row on x = 0 fill the rest of the
        height. In a square brick both radii are equal.
        """
        width, height = self.brick
        along_x = 0.5 * width / round(width / (2.0 * self.edge_radius))
        left = height - 2.0 * along_x
        return 0.5 * left / round(left / (2.0 * self.edge_radius)), along_x

    @property
    def largest_radius(self) -> float:
        """Radius of the largest disk in metres, row disks included."""
        return max(super().largest_radius, self.edge_radius)

    def pack(self, contact_modulus: float) -> Brick:
        """The packed brick for contact modulus E_c (Pa), from the cache if it is there.

        Raises CaseError for a confining stress out of range and PackingError when packing fails.
        """
        recipe = self.recipe(contact_modulus)
        key = {"pattern": self.pattern, **asdict(recipe), "edge_radii": self.edge_radii}
        return load_or_pack(key, lambda: pack_dense(recipe, regular_rows(self.brick, self.edge_radii)))


def regular_rows(size: tuple[float, float], edge_radii: tuple[float, float]) -> RegularRows:
    """The row on y = 0, from the origin on, then the rest of the row on x = 0; neighbours touch exactly.

    size (width, height) of the brick and edge_radii (row on x = 0, row on y = 0), in metres.
    """
    along_y, along_x = edge_radii
    lower = np.arange(round(0.5 * size[0] / along_x)) * 2.0 * along_x
    upright = along_x + along_y * (2.0 * np.arange(round((0.5 * size[1] - along_x) / along_y)) + 1.0)
    positions = np.vstack(
        [np.column_stack([lower, np.zeros_like(lower)]), np.column_stack([np.zeros_like(upright), upright])]
    )
    radii = np.concatenate([np.full(len(lower), along_x), np.full(len(upright), along_y)])
    return RegularRows(positions, radii, member=positions == 0.0)
