"""The runs of a page, and its tables: changed keys, monitors, sides, energies, times, versions, estimated errors."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dembound.boundaries.description import FACTORS
from dembound.errors import CaseError, RecordError
from dembound.kinds import kind_of_record
from dembound.motion.kind import Kind
from dembound.plot.disks import GROUP
from dembound.plot.energy import BAR_COLUMNS, COLUMNS, PREFIXES, power_of_unit
from dembound.results.histories import KEY, entries
from dembound.results.reader import laws_in_words, open_record, record_names, understood
from dembound.results.results import Results
from dembound.results.summary import end_in_words, read_summary
from dembound.words import Entries, percent

NONE = "–"
"""Text in place of an entry that a run does not have."""


@dataclass(frozen=True)
class Table:
    """A table of texts: its title, the heads of its columns, and rows of as many cells."""

    title: str
    heads: Sequence[str]
    rows: Sequence[Sequence[str]]


def side_by_side(
    title: str, runs: Sequence[ReportedRun], entries: Callable[[ReportedRun], Entries], *, different: bool = False
) -> Table | None:
    """A table with a column for each run, and a row for each entry that any of them has; None without rows.

    different : only entries in which the runs differ.
    """
    found = [dict(entries(run)) for run in runs]
    names = dict.fromkeys(name for each in found for name in each)
    rows = [[name, *(each.get(name, NONE) for each in found)] for name in names]
    rows = [row for row in rows if not different or len(set(row[1:])) > 1]
    return Table(title, ["", *(run.name for run in runs)], rows) if rows else None


def _overview(run: ReportedRun) -> Entries:
    """Body, duration and law of a run, and how it ended."""
    attributes, summary = run.results.attributes, run.summary
    if run.has_histories_alone:
        library = attributes.get("superposed")
        yield "body", f"motion at monitors, from the library {library}" if library else "exact motion at monitors"
        return
    size = attributes.get("size", [0.0, 0.0])
    if run.is_bar:
        yield "body", f"bar of {size[0]:.6g} m, {len(run.results.particles['position']):,} nodes"
    else:
        yield "body", f"{size[0]:.6g} m × {size[1]:.6g} m, {', '.join(_contents(run))}"
    yield "duration", f"{attributes['steps']:,} steps of {attributes['time_step']:.5g} s"
    if run.results.laws:
        yield "law", laws_in_words(run.results.laws)
    if not summary:
        yield "end", "the run is not complete"
        return
    yield "end", (end_in_words(summary) or [f"after {summary['duration']:.6g} s, as planned"])[0]
    if outcome := run.kind.outcome(summary):
        yield "outcome", "; ".join(outcome)
    cracks = summary["cracks"]
    yield "broken bonds", f"{cracks['tension']:,} in tension, {cracks['shear']:,} in shear"
    yield "largest error of the energy balance", percent(summary["energy"]["relative_error"], 3)


def _contents(run: ReportedRun) -> Iterator[str]:
    """The contents of a scene of disks in words."""
    column = run.results.attributes.get("column", 0)
    yield f"{len(run.results.particles['radius']) - column:,} disks"
    if column > 0:
        yield f"{column:,} more in the free-field column"
    with open_record(run.record) as file:
        if GROUP in file:
            yield f"a continuum of {len(file[f'{GROUP}/position']):,} nodes"


def _flat(value: Any, name: str = "") -> Iterator[tuple[str, str]]:
    """Keys of nested tables by their paths, and their values as text."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _flat(inner, f"{name}.{key}" if name else str(key))
    elif isinstance(value, list) and any(isinstance(each, Mapping) for each in value):
        for number, inner in enumerate(value, start=1):
            yield from _flat(inner, f"{name}[{number}]")
    else:
        yield name, _text(value)


def _text(value: Any) -> str:
    """A plain value as text."""
    if isinstance(value, list):
        return f"[{', '.join(map(_text, value))}]"
    if value is None or isinstance(value, bool):
        return {None: NONE, True: "yes", False: "no"}[value]
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def monitors(runs: Sequence[ReportedRun]) -> Table | None:
    """Peaks and arrivals at the monitors of all runs; None without any."""
    rows = [
        [
            name,
            run.name,
            f"({', '.join(f'{each:.5g}' for each in entry['position'])}) m",
            f"{entry['peak_velocity']:.4g} m/s along {entry['component']}",
            _seconds(entry["peak_time"]),
            _seconds(entry["arrival"]),
        ]
        for run in runs
        for name, entry in run.summary.get("monitors", {}).items()
    ]
    rows.sort(key=lambda row: row[0])  # a monitor of several runs in consecutive rows
    heads = ["monitor", "run", "position", "peak velocity", "time of the peak", "arrival"]
    return Table("Monitors", heads, rows) if rows else None


def _seconds(time: float | None) -> str:
    return NONE if time is None else f"{time:.5g} s"


def layers(runs: Sequence[ReportedRun]) -> Table | None:
    """The layers of the grounds from the surface down, with their joints as packed; None without any."""
    rows = [
        [
            f"{layer['name']}, {layer['side']}" if "side" in layer else layer["name"],
            run.name,
            f"{layer['top']:.6g} to {layer['bottom']:.6g} m",
            f"{layer['density']:.5g} kg/m³",
            *(NONE if layer[key] is None else f"{layer[key]:.5g} m/s" for key in ("p_wave_speed", "s_wave_speed")),
            _joint(layer["joint"] or {}),
        ]
        for run in runs
        for layer in run.summary.get("layers", [])
    ]
    heads = ["layer", "run", "y", "density", "c_p along y", "c_s along y", "joint below, as packed above its plane"]
    return Table("Layers", heads, rows) if rows else None


def _joint(heights: Mapping[str, float | None]) -> str:
    """The effective heights of a joint above its plane."""
    names = {"mass": "mass", "p": "P", "s": "S"}
    return ", ".join(f"{names[key]} {at:.3g} m" for key, at in heights.items() if at is not None) or NONE


def _fragments(run: ReportedRun) -> Entries:
    """The fragments at the end of a run; none where nothing came off."""
    found = (run.summary.get("debris") or {}).get("fragments") or {}
    if found.get("share"):
        yield "of two disks or more", f"{found['count']:,}"
        yield "share of the mass of the body", percent(found["share"], 3)
        yield "of that, single disks", percent(found["singles"], 3)
        for name, words in {"d50": "d50", "d80": "d80", "largest": "diameter of the largest"}.items():
            yield words, f"{found[name]:.4g} m" if name in found else NONE


def sides(runs: Sequence[ReportedRun]) -> Table | None:
    """Table of the sides: type, factors, energies that came in and absorbed energies; None without summaries."""
    rows = []
    for run in runs:
        tables = run.summary.get("boundaries", {})
        for side, energy in run.summary.get("sides", {}).items():
            table = tables.get(side, {})
            factors = [f"{letter} = {_each(table, key)}" for key, letter in FACTORS.items() if key in table]
            amounts = [_joules(energy[column], run) for column in ("came_in", "absorbed", "stored")]
            taken = NONE if (share := energy["absorbed_share"]) is None else percent(share, 3)
            rows.append([side, run.name, table.get("type", NONE), ", ".join(factors) or NONE, *amounts, taken])
    heads = ["side", "run", "type", "factors", "came in", "absorbed", "stored in springs", "absorbed of all"]
    return Table("Sides", heads, rows) if rows else None


def _each(side: Mapping[str, Any], key: str) -> str:
    """A number of a side, or those beside all of its layers, the lowest first."""
    return ", ".join(dict.fromkeys(f"{each[key]:.5g}" for each in side.get("layers", [side])))


def _energies(run: ReportedRun) -> Entries:
    """The last entries of a run's energy ledger; none without a summary."""
    ledger = run.summary.get("energy")
    if ledger is None:
        return
    yield "supplied in all", _joules(ledger["supplied"], run)
    for column, words in (BAR_COLUMNS if run.is_bar else COLUMNS).items():
        if ledger.get(column, 0.0) != 0.0:
            yield words, _joules(ledger[column], run)
    left = sum(ledger.get(column, 0.0) for column in ("kinetic", "contact", "bond", "stepping"))
    if ledger["supplied"] > 0.0:
        yield "left in the body, of all that was supplied", percent(left / ledger["supplied"], 3)


def _joules(energy: float, run: ReportedRun) -> str:
    """An energy with a prefix of its unit, which for disks is J per metre of thickness."""
    power = power_of_unit(abs(energy))
    return f"{energy / 10.0**power:.4g} {PREFIXES[power]}{'J' if run.is_bar else 'J/m'}"


def _time(run: ReportedRun) -> Entries:
    """Seconds by part of a run, rate and RAM; none without a summary."""
    summary = run.summary
    if not summary:
        return
    yield from ((part, f"{seconds:.3g} s") for part, seconds in summary["seconds"].items())
    yield "in all", f"{summary['wall_time']:.3g} s"
    yield "threads", str(summary["threads"])
    yield "rate", f"{summary['particle_steps_per_second'] / 1e6:.3g} million particle-steps per second"
    yield "memory", f"{summary['memory_bytes'] / 1e6:.0f} MB"


def _version(run: ReportedRun) -> Entries:
    """Version, seed and resumptions of a run."""
    yield "dembound", str(run.results.attributes.get("version", NONE))
    yield "seed", str(run.results.attributes.get("seed", NONE))
    if resumed := [f"step {each['step']:,}" for each in run.summary.get("resumed", [])]:
        yield "resumed", ", ".join(resumed)


TABLES: dict[str, Callable[[Sequence[ReportedRun]], Table | None]] = {
    "overview": lambda runs: side_by_side("Runs", runs, _overview),
    "changed_keys": lambda runs: side_by_side(
        "Keys of the cases that differ", runs, lambda run: _flat(run.summary.get("keys", {})), different=True
    ),
    "fragments": lambda runs: side_by_side("Fragments at the end", runs, _fragments),
    "layers": layers,
    "monitors": monitors,
    "sides": sides,
    "energies": lambda runs: side_by_side("Energy at the end", runs, _energies),
    "error_estimate": lambda runs: side_by_side(
        "Estimated errors", runs, lambda run: entries(run.summary[KEY]) if KEY in run.summary else iter(())
    ),
    "time_split": lambda runs: side_by_side("Where the time went", runs, _time),
    "versions": lambda runs: side_by_side("Versions", runs, _version),
}
"""The tables of a page by their names in its template; None for one without rows."""


@dataclass(frozen=True)
class ReportedRun:
    """A run: its record, a unique name, its kind, its results, and its summary.

    The summary is empty for a run that is not complete.
    """

    record: Path
    name: str
    kind: Kind[Any, Any]
    results: Results
    summary: Mapping[str, Any]

    @property
    def has_histories_alone(self) -> bool:
        """Whether the record has only histories of monitors, exact or superposed from a library, and no body."""
        return len(self.results.particles) == 0

    @property
    def is_bar(self) -> bool:
        """Whether the record is that of a bar."""
        return self.kind.name == "bar"


def read_runs(records: Sequence[Path]) -> list[ReportedRun]:
    """The runs of a page.

    Raises CaseError or RecordError, with one line for each record that cannot be read, is not that of a run, or is of
    another kind than the first.
    """
    found: list[tuple[Path, Kind[Any, Any], Results, Mapping[str, Any]]] = []
    errors: list[CaseError] = []
    for record in records:
        try:
            found.append((record, *_read(record)))
        except CaseError as error:
            errors.append(error)
    if errors:
        failure = RecordError if all(isinstance(error, RecordError) for error in errors) else CaseError
        raise failure([line for error in errors for line in str(error).splitlines()])
    kinds = sorted({kind.plural for _, kind, _, _ in found})
    if len(kinds) > 1:
        holds = f"RESULTS: holds runs of {' and of '.join(kinds)}"
        raise CaseError([f"{holds}, which have no page in common; name one kind"])
    names = record_names(records)
    return [ReportedRun(each[0], name, *each[1:]) for name, each in zip(names, found, strict=True)]


def _read(record: Path) -> tuple[Kind[Any, Any], Results, Mapping[str, Any]]:
    """Kind, results and summary of a record."""
    if record.name == "calibration.h5":
        raise CaseError([f"{record}: is of a calibration; pages and movies are of runs"])
    kind, results = kind_of_record(record), Results(record)
    if record.name != "run.h5" or not (record.parent / "summary.json").is_file():
        return kind, results, {}
    summary = read_summary(record.parent)
    with understood(record):
        _ = summary["version"]  # which every summary has
        return kind, results, dict(summary)
