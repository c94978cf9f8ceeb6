"""Parts and ties: a part is a range of the nodes with its own law, a tie couples nodes of two parts."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import ClassVar, NamedTuple

import numpy as np

from dembound.kernels.tables.motion import Followers
from dembound.motion.state import Arrays, Owner, State, arrays_of_owner

MANY = 10
"""Largest number of broken bonds of a run without a note that it is one draw of many."""


@dataclass(frozen=True)
class Cracks:
    """Bonds that broke, k of them, in the order in which they broke.

    step (k,) int64; pair (k, 2) int64 nodes; position (k, 2) m, the middle of the pair in that step; shear (k,) bool,
    True for shear, False for tension.
    """

    step: np.ndarray
    pair: np.ndarray
    position: np.ndarray
    shear: np.ndarray

    def __len__(self) -> int:
        return len(self.step)

    def among(self, kept: np.ndarray) -> "Cracks":
        """The cracks between two of the nodes kept (m,), ascending, with the numbering of these nodes."""
        inside = np.isin(self.pair, kept).all(axis=1)
        pair = np.searchsorted(kept, self.pair[inside])
        return Cracks(self.step[inside], pair, self.position[inside], self.shear[inside])


NO_CRACKS = Cracks(np.zeros(0, np.int64), np.zeros((0, 2), np.int64), np.zeros((0, 2)), np.zeros(0, np.bool_))
"""An empty list."""


def joined(lists: Sequence[Cracks]) -> Cracks:
    """Several lists of cracks as one, in the order of their steps."""
    columns = [np.concatenate([getattr(part, field.name) for part in [NO_CRACKS, *lists]]) for field in fields(Cracks)]
    order = np.argsort(columns[0], kind="stable")
    return Cracks(*(column[order] for column in columns))


class Part(Owner, ABC):
    """Nodes that move under one law.

    Attributes
    ----------
    name : in the state and in messages.
    nodes : its range of the scene's nodes.
    law_name : name of the law in use, for reports.
    is_summarised : whether summaries read its arrays at the end of a run.
    """

    name: str
    nodes: slice
    law_name: str
    is_summarised: ClassVar[bool] = False

    @abstractmethod
    def law(self) -> NamedTuple:
        """The bundle of arrays of its law; the type chooses the compiled code, see kernels/law.py."""

    @abstractmethod
    def react(self, why: int, steps: int, state: State) -> None:
        """React to a return of the loop; why : the reason, see kernels/common.py; steps : done so far."""

    @abstractmethod
    def stored(self, u: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) at displacements (3, slots): in contacts and in bonds, of a bar in springs and in bonds."""

    def counted(self, u: np.ndarray) -> float:
        """Strain energy (J) at displacements (3, slots) that the loop counts as taken by damping; by default none."""
        return 0.0

    @abstractmethod
    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since this was last called; steps : number of steps done."""

    def blown_up(self, velocity: np.ndarray) -> int | None:
        """The node of an instability that adds energy, if the part can detect it; velocity (3, slots) m/s."""
        return None

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Fields of its nodes at displacements (3, n) other than their motion, by name: values (m, …) and unit.

        Those of all parts of one kind are the same. Every field is in the snapshots of ``run.h5``, and in the files for
        ParaView, where values (m, 2) are vectors and (m, 3), as of a stress, the xx, yy, xy of symmetric tensors.
        """
        return {}


class Tie(Owner, ABC):
    """A coupling between nodes of two parts, or of a part and the medium beyond it.

    Attributes
    ----------
    name : in the state, where it has arrays to save.
    nodes : (k,) that it acts on, ascending; the support table moves them.
    """

    name: str = "tie"
    nodes: np.ndarray

    @abstractmethod
    def bundle(self, supported: np.ndarray) -> NamedTuple:
        """Arrays of the part for the kernels; supported (s,) are all nodes of the support table, ascending."""


class System(Owner):
    """All moving parts of a run, in the order of their nodes, with ties and steady forces.

    Parameters
    ----------
    parts, ties : of the scene.
    load : (3, n) N and N·m, steady forces and moments of loads.

    Attributes
    ----------
    steady : (3, n) N and N·m, all steady forces that kernels add, or (3, 0) for none.
    turning : the steady forces that rotate with their sides; None if there are none. drag : (n,) 1/s by which the laws
    slow all nodes, over their masses, or (0,) if none do.
    work_before : J, to be added to the work of the present loads from the start on, where they have changed.
    refused : requested cheaper laws that cannot be used, each in a line with the reason. supply_is_plain : whether the
    work of the outside contains no work of forces at rest, which are balanced.
    """

    evolving = ("load", "work_before")
    refused: tuple[str, ...] = ()
    supply_is_plain = True

    def __init__(self, parts: Sequence[Part], ties: Sequence[Tie], load: np.ndarray) -> None:
        self.parts, self.ties = tuple(parts), tuple(ties)
        self.load = load
        self.steady = np.zeros((3, 0))
        self.turning: Followers | None = None
        self.work_before = 0.0
        self.drag = np.zeros(0)

    @property
    def law_name(self) -> str:
        """Name of the law in use, for reports; all parts change it together."""
        return self.parts[-1].law_name

    @property
    def recorded_parts(self) -> tuple[Part, ...]:
        """The parts whose nodes are recorded as particles; by default all."""
        return self.parts

    def laws(self) -> tuple[NamedTuple, ...]:
        """The bundles of all parts."""
        return tuple(part.law() for part in self.parts)

    def bundles(self, supported: np.ndarray) -> tuple[NamedTuple, ...]:
        """The bundles of all ties, see `Tie.bundle`."""
        return tuple(tie.bundle(supported) for tie in self.ties)

    def begin(self, state: State) -> None:
        """Record the first law of the run."""
        state.laws.append((self.law_name, state.step))

    def react(self, why: int, steps: int, state: State) -> None:
        """React to a return of the loop, see `Part.react`; records a change of law."""
        for part in self.parts:
            part.react(why, steps, state)
        if self.law_name != state.laws[-1][0]:
            state.laws.append((self.law_name, state.step))

    def steps_to_look(self, step: int) -> int | None:
        """Steps after which the loop has to return from this one for the system to look at it; None: any number."""
        return None

    def stored(self, u: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) at displacements (3, slots), see `Part.stored`."""
        stored = [part.stored(u) for part in self.parts]
        return sum(first for first, _ in stored), sum(second for _, second in stored)

    def counted(self, u: np.ndarray) -> float:
        """Strain energy (J) at displacements (3, slots) that is counted as taken by damping, see `Part.counted`."""
        return sum(part.counted(u) for part in self.parts)

    def balancing_work(self, u: np.ndarray) -> float:
        """Work (J) up to displacements (3, slots) of forces that balance a settled stress, without their rotation."""
        return 0.0

    def spring_shift(self, u: np.ndarray) -> float:
        """Work (J) up to displacements (3, slots) of the part of the balancing forces that shifts springs to rest."""
        return 0.0

    @property
    def work_of_walls(self) -> float:
        """Work (J) of the walls that move, up to the last whole step; 0 by default."""
        return 0.0

    def wall_samples(self, steps: np.ndarray) -> np.ndarray:
        """Displacement (m) and force (N), along x and y, of and on each wall (k, w, 4) in some of the last steps (k,).

        By default there are no walls.
        """
        return np.zeros((len(steps), 0, 4))

    def joint_samples(self, steps: np.ndarray) -> np.ndarray:
        """Means over each joint (k, j, 6) in some of the last steps (k,), see `new_record`; by default none."""
        return np.zeros((len(steps), 0, 6))

    def joint_segments(self) -> dict[str, tuple[np.ndarray, str]]:
        """Columns of the segments of all joints in the last step, by name: values (s, …) and unit; by default none."""
        return {}

    @property
    def balancing_force(self) -> np.ndarray | None:
        """Forces (3, n) N and N·m that balance a settled stress, without their rotation; None if there are none."""
        return None

    def look(self, u: np.ndarray, step: int, borne: float, energy: float) -> None:
        """Look at displacements (3, slots) of a step for which the ledger is written; by default nothing.

        borne : J, at most 0, by how much less than their work forces at rest have supplied, as they have lifted weight
        and strained the body; energy : J, the larger of the supplied energy and that stored at rest. Raises RunError
        where something has gone wrong.
        """

    def borne(self, supported: np.ndarray) -> np.ndarray:
        """Forces (s, 3) N of springs on relative motion on the nodes (s,) of the support table; by default none."""
        return np.zeros((len(supported), 3))

    def saved(self, state: State) -> tuple[str, ...]:
        """A line for each cheaper law used, with its number of steps."""
        return ()

    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since this was last called; steps : number of steps done."""
        return joined([part.take_cracks(steps) for part in self.parts])

    def blown_up(self, velocity: np.ndarray) -> int | None:
        """A node of an instability that adds energy, if a part detects one; velocity (3, slots) m/s."""
        found = (part.blown_up(velocity) for part in self.parts)
        return next((node for node in found if node is not None), None)

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Fields of every node at displacements (3, n) other than its motion, by name: values (n, …) and unit."""
        each = [part.snapshot(displacement) for part in self.recorded_parts]
        return {name: (np.concatenate([known[name][0] for known in each]), unit) for name, (_, unit) in each[0].items()}

    def snapshot_beside(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Values (m, …) of the nodes after those recorded as particles; by default none."""
        return {}

    def contact_forces(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Columns of the contacts of the whole scene at displacements (3, n), by name: values (b, …) and unit.

        Empty by default, and unless the case requests them.
        """
        return {}

    def saved_arrays(self) -> Arrays:
        """All arrays that change during a run except the motion, by name."""
        saved = {**super().saved_arrays(), "steady": self.steady}
        for each in (*self.parts, *self.ties):
            saved |= {f"{each.name}/{name}": values for name, values in each.saved_arrays().items()}
        return saved

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        super().restore(saved)
        self.steady = saved["steady"].copy()
        for each in (*self.parts, *self.ties):
            each.restore(arrays_of_owner(saved, each.name))
