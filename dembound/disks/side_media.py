"""The ground beside the sides of a body: its medium, by layer."""

import numpy as np

from dembound.boundaries.support import BoundaryMedium, Edge
from dembound.disks.body import DiskBody
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.mirrored import with_images
from dembound.disks.material.packed_material import PackedMaterial


def boundary_medium(ground: PackedMaterial, axis: int) -> BoundaryMedium:
    """The medium beyond a side: the wave speeds given in the case, else those of the packing along the side's normal.

    axis : of the normal, 0 (x) or 1 (y): a packing may be stiffer along one than along the other.
    """
    p_gradient, s_gradient = ((0, 3), (1, 2))[axis]  # of u_n and of u_s along the normal, see homogenise.GRADIENTS
    p_speed, s_speed = ground.given_speeds
    if p_speed is None:
        p_speed = float(np.sqrt(ground.material_tensor[p_gradient, p_gradient] / ground.density))
    if s_speed is None:
        s_speed = float(np.sqrt(ground.material_tensor[s_gradient, s_gradient] / ground.density))

    def mirror_stiffness(diameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        between = with_images(ground, axis, diameters)
        return between.normal, between.bending

    return BoundaryMedium(
        ground.density, p_speed, s_speed, mirror_stiffness, own_speeds=lambda: ground.wave_speeds(axis)
    )


def media_of(scene: DiskBody, side: str) -> list[tuple[Edge, BoundaryMedium]]:
    """The parts of a side within one layer, with the medium that each represents; the lowest first."""
    ground, edge = scene.ground, scene.edges[side]
    if not isinstance(ground, LayeredGround):
        return [(edge, boundary_medium(ground, edge.axis))]
    layer = ground.layer_of(edge.positions[:, 1])
    found = []
    for each in ground.layers:
        chosen = layer == each.layer
        if chosen.any():
            low, high = scene.low[1], scene.low[1] + edge.length
            length = min(each.high, high) - max(each.low, low) if edge.axis == 0 else edge.length
            found.append((edge.only(chosen, length), boundary_medium(each.material, edge.axis)))
    return found


def layers_beside(scene: DiskBody, side: str) -> list[int]:
    """Number of the layer, from the top, of each of the parts of a side, see `media_of`."""
    return [int(scene.ground.layer_of(edge.positions[:1, 1])[0]) for edge, _ in media_of(scene, side)]


def ground_at(scene: DiskBody, side: str) -> PackedMaterial:
    """The material at a side; in a layered ground that of the lowest of its layers."""
    return scene.ground.at(scene.case.box[3 if side == "top" else 1])


def medium_of_side(scene: DiskBody, side: str) -> BoundaryMedium:
    """The medium that a side represents; in a layered ground that of the lowest of its layers."""
    return media_of(scene, side)[0][1]
