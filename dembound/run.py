"""One case, from tables to a folder of results."""

import json
import shutil
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from dembound import __version__
from dembound.case import Case
from dembound.errors import CaseError
from dembound.export import write_vtu
from dembound.plot.histories import plot_histories
from dembound.plot.scene import plot_scene
from dembound.plot.style import save
from dembound.record import Recorder
from dembound.results import open_record
from dembound.scene import Scene, build, ground_of
from dembound.simulate import Simulation
from dembound.stability import choose_step
from dembound.threads import worthwhile_threads

Progress = Callable[[Simulation, int], None]
"""Called after every block with the simulation and the number of steps it will do in all."""


@dataclass(frozen=True)
class Plan:
    """What a case comes to before its first step: the scene, the step and its limit (s), the number of steps."""

    scene: Scene
    time_step: float
    step_limit: float
    steps: int


def plan(case: Case) -> Plan:
    """Build the scene and choose the step.

    Raises PackingError for an impossible brick and CaseError for a step above the stability limit.
    """
    try:
        scene = build(case)
        _ = scene.ground.material_tensor  # the summary needs it: a singular material must not end a finished run
        time_step, limit = choose_step(scene)
    except CaseError as error:
        raise CaseError(error.problems, case.name) from None
    return Plan(scene, time_step, limit, max(1, int(np.ceil(case.run.duration / time_step - 1e-9))))


def foresee(case: Case) -> None:
    """Find what would stop a case later, as far as it can be found cheaply.

    Packs its brick, which is then cached, and compares a given time step with the stability limit. Raises CaseError
    and PackingError.
    """
    if case.run.time_step == "auto":
        _ = ground_of(case).material_tensor
    else:
        plan(case)


def run_case(case: Case, results: Path, on_block: Progress | None = None) -> Path:
    """Run a case and leave ``results/<case name>/``; returns that folder.

    Everything is written to ``<case name>.partial`` first and takes its name when the run is complete, so a
    finished folder is always whole. A run that fails leaves the partial folder with the histories so far.

    Raises the errors of `plan`, and RunError when the motion grows without bound.
    """
    planned = plan(case)
    folder, partial = results / case.name, results / f"{case.name}.partial"
    for old in (folder, partial):
        _must_be_replaceable(old)
    if partial.exists():
        shutil.rmtree(partial)
    partial.mkdir(parents=True)
    began = time.perf_counter()
    simulation = _simulate(planned, partial / "run.h5", on_block)
    wall_time = time.perf_counter() - began
    summary = summarise(planned, simulation, partial / "run.h5", wall_time)
    (partial / "summary.json").write_text(json.dumps(summary, indent=2) + "\n")
    write_vtu(partial / "run.h5", partial / "paraview")
    if case.output.pictures:
        save(plot_scene(partial / "run.h5"), partial / "scene.png")
        if case.monitor:
            save(plot_histories([partial / "run.h5"]), partial / "histories.png")
    if folder.exists():
        shutil.rmtree(folder)
    partial.rename(folder)
    return folder


def _must_be_replaceable(folder: Path) -> None:
    """Raise CaseError where a new run would delete something that no run has written."""
    if folder.exists() and not (folder / "run.h5").is_file():
        raise CaseError([f"{folder}: exists and holds no run, give another --output or --name"])


def _simulate(planned: Plan, path: Path, on_block: Progress | None) -> Simulation:
    """Advance to the end, recording histories, snapshots and boundary peaks."""
    case = planned.scene.case
    monitors = np.array(list(planned.scene.monitors.values()), dtype=np.int64)
    simulation = Simulation(planned.scene, planned.time_step, monitors)
    count = min(max(1, case.output.snapshots), planned.steps)
    with Recorder(path, simulation, planned.step_limit, case.output.history_interval) as recorder:

        def keep(simulation: Simulation, record: np.ndarray) -> None:
            recorder.append(record)
            if on_block is not None:
                on_block(simulation, planned.steps)

        for number in range(1, count + 1):
            simulation.run(planned.steps * number // count, keep)
            recorder.snapshot()
    return simulation


def summarise(planned: Plan, simulation: Simulation, record: Path, wall_time: float) -> dict[str, Any]:
    """The run in numbers, for scripts: plain JSON values, SI units."""
    scene = planned.scene
    return {
        "name": scene.case.name,
        "title": scene.case.title,
        "version": __version__,
        "particles": scene.count,
        "contacts": len(scene.assembly.pairs),
        "loose_disks_left_out": scene.assembly.loose,
        "time_step": planned.time_step,
        "step_limit": planned.step_limit if np.isfinite(planned.step_limit) else None,
        "steps": simulation.steps,
        "duration": simulation.time,
        "wall_time": wall_time,
        "threads": worthwhile_threads(scene.count),
        "particle_steps_per_second": scene.count * simulation.steps / wall_time,
        "memory_bytes": scene.bytes,
        "packing": describe_packing(scene),
        "boundaries": {side: _describe_edge(scene, simulation, side) for side in scene.edges},
        "monitors": _describe_monitors(record),
        "reduced": [],
    }


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
    """One side in numbers: type, particles, diameters (m), ΣD/H and the factors β."""
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
    for factor in ("beta_p", "beta_s"):
        if hasattr(table, factor):
            described[factor] = getattr(table, factor)
    return described


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
