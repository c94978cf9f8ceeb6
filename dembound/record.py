"""The recorder: a run in one HDF5 file. Pictures, VTU files and reports are made from that file alone.

Layout of ``run.h5`` (units stand as attribute ``unit`` on every dataset)::

    /                       attributes: case, name, version, seed, time_step, step_limit, steps, complete, …
    particles/              position (n, 2), radius (n,), brick_particle (n,)
    histories/<monitor>/    time (k,), displacement (k, 3), velocity (k, 3); attributes particle, position, wanted
    boundaries/<side>/      particle, position, diameter, peak_velocity (q, 3, 2)
    snapshots/<number>/     displacement (n, 3), velocity (n, 3), the latter half a step earlier; attribute time
"""

from pathlib import Path
from types import TracebackType

import h5py
import numpy as np

from dembound import __version__
from dembound.simulate import Simulation

DISPLACEMENT_UNIT = "m, m, rad"
VELOCITY_UNIT = "m/s, m/s, rad/s"


class Recorder:
    """Writes one run, appending as it goes; ``complete`` turns true only when the run is over.

    Parameters
    ----------
    path : file to create.
    simulation : the run to record; its first probes are the monitors in their order.
    step_limit : stability limit in s, kept for the record.
    interval : time between two history samples in s; 0 keeps every step.
    """

    def __init__(self, path: Path, simulation: Simulation, step_limit: float, interval: float) -> None:
        self.simulation = simulation
        self.stride = max(1, round(interval / simulation.time_step))
        self.file = h5py.File(path, "w")
        self._write_header(step_limit)
        self._write_particles()
        self._histories = self._make_histories()
        self._done = 0
        self._snapshots = 0

    def __enter__(self) -> "Recorder":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self._write_boundaries()
        self.file.attrs["steps"] = self.simulation.steps
        self.file.attrs["complete"] = kind is None
        self.file.close()

    def append(self, record: np.ndarray) -> None:
        """Keep a block's probe record (k, p, 6), of which every stride-th step."""
        count = len(record)
        first = -self._done % self.stride
        rows = np.arange(first, count, self.stride)
        times = (self._done + rows) * self.simulation.time_step
        for index, group in enumerate(self._histories):
            _extend(group["time"], times)
            _extend(group["displacement"], record[rows, index, :3])
            _extend(group["velocity"], record[rows, index, 3:])
        self._done += count
        self.file.flush()

    def snapshot(self) -> None:
        """Keep the whole scene as it is now."""
        group = self.file.create_group(f"snapshots/{self._snapshots:04d}")
        group.attrs["time"] = self.simulation.time
        _write(group, "displacement", self.simulation.displacement.T, DISPLACEMENT_UNIT)
        _write(group, "velocity", self.simulation.velocity.T, VELOCITY_UNIT)
        self._snapshots += 1

    def _write_header(self, step_limit: float) -> None:
        scene, case = self.simulation.scene, self.simulation.scene.case
        self.file.attrs.update(
            {
                "name": case.name,
                "title": case.title,
                "case": case.text,
                "version": __version__,
                "seed": getattr(case.packing, "seed", 0),
                "time_step": self.simulation.time_step,
                "step_limit": step_limit,
                "size": scene.assembly.size,
                "complete": False,
            }
        )

    def _write_particles(self) -> None:
        assembly = self.simulation.scene.assembly
        group = self.file.create_group("particles")
        _write(group, "position", assembly.positions, "m")
        _write(group, "radius", assembly.radii, "m")
        _write(group, "brick_particle", assembly.brick_particle, "1")

    def _make_histories(self) -> list[h5py.Group]:
        scene = self.simulation.scene
        wanted = {monitor.name: monitor.position for monitor in scene.case.monitor}
        histories = self.file.create_group("histories", track_order=True)  # the case's order, not the alphabet's
        groups = []
        for name, node in scene.monitors.items():
            group = histories.create_group(name)
            group.attrs["particle"] = node
            group.attrs["position"] = scene.assembly.positions[node]
            group.attrs["wanted"] = wanted[name]
            group.attrs["unit"] = "m"
            for dataset, width, unit in (
                ("time", (), "s"),
                ("displacement", (3,), DISPLACEMENT_UNIT),
                ("velocity", (3,), VELOCITY_UNIT),
            ):
                made = group.create_dataset(dataset, shape=(0, *width), maxshape=(None, *width), dtype="f8")
                made.attrs["unit"] = unit
            groups.append(group)
        return groups

    def _write_boundaries(self) -> None:
        scene = self.simulation.scene
        for side, edge in scene.edges.items():
            group = self.file.create_group(f"boundaries/{side}")
            group.attrs["length"] = edge.length
            group.attrs["cover"] = edge.cover
            _write(group, "particle", edge.nodes, "1")
            _write(group, "position", scene.assembly.positions[edge.nodes], "m")
            _write(group, "diameter", edge.diameters, "m")
            _write(group, "peak_velocity", self.simulation.edge_peaks(side), VELOCITY_UNIT)


def _write(group: h5py.Group, name: str, values: np.ndarray, unit: str) -> None:
    group.create_dataset(name, data=values).attrs["unit"] = unit


def _extend(dataset: h5py.Dataset, values: np.ndarray) -> None:
    count = len(dataset)
    dataset.resize(count + len(values), axis=0)
    dataset[count:] = values
