"""Pattern A: equal disks on a square lattice."""

from typing import ClassVar, Literal

import numpy as np

from dembound.packings.base import Packing
from dembound.packings.brick import Brick


class Square(Packing):
    """Equal disks on a square lattice, touching without force; a brick is one disk (Z section 2.3.1)."""

    is_lattice: ClassVar[bool] = True
    regular_sides: ClassVar[tuple[str, ...]] = ("left", "right", "bottom", "top")

    pattern: Literal["A"] = "A"

    @property
    def brick_size(self) -> tuple[float, float]:
        """The cell of one disk, in metres."""
        return 2.0 * self.radius, 2.0 * self.radius

    @property
    def expected_disks(self) -> float:
        """Number of disks: one per cell."""
        across, up = self.copies
        return float(across) * up

    @property
    def expected_contacts(self) -> float:
        """Contacts per disk: 2, to the right and above."""
        return 2.0

    def apart(self, axis: int, place: float) -> float:
        """The distance (m) from the nearest edge of a cell."""
        if not self.box[axis] < place < self.box[2 + axis]:
            return 0.0
        diameter = 2.0 * self.radius
        cells = (place - self.box[axis]) / diameter
        return abs(cells - round(cells)) * diameter

    def pack(self, contact_modulus: float) -> Brick:
        """One disk in the middle of its cell, touching its own images to the right and above.

        The lattice is unstressed, so the contact modulus (Pa) has no effect.
        """
        return Brick(
            size=np.array(self.brick_size),
            positions=np.full((1, 2), self.radius),
            radii=np.full(1, self.radius),
            pairs=np.zeros((2, 2), np.int64),
            images=np.eye(2, dtype=np.int64),
            edge_rows=np.zeros((1, 2), bool),
            stress=np.zeros(3),
            residual_ratio=0.0,
        )
