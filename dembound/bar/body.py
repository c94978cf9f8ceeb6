"""The arrays of a bar, the stability limit of its bonds, and what a run needs: RAM and bytes on disk."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from dembound.bar.layers import EndLayer, continued
from dembound.boundaries.support import Edge, Supports
from dembound.casefile.bar.bar import Bar
from dembound.casefile.bar.model import BarCase
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Rod
from dembound.motion.memory import Storage, for_paraview, largest, must_fit, recorded, total
from dembound.motion.scene import FASTEST, Scene

ROUNDING = 1e-9
"""Share by which a step may exceed its limit, as rounding may shift the limit to either side of a round number."""

BISECTIONS = 60
"""Number of bisections of the bracket of the largest eigenvalue: more than the bits of a float."""


def largest_stable_step(bands: np.ndarray, mass: np.ndarray, held: np.ndarray) -> float:
    """Largest stable step 2/ω_max of central differences, s; infinite where nothing vibrates.

    bands (b, n) N/m: the stiffness matrix, row d contains the entries K[i + d, i]; mass (n,) kg; held (h,) nodes that
    cannot move. ω_max² is the largest eigenvalue of M⁻¹K, the least λ for which λM − K has a Cholesky factor; it is
    found to the last bits by bisection.
    """
    scaled = _by_mass(bands, mass, held)
    sums = np.abs(scaled[0])  # of |entries| of each row: no eigenvalue is larger than all of them (Gershgorin)
    for d, band in enumerate(np.abs(scaled[1:]), start=1):
        sums = sums + band
        sums[d:] += band[:-d]
    low, high = 0.0, float(sums.max())
    if high == 0.0:
        return np.inf
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        low, high = (low, middle) if _is_above(scaled, middle) else (middle, high)
    return float(2.0 / np.sqrt(high))


def is_stable(step: float, bands: np.ndarray, mass: np.ndarray, held: np.ndarray) -> bool:
    """Whether central differences are stable with a time step (s).

    Bands, mass and held nodes as in `largest_stable_step`.
    """
    return _is_above(_by_mass(bands, mass, held), 4.0 / step**2)


def _by_mass(bands: np.ndarray, mass: np.ndarray, held: np.ndarray) -> np.ndarray:
    """Bands of M^(-1/2) K M^(-1/2) (1/s²), without the nodes that are held."""
    root = 1.0 / np.sqrt(mass)
    root[held] = 0.0
    scaled = bands * root
    for d, band in enumerate(scaled):
        band[: len(root) - d] *= root[d:]
        band[len(root) - d :] = 0.0
    return scaled


def _is_above(bands: np.ndarray, value: float) -> bool:
    """Whether a value lies above all eigenvalues of a symmetric banded matrix."""
    from scipy.linalg import LinAlgError, cholesky_banded

    shifted = -bands
    shifted[0] += value
    try:
        cholesky_banded(shifted, lower=True, overwrite_ab=True, check_finite=False)
    except LinAlgError:
        return False
    return True


BLOCK, WIDTH = 2048, 7
"""Steps of a block of the record, and numbers of a node in it."""


def must_fit_here(case: BarCase) -> None:
    """Raise CaseError if a run of a case needs more RAM than is free on this machine, without building it."""
    lengths = case.method.largest_horizon
    horizon = f" with a horizon of {lengths:,} spacings" if lengths > 1 else ""
    must_fit(run_bytes(case), "bar.spacing", f"{case.bar.nodes:,} nodes{horizon}")


def counts_of(case: BarCase) -> dict[str, float]:
    """Numbers of nodes, bonds and records of a run, see `motion.memory.BYTES`."""
    nodes, lengths = float(case.bar.nodes), max(case.method.largest_horizon, 1)
    beyond = case.method.horizon_beyond
    layers = [table.layer.nodes for table in case.boundary.values() if table.layer]
    return {
        "node": nodes,
        "slot": nodes,
        "bond": lengths * nodes,
        "link": (lengths + 1) * nodes,
        "layer_link": sum((beyond + 1.0) * (count + beyond) for count in layers),
        **recorded(len(case.monitor), BLOCK, WIDTH, sum(load.nodes for load in case.load) + 2.0),
    }


def run_bytes(case: BarCase) -> float:
    """Largest RAM (bytes) of a run, with the temporary arrays of its largest moment."""
    counts, snapshots = counts_of(case), case.output.snapshots > 0
    run = ("bar", "bonds", "bar_motion", "ledger", "record", "bar_layer")
    stages = {
        "step": total(counts, "bar", "bonds", "bands"),
        "run": total(counts, *run, opening=case.bar.opens, damage=snapshots),
        "export": total(counts, bar_export=snapshots),
    }
    return largest(stages, case)


def storage_of(case: BarCase) -> Storage:
    """Bytes on disk of the results of a bar."""
    counts, files = counts_of(case), case.output.paraview
    vtu = total(counts, "bar_vtu", bar_vtu_peaks=case.output.peaks)
    return Storage(
        total(counts, "bar_header") + for_paraview(files, 0.0, total(counts, "bar_vtkhdf_header")),
        total(counts, "bar_snapshot") + for_paraview(files, vtu, total(counts, "bar_vtkhdf")),
        total(counts, "bar_state", "bonds"),
    )


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
