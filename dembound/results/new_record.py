"""A new record: its groups and attributes, constant datasets, and empty datasets that will grow.

Layout of ``run.h5`` (every dataset of numbers has its unit as attribute ``unit``)::

    /                       attributes: name, origin (the case's own name, whatever --name is), source, the case file's
                            place from the folder of results, source_digest, its SHA-256; title, case (its text),
                            keys (all, as JSON), kind ("disks", "bar"), version, size, time_step, step_limit, steps,
                            complete, late (s, all motion, by where waves enter); of disks seed, with layers
                            layer_names and joints (m, heights between them), from the surface down; where they differ
                            left and right of x = meet (m), left_layers, left_joints and right_layers, right_joints
                            in place of joints, numbers from 1; of a bar loaded,
                            which of its ends is, and ends, their types,
                            without ranges also density, section, youngs_modulus, wave_speed, attenuation; of a run that
                            was continued to another time regular_steps, those of the run as it was begun; of a
                            response of a library silent, the inputs without a record, whose waves begin after the run
    inputs/<number>         bytes of a file that the case refers to; attribute path
    particles/              position (n, 2); of disks radius (n,), brick_particle (n,), bonds (n,) of each at the start,
                            column (n,), whether it belongs to a free-field column, with layers layer (n,), from 1 at
                            the surface; of a bar's nodes volume (n,); if the case asks for it peak_velocity (n,), the
                            largest speed of each in the whole run
    continuum/              of a continuum round the particles: position (m, 2), absorbs (m,), whether a node is in the
                            layer that absorbs, cell (c, 4), nodes at the corners of the cells between them; element
                            (e, 4), left, bottom, right, top of each, node (e, N, N), its nodes by row and column;
                            surface (s, 4), ends of the element sides at its free surface; tie (t, 2), where ties to
                            disks act; if the case asks for it peak_velocity (m,)
    histories/<monitor>/    time (k,), displacement (k, 3), velocity (k, 3), on a bar stress (k,); attributes particle
                            (−1 in a continuum), position, requested; after a complete run end_time, end_displacement,
                            end_velocity; on a bar density, section, youngs_modulus, wave_speed, attenuation there, and
                            with ranges the name of its range
    boundaries/<side>/      particle, position, diameter (of a bar's end its section), peak_velocity (q, 3, 2); of the
                            side as a whole, without a free-field column, time (k,), displacement (k, 3), force (k, 2)
    walls/<wall>/           points (p, 2) at the start; time (k,), displacement (k, 2), force (k, 2) of the disks on
                            it, at the times of histories
    joints/<joint>/         points (p, 2) at the start, to the left of which a pair's first disk is; at the times of
                            histories time and means over its length, (k,) each, 0 where it has none: slip and opening
                            since the start, slip and shear of the left side along the line, pressure, shear, and shares
                            that are closed and that slide
    snapshots/<number>/     displacement (n, 3), velocity (n, 3), the mean of those half a step before and after, if the
                            run got so far (attribute velocity_of_half_step otherwise); coordination (n,) of a
                            history-dependent law; stress (n, 3) if the case asks for it; on a bar stress (n,)
                            and local damage (n,); of a static stage that stalled unbalanced (n, 2), sum of the forces
                            on each particle; attribute time; of disks, if the case asks for them, contacts/ with the
                            columns of `disks.contact_forces.contact_columns`; with joints,
                            joints/ with those of `JointTie.segments`; with a continuum, continuum/ with
                            displacement, velocity and stress (m, 3) of its nodes; beside a free-field column the stress
                            and scattered_displacement and scattered_velocity are those of the scattered motion, the
                            others those of the total one
    energy/                 time and the columns of `motion.energy.Entry`, (k,) each
    energy/sides/<side>/    the columns of `motion.energy.SideEntry`, (k,) each
    cracks/                 time (k,), position (k, 2), particles (k, 2), shear (k,), in the order they happened; like
                            displacements, positions count from the start of the run
    laws/                   name (l,) of each law or method used and time (l,) it began at
    static/                 attributes: results of the static stage, if there was one; displacement (n, 3) at its end
    debris/                 of disks with a history-dependent law, after the run: the columns of
                            `kinds.disks.debris.debris_columns`
    static/before/          the same before an excavation, of the particles that are left by it
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.errors import RecordError
from dembound.motion.energy import Entry, Ledger, SideEntry
from dembound.motion.kind import Stage
from dembound.motion.scene import Scene
from dembound.motion.trackers import Run
from dembound.results.datasets import describe, make, write
from dembound.results.folder import source_of
from dembound.results.line_histories import make_lines
from dembound.results.reader import finite, snapshots_of
from dembound.version import __version__

if TYPE_CHECKING:
    import h5py

DISPLACEMENT_UNIT = "m, m, rad"
VELOCITY_UNIT = "m/s, m/s, rad/s"

MOTION = ("displacement", "velocity")
"""Names of the datasets of every snapshot."""

UNBALANCED = "unbalanced"
"""Name of the dataset of the snapshot of a static stage that stalled."""

DERIVED = "debris"
"""Group of what follows from snapshots and cracks, written when a run is complete."""

NO_PARTICLE = -1
"""Number of the particle of a monitor in a continuum."""

LONGEST_NAME = 64
"""Bytes of the name of a law."""

HISTORY = (
    ("time", (), "f8", "s"),
    ("displacement", (3,), "f8", DISPLACEMENT_UNIT),
    ("velocity", (3,), "f8", VELOCITY_UNIT),
)
SIDE_HISTORY = (("time", (), "f8", "s"), ("displacement", (3,), "f8", DISPLACEMENT_UNIT), ("force", (2,), "f8", "N/m"))
LAWS = (("name", (), f"S{LONGEST_NAME}", ""), ("time", (), "f8", "s"))
CRACKS = (
    ("time", (), "f8", "s"),
    ("position", (2,), "f8", "m"),
    ("particles", (2,), "i8", "1"),
    ("shear", (), "?", "1"),
)


def begin_record(
    file: h5py.File, run: Run, step_limit: float, sides: Collection[str], ledger: Ledger | None, stages: Sequence[Stage]
) -> None:
    """Write all groups of a new file.

    run : to be recorded, with all nodes of its whole scene. step_limit : s. sides : with histories.
    ledger : its energy ledger, if it has one. stages : before the run.
    """
    source = source_of(run.scene.whole.case, Path(file.filename).parent.parent)
    describe(file, header_of(run) | source | {"step_limit": step_limit, "complete": False})
    _lay_out(file, run.scene.whole, sides, None if ledger is None else ledger.side_names)
    write_stages(file, stages)


def write_stages(file: h5py.File, stages: Sequence[Stage]) -> None:
    """Write the stages before the run that a record does not have."""
    for stage in stages:
        group = file.require_group(stage.name)
        describe(group, stage.facts)
        if "displacement" not in group:
            write(group, "displacement", stage.displacement.T, DISPLACEMENT_UNIT)


def require_laid_out(file: h5py.File, scene: Scene, counts: Mapping[str, int]) -> None:
    """Raise RecordError if a record lacks a dataset or row that a continued run of the whole scene needs.

    counts : rows and snapshots that it must have, see `Recorder.counts`.
    """
    import h5py

    with h5py.File("layout", "w", driver="core", backing_store=False) as layout:
        _lay_out(layout, scene, [name for name in scene.sides if name in scene.edges], list(scene.sides))
        expected: dict[str, Any] = {}
        layout.visititems(expected.__setitem__)
        for name, item in expected.items():
            kind = name.split("/")[0]
            rows = counts[{"boundaries": "sides"}.get(kind, kind)] if _grows(item) else 0
            _require_like(file, name, item, rows)
    snapshots = snapshots_of(file)[: counts["snapshots"]]
    if len(snapshots) < counts["snapshots"]:
        raise _lacking(file, f"{counts['snapshots']} snapshots, it has {len(snapshots)}")
    for group in snapshots:
        for name in sorted({*MOTION, *scene.in_snapshots, *snapshots[0]}):  # a law that begins later may add others
            if name not in group:
                raise _lacking(file, f"{group.name[1:]}/{name}")
        if "time" not in group.attrs:
            raise _lacking(file, f"{group.name[1:]}, attribute time")


def _grows(item: h5py.HLObject) -> bool:
    """Whether an item is a dataset to which rows are appended."""
    return hasattr(item, "maxshape") and item.shape != () and item.maxshape[0] is None


def _require_like(file: h5py.File, name: str, expected: h5py.HLObject, rows: int) -> None:
    """Raise RecordError if a record lacks a group, dataset or rows of its layout, or numbers are not finite."""
    found = file.get(name)
    if found is None or hasattr(found, "dtype") != hasattr(expected, "dtype"):
        raise _lacking(file, name)
    if missing := sorted(set(expected.attrs) - set(found.attrs)):
        raise _lacking(file, f"{name}, attribute {missing[0]}")
    if not hasattr(expected, "dtype"):
        return
    shapes = [(each.dtype.kind, each.shape[1:] if _grows(each) else each.shape) for each in (found, expected)]
    if shapes[0] != shapes[1] or _grows(found) != _grows(expected):
        raise _lacking(file, f"{name} as this case records it")
    if _grows(found) and len(found) < rows:
        raise _lacking(file, f"{rows} rows in {name}, it has {len(found)}")
    if _grows(found) and found.dtype.kind == "f":
        finite(found)


def _lacking(file: h5py.File, what: str) -> RecordError:
    return RecordError([f"{file.filename}: cannot be continued: it lacks {what}"])


def _lay_out(file: h5py.File, scene: Scene, sides: Collection[str], entered: Sequence[str] | None) -> None:
    """Make the groups and datasets of a whole scene.

    sides : with histories; entered : sides with energies, None for a record without a ledger.
    """
    group = file.create_group("particles")
    for name, (values, unit) in scene.columns.items():
        write(group, name, values, unit)
    for name, (values, unit) in ({} if scene.beside is None else scene.beside.columns).items():
        write(file.require_group("continuum"), name, values, unit)
    write_inputs(file, scene.case.files)
    _make_histories(file, scene)
    _write_boundaries(file, scene, sides)
    make_lines(file, scene)
    make(file.create_group("cracks"), CRACKS)
    if entered is not None:
        _make_energy(file, scene, entered)
    make(file.create_group("laws"), LAWS)
    file.create_group("snapshots")


def header_of(run: Run) -> dict[str, Any]:
    """The attributes of the record of a run, without its step limit and whether it is complete."""
    scene, case = run.scene.whole, run.scene.whole.case
    return {
        "name": case.name,
        "origin": case.origin,
        "title": case.title,
        "case": case.text,
        "keys": json.dumps(case.keys),
        **({"silent": sorted(case.silent)} if case.silent else {}),
        "version": __version__,
        "time_step": run.time_step,
        "corner": scene.low,
        "size": scene.size,
        "kind": scene.kind,
        **scene.attributes,
    }


def header_of_monitor(scene: Scene, name: str) -> dict[str, Any]:
    """The attributes of a monitor's history."""
    place = scene.monitored[name]
    requested = scene.places.get(name, place)  # a twin has no given position
    particle = NO_PARTICLE if name in scene.between else scene.monitors[name]
    places = {"particle": particle, "position": place, "requested": requested, "unit": "m"}
    return places | scene.attributes_of_monitor(name)


def _make_energy(file: h5py.File, scene: Scene, sides: Sequence[str]) -> None:
    """Make empty columns of the ledger and of sides."""
    unit = scene.energy_unit
    columns = [(field.name, (), "f8", "s" if field.name == "time" else unit) for field in fields(Entry)]
    make(file.create_group("energy"), columns)
    for side in sides:
        make(file.create_group(f"energy/sides/{side}"), [(name, (), "f8", unit) for name in SideEntry._fields])


def write_derived(file: h5py.File, columns: Mapping[str, tuple[np.ndarray, str]]) -> None:
    """Write what follows from snapshots and cracks, values and unit by path in `DERIVED`, in place of what is there."""
    file.pop(DERIVED, None)
    for name, (values, unit) in columns.items():
        write(file.require_group(DERIVED), name, values, unit)


def write_inputs(file: h5py.File, files: Mapping[str, str]) -> None:
    """The texts of the files that a case refers to, by their paths in it."""
    group = file.create_group("inputs")
    for number, (path, content) in enumerate(files.items()):
        write(group, str(number), np.frombuffer(content.encode(), dtype=np.uint8), "UTF-8")
        describe(group[str(number)], {"path": path})


def _make_histories(file: h5py.File, scene: Scene) -> None:
    """The groups of the monitors, with empty datasets."""
    histories = file.create_group("histories", track_order=True)  # in the order of the case, not alphabetical
    columns = HISTORY if scene.record_width <= 6 else (*HISTORY, ("stress", (), "f8", "Pa"))
    for name in scene.monitors:
        group = histories.create_group(name)
        describe(group, header_of_monitor(scene, name))
        make(group, columns)


def _write_boundaries(file: h5py.File, scene: Scene, sides: Collection[str]) -> None:
    """The sides; their peaks are written later."""
    for side, edge in scene.edges.items():
        group = file.create_group(f"boundaries/{side}")
        group.attrs["length"] = edge.length
        group.attrs["diameter_sum_ratio"] = edge.diameter_sum_ratio
        write(group, "particle", edge.nodes, "1")
        write(group, "position", scene.positions[edge.nodes], "m")
        write(group, "diameter", edge.diameters, "m")
        write(group, "peak_velocity", np.zeros((len(edge.nodes), 3, 2)), VELOCITY_UNIT)
        if side in sides:
            group.attrs["body_length"] = scene.sides[side].length
            force = "N" if scene.energy_unit == "J" else "N/m"  # as energies
            make(group, [(*column[:3], force if column[0] == "force" else column[3]) for column in SIDE_HISTORY])
