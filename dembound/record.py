"""The recorder: a run in one HDF5 file. Pictures, VTU files and reports are made from that file alone.

Layout of ``run.h5`` (units stand as attribute ``unit`` on every dataset of numbers)::

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
                            and local damage (n,); of a static stage that stalled unbalanced (n, 2), what the forces on
                            each particle come to; attribute time
    energy/                 time and the columns of `energy.Entry`, (k,) each
    cracks/                 time (k,), position (k, 2), particles (k, 2), shear (k,), in the order they happened; like
                            displacements, positions count from the start of the run
    laws/                   name (l,) of each law or method used and time (l,) it began at
    static/                 attributes: what the static stage came to, if there was one; displacement (n, 3) at its end
    static/before/          the same before an excavation, of the particles that are left by it
"""

from dataclasses import fields
from pathlib import Path
from types import TracebackType

import h5py
import numpy as np

from dembound import __version__
from dembound.case.monitor import FREE_FIELD
from dembound.contacts import Cracks
from dembound.energy import Entry, Ledger
from dembound.simulate import Simulation
from dembound.static import Settled
from dembound.stress import stress_now

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
    settled : what the static stage came to, if there was one.
    """

    def __init__(
        self, path: Path, simulation: Simulation, step_limit: float, interval: float, settled: Settled | None = None
    ) -> None:
        self.simulation = simulation
        self.ledger = Ledger(simulation)
        self.stride = max(1, round(interval / simulation.time_step))
        self.file = h5py.File(path, "w")
        self._write_header(step_limit)
        self._write_particles()
        self._histories = self._make_histories()
        self._cracks = self._make_cracks()
        if settled is not None:
            self._write_static(settled)
        self._done = 0
        self._snapshots = 0

    def __enter__(self) -> "Recorder":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self._write_boundaries()
            self._write_peaks()
            self._write_energy()
        self._write_laws()
        self.file.attrs["steps"] = self.simulation.steps
        self.file.attrs["complete"] = kind is None
        self.file.close()

    def append(self, record: np.ndarray) -> None:
        """Keep a block's probe record, see `Simulation.advance`, of which every stride-th step."""
        count = len(record)
        first = -self._done % self.stride
        rows = np.arange(first, count, self.stride)
        times = (self._done + rows) * self.simulation.time_step
        for index, group in enumerate(self._histories):
            _extend(group["time"], times)
            _extend(group["displacement"], record[rows, index, :3])
            _extend(group["velocity"], record[rows, index, 3:6])
            if "stress" in group:
                _extend(group["stress"], record[rows, index, 6])
        self._done += count
        self._append_cracks(self.simulation.take_cracks(), self.simulation.time_step)
        self.file.flush()

    def enter_energy(self) -> np.ndarray:
        """Advance by one step and enter its energies in the ledger; returns the step's probe record."""
        return self.ledger.step()

    def snapshot(self) -> None:
        """Keep the whole scene as it is now."""
        group = self.file.create_group(f"snapshots/{self._snapshots:04d}")
        group.attrs["time"] = self.simulation.time
        moved = self.simulation.displacement - self.simulation.datum
        _write(group, "displacement", moved.T, DISPLACEMENT_UNIT)
        _write(group, "velocity", self.simulation.velocity.T, VELOCITY_UNIT)
        for name, (values, unit) in self.simulation.engine.snapshot(self.simulation.displacement).items():
            _write(group, name, values, unit)
        if self.simulation.scene.case.output.stress and "stress" not in group:
            _write(group, "stress", stress_now(self.simulation), "Pa")
        self._snapshots += 1

    def stalled_snapshot(self, unbalanced: np.ndarray, cracks: Cracks) -> None:
        """Keep the scene as a stalled static stage left it, unbalanced forces (n, 2) N and cracks with it."""
        self.snapshot()
        self._append_cracks(cracks, self.simulation.time_step)
        _write(self.file[f"snapshots/{self._snapshots - 1:04d}"], "unbalanced", unbalanced, "N")

    def _write_header(self, step_limit: float) -> None:
        scene, case = self.simulation.scene, self.simulation.scene.case
        self.file.attrs.update(
            {
                "name": case.name,
                "title": case.title,
                "case": case.text,
                "version": __version__,
                "time_step": self.simulation.time_step,
                "step_limit": step_limit,
                "size": scene.size,
                "kind": scene.kind,
                "complete": False,
                **scene.attributes,
            }
        )

    def _write_particles(self) -> None:
        group = self.file.create_group("particles")
        for name, (values, unit) in self.simulation.scene.columns.items():
            _write(group, name, values, unit)

    def _make_histories(self) -> list[h5py.Group]:
        scene = self.simulation.scene
        histories = self.file.create_group("histories", track_order=True)  # the case's order, not the alphabet's
        groups = []
        for name, node in scene.monitors.items():
            group = histories.create_group(name)
            group.attrs["particle"] = node
            group.attrs["position"] = scene.positions[node]
            twin = name.endswith(FREE_FIELD)  # its place is nobody's wish
            group.attrs["wanted"] = scene.positions[node] if twin else scene.places[name]
            group.attrs["unit"] = "m"
            for dataset, width, unit in (
                ("time", (), "s"),
                ("displacement", (3,), DISPLACEMENT_UNIT),
                ("velocity", (3,), VELOCITY_UNIT),
            ):
                _make(group, dataset, width, "f8", unit)
            if scene.record_width > 6:
                _make(group, "stress", (), "f8", "Pa")
            groups.append(group)
        return groups

    def _make_cracks(self) -> h5py.Group:
        group = self.file.create_group("cracks")
        _make(group, "time", (), "f8", "s")
        _make(group, "position", (2,), "f8", "m")
        _make(group, "particles", (2,), "i8", "1")
        _make(group, "shear", (), "?", "1")
        return group

    def _append_cracks(self, cracks: Cracks, time_step: float) -> None:
        _extend(self._cracks["time"], cracks.step * time_step)
        before = 0.5 * self.simulation.datum[:2, cracks.pair].sum(axis=2).T  # of the middle, until the run began
        _extend(self._cracks["position"], cracks.position - before)
        _extend(self._cracks["particles"], cracks.pair)
        _extend(self._cracks["shear"], cracks.shear)

    def _write_static(self, settled: Settled) -> None:
        kept = getattr(self.simulation.scene, "kept", None)
        if settled.before is not None and kept is not None:
            before = settled.before
            displacement = before.start.displacement[:, kept]
            self._write_stage("static/before", before, displacement, before.cracks.among(kept))
        self._write_stage("static", settled, settled.start.displacement, settled.cracks)

    def _write_stage(self, name: str, settled: Settled, displacement: np.ndarray, cracks: Cracks) -> None:
        """What a static stage came to; displacement (3, n) and cracks of the particles that are there in the run."""
        group = self.file.require_group(name)
        group.attrs.update(
            {
                "steps": settled.steps,
                "ratio": settled.ratio,
                "carried": settled.carried,
                "left": settled.left,
                "stress": settled.stress,
                "cracks": len(settled.cracks),
            }
        )
        _write(group, "displacement", displacement.T, DISPLACEMENT_UNIT)
        self._append_cracks(cracks, 0.0)  # before the run began

    def _write_energy(self) -> None:
        unit = self.simulation.scene.energy_unit
        group = self.file.create_group("energy")
        for field, column in zip(fields(Entry), self.ledger.columns.T, strict=True):
            _write(group, field.name, column, "s" if field.name == "time" else unit)

    def _write_laws(self) -> None:
        group = self.file.create_group("laws")
        names, steps = zip(*self.simulation.laws, strict=True)
        group.create_dataset("name", data=list(names))
        _write(group, "time", np.array(steps) * self.simulation.time_step, "s")

    def _write_boundaries(self) -> None:
        scene = self.simulation.scene
        for side, edge in scene.edges.items():
            group = self.file.create_group(f"boundaries/{side}")
            group.attrs["length"] = edge.length
            group.attrs["cover"] = edge.cover
            _write(group, "particle", edge.nodes, "1")
            _write(group, "position", scene.positions[edge.nodes], "m")
            _write(group, "diameter", edge.diameters, "m")
            _write(group, "peak_velocity", self.simulation.edge_peaks(side), VELOCITY_UNIT)

    def _write_peaks(self) -> None:
        if self.simulation.scene.case.output.peaks:
            _write(self.file["particles"], "peak_velocity", self.simulation.top_speed, "m/s")


def _make(group: h5py.Group, name: str, width: tuple[int, ...], kind: str, unit: str) -> None:
    """An empty dataset that rows of this width can be appended to."""
    group.create_dataset(name, shape=(0, *width), maxshape=(None, *width), dtype=kind).attrs["unit"] = unit


def _write(group: h5py.Group, name: str, values: np.ndarray, unit: str) -> None:
    group.create_dataset(name, data=values).attrs["unit"] = unit


def _extend(dataset: h5py.Dataset, values: np.ndarray) -> None:
    count = len(dataset)
    dataset.resize(count + len(values), axis=0)
    dataset[count:] = values
