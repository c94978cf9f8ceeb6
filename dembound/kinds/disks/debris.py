"""Debris in the results of a run: columns at snapshots, entries of the summary, words and warnings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.disks.debris import AT_REST, RUN_OUT, WAYS, Debris, Rest
from dembound.disks.scene import DiskScene
from dembound.motion.trackers import Run
from dembound.results.pieces import PIECE
from dembound.results.reader import cracks_until, open_record, snapshots_of, until
from dembound.words import percent

if TYPE_CHECKING:
    import h5py

Column = tuple[np.ndarray, str]

PIECES = {"count": "1", "largest": "m", "share": "1", "singles": "1", "d50": "m", "d80": "m"}
"""Numbers of the fragments at a snapshot, with their units."""

UNIT_OF_MASS = "kg/m"


def debris_columns(scene: DiskScene, file: h5py.File) -> dict[str, Column]:
    """Run-out and fragments at the k snapshots of an open record, by name: values and unit.

    time (k,); mass (k,), share (k,), centre (k, 2), left/x95 … right/angle (k,), see `Debris.run_out`; of a body with
    bonds fragments/count … fragments/d80 (k,), see `Fragments.describe`, and of each fragment, single disks too, at
    any snapshot sizes/snapshot, sizes/piece, sizes/disks, sizes/mass, sizes/diameter (f,); once bonds have broken
    `PIECE` (k, n), the number of the fragment of each disk. Nothing under linear laws, and without snapshots.
    """
    snapshots = list(snapshots_of(file))
    if not scene.has_history or not snapshots:
        return {}
    debris, cracks = Debris(scene), cracks_until(file, np.inf)
    rows, sizes, of_disks = [], [], []
    for number, group in enumerate(snapshots):
        time = float(group.attrs["time"])
        row = {"time": time} | debris.run_out(group["displacement"][debris.body, :2])
        if (found := debris.fragments(until(cracks, time)["particles"])) is not None:
            row["fragments"] = found.describe()
            sizes.append((np.full(len(found.disks), number), found.number, found.disks, found.mass, found.diameter))
            of_disks.append(found.of_disk)
        rows.append(row)
    units = {"time": "s", "mass": UNIT_OF_MASS, "share": "1", "centre": "m"}
    columns = {name: (np.array([row[name] for row in rows]), unit) for name, unit in units.items()}
    inner = [*((side, RUN_OUT) for side in WAYS), *([("fragments", PIECES)] if sizes else [])]
    for of, numbers in inner:
        columns |= {f"{of}/{key}": (np.array([row[of][key] for row in rows]), unit) for key, unit in numbers.items()}
    if of_disks and len(cracks["time"]):
        columns[PIECE] = np.array(of_disks), "1"
    names = zip(("snapshot", "piece", "disks", "mass", "diameter"), ("1", "1", "1", UNIT_OF_MASS, "m"), strict=True)
    together = map(np.concatenate, zip(*sizes, strict=True))
    return columns | {f"sizes/{name}": (values, unit) for (name, unit), values in zip(names, together, strict=False)}


def describe_debris(scene: DiskScene, run: Run, record: Path) -> dict[str, Any] | None:
    """The debris at the end of a run, as plain JSON values; None under linear laws.

    Entries as in `debris_columns`, of a side without run-out and of a body without bonds null; with a steady
    acceleration also those of `Rest.describe`.
    """
    if not scene.has_history:
        return None
    debris = Debris(scene)
    displacement = run.scene.widened("displacement", (run.state.displacement - run.state.datum).T)
    found = debris.run_out(displacement[debris.body, :2])
    found["centre"] = found["centre"].tolist()
    for key in ("centre", *WAYS):
        values = found[key] if key == "centre" else list(found[key].values())
        found[key] = None if np.isnan(values).any() else found[key]
    with open_record(record) as file:
        pieces = debris.fragments(cracks_until(file, np.inf)["particles"])
    found["fragments"] = None if pieces is None else pieces.describe()
    rest = run.state.owners.get(Rest.name)
    return found | (rest.describe(run) if isinstance(rest, Rest) else {})


def debris_in_words(found: Mapping[str, Any] | None) -> Iterator[str]:
    """The debris of a summary: the moved mass and its run-out, and the fragments; nothing where nothing moved."""
    if found is None or found["mass"] == 0.0:
        return
    ways = [(side, found[side]) for side in WAYS if found[side] is not None]
    ran = [f"x99 {way['x99']:.4g} m at the {side}, {way['angle']:.3g}° below the old crest" for side, way in ways]
    rest = found.get("rest")
    still = [] if "rest" not in found else ["not at rest" if rest is None else f"at rest from {rest:.4g} s"]
    moved = f"{percent(found['share'])} of the mass moved by more than a diameter"
    yield "; ".join([moved, *ran, *still])
    if (pieces := found["fragments"]) is not None and pieces["share"] > 0.0:
        yield (
            f"{pieces['count']:,} fragments of two disks or more, the largest {pieces['largest']:.3g} m, and "
            f"{percent(pieces['singles'])} of their mass in single disks; d50 {pieces['d50']:.3g} m, "
            f"d80 {pieces['d80']:.3g} m"
        )


def rest_warnings(case: DiskCase, summary: Mapping[str, Any]) -> Iterator[str]:
    """A warning about a run that should have ended at rest, and did not."""
    if case.run.until != "rest" or summary["ended"] is not None:
        return
    found = summary["debris"]
    why = "nothing fell: no disk moved by more than a diameter"
    if found["fall"] > 0.0:
        share = found["kinetic"] / found["fall"]
        why = f"the kinetic energy at its end is {share:.2g} of that of the fall"
        why += f"; below {AT_REST:g} it must stay for run.rest_for" if share < AT_REST else ""
    yield (
        f'run.until: is "rest", but the run took its whole duration, {case.run.duration:g} s: {why}; take a longer '
        "run.duration, or dashpots of contacts (dp_nratio)"
    )
