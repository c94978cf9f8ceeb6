"""The tie that joins both sides of the slit of a continuum beside two free-field columns, see kernels/jump.py."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody
from dembound.damping import factors_of
from dembound.disks.surroundings.continuum import Surroundings
from dembound.kernels import jump  # noqa: F401  # it registers its tie
from dembound.kernels.tables import Jump
from dembound.motion.part import Tie
from dembound.motion.state import Arrays, Layout


class JumpTie(Tie):
    """The jump across the slit of the continuum round a body, from the motion of the feet of its two columns.

    Parameters
    ----------
    outside : the continuum. feet : those below the columns, with the same rows; none: rotations of the nodes carry the
    rate of the jump, see oblique_jump.py. layout : the slots of all nodes of the scene. time_step : Δt in s.
    """

    name = "jump"

    def __init__(self, outside: Surroundings, feet: tuple[Surroundings, ...], layout: Layout, time_step: float) -> None:
        self._outside, self._feet, self._layout, self._time_step = outside, feet, layout, time_step
        self._last: tuple[np.ndarray, Jump] | None = None
        self.nodes = nodes_on_slit(outside)

    @cached_property
    def _at_rest(self) -> Jump:
        """The arrays for the kernels, without lines in the support table."""
        body, slot = self._outside.body, self._layout.slot
        mesh, count = body.mesh, body.mesh.order + 1
        assert mesh.box is not None
        own, copy = mesh.doubled
        elements = elements_on_slit(mesh)
        heights, layer = mesh.element_sizes[elements, 1], body.layer[elements]
        lines = mesh.order * mesh.elements[elements, 1][:, None] + np.arange(count)
        q, profile = depths_on_slit(mesh)[lines], body.profile("bottom")
        decay, gain, delay = np.zeros((3, *q.shape))
        if profile is not None:
            decay, gain, delay = (of(q, self._time_step) for of in (profile.decay, profile.gain, profile.delay))
            absorbs = mesh.absorbs[elements, 1][:, None]
            decay, gain, delay = (np.where(absorbs, each, 0.0) for each in (decay, gain, delay))
        factors = factors_of(body.mechanisms or (None,), self._time_step)[layer if body.mechanisms else 0 * layer]
        none = np.zeros((len(own), 0), dtype=np.int64), np.zeros(0)
        (left, left_share), (right, right_share) = map(_across, self._feet) if self._feet else (none, none)
        return Jump(
            left=slot[left],
            right=slot[right],
            left_share=left_share,
            right_share=right_share,
            node=slot[self._outside.first + own],
            copy=slot[self._outside.first + copy],
            line=np.zeros(len(own), dtype=np.int64),
            copy_line=np.zeros(len(own), dtype=np.int64),
            first=int(np.count_nonzero(mesh.held[own])),
            given=int(not self._feet),
            slope=2.0 / heights[:, None, None] * mesh.rule.derivative,
            weight=0.5 * body.thickness * heights[:, None] * mesh.rule.weights,
            moduli=np.stack([body.stepped_media[number].moduli for number in layer]),
            decay=decay,
            gain=gain,
            delay=delay,
            factors=factors,
            strain_memory=np.zeros((*q.shape, 2)),
            memory=np.zeros((*q.shape, 2, factors.shape[2])),
            traction=np.zeros((len(own), 2)),
            moved=np.zeros((2, count)),
            strain=np.zeros(2),
            stress=np.zeros(2),
        )

    def bundle(self, supported: np.ndarray) -> NamedTuple:
        """The arrays of the tie for the kernels; supported (s,) are all nodes of the support table, ascending."""
        if self._last is None or self._last[0] is not supported:
            line, copy_line = (
                np.searchsorted(supported, self._outside.first + nodes).clip(max=len(supported) - 1)
                for nodes in self._outside.body.mesh.doubled
            )
            self._last = supported, self._at_rest._replace(line=line, copy_line=copy_line)
        return self._last[1]

    def saved_arrays(self) -> Arrays:
        """The convolution variables of the absorbing layer, and the memories of damping."""
        return {name: getattr(self._at_rest, name) for name in ("strain_memory", "memory")}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        for name, values in self.saved_arrays().items():
            values[:] = saved[name]


def elements_on_slit(mesh: Mesh) -> np.ndarray:
    """Elements (k,) right of a slit beside it, from the bottom."""
    assert mesh.box is not None
    return np.flatnonzero((mesh.elements[:, 0] == mesh.box[2]) & (mesh.elements[:, 1] < mesh.box[1]))


def depths_on_slit(mesh: Mesh) -> np.ndarray:
    """Depth (n,) of the nodes on a slit in the layer below, over its thickness, from the bottom."""
    return np.asarray(-np.minimum(mesh.axes[1].depth[: len(mesh.doubled[0])], 0.0))


def weights_on_slit(body: GridBody) -> np.ndarray:
    """(n,) m², of the quadrature along a slit times the thickness, for its nodes from the bottom."""
    mesh = body.mesh
    heights, weight = mesh.element_sizes[elements_on_slit(mesh), 1], np.zeros(len(mesh.doubled[0]))
    places = mesh.order * np.arange(len(heights))[:, None] + np.arange(mesh.order + 1)
    np.add.at(weight, places, 0.5 * body.thickness * heights[:, None] * mesh.rule.weights)
    return weight


def nodes_on_slit(outside: Surroundings | None) -> np.ndarray:
    """Nodes (k,) of a scene on both sides of the slit of its continuum that move, ascending; none without a slit."""
    if outside is None or not outside.body.mesh.slit:
        return np.zeros(0, dtype=np.int64)
    both = np.concatenate(outside.body.mesh.doubled)
    return np.asarray(outside.first + np.sort(both[~outside.body.mesh.held[both]]))


def _across(foot: Surroundings) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (n, a) of a scene on the lines across a foot, from the bottom, and weights (a,) of the mean of a line."""
    mesh = foot.body.mesh
    assert mesh.box is not None
    lines, along = mesh.order * mesh.box[1] + 1, mesh.axes[0].lines
    share = np.zeros(along)
    places = mesh.order * np.arange(mesh.cells[0])[:, None] + np.arange(mesh.order + 1)
    np.add.at(share, places % along, 0.5 * mesh.axes[0].sizes[:, None] * mesh.rule.weights)
    return foot.first + np.arange(lines * along).reshape(lines, along), share / mesh.axes[0].length
