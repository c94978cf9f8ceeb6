"""A run and what it is made of in numbers, for scripts."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from dembound import __version__
from dembound.any_scene import AnyScene
from dembound.bar.scene import BarScene
from dembound.bar.summary import summarise_bar
from dembound.boundaries.support import Edge
from dembound.boundaries.viscoelastic import Springs
from dembound.results import energy_of, open_record
from dembound.scene import Scene, boundary_medium
from dembound.simulate import Simulation
from dembound.static import Settled


@dataclass(frozen=True)
class Plan:
    """What a case comes to before its first step: the scene, the step and its limit (s), the number of steps."""

    scene: AnyScene
    time_step: float
    step_limit: float
    steps: int


def summarise(
    planned: Plan, simulation: Simulation, settled: Settled | None, record: Path, wall_time: float
) -> dict[str, Any]:
    """The run in numbers, for scripts: plain JSON values, SI units."""
    scene = planned.scene
    common = {
        "name": scene.case.name,
        "title": scene.case.title,
        "version": __version__,
        "time_step": planned.time_step,
        "step_limit": planned.step_limit if np.isfinite(planned.step_limit) else None,
        "steps": simulation.steps,
        "duration": simulation.time,
        "wall_time": wall_time,
        "threads": scene.threads,
        "particle_steps_per_second": scene.count * simulation.steps / wall_time,
        "memory_bytes": scene.bytes,
        "laws": [{"law": name, "from": step * simulation.time_step} for name, step in simulation.laws],
        "cracks": _count_cracks(record),
        "energy": _describe_energy(record),
        "monitors": _describe_monitors(record),
        "reduced": [],
    }
    if isinstance(scene, BarScene):
        return common | summarise_bar(scene, simulation, record)
    return common | {
        "particles": scene.count,
        "contacts": len(scene.assembly.pairs),
        "loose_disks_left_out": scene.assembly.loose,
        "static": None if settled is None else _describe_static(settled, _asked(scene)),
        "packing": describe_packing(scene),
        "boundaries": {side: _describe_edge(scene, simulation, side) for side in scene.edges},
    }


def _asked(scene: Scene) -> list[float] | None:
    """The stress (Pa) that the static stage was asked for, if any."""
    static = scene.case.static
    return None if static is None or static.stress is None else list(static.stress)


def _describe_static(settled: Settled, asked: list[float] | None) -> dict[str, Any]:
    """The static stage: steps, force ratio, forces (N) carried by supports and tractions and left, stress (Pa).

    And the same of the free-field column alone, if there is one, and before an excavation, if there was one.
    """
    return {
        "steps": settled.steps,
        "ratio": settled.ratio,
        "carried": settled.carried,
        "left": settled.left,
        "stress": settled.stress.tolist(),
        "asked": asked,
        "cracks": len(settled.cracks),
        "column": None if settled.column is None else _describe_static(settled.column, None),
        "before": None if settled.before is None else _describe_static(settled.before, asked),
    }


def _count_cracks(record: Path) -> dict[str, int]:
    """Bonds that broke, in tension and in shear, those of the static stage included."""
    with open_record(record) as file:
        shear = file["cracks/shear"][:]
    return {"tension": int(np.count_nonzero(~shear)), "shear": int(np.count_nonzero(shear))}


def _describe_energy(record: Path) -> dict[str, float]:
    """Last entry of the ledger (J/m), and the largest error of any over what came in from outside at most."""
    with open_record(record) as file:
        columns = energy_of(file)
    last = {name: float(column[-1]) for name, column in columns.items()}
    return last | {"relative_error": float(np.abs(columns["relative_error"]).max())}


def describe_packing(scene: Scene) -> dict[str, Any]:
    """The brick in numbers: stresses and stiffnesses in Pa, speeds along x in m/s (null where the motion is held)."""
    ground, brick = scene.ground, scene.ground.brick
    tensor = ground.material_tensor
    p_speed, s_speed = ground.wave_speeds(0)
    return {
        "disks_per_brick": len(brick.radii),
        "mean_diameter": brick.mean_diameter,
        "solid_fraction": brick.solid_fraction,
        "coordination": brick.coordination,
        "residual_ratio": brick.residual_ratio,
        "stress": (brick.stress * ground.moduli.emod).tolist(),
        "emod": ground.moduli.emod,
        "pb_emod": ground.moduli.pb_emod,
        "C11": tensor[0, 0],
        "C22": tensor[1, 1],
        "C12": tensor[0, 1],
        "C66": tensor[3, 3],
        "p_wave_speed": None if np.isnan(p_speed) else p_speed,
        "s_wave_speed": None if np.isnan(s_speed) else s_speed,
    }


def describe_side(scene: Scene, side: str) -> dict[str, Any]:
    """One side in numbers: type, particles, diameters (m), ΣD/H, the factors β and whether masses are halved.

    Of springs their factors α, modulus G (Pa) and distances L (m).
    """
    edge = scene.edges[side]
    table = scene.case.boundary.get(side)
    described: dict[str, Any] = {
        "type": table.type if table is not None else "free",
        "particles": len(edge.nodes),
        "length": edge.length,
        "diameter_min": edge.diameters.min(),
        "diameter_mean": edge.diameters.mean(),
        "diameter_max": edge.diameters.max(),
        "cover": edge.cover,
    }
    for key in ("beta_p", "beta_s", "half_mass"):
        if hasattr(table, key):
            described[key] = getattr(table, key)
    return described | (_describe_springs(scene, edge, table) if isinstance(table, Springs) else {})


def _describe_springs(scene: Scene, edge: Edge, springs: Springs) -> dict[str, float]:
    """Springs of a side in numbers."""
    distances = springs.distances(edge)
    return {
        "alpha_n": springs.alpha_n,
        "alpha_s": springs.alpha_s,
        "shear_modulus": springs.shear_modulus(boundary_medium(scene.case, scene.ground, edge.axis)),
        "distance_min": distances.min(),
        "distance_max": distances.max(),
    }


def _describe_edge(scene: Scene, simulation: Simulation, side: str) -> dict[str, Any]:
    """A side in numbers, with mean and standard deviation of its particles' largest |velocity| in x and y."""
    described = describe_side(scene, side)
    largest = np.abs(simulation.edge_peaks(side)[:, :2]).max(axis=2)
    described["peak_velocity"] = largest.mean(axis=0).tolist()
    described["peak_velocity_deviation"] = largest.std(axis=0).tolist()
    return described


def _describe_monitors(record: Path) -> dict[str, Any]:
    """Peaks and arrivals of every history."""
    with open_record(record) as file:
        groups: Mapping[str, h5py.Group] = file.get("histories", {})
        return {
            name: {
                "particle": int(group.attrs["particle"]),
                "position": group.attrs["position"].tolist(),
                **arrival(group["time"][:], group["velocity"][:, :2]),
                "peak_displacement": np.abs(group["displacement"][:, :2]).max(axis=0).tolist(),
            }
            for name, group in groups.items()
        }


def arrival(time: np.ndarray, velocity: np.ndarray) -> dict[str, Any]:
    """Largest motion of a history and when it came.

    time (k,) s, velocity (k, 2) m/s. Taken from the component that moves most: `peak_velocity` (signed),
    `peak_time`, and `arrival`, the moment |velocity| first passes half its peak, interpolated; null at rest.
    """
    axis = int(np.argmax(np.abs(velocity).max(axis=0)))
    speed = np.abs(velocity[:, axis])
    crest = int(np.argmax(speed))
    half = 0.5 * speed[crest]
    if half == 0.0:
        return {"component": "xy"[axis], "peak_velocity": 0.0, "peak_time": None, "arrival": None}
    first = int(np.argmax(speed >= half))
    passed = time[first]
    if first > 0:
        part = (half - speed[first - 1]) / (speed[first] - speed[first - 1])
        passed = time[first - 1] + part * (time[first] - time[first - 1])
    return {
        "component": "xy"[axis],
        "peak_velocity": float(velocity[crest, axis]),
        "peak_time": float(time[crest]),
        "arrival": float(passed),
    }
