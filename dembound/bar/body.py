"""The arrays of a bar."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from dembound.bar.banded import is_stable, largest_stable_step
from dembound.bar.memory import run_bytes
from dembound.boundaries.support import Edge, Supports
from dembound.casefile.bar import BarCase
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Rod
from dembound.motion.scene import Scene


@dataclass(frozen=True)
class BarBody(Scene):
    """A bar of n nodes, all SI; its displacements and velocities fill the first row of the (3, n) state arrays.

    Attributes
    ----------
    case : the case it was built from.
    rod : nodes, section and stiffness.
    nodes : (n, 2) m, their places, with y = 0.
    edges : the two ends, left and right; the "diameter" of an end node is the section.
    supports : the table of forces from outside, loads included.
    monitors : name -> node.

    Stress is the seventh column of a probe's record. Blocks contain many steps, as a step takes little time.
    """

    case: BarCase
    rod: Rod
    nodes: np.ndarray
    edges: Mapping[str, Edge]
    supports: Supports
    monitors: Mapping[str, int]

    kind = "bar"
    energy_unit = "J"
    record_width = 7
    block = 2048

    @property
    def attributes(self) -> dict[str, Any]:
        """The attributes of a record's header in addition to those of every run.

        Density in kg/m³, section in m², wave speed in m/s, attenuation in 1/m, which end is loaded, and the types of
        the left and the right end.
        """
        bar = self.case.bar
        return {
            "density": bar.density,
            "section": self.rod.ranges[0].section,
            "wave_speed": bar.speed,
            "attenuation": bar.attenuation,
            "loaded": self.case.loaded,
            "ends": [self.case.boundary[side].type if side in self.case.boundary else "free" for side in self.edges],
        }

    @property
    def columns(self) -> dict[str, tuple[np.ndarray, str]]:
        """Data of every node for the record, by name: values (n, …) and unit."""
        return {"position": (self.positions, "m"), "volume": (self.rod.volumes, "m³")}

    @property
    def places(self) -> dict[str, tuple[float, float]]:
        """The positions given for the monitors, m."""
        return {monitor.name: (monitor.position, 0.0) for monitor in self.case.monitor}

    @property
    def count(self) -> int:
        """Number of nodes n."""
        return self.rod.count

    @property
    def size(self) -> np.ndarray:
        """(2,) length and height of the scene, m; the latter is 0."""
        return np.array([self.case.bar.length, 0.0])

    @cached_property
    def mass(self) -> np.ndarray:
        """(n,) kg; half at the ends."""
        return self.rod.mass

    @cached_property
    def inertia(self) -> np.ndarray:
        """(n,) kg·m² of thin slices as long as the spacing; they do not turn."""
        return self.rod.summed(lambda part: part.density * part.volumes * part.spacing**2 / 12.0)

    @property
    def free(self) -> np.ndarray:
        """(3,) 1 for a component that moves: only x."""
        return np.array([1.0, 0.0, 0.0])

    @property
    def steady_load(self) -> np.ndarray:
        """(3, n) N: zero, as every load of a bar follows a wave."""
        return np.zeros((3, self.count))

    @property
    def positions(self) -> np.ndarray:
        """(n, 2) m, with y = 0."""
        return self.nodes

    @property
    def damp(self) -> float:
        """No local damping."""
        return 0.0

    @property
    def threads(self) -> int:
        """One: a step of a bar takes less time than the synchronisation of threads."""
        return 1

    def step_limit(self) -> float:
        """Largest time step (s) that is stable at every stage of the case's method."""
        return min(self.stable_step(bonds) for bonds in self.case.method.stages(self.rod))

    def stable_step(self, bonds: Bonds) -> float:
        """Largest stable time step (s) with these bonds."""
        return largest_stable_step(bonds.stiffness(), self.mass, self._held)

    def is_stable(self, bonds: Bonds, step: float) -> bool:
        """Whether a time step (s) is stable with these bonds; faster than `stable_step`."""
        return is_stable(step, bonds.stiffness(), self.mass, self._held)

    @cached_property
    def _held(self) -> np.ndarray:
        """Nodes (h,) whose velocity is prescribed."""
        return self.supports.node[self.supports.prescribed & (self.supports.component == 0)]

    @property
    def largest_memory(self) -> float:
        """Largest memory (bytes) of a run."""
        return run_bytes(self.case)
