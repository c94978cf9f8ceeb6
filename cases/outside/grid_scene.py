"""A scene of a continuum without particles, and its largest stable time step."""

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from dembound.boundaries.support import Edge, SupportBuilder, Supports
from dembound.casefile import Case
from dembound.casefile.tables import Run
from dembound.continuum.part import GridBody, GridPart
from dembound.motion.memory import thread_count_for, total
from dembound.motion.part import System
from dembound.motion.scene import Scene
from dembound.motion.stability import largest_eigenvalue
from dembound.motion.state import Layout


class GridScene(Scene):
    """A continuum without particles.

    Parameters
    ----------
    body : elements, medium and layers, its first slot 0.
    supports : forces from outside on single nodes; by default none.
    load : (3, n) N, steady forces; by default none.
    """

    kind = "continuum"
    energy_unit = "J/m"
    record_width = 6
    block = 1000

    def __init__(self, body: GridBody, *, supports: Supports | None = None, load: np.ndarray | None = None) -> None:
        self.case = Case(run=Run(duration=1.0), name="continuum")
        self.body = body
        self.edges: Mapping[str, Edge] = {}
        self.monitors: Mapping[str, int] = {}
        self.supports = SupportBuilder().table() if supports is None else supports
        self._load = np.zeros((3, body.count)) if load is None else load

    @property
    def count(self) -> int:
        """Number of nodes n."""
        return self.body.count

    @property
    def positions(self) -> np.ndarray:
        """(n, 2) m."""
        return self.body.mesh.positions

    @property
    def size(self) -> np.ndarray:
        """(2,) m."""
        return self.body.mesh.size

    @property
    def mass(self) -> np.ndarray:
        """(n,) kg."""
        return self.body.mass

    @property
    def inertia(self) -> np.ndarray:
        """Moment of inertia (n,) kg·m² of the mass at a distance of 1 m; nodes do not rotate."""
        return self.body.mass

    @property
    def free(self) -> np.ndarray:
        """(3,) all but rotation."""
        return np.array([1.0, 1.0, 0.0])

    @property
    def moves(self) -> np.ndarray:
        """(3, n) bool, False for rotations, and on the outer edges of layers."""
        return super().moves & ~self.body.mesh.held

    @property
    def damp(self) -> float:
        """None."""
        return 0.0

    @property
    def steady_load(self) -> np.ndarray:
        """(3, n) N."""
        return self._load

    @property
    def threads(self) -> int:
        """Number of threads of its steps."""
        return thread_count_for(self.count)

    @cached_property
    def layout(self) -> Layout:
        """The slots of the nodes."""
        return Layout(self.body.blocks.slot, self.body.blocks.end)

    @property
    def largest_memory(self) -> float:
        """Bytes of its motion and its law."""
        law = self.body.law(1.0)
        arrays = (values for bundle in (*law, law) for values in bundle if isinstance(values, np.ndarray))
        return total({"slot": self.layout.count}, "motion") + sum(values.nbytes for values in arrays)

    @property
    def attributes(self) -> dict[str, Any]:
        """None."""
        return {}

    @property
    def columns(self) -> dict[str, tuple[np.ndarray, str]]:
        """None."""
        return {}

    @property
    def places(self) -> dict[str, tuple[float, float]]:
        """None."""
        return {}

    def system(self, time_step: float) -> System:
        """Its part, to be stepped by time_step (s)."""
        supported = np.unique(self.supports.node)
        system = System([GridPart(self.body, time_step, supported=supported)], [], self._load)
        if self._load.any():
            system.steady = self._load
        return system


def step_limit(body: GridBody) -> float:
    """Largest stable step 2/ω_max (s) of central differences of a continuum only, with its layers' delay τ.

    The layers' convolution variables are not counted: they make no step unstable that is stable without them.
    """
    slot = body.blocks.slot - body.first_slot
    layout = Layout(slot, body.blocks.end - body.first_slot)
    moves = np.stack([~body.mesh.held] * 2 + [np.zeros_like(body.mesh.held)])
    mass = body.mass_for_limit
    return float(
        2.0 / np.sqrt(largest_eigenvalue(layout, mass, mass, np.array([1.0, 1.0, 0.0]), moves, body.fill_forces))
    )
