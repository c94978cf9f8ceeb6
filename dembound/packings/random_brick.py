"""Pattern B: a random dense packing in a periodic brick."""

from dataclasses import asdict
from typing import Literal

from dembound.packings.base import DensePacking
from dembound.packings.brick import Brick, load_or_pack
from dembound.packings.dense import pack_dense


class RandomBrick(DensePacking):
    """A random packing in a periodic brick, radii uniform from R_min to `radius_ratio`·R_min (Z section 2.3.1)."""

    pattern: Literal["B"] = "B"

    def pack(self, contact_modulus: float) -> Brick:
        """The packed brick for contact modulus E_c (Pa), from the cache if it is there.

        Raises CaseError for a confining stress out of range and PackingError when packing fails.
        """
        recipe = self.recipe(contact_modulus)
        return load_or_pack({"pattern": self.pattern, **asdict(recipe)}, lambda: pack_dense(recipe))
