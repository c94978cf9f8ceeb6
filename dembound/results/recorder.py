"""The recorder: writes a run to one HDF5 file. Pictures, VTU files and reports are made only from that file.

Its layout is described in `new_record`.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.motion.energy import Entry, Ledger, SideEntry
from dembound.motion.kind import Stage, StalledError
from dembound.motion.part import Cracks, joined
from dembound.motion.trackers import Run
from dembound.results.committed import FORMAT, CommittedFile
from dembound.results.datasets import datasets_of, describe, extend, text, write
from dembound.results.line_histories import LineHistories
from dembound.results.new_record import (
    DERIVED,
    DISPLACEMENT_UNIT,
    SIDE_HISTORY,
    UNBALANCED,
    VELOCITY_UNIT,
    begin_record,
    header_of,
    write_stages,
)
from dembound.results.reader import snapshot_of, snapshots_of

if TYPE_CHECKING:
    import h5py

KEPT_BYTES, KEPT_SECONDS = 2**20, 10.0
"""Largest size (bytes) of samples, and longest time (s), for which samples and cracks are kept in RAM.

Thousands of small writes take longer than all steps of a small scene."""

HALF_STEP = "velocity_of_half_step"
"""Attribute of a snapshot whose velocities are still those of half a step before its time."""


class Recorder:
    """Writes one run, appending during the run; ``complete`` becomes true only at its end.

    At the end of its ``with`` statement the file has everything that was recorded, also after an error or Ctrl-C. If
    the process is killed, or the disk is full, it has everything up to the last `flush`.

    Parameters
    ----------
    path : file to create.
    run : the run to record, with all nodes of its whole scene; its probes are those of the scene.
    step_limit : stability limit in s, written to the record.
    interval : time between two history samples in s; 0: every step. ledger : of the run, or None. stages : before it.
    counts : the result of `counts` in a run that this one continues; the file is then not created, but appended to.
    None: a new file.
    """

    def __init__(
        self,
        path: Path,
        run: Run,
        step_limit: float,
        interval: float = 0.0,
        ledger: Ledger | None = None,
        stages: Sequence[Stage] = (),
        counts: Mapping[str, int] | None = None,
    ) -> None:
        import h5py

        self.run = run
        self.scene = run.scene.whole
        self.ledger = ledger
        self.stride = max(1, round(interval / run.time_step))
        measured = [] if run.sides is None else run.sides.names
        self._sides = {name: number for number, name in enumerate(measured) if name in self.scene.edges}
        self._times: list[np.ndarray] = []
        self._samples: list[np.ndarray] = []
        self._side_samples: list[np.ndarray] = []
        self._side_times: list[np.ndarray] = []
        self._lines = LineHistories(self.scene)
        self._broken: list[Cracks] = []
        self._store = CommittedFile(path, "w" if counts is None else "a")
        self.file = h5py.File(self._store, "w" if counts is None else "a", libver=FORMAT)
        try:
            self._begin(step_limit, stages, counts)
        except BaseException:
            self._close()
            raise

    def _begin(self, step_limit: float, stages: Sequence[Stage], counts: Mapping[str, int] | None) -> None:
        """Create all groups of a new file, or cut one to what is continued."""
        if counts is None:
            begin_record(self.file, self.run, step_limit, self._sides, self.ledger, stages)
        else:
            self._cut(counts)
            write_stages(self.file, stages)
        self._find_datasets()
        for stage in stages if counts is None else ():
            self._append_cracks(stage.cracks, 0.0)  # before the run began
        self.flush(durable=False)

    def __enter__(self) -> Recorder:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            if kind is None:
                self.file.attrs["complete"] = True
            self._write_all()
            self.file.close()
            self._store.commit(durable=False)
        finally:
            self._close()

    def _close(self) -> None:
        self.file.close()
        self._store.close()

    @property
    def counts(self) -> dict[str, int]:
        """Numbers of rows of histories, cracks, energy and laws, and of snapshots, from which a run can be continued.

        The ledger's entry of the last step, which may be the last of this run only, is not included.
        """
        return {
            "histories": max((len(each["time"]) for each in self._histories), default=0),
            "sides": max((len(each["time"]) for each in self._side_histories), default=0),
            **self._lines.counts,
            "cracks": len(self._cracks["time"]),
            "energy": 0 if self.ledger is None else self.ledger.regular_entries,
            "laws": len(self._laws["time"]),
            "snapshots": len(self.file["snapshots"]),
        }

    def _find_datasets(self) -> None:
        """The datasets that grow, kept because searching a dataset takes as long as extending it."""
        self._histories = [dict(self.file["histories"][name]) for name in self.scene.monitors]
        self._side_histories = [dict(self.file["boundaries"][name]) for name in self._sides]
        self._lines.find(self.file)
        self._cracks, self._laws = dict(self.file["cracks"]), dict(self.file["laws"])
        self._energy = datasets_of(self.file["energy"]) if self.ledger is not None else {}

    def append(self, record: np.ndarray) -> None:
        """Take every stride-th of the last steps; record : of the probes, see `Simulation.advance`."""
        state, step = self.run.state, self.run.time_step
        begun = state.step - len(record)
        rows = np.arange(-begun % self.stride, len(record), self.stride)
        self._times.append((begun + rows) * step)
        self._samples.append(self.run.scene.observed(record[rows], self._times[-1]))
        if self._sides:
            sides = self.run.side_samples
            self._side_times.append(sides.steps * step)
            self._side_samples.append(sides.record)
        self._lines.take(self.run.system, begun + rows)
        self._broken.append(self.run.system.take_cracks(state.step))
        kept = sum(samples.nbytes for samples in self._samples + self._side_samples + self._lines.kept)
        if time.monotonic() - self._written >= KEPT_SECONDS:
            self.flush()
        elif kept >= KEPT_BYTES:
            self._append_kept()

    def note(self, facts: Mapping[str, Any]) -> None:
        """Write attributes of the record."""
        describe(self.file, facts)

    def flush(self, *, durable: bool = True) -> None:
        """Write everything up to now; from then on the file is readable in this state.

        durable : wait for the disk, so that data survive a power failure.

        Raises OSError if anything could not be written; the file then has the state of the previous flush.
        """
        import h5py

        self._write_all()
        self.file.close()  # an open file has a mark, and could not be read
        try:
            self._store.commit(durable=durable)
        finally:
            self.file = h5py.File(self._store, "a", libver=FORMAT)
            self._find_datasets()
        self._written = time.monotonic()

    def snapshot(self) -> None:
        """Write the present state of the whole scene.

        Its velocities are of half a step before, except at the start, and `centre` is to be called a step later.
        """
        state, snapshots = self.run.state, self.file["snapshots"]
        group = snapshots.create_group(f"{len(snapshots):04d}")
        group.attrs["time"] = self.run.time
        if state.step > 0:
            group.attrs[HALF_STEP] = True
        widened = self.run.scene.widened
        for name, values, unit in (
            ("displacement", state.displacement - state.datum, DISPLACEMENT_UNIT),
            ("velocity", state.velocity, VELOCITY_UNIT),
        ):
            for path, each in self._moved(name, values, self.run.time):
                write(group, path, each, unit)
        for name, (values, unit) in self.run.system.snapshot_beside(state.displacement).items():
            write(group["continuum"], name, values, unit)
        for name, (values, unit) in self.run.system.snapshot(state.displacement).items():
            write(group, name, widened(name, values), unit)
        for name, (values, unit) in self.run.system.contact_forces(state.displacement).items():
            write(group.require_group("contacts"), name, values, unit)
        for name, (values, unit) in self.run.system.joint_segments().items():
            write(group.require_group("joints"), name, values, unit)

    def _moved(self, name: str, values: np.ndarray, time: float) -> Iterator[tuple[str, np.ndarray]]:
        """Arrays of a snapshot, by their paths in it, for the motion (3, n) of the nodes at a time (s).

        name : "displacement" or "velocity".
        """
        widened, beside = self.run.scene.widened(name, values.T), self.scene.beside
        yield name, widened[: self.scene.recorded]
        for kind, motion in ({} if beside is None else beside.motion(widened, name, time)).items():
            yield f"continuum/{kind}{name}", motion

    def centre(self) -> None:
        """A step after a snapshot, give it the velocities of its time: means of those half a step before and after.

        Nothing is done if it has them, as in a record that is ahead of the checkpoint from which the run continues.
        """
        group = snapshot_of(self.file, -1)
        if group.attrs.get(HALF_STEP, False):
            for path, later in self._moved("velocity", self.run.state.velocity, float(group.attrs["time"])):
                group[path][...] = 0.5 * (group[path][...] + later)
            del group.attrs[HALF_STEP]

    def end(self, time: float, record: np.ndarray) -> None:
        """Write the motion of the monitors at the end of the run, at a time (s); record (p, 6 or 7) : of the probes."""
        motion = self.run.scene.observed(record[None], np.array([time]))[0]
        for name, each in zip(self.scene.monitors, motion, strict=True):
            ends = {"end_time": time, "end_displacement": each[:3], "end_velocity": each[3:6]}
            describe(self.file["histories"][name], ends)

    def stalled_snapshot(self, stalled: StalledError) -> None:
        """Write the scene at the end of a stage that stalled, with unbalanced forces and cracks."""
        self.snapshot()
        self._append_cracks(stalled.cracks, self.run.time_step)
        write(snapshot_of(self.file, -1), UNBALANCED, stalled.unbalanced, "N")

    def _cut(self, counts: Mapping[str, int]) -> None:
        """Remove everything written after the state from which the run continues."""
        for name, history in self.file["histories"].items():
            if name in self.scene.monitors:
                _cut(history, counts["histories"])
        for name in self._sides:
            _cut({column: self.file["boundaries"][name][column] for column, *_ in SIDE_HISTORY}, counts["sides"])
        for kind, histories in self._lines.datasets(self.file):
            _cut(histories, counts[kind])
        for name in ("cracks", "energy", "laws"):
            _cut(datasets_of(self.file[name]), counts[name])
        for side in self.file.get("energy/sides", {}).values():
            _cut(side, counts["energy"])
        self.file.pop(DERIVED, None)
        for snapshot in snapshots_of(self.file)[counts["snapshots"] :]:
            del self.file[snapshot.name]
        self.file.attrs["complete"] = False
        header = header_of(self.run)
        describe(self.file, {name: header[name] for name in ("case", "keys")})  # it may run for longer

    def _write_all(self) -> None:
        """Write everything up to now."""
        self._append_kept()
        self._append_energy()
        self._append_laws()
        self._write_peaks()
        self.file.attrs["steps"] = self.run.state.step

    def _append_kept(self) -> None:
        """Write samples and cracks that are kept in RAM."""
        if self._times:
            times, samples = np.concatenate(self._times), np.concatenate(self._samples)
            self._times, self._samples = [], []
            self._lines.append(times)
            for index, history in enumerate(self._histories):
                extend(history["time"], times)
                extend(history["displacement"], samples[:, index, :3])
                extend(history["velocity"], samples[:, index, 3:6])
                if "stress" in history:
                    extend(history["stress"], samples[:, index, 6])
        if self._side_times:
            times, sides = np.concatenate(self._side_times), np.concatenate(self._side_samples)
            self._side_times, self._side_samples = [], []
            for index, history in zip(self._sides.values(), self._side_histories, strict=True):
                extend(history["time"], times)
                extend(history["displacement"], sides[:, index, :3])
                extend(history["force"], sides[:, index, 3:])
        self._append_cracks(joined(self._broken), self.run.time_step)
        self._broken = []

    def _append_cracks(self, cracks: Cracks, time_step: float) -> None:
        if len(cracks.step) == 0:
            return
        extend(self._cracks["time"], cracks.step * time_step)
        before = 0.5 * self.run.state.datum[:2, cracks.pair].sum(axis=2).T  # of the middle, up to the start of the run
        extend(self._cracks["position"], cracks.position - before)
        extend(self._cracks["particles"], cracks.pair)
        extend(self._cracks["shear"], cracks.shear)

    def _append_energy(self) -> None:
        """Write the new entries of the ledger."""
        if self.ledger is None:
            return
        written = len(self._energy["time"])
        if written == len(self.ledger.columns):
            return
        columns, sides = self.ledger.columns[written:], self.ledger.side_columns[written:]
        for field, column in zip(fields(Entry), columns.T, strict=True):
            extend(self._energy[field.name], column)
        for side, values in zip(self.ledger.side_names, np.moveaxis(sides, 1, 0), strict=True):
            for name, column in zip(SideEntry._fields, values.T, strict=True):
                extend(self.file[f"energy/sides/{side}/{name}"], column)

    def _append_laws(self) -> None:
        """Write the laws that are new."""
        for name, step in self.run.state.laws[len(self._laws["time"]) :]:
            extend(self._laws["name"], np.array([text(name)]))
            extend(self._laws["time"], np.array([step * self.run.time_step]))

    def _write_peaks(self) -> None:
        """Replace the peaks of the sides, and those of all particles if the case asks for them."""
        for side in self.scene.edges:
            self.file[f"boundaries/{side}/peak_velocity"][...] = self.run.edge_peaks(side)
        if self.scene.case.output.peaks:
            speed, count = self.run.scene.widened("peak_velocity", self.run.state.top_speed), self.scene.recorded
            apart = [] if self.scene.beside is None else [("continuum", speed[self.scene.beside.nodes])]
            for name, values in [("particles", speed[:count]), *apart]:
                if "peak_velocity" not in self.file[name]:
                    write(self.file[name], "peak_velocity", values, "m/s")
                self.file[name]["peak_velocity"][...] = values


def _cut(group: Mapping[str, h5py.Dataset], count: int) -> None:
    """Remove rows from the end of datasets."""
    for dataset in group.values():
        dataset.resize(count, axis=0)
