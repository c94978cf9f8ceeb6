"""The arrays of a bar."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from dembound.bar.banded import is_stable, largest_stable_step
from dembound.bar.layers import EndLayer, continued
from dembound.bar.memory import run_bytes
from dembound.boundaries.support import Edge, Supports
from dembound.casefile.bar import BarCase
from dembound.casefile.bar.bar import Bar
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Rod
from dembound.motion.scene import FASTEST, Scene


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
    layers : side -> layer of nodes beyond it; these are no nodes of the scene (layers.py).

    Stress is the seventh column of a probe's record. Blocks contain many steps, as a step takes little time.
    """

    case: BarCase
    rod: Rod
    nodes: np.ndarray
    edges: Mapping[str, Edge]
    supports: Supports
    monitors: Mapping[str, int]
    layers: Mapping[str, EndLayer]

    kind = "bar"
    energy_unit = "J"
    record_width = 7
    in_snapshots = ("stress", "damage")
    block = 2048

    @property
    def attributes(self) -> dict[str, Any]:
        """Additional attributes of a record's header for bars: loaded end, and types of the left and the right end.

        For a bar without ranges they include its material, with the names of `attributes_of_monitor`.
        """
        uniform = {} if self.case.bar.range else _attributes_of(self.case.bar)
        return uniform | {
            "loaded": self.case.loaded,
            "ends": [self.case.boundary[side].type if side in self.case.boundary else "free" for side in self.edges],
        }

    def attributes_of_monitor(self, name: str) -> dict[str, Any]:
        """At a monitor's node: density kg/m³, section m², Young's modulus Pa, wave speed m/s, attenuation 1/m.

        The strength (Pa) is given at the slowest and at the fastest strain rate, infinite where nothing breaks. At an
        interface the range on the left counts; with ranges also their name.
        """
        bar, node = self.case.bar, self.monitors[name]
        number = next(k for k, part in enumerate(self.rod.ranges) if node <= part.last)
        named = {"range": bar.range[number].name} if bar.range else {}
        return named | _attributes_of(bar.parts[number])

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
    def tied(self) -> dict[str, np.ndarray]:
        """Nodes (k,) whose bonds reach into layers, by side."""
        return {side: np.sort(layer.inner) for side, layer in self.layers.items()}

    @property
    def against_growth(self) -> str:
        """A smaller step."""
        return "a smaller run.safety, run.courant or run.time_step"

    @property
    def damp(self) -> float:
        """Local damping coefficient: 0."""
        return 0.0

    @property
    def threads(self) -> int:
        """Number of threads: 1, as a step of a bar takes less time than their synchronisation."""
        return 1

    @property
    def first_velocity(self) -> np.ndarray | None:
        """(3, n) m/s at the start, None without moving ranges; a node that two share has the momentum of both."""
        if not any(given.velocity for given in self.case.bar.range):
            return None
        momentum = np.zeros(self.count)
        for given, part in zip(self.case.bar.range, self.rod.ranges, strict=False):
            momentum[part.nodes] += given.velocity * part.density * part.volumes
        velocity = np.zeros((3, self.count))
        velocity[0] = momentum / self.mass
        return velocity

    @property
    def fastest(self) -> float:
        """Speed (m/s) that no node can reach, see `Scene.fastest`; with moving ranges the limit of the number range."""
        return FASTEST if any(given.velocity for given in self.case.bar.range) else super().fastest

    def step_limit(self) -> float:
        """Largest time step (s) that is stable at every stage of the case's method."""
        return min(self.stable_step(bonds) for bonds in self.case.method.stages(self.rod))

    def stable_step(self, bonds: Bonds) -> float:
        """Largest stable time step (s) with these bonds."""
        decays = (layer.step_limit for layer in self.layers.values())
        return min(largest_stable_step(*self._with_layers(bonds)), *decays, np.inf)

    def is_stable(self, bonds: Bonds, step: float) -> bool:
        """Whether a time step (s) is stable with these bonds; computed faster than `stable_step`."""
        decays = all(step <= layer.step_limit for layer in self.layers.values())
        return decays and is_stable(step, *self._with_layers(bonds))

    def _with_layers(self, bonds: Bonds) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Stiffness bands, masses and held nodes of the bar with these bonds and its layers."""
        return continued(self.layers, bonds.stiffness(), self.mass, self._held)

    @cached_property
    def _held(self) -> np.ndarray:
        """Nodes (h,) whose velocity is prescribed."""
        return self.supports.node[self.supports.prescribed & (self.supports.component == 0)]

    @property
    def largest_memory(self) -> float:
        """Largest RAM (bytes) of a run."""
        return run_bytes(self.case)


def _attributes_of(part: Bar) -> dict[str, Any]:
    """The material of a uniform bar, SI units; its strength at the slowest and at the fastest strain rate."""
    return {
        "density": part.density,
        "section": part.area,
        "youngs_modulus": part.modulus,
        "wave_speed": part.speed,
        "attenuation": part.attenuation,
        "strength": [part.breaking_stretch * part.modulus, part.largest_strength],
    }
