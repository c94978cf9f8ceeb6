"""The sides of a body of disks by name, with those of its free-field column and of continua."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

import numpy as np

from dembound.boundaries import normal_axis
from dembound.boundaries.support import Edge
from dembound.casefile.disks.monitor import FREE_FIELD
from dembound.disks.body import DiskBody

T = TypeVar("T")


def sides_of(body: DiskBody) -> dict[str, Edge]:
    """The edges of a body, of its column bottom and top, as ``bottom.free_field``, and those of continua."""
    sides = dict(body.edges)
    if body.seam is not None:
        sides = {}
        for side, edge in body.edges.items():
            beside = edge.nodes < body.seam.count
            width = body.seam.width if edge.axis == 1 else 0.0
            sides[side] = edge.only(~beside, edge.length - width)
            if beside.any():
                sides[f"{side}{FREE_FIELD}"] = edge.only(beside, width)
    if body.outside is not None:
        if body.seam is not None:  # in the ground the column's ends are not at the level of the body's
            sides |= {side: _tied_edge(body, side) for side in body.outside.sides}
        sides |= body.outside.edges
    if body.foot is not None:
        sides |= _of_column(body.foot.edges)
    return sides


def tied_of(body: DiskBody) -> dict[str, np.ndarray]:
    """Nodes (k,) of a body that ties act on, by side: particles beside a free field or continuum, nodes of continua."""
    if body.outside is not None:
        return body.outside.tied_by_side | ({} if body.foot is None else _of_column(body.foot.tied_by_side))
    if body.seam is None:
        return {}
    node = body.seam.node
    left = body.assembly.positions[node, 0] < body.low[0] + 0.5 * body.size[0]
    near = {"left": node[left], "right": node[~left]}
    return {side: nodes for side, nodes in near.items() if body.case.side(side).needs_column}


def _of_column(by_side: Mapping[str, T]) -> dict[str, T]:
    """A mapping by side of the column's foot, renamed to the names of the column's sides in the scene."""
    return {name.replace("bottom", f"bottom{FREE_FIELD}"): value for name, value in by_side.items()}


def _tied_edge(body: DiskBody, side: str) -> Edge:
    """The disks of a side that ties act on."""
    nodes, length = body.tied[side], float(body.assembly.extent[1 - normal_axis(side)])
    return Edge(side, nodes, body.assembly.positions[nodes], 2.0 * body.assembly.radii[nodes], length)
