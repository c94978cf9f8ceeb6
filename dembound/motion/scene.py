"""The scene: the arrays of a case that the loop, trackers and records need, and what is recorded besides particles."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

from dembound.boundaries.edge import plane_of
from dembound.boundaries.support import Edge, Supports
from dembound.casefile import Case
from dembound.motion.part import System
from dembound.motion.state import Layout


class Beside(ABC):
    """The m nodes of a scene that are recorded separately.

    Attributes
    ----------
    nodes : their range among the nodes of the scene.
    """

    nodes: slice

    @property
    @abstractmethod
    def columns(self) -> dict[str, tuple[np.ndarray, str]]:
        """Data of these nodes for the record, by name: values (m, …) and unit."""

    @abstractmethod
    def motion(self, values: np.ndarray, of: str, time: float) -> dict[str, np.ndarray]:
        """Motion (m, 3) of these nodes by prefix of its name, from the motion of all nodes (n, 3) of the scene.

        The prefix "" is the total motion. of : "displacement" or "velocity"; time : of the values, s.
        """


@dataclass(frozen=True, eq=False)
class Between:
    """A place whose motion is a sum over nodes, plus, if any, a motion that is known in advance.

    Attributes
    ----------
    place : (2,) m.
    node : (k,) int64. share : (k, 3, 3); displacement and velocity of the place are Σ share @ those of the nodes, by
    components x, y, rotation. known : times (s,) s -> displacement and velocity (s, 6) to be added; None: nothing.
    """

    place: np.ndarray
    node: np.ndarray
    share: np.ndarray
    known: Callable[[np.ndarray], np.ndarray] | None = None

    def at(self, times: np.ndarray, record: np.ndarray) -> np.ndarray:
        """Displacement and velocity (s, 6) in steps at times (s,) s, from those of its nodes (s, k, 6)."""
        return self.motion(record) if self.known is None else self.motion(record) + self.known(times)

    def motion(self, record: np.ndarray) -> np.ndarray:
        """The weighted sum (s, 6) over its nodes' displacements and velocities (s, k, 6) in s steps.

        Sums are in the order of the nodes, so that they have the same bits for any number of steps.
        """
        each = record.reshape(len(record), len(self.node), 2, 3)
        moved = np.zeros((len(record), 2, 3))
        for k, component in np.argwhere(self.share.any(axis=1)):
            moved += each[:, k, :, component, None] * self.share[k, :, component]
        return moved.reshape(-1, 6)


class Mean(Between):
    """The mean motion of nodes, at their centre; share : (k,) of each node, of sum 1, for all components."""

    def motion(self, record: np.ndarray) -> np.ndarray:
        """The weighted sum (s, 6) over the nodes' displacements and velocities (s, k, 6) in s steps, in their order."""
        moved = np.zeros((len(record), 6))
        for k, share in enumerate(self.share):
            moved += share * record[:, k]
        return moved


RUNAWAY = 1e4
"""Factor by which the speed of a node may exceed that of all waves together: resonance gives factors of ten."""

FASTEST = 1e100
"""Speed (m/s) above which energies approach the largest double, 1e308 J."""


class Scene(ABC):
    """The arrays of a case: n nodes of three components each (x, y, rotation), all SI.

    Attributes
    ----------
    case : the case it was built from.
    edges : side -> its exposed nodes, for every side that is not periodic.
    supports : the table of forces from outside, loads that follow a wave included.
    monitors : name -> node, the nearest one for a place between nodes.
    between : name -> place, of the monitors at places between nodes.
    kind : name of the kind of body in records.
    energy_unit : the unit of its energies.
    record_width : columns of a probe's record, see kernels.tables.Log.
    in_snapshots : names of the fields that each snapshot has for this kind of body, besides its motion.
    block : steps between two returns of the compiled loop.
    has_history : whether its law is history-dependent.
    weight : energies of the whole scene over those of this one, see `whole`.
    """

    case: Case
    edges: Mapping[str, Edge]
    supports: Supports
    monitors: Mapping[str, int]
    between: Mapping[str, Between] = MappingProxyType({})
    kind: str
    energy_unit: str
    record_width: int
    in_snapshots: tuple[str, ...] = ()
    block: int
    has_history: bool = False
    weight: float = 1.0

    @property
    @abstractmethod
    def count(self) -> int:
        """Number of nodes n."""

    @property
    def recorded(self) -> int:
        """Number of its first nodes that are recorded as particles; by default all."""
        return self.count

    @property
    @abstractmethod
    def positions(self) -> np.ndarray:
        """(n, 2) m."""

    @property
    def low(self) -> np.ndarray:
        """(2,) m, lower left corner of the body; by default it begins at zero."""
        return np.zeros(2)

    @property
    @abstractmethod
    def size(self) -> np.ndarray:
        """(2,) width and height, m."""

    def plane(self, side: str) -> float:
        """Position (m, along its normal) of a side of the body."""
        low, high = self.low.tolist(), (self.low + self.size).tolist()
        return plane_of(side, (*low, *high))

    @property
    @abstractmethod
    def mass(self) -> np.ndarray:
        """(n,) kg."""

    @property
    @abstractmethod
    def inertia(self) -> np.ndarray:
        """(n,) kg·m²."""

    @property
    @abstractmethod
    def free(self) -> np.ndarray:
        """(3,) 1 for a component that moves, 0 for one held everywhere."""

    @property
    def moves(self) -> np.ndarray:
        """(3, n) bool, False for components that are held or whose motion is prescribed."""
        moves = np.repeat(self.free[:, None] > 0.0, self.count, axis=1)
        fixed = self.supports.prescribed
        moves[self.supports.component[fixed], self.supports.node[fixed]] = False
        return moves

    @property
    @abstractmethod
    def damp(self) -> float:
        """Local damping coefficient."""

    @property
    @abstractmethod
    def steady_load(self) -> np.ndarray:
        """(3, n) forces and moments (N, N·m) of the loads without a wave."""

    @property
    def forces_by_side(self) -> Mapping[str, tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """By side, nodes (k,), forces (2, k) N by which it holds a body at rest, and recorded forces; empty if unknown.

        The recorded forces (2, k) N add up to the stress times the length of the side; the sum over all sides is the
        same.
        """
        return {}

    @property
    @abstractmethod
    def threads(self) -> int:
        """Number of threads of its steps."""

    @property
    @abstractmethod
    def largest_memory(self) -> float:
        """Largest RAM (bytes) of a run of the scene, or of the scene it is stepped in place of."""

    @property
    @abstractmethod
    def attributes(self) -> dict[str, Any]:
        """Additional attributes of a record's header for this kind of body."""

    def attributes_of_monitor(self, name: str) -> dict[str, Any]:
        """The attributes of a monitor's history in addition to its places; by default none."""
        return {}

    @property
    @abstractmethod
    def columns(self) -> dict[str, tuple[np.ndarray, str]]:
        """Data of every node for the record, by name: values (n, …) and unit."""

    @property
    def beside(self) -> Beside | None:
        """The nodes that are recorded separately, those of a continuum; None, the default, without any."""
        return None

    @property
    @abstractmethod
    def places(self) -> dict[str, tuple[float, float]]:
        """The positions given for the monitors, m."""

    @property
    def monitored(self) -> dict[str, np.ndarray]:
        """The places (2,) m whose motion the monitors record."""
        return {
            name: self.between[name].place if name in self.between else self.positions[node]
            for name, node in self.monitors.items()
        }

    @property
    def probes(self) -> np.ndarray:
        """(p,) nodes whose motion is recorded at every step: of one monitor after the other those it needs."""
        each = [self.between[name].node if name in self.between else [node] for name, node in self.monitors.items()]
        return np.concatenate([np.zeros(0, dtype=np.int64), *each])

    @abstractmethod
    def system(self, time_step: float) -> System:
        """Its parts and ties at rest as built, to be stepped by time_step (s)."""

    @property
    def whole(self) -> "Scene":
        """The scene of the case, if this one is stepped in its place; by default itself."""
        return self

    @property
    def uniform_axes(self) -> tuple[int, ...]:
        """Axes along which the motion of the whole scene does not vary, so that one row of it is stepped."""
        return ()

    @property
    def reduced(self) -> tuple[str, ...]:
        """A line for each reduction of the whole scene to this one."""
        return ()

    def widened(self, name: str, values: np.ndarray) -> np.ndarray:
        """Values (n, …) of its nodes expanded to the nodes of the whole scene; name : of the quantity in records."""
        return values

    def observed(self, record: np.ndarray, times: np.ndarray) -> np.ndarray:
        """The record (s, m, 6 or 7) of the m monitors of the whole scene, from that of the probes (s, p, 6 or 7).

        times : (s,) s, of the steps.
        """
        if not self.between:
            return record
        columns, first = [], 0
        for name in self.monitors:
            place = self.between.get(name)
            last = first + (1 if place is None else len(place.node))
            columns.append(record[:, first] if place is None else place.at(times, record[:, first:last]))
            first = last
        return np.stack(columns, axis=1)

    @property
    def twin(self) -> np.ndarray | None:
        """(n,) node to whose velocity the dashpots of each node are relative, the node itself for none.

        The result is None if no node has one.
        """
        return None

    @property
    def first_velocity(self) -> np.ndarray | None:
        """(3, n) m/s and rad/s at the start of a run; None, the default, at rest."""
        return None

    @property
    def layout(self) -> Layout:
        """The slots in which kernels hold its nodes."""
        return Layout.plain(self.count)

    @cached_property
    def tracked(self) -> np.ndarray:
        """(q,) the nodes of all edges, one edge after the other."""
        return np.concatenate([np.zeros(0, dtype=np.int64), *(edge.nodes for edge in self.edges.values())])

    @property
    def sides(self) -> dict[str, Edge]:
        """The sides whose forces are recorded, by name; by default the edges."""
        return dict(self.edges)

    @property
    def lines(self) -> Mapping[str, Mapping[str, np.ndarray]]:
        """Points (p, 2) m by name of rigid "walls" that it touches, and of "joints" in it; by default none."""
        return {}

    @property
    def tied(self) -> Mapping[str, np.ndarray]:
        """Nodes (k,) on which ties act, by the side they belong to; by default none."""
        return {}

    @property
    def borne(self) -> Mapping[str, tuple[np.ndarray, np.ndarray]]:
        """Nodes (k,) with springs on their motion relative to the ground beyond, by side; by default none.

        Also the side's shares (k, 2) of their forces along x and y.
        """
        return {}

    def side_peaks(self, side: str, peaks: np.ndarray) -> np.ndarray:
        """Smallest and largest velocity (k, 3, 2) of the nodes of a side of the whole scene.

        peaks : (q, 3, 2) of the nodes `tracked`.
        """
        sides = list(self.edges)
        first = sum(len(self.edges[name].nodes) for name in sides[: sides.index(side)])
        return peaks[first : first + len(self.edges[side].nodes)]

    @property
    def against_growth(self) -> str:
        """What helps against motion that grows, or gains energy, from nothing, in words."""
        return "a smaller run.safety or run.time_step"

    @property
    def fastest(self) -> float:
        """Speed (m/s) that no node can reach; if loads or other forces act too, the limit of the number range."""
        waves = sum(wave.peak() for wave in self.case.wave.values())
        more = self.case.load or self.has_history
        return RUNAWAY * waves if waves and not more else FASTEST
