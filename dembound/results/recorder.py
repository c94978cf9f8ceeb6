"""The recorder: writes a run to one HDF5 file. Pictures, VTU files and reports are made only from that file.

Layout of ``run.h5`` (every dataset of numbers has its unit as attribute ``unit``)::

    /                       attributes: case, name, kind ("disks", "bar"), version, size, time_step, step_limit, steps,
                            complete; of disks seed, of a bar density, section, wave_speed, attenuation, loaded,
                            the end that is, and ends, the types of the left and the right one
    particles/              position (n, 2); of disks radius (n,), brick_particle (n,), bonds (n,) of each at the start,
                            of a bar's nodes volume (n,); if the case asks for it peak_velocity (n,), the largest speed
                            of each in the whole run
    histories/<monitor>/    time (k,), displacement (k, 3), velocity (k, 3), on a bar stress (k,); attributes particle,
                            position, wanted
    boundaries/<side>/      particle, position, diameter (of a bar's end its section), peak_velocity (q, 3, 2)
    snapshots/<number>/     displacement (n, 3), velocity (n, 3), the latter half a step earlier; coordination (n,)
                            under a history-dependent law; stress (n, 3) if the case asks for it; on a bar stress (n,)
                            and local damage (n,); of a static stage that stalled unbalanced (n, 2), sum of the forces
                            on each particle; attribute time
    energy/                 time and the columns of `motion.energy.Entry`, (k,) each
    cracks/                 time (k,), position (k, 2), particles (k, 2), shear (k,), in the order they happened; like
                            displacements, positions count from the start of the run
    laws/                   name (l,) of each law or method used and time (l,) it began at
    static/ attributes: results of the static stage, if there was one; displacement (n, 3) at its end static/before/ the
    same before an excavation, of the particles that are left by it
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import fields
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

import numpy as np

from dembound.motion.cracks import Cracks, joined
from dembound.motion.energy import Entry, Ledger
from dembound.motion.kind import Stage, StalledError
from dembound.motion.trackers import NEVER, Run, Tracker
from dembound.version import __version__

if TYPE_CHECKING:
    import h5py

DISPLACEMENT_UNIT = "m, m, rad"
VELOCITY_UNIT = "m/s, m/s, rad/s"

KEPT_BYTES, KEPT_SECONDS = 2**20, 10.0
"""Samples and cracks are kept in memory until the samples have this size, or for this long.

Thousands of small writes take longer than all steps of a small scene.
"""


class Recorder:
    """Writes one run, appending during the run; ``complete`` becomes true only at its end.

    At the end of its ``with`` statement the file has everything that was recorded, also after an error or Ctrl-C.

    Parameters
    ----------
    path : file to create.
    run : the run to record, of whose whole scene all nodes are written; its first probes are the monitors in order.
    step_limit : stability limit in s, written to the record.
    interval : time between two history samples in s; 0: every step is recorded. ledger : the run's energy ledger,
    written at the end; None: without a ledger. stages : those before the run.
    """

    def __init__(
        self,
        path: Path,
        run: Run,
        step_limit: float,
        interval: float = 0.0,
        ledger: Ledger | None = None,
        stages: Sequence[Stage] = (),
    ) -> None:
        import h5py

        self.run = run
        self.scene = run.scene.whole
        self.ledger = ledger
        self.stride = max(1, round(interval / run.time_step))
        self.file = h5py.File(path, "w")
        self._write_header(step_limit)
        self._write_particles()
        self._histories = self._make_histories()
        self._cracks = self._make_cracks()
        for stage in stages:
            self._write_stage(stage)
        self._snapshots = 0
        self._times: list[np.ndarray] = []
        self._samples: list[np.ndarray] = []
        self._broken: list[Cracks] = []
        self.flush()

    def __enter__(self) -> Recorder:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.flush()
        if kind is None:
            self._write_boundaries()
            self._write_peaks()
            self._write_energy()
        self._write_laws()
        self.file.attrs["steps"] = self.run.state.step
        self.file.attrs["complete"] = kind is None
        self.file.close()

    def append(self, record: np.ndarray) -> None:
        """Take every stride-th of the last steps; record : of the probes, see `Simulation.advance`."""
        state, step = self.run.state, self.run.time_step
        begun = state.step - len(record)
        rows = np.arange(-begun % self.stride, len(record), self.stride)
        self._times.append((begun + rows) * step)
        self._samples.append(self.run.scene.observed(record[rows]))
        self._broken.append(self.run.system.take_cracks(state.step))
        kept = sum(samples.nbytes for samples in self._samples)
        if kept >= KEPT_BYTES or time.monotonic() - self._written >= KEPT_SECONDS:
            self.flush()

    def flush(self) -> None:
        """Write what is kept in memory; should the process be killed, the file can be read as of now."""
        if self._times:
            times, samples = np.concatenate(self._times), np.concatenate(self._samples)
            self._times, self._samples = [], []
            for index, history in enumerate(self._histories):
                _extend(history["time"], times)
                _extend(history["displacement"], samples[:, index, :3])
                _extend(history["velocity"], samples[:, index, 3:6])
                if "stress" in history:
                    _extend(history["stress"], samples[:, index, 6])
        self._append_cracks(joined(self._broken), self.run.time_step)
        self._broken = []
        self.file.flush()
        self._written = time.monotonic()

    def snapshot(self) -> None:
        """Write the present state of the whole scene."""
        state = self.run.state
        group = self.file.create_group(f"snapshots/{self._snapshots:04d}")
        group.attrs["time"] = self.run.time
        widened = self.run.scene.widened
        _write(group, "displacement", widened("displacement", (state.displacement - state.datum).T), DISPLACEMENT_UNIT)
        _write(group, "velocity", widened("velocity", state.velocity.T), VELOCITY_UNIT)
        for name, (values, unit) in self.run.system.snapshot(state.displacement).items():
            _write(group, name, widened(name, values), unit)
        self._snapshots += 1
        self.file.flush()

    def stalled_snapshot(self, stalled: StalledError) -> None:
        """Write the scene at the end of a stage that stalled, with unbalanced forces and cracks."""
        self.snapshot()
        self._append_cracks(stalled.cracks, self.run.time_step)
        _write(self.file[f"snapshots/{self._snapshots - 1:04d}"], "unbalanced", stalled.unbalanced, "N")

    def _write_header(self, step_limit: float) -> None:
        scene, case = self.scene, self.scene.case
        self.file.attrs.update(
            {
                "name": case.name,
                "title": case.title,
                "case": case.text,
                "version": __version__,
                "time_step": self.run.time_step,
                "step_limit": step_limit,
                "size": scene.size,
                "kind": scene.kind,
                "complete": False,
                **scene.attributes,
            }
        )

    def _write_particles(self) -> None:
        group = self.file.create_group("particles")
        for name, (values, unit) in self.scene.columns.items():
            _write(group, name, values, unit)

    def _make_histories(self) -> list[dict[str, h5py.Dataset]]:
        """The datasets of each monitor by name; searching one in the file takes as long as extending it."""
        scene = self.scene
        histories = self.file.create_group("histories", track_order=True)  # in the order of the case, not alphabetical
        kept = []
        for name, node in scene.monitors.items():
            group = histories.create_group(name)
            group.attrs["particle"] = node
            group.attrs["position"] = scene.positions[node]
            group.attrs["wanted"] = scene.places.get(name, scene.positions[node])  # a twin has no given position
            group.attrs["unit"] = "m"
            columns = [
                ("time", (), "f8", "s"),
                ("displacement", (3,), "f8", DISPLACEMENT_UNIT),
                ("velocity", (3,), "f8", VELOCITY_UNIT),
            ]
            if scene.record_width > 6:
                columns.append(("stress", (), "f8", "Pa"))
            kept.append(_make(group, columns))
        return kept

    def _make_cracks(self) -> dict[str, h5py.Dataset]:
        columns = [
            ("time", (), "f8", "s"),
            ("position", (2,), "f8", "m"),
            ("particles", (2,), "i8", "1"),
            ("shear", (), "?", "1"),
        ]
        return _make(self.file.create_group("cracks"), columns)

    def _append_cracks(self, cracks: Cracks, time_step: float) -> None:
        if len(cracks.step) == 0:
            return
        _extend(self._cracks["time"], cracks.step * time_step)
        before = 0.5 * self.run.state.datum[:2, cracks.pair].sum(axis=2).T  # of the middle, up to the start of the run
        _extend(self._cracks["position"], cracks.position - before)
        _extend(self._cracks["particles"], cracks.pair)
        _extend(self._cracks["shear"], cracks.shear)

    def _write_stage(self, stage: Stage) -> None:
        """Write the results of a stage before the run."""
        group = self.file.require_group(stage.name)
        group.attrs.update(stage.facts)
        _write(group, "displacement", stage.displacement.T, DISPLACEMENT_UNIT)
        self._append_cracks(stage.cracks, 0.0)  # before the run began

    def _write_energy(self) -> None:
        if self.ledger is None:
            return
        unit = self.scene.energy_unit
        group = self.file.create_group("energy")
        for field, column in zip(fields(Entry), self.ledger.columns.T, strict=True):
            _write(group, field.name, column, "s" if field.name == "time" else unit)

    def _write_laws(self) -> None:
        group = self.file.create_group("laws")
        names, steps = zip(*self.run.state.laws, strict=True)
        group.create_dataset("name", data=list(names))
        _write(group, "time", np.array(steps) * self.run.time_step, "s")

    def _write_boundaries(self) -> None:
        scene = self.scene
        for side, edge in scene.edges.items():
            group = self.file.create_group(f"boundaries/{side}")
            group.attrs["length"] = edge.length
            group.attrs["diameter_sum_ratio"] = edge.diameter_sum_ratio
            _write(group, "particle", edge.nodes, "1")
            _write(group, "position", scene.positions[edge.nodes], "m")
            _write(group, "diameter", edge.diameters, "m")
            _write(group, "peak_velocity", self.run.edge_peaks(side), VELOCITY_UNIT)

    def _write_peaks(self) -> None:
        if self.scene.case.output.peaks:
            speed = self.run.scene.widened("peak_velocity", self.run.state.top_speed)
            _write(self.file["particles"], "peak_velocity", speed, "m/s")


class Histories(Tracker):
    """Writes the motion of the monitors, and the bonds that broke, after every return of the loop."""

    name = "histories"

    def __init__(self, recorder: Recorder) -> None:
        self.recorder = recorder

    def handle(self, run: Run) -> None:
        """Does nothing, as it is never due."""

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Append the record."""
        self.recorder.append(record)


class Snapshots(Tracker):
    """Writes the whole scene at some steps.

    Parameters
    ----------
    recorder : writes the file.
    steps : those steps.
    """

    name = "snapshots"

    def __init__(self, recorder: Recorder, steps: Sequence[int]) -> None:
        self.recorder = recorder
        self._steps = sorted(steps)
        self._last = -1
        self._after(-1)

    def _after(self, step: int) -> None:
        self.due = next((later for later in self._steps if later > step), NEVER)

    def handle(self, run: Run) -> None:
        """Write the scene."""
        self.recorder.snapshot()
        self._last = run.state.step
        self._after(run.state.step)

    def take_last(self, run: Run) -> None:
        """Write the scene at the end of a run that was ended early, unless it has just been written."""
        if self._last < run.state.step:
            self.handle(run)


def _make(group: h5py.Group, columns: Iterable[tuple[str, tuple[int, ...], str, str]]) -> dict[str, h5py.Dataset]:
    """Empty datasets of a group that rows can be appended to; columns: their names, widths of a row, types, units."""
    kept = {}
    for name, width, kind, unit in columns:
        kept[name] = group.create_dataset(name, shape=(0, *width), maxshape=(None, *width), dtype=kind)
        kept[name].attrs["unit"] = unit
    return kept


def _write(group: h5py.Group, name: str, values: np.ndarray, unit: str) -> None:
    group.create_dataset(name, data=values).attrs["unit"] = unit


def _extend(dataset: h5py.Dataset, values: np.ndarray) -> None:
    if len(values) == 0:
        return
    count = len(dataset)
    dataset.resize(count + len(values), axis=0)
    dataset[count:] = values
