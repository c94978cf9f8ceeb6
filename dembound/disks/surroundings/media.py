"""The continuum that the ground of disks is equivalent to, by layer."""

from dembound.continuum.medium import Ground, Layered, Medium, Unlike, one_side
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.unlike import UnlikeGround


def medium_of(ground: PackedMaterial) -> Ground:
    """The continuum that a packing is equivalent to, with all six constants, by layer."""
    if isinstance(ground, UnlikeGround):
        left, right = (one_side(medium_of(side)) for side in ground.sides)
        return Unlike(left, right)
    if isinstance(ground, LayeredGround):
        media = tuple(homogeneous(each.material) for each in ground.layers)
        return Layered(media, tuple(each.low for each in ground.layers[1:]))
    return homogeneous(ground)


def homogeneous(ground: PackedMaterial) -> Medium:
    """The continuum that one material is equivalent to."""
    c = ground.material_tensor
    return Medium(ground.density, c[0, 0], c[1, 1], c[0, 1], c[2, 2], c[0, 2], c[1, 2])
