"""Parts and ties: what moves, each part a range of the nodes under a law of its own, and what couples them."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from dembound.kernels.tables import Followers
from dembound.motion.cracks import Cracks, joined
from dembound.motion.state import Arrays, State, within


class Part(ABC):
    """Nodes that move under one law.

    Attributes
    ----------
    name : what the state and messages call it.
    nodes : its nodes, a range of the scene's.
    law_name : what reports call the law in use.
    """

    name: str
    nodes: slice
    law_name: str

    @abstractmethod
    def law(self) -> NamedTuple:
        """The bundle of arrays that its law is; the type chooses the compiled code, see kernels/law.py."""

    @abstractmethod
    def react(self, why: int, steps: int, state: State) -> None:
        """Go on after the loop has done so many steps and returned for a reason, see kernels/common.py."""

    @abstractmethod
    def stored(self, displacement: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) at displacements (3, n): in contacts and in bonds, of a bar in springs and in bonds."""

    @abstractmethod
    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since this was last called; steps : those done by now."""

    @abstractmethod
    def memory(self) -> Arrays:
        """All that evolves in it, by name."""

    @abstractmethod
    def recall(self, memory: Arrays) -> None:
        """Take over what `memory` has returned in another run of the same case."""

    def blown_up(self, velocity: np.ndarray) -> int | None:
        """The node at which the run gains energy from nothing, where the part can see that; velocity (3, n) m/s."""
        return None

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """What is known of its nodes at displacements (3, n) beside their motion, by name: values (m, …) and unit."""
        return {}


class Tie(ABC):
    """What couples nodes of two parts."""

    @property
    @abstractmethod
    def nodes(self) -> np.ndarray:
        """Nodes (k,) that it acts on, ascending; the support table moves them."""

    @abstractmethod
    def bundle(self, supported: np.ndarray) -> NamedTuple:
        """Its arrays for the kernels; supported (s,) are all nodes of the support table, ascending."""


class System:
    """All that moves in a run: parts that make up the nodes in their order, ties, and steady forces.

    Parameters
    ----------
    parts, ties : those of the scene.
    load : (3, n) N and N·m, steady forces and moments of loads.

    Attributes
    ----------
    steady : (3, n) N and N·m, all steady forces that kernels add, or (3, 0) for none.
    turning : forces among them that turn with their sides; None: there are none.
    """

    def __init__(self, parts: Sequence[Part], ties: Sequence[Tie], load: np.ndarray) -> None:
        self.parts, self.ties = tuple(parts), tuple(ties)
        self.load = load
        self.steady = np.zeros((3, 0))
        self.turning: Followers | None = None

    @property
    def law_name(self) -> str:
        """What reports call the law in use; all parts change it together."""
        return self.parts[-1].law_name

    def laws(self) -> tuple[NamedTuple, ...]:
        """The bundles of all parts."""
        return tuple(part.law() for part in self.parts)

    def bundles(self, supported: np.ndarray) -> tuple[NamedTuple, ...]:
        """Those of all ties, see `Tie.bundle`."""
        return tuple(tie.bundle(supported) for tie in self.ties)

    def begin(self, state: State) -> None:
        """Enter the law that the run begins with."""
        state.laws.append((self.law_name, state.step))

    def react(self, why: int, steps: int, state: State) -> None:
        """Go on after the loop has done so many steps and returned for a reason; enters a law that has changed."""
        for part in self.parts:
            part.react(why, steps, state)
        if self.law_name != state.laws[-1][0]:
            state.laws.append((self.law_name, state.step))

    def stored(self, displacement: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) at displacements (3, n), see `Part.stored`."""
        stored = [part.stored(displacement) for part in self.parts]
        return sum(first for first, _ in stored), sum(second for _, second in stored)

    def balancing_work(self, displacement: np.ndarray) -> float:
        """Work (J) up to displacements (3, n) of what balances the stress of a settled body, without its turning."""
        return 0.0

    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since this was last called; steps : those done by now."""
        return joined([part.take_cracks(steps) for part in self.parts])

    def blown_up(self, velocity: np.ndarray) -> int | None:
        """A node at which the run gains energy from nothing, if a part can see one; velocity (3, n) m/s."""
        found = (part.blown_up(velocity) for part in self.parts)
        return next((node for node in found if node is not None), None)

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """What is known of every node at displacements (3, n) beside its motion, by name: values (n, …) and unit."""
        each = [part.snapshot(displacement) for part in self.parts]
        return {name: (np.concatenate([known[name][0] for known in each]), unit) for name, (_, unit) in each[0].items()}

    def memory(self) -> Arrays:
        """All that evolves in it beside the motion, by name."""
        memory: dict[str, np.ndarray] = {"load": self.load, "steady": self.steady}
        for part in self.parts:
            memory |= {f"{part.name}/{name}": values for name, values in part.memory().items()}
        return memory

    def recall(self, memory: Mapping[str, Any]) -> None:
        """Take over what `memory` has returned in another run of the same case."""
        self.load, self.steady = memory["load"].copy(), memory["steady"].copy()
        for part in self.parts:
            part.recall(within(memory, part.name))
