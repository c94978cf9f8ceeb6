"""The state of a run: all arrays that change during it, and the order of its nodes."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

ALIGNMENT = 64
"""Bytes at whose multiples arrays of slots begin: a line of the caches, and eight doubles."""


def aligned_zeros(*shape: int, dtype: Any = np.float64) -> np.ndarray:
    """Zeros of this shape and type, at an aligned address (`ALIGNMENT`)."""
    kind = np.dtype(dtype)
    size = int(np.prod(shape)) * kind.itemsize
    room = np.zeros(size + ALIGNMENT, dtype=np.uint8)
    first = -room.ctypes.data % ALIGNMENT
    return room[first : first + size].view(kind).reshape(shape)


@dataclass(frozen=True, eq=False)
class Layout:
    """The assignment of n nodes to slots.

    Attributes
    ----------
    slot : (n,) int64, the slot of each node.
    count : number of slots.
    """

    slot: np.ndarray
    count: int

    @classmethod
    def plain(cls, nodes: int) -> "Layout":
        """Every node in the slot of its own number."""
        return cls(np.arange(nodes), nodes)

    @cached_property
    def node(self) -> np.ndarray:
        """(slots,) the node in each slot, −1 where there is none."""
        node = np.full(self.count, -1)
        node[self.slot] = np.arange(len(self.slot))
        return node

    @cached_property
    def is_plain(self) -> bool:
        """Whether each slot holds the node of the same number."""
        return len(self.slot) == self.count and bool((self.slot == np.arange(self.count)).all())

    def spread(self, values: np.ndarray) -> np.ndarray:
        """Values (..., n) of nodes as a new array of slots (..., slots), zero where there is no node."""
        spread = aligned_zeros(*values.shape[:-1], self.count)
        spread[..., self.slot] = values
        return spread

    def gather(self, values: np.ndarray) -> np.ndarray:
        """Values (..., slots) reordered by node (..., n), not to be written to; a view where possible.

        It is contiguous by row, as in a checkpoint, because numpy's order of summation depends on this.
        """
        gathered = values[...] if self.is_plain else np.take(values, self.slot, axis=-1)
        gathered.flags.writeable = False
        return gathered


Arrays = Mapping[str, np.ndarray]
"""Arrays by name."""

WORK = ("outside", "damping", "friction", "crack", "law_switch", "turning", "closing")
"""Names of the columns of the work, see kernels.tables.Log."""


class Owner:
    """An object that contains a part of the state: a system of parts, a part, a tie, a tracker.

    name : in the state, where it is one of several. evolving : its attributes that change during a run, arrays,
    numbers, flags or texts, which the state has under their names without a leading underscore. Classes with others
    extend `saved_arrays` and `restore`.
    """

    name: str
    evolving: ClassVar[tuple[str, ...]] = ()

    def saved_arrays(self) -> Arrays:
        """All arrays that change during a run, by name."""
        return {name.removeprefix("_"): np.asarray(getattr(self, name)) for name in self.evolving}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case; ValueError for another one."""
        for name in self.evolving:
            now, kept = getattr(self, name), saved[name.removeprefix("_")]
            if np.size(now) and np.shape(now) != kept.shape:  # some are empty at first
                raise ValueError(f"{name} has the shape {kept.shape}, must have {np.shape(now)}")
            setattr(self, name, kept.copy() if isinstance(now, np.ndarray) else type(now)(kept.item()))


@dataclass
class State:
    """The state of a run of n nodes.

    Attributes
    ----------
    layout : the slots of the nodes.
    u, v : (3, slots) displacements in m and rad and velocities in m/s and rad/s, half a time step behind.
    datum : (3, n) displacement at the start.
    peaks : (q, 3, 2) smallest and largest velocity so far of the nodes of all edges, one edge after the other.
    top : (slots,) m/s, largest speed so far; (0,) unless the case asks for it.
    work : (2, 7) J, in the columns `WORK`; supplied : (1,) J, the largest work of supports so far; see
        kernels.tables.Log.
    side_work : (2, s, 2) J that came in through every side and that its dashpots absorbed; see kernels.tables.Sides.
    step : steps done.
    laws : name of each law used and its first step.
    switch_velocity : (3, n) velocity half a step before the history-dependent law began; (3, 0) under another law.
    owners : objects that contain the rest of the state, by name.
    """

    layout: Layout
    u: np.ndarray
    v: np.ndarray
    datum: np.ndarray
    peaks: np.ndarray
    top: np.ndarray
    work: np.ndarray = field(default_factory=lambda: np.zeros((2, len(WORK))))
    supplied: np.ndarray = field(default_factory=lambda: np.zeros(1))
    side_work: np.ndarray = field(default_factory=lambda: np.zeros((2, 0, 2)))
    step: int = 0
    laws: list[tuple[str, int]] = field(default_factory=list)
    switch_velocity: np.ndarray = field(default_factory=lambda: np.zeros((3, 0)))
    owners: dict[str, Owner] = field(default_factory=dict)

    @property
    def displacement(self) -> np.ndarray:
        """Displacements (3, n) m and rad, to be read or replaced as a whole; copy them to keep them."""
        return self.layout.gather(self.u)

    @displacement.setter
    def displacement(self, values: np.ndarray) -> None:
        self.u[:, self.layout.slot] = values

    @property
    def velocity(self) -> np.ndarray:
        """Velocities (3, n) m/s and rad/s, half a time step behind, to be read or replaced as a whole; copy to keep."""
        return self.layout.gather(self.v)

    @velocity.setter
    def velocity(self, values: np.ndarray) -> None:
        self.v[:, self.layout.slot] = values

    @property
    def top_speed(self) -> np.ndarray:
        """(n,) m/s, largest speed of every node so far; (0,) unless the case asks for it."""
        return self.layout.gather(self.top) if self.top.size else self.top

    @top_speed.setter
    def top_speed(self, values: np.ndarray) -> None:
        if self.top.size:
            self.top[self.layout.slot] = values

    def arrays(self, *, copies: bool = True) -> dict[str, np.ndarray]:
        """All arrays, by name; a run continued from them in another process gives the same bits.

        copies : whether to copy all arrays; otherwise some are those of the run, which change as it goes on.
        """
        arrays = {name: getattr(self, name) for name in _ARRAYS}
        arrays |= {f"work/{name}": self.work[:, column] for column, name in enumerate(WORK)}
        arrays["step"] = np.array(self.step)
        arrays["laws/name"] = np.array([name for name, _ in self.laws])
        arrays["laws/step"] = np.array([step for _, step in self.laws], dtype=np.int64)
        for owner, kept in self.owners.items():
            arrays |= {f"{owner}/{name}": values for name, values in kept.saved_arrays().items()}
        return {name: np.array(values) for name, values in arrays.items()} if copies else arrays

    def take(self, arrays: Arrays) -> None:
        """Restore the arrays returned by `arrays` in another run of the same case.

        Raises ValueError for those of another one, numbers that are not finite, and trackers that were due before.
        """
        for name in _ARRAYS:
            if not np.isfinite(arrays[name]).all():
                raise ValueError(f"{name} is not finite")
            if name != "switch_velocity" and arrays[name].shape != getattr(self, name).shape:  # absent at first
                raise ValueError(f"{name} has the shape {arrays[name].shape}, must have {getattr(self, name).shape}")
            setattr(self, name, arrays[name].copy())
        self.work = np.stack([arrays[f"work/{name}"] for name in WORK], axis=1)
        self.step = int(arrays["step"])
        self.laws = list(zip(arrays["laws/name"].tolist(), arrays["laws/step"].tolist(), strict=True))
        for owner, kept in self.owners.items():
            for name, fresh in kept.saved_arrays().items():
                saved = arrays[f"{owner}/{name}"]
                if (saved.dtype.kind, saved.ndim) != (fresh.dtype.kind, fresh.ndim):
                    raise ValueError(f"{owner}/{name} has {saved.ndim} axes of {saved.dtype}")
            kept.restore(arrays_of_owner(arrays, owner))
            if getattr(kept, "due", self.step) < self.step:
                raise ValueError(f"{owner} was due before step {self.step}")


_ARRAYS = ("displacement", "velocity", "datum", "peaks", "top_speed", "switch_velocity", "supplied", "side_work")
"""The arrays of a state that are saved as they are."""


def arrays_of_owner(arrays: Arrays, owner: str) -> dict[str, np.ndarray]:
    """The arrays whose names begin with that of an owner, under names without this prefix."""
    return {name.removeprefix(f"{owner}/"): values for name, values in arrays.items() if name.startswith(f"{owner}/")}
