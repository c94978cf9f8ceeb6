"""The sides of a body of disks: with those of its free-field column, and the ground beside them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

import numpy as np

from dembound.boundaries.edge import BoundaryMedium, Edge, normal_axis
from dembound.casefile.disks.load import FREE_FIELD
from dembound.disks.body import DiskBody
from dembound.disks.material.constants import with_images
from dembound.disks.material.layered import LayeredGround
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
    ground, edge = ground_beside(scene, side), scene.edges[side]
    if not isinstance(ground, LayeredGround):
        return [(edge, boundary_medium(ground, edge.axis))]
    layer = ground.layer_of(edge.positions)
    found = []
    for each in ground.layers:
        chosen = layer == each.layer
        if chosen.any():
            low, high = scene.low[1], scene.low[1] + edge.length
            length = min(each.high, high) - max(each.low, low) if edge.axis == 0 else edge.length
            found.append((edge.only(chosen, length), boundary_medium(each.material, edge.axis)))
    return found


def layers_beside(scene: DiskBody, side: str) -> list[int]:
    """Number of the layer, from the top of its ground, of each of the parts of a side, see `media_of`."""
    ground = ground_beside(scene, side)
    return [int(ground.layer_of(edge.positions[:1])[0]) for edge, _ in media_of(scene, side)]


def ground_beside(scene: DiskBody, side: str) -> PackedMaterial:
    """The ground beyond a side; below the disks it is the same at both sides, and the top has none."""
    return scene.ground.beside("right" if side == "right" else "left")


def ground_at(scene: DiskBody, side: str) -> PackedMaterial:
    """The material at a side; in a layered ground that of the lowest of its layers."""
    return ground_beside(scene, side).at(scene.case.box[3 if side == "top" else 1])


def medium_of_side(scene: DiskBody, side: str) -> BoundaryMedium:
    """The medium that a side represents; in a layered ground that of the lowest of its layers."""
    return media_of(scene, side)[0][1]


T = TypeVar("T")

ENDS_OF_COLUMNS = (FREE_FIELD, ".right_free_field")
"""Endings of the names of the bottom and top of each column."""


def sides_of(body: DiskBody) -> dict[str, Edge]:
    """The edges of a body, of its columns bottom and top, as ``bottom.free_field``, and those of continua."""
    sides = dict(body.edges)
    if body.seams:
        sides = {}
        for side, edge in body.edges.items():
            own = edge.nodes >= body.column_count
            widths = [seam.width if edge.axis == 1 else 0.0 for seam in body.seams]
            sides[side] = edge.only(own, edge.length - sum(widths))
            for seam, width, name in zip(body.seams, widths, ENDS_OF_COLUMNS, strict=False):
                beside = (edge.nodes >= seam.disks.start) & (edge.nodes < seam.disks.stop)
                if beside.any():
                    sides[f"{side}{name}"] = edge.only(beside, width)
    if body.outside is not None:
        if body.seams:  # in the ground the column's ends are not at the level of the body's
            sides |= {side: _tied_edge(body, side) for side in body.outside.sides}
        sides |= body.outside.edges
    for foot, name in zip(body.feet, ENDS_OF_COLUMNS, strict=False):
        sides |= _of_column(foot.edges, name)
    return sides


def tied_of(body: DiskBody) -> dict[str, np.ndarray]:
    """Nodes (k,) of a body that ties act on, by side: particles beside a free field or continuum, nodes of continua."""
    if body.outside is not None:
        tied = dict(body.outside.tied_by_side)
        for foot, name in zip(body.feet, ENDS_OF_COLUMNS, strict=False):
            tied |= _of_column(foot.tied_by_side, name)
        return tied
    if not body.seams:
        return {}
    node = np.unique(np.concatenate([seam.node for seam in body.seams]))
    left = body.assembly.positions[node, 0] < body.low[0] + 0.5 * body.size[0]
    near = {"left": node[left], "right": node[~left]}
    return {side: nodes for side, nodes in near.items() if body.case.side(side).needs_column}


def _of_column(by_side: Mapping[str, T], ending: str) -> dict[str, T]:
    """A mapping by side of a column's foot, renamed to the names of the column's sides in the scene."""
    return {name.replace("bottom", f"bottom{ending}"): value for name, value in by_side.items()}


def _tied_edge(body: DiskBody, side: str) -> Edge:
    """The disks of a side that ties act on."""
    nodes, length = body.tied[side], float(body.assembly.extent[1 - normal_axis(side)])
    return Edge(side, nodes, body.assembly.positions[nodes], 2.0 * body.assembly.radii[nodes], length)
