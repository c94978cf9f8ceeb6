"""One self-contained HTML page of runs: pictures, charts to zoom, tables, cases. It loads nothing."""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.errors import CaseError, RecordError, visible
from dembound.files import require_folder, write_text
from dembound.plot.energy import plot_energy
from dembound.plot.field_reader import FRAGMENTS, evenly_chosen
from dembound.plot.histories import largest_values, plot_histories
from dembound.plot.pieces import plot_sieve
from dembound.plot.record import plot_spectra
from dembound.report.pictures import Picture, picture_of, uri_of
from dembound.report.tables import TABLES, ReportedRun, read_runs
from dembound.results.histories import read_histories
from dembound.results.pieces import have_pieces
from dembound.results.reader import reading, snapshots_of, understood
from dembound.version import __version__

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup

MOST_FRAMES = 40
"""Largest number of frames of a scene; more snapshots are thinned evenly."""

FRAME_DOTS = 105
"""Pixels per inch of a frame."""

VISIBLE = 0.01
"""Share of the largest velocity above which the other component has its own picture."""


@dataclass(frozen=True)
class Frames:
    """A scene at several times: URIs of its pictures, what each shows in words, and their size in pixels.

    first : the number of the frame that is shown first, the one with the most motion.
    """

    uris: list[str]
    captions: list[str]
    width: int
    height: int
    first: int


@dataclass(frozen=True)
class ShownRun:
    """A run on a page, with the still pictures of its scene, its frames, and pictures of its energy and fragments."""

    run: ReportedRun
    scenes: list[Picture]
    frames: Frames | None
    energy: Picture | None
    pieces: Picture | None = None


def write_report(records: Sequence[Path], path: Path, say: Callable[[str], None] = lambda line: None) -> None:
    """Write the page of some runs of one kind, either completely or not at all.

    Parameters
    ----------
    records
        ``run.h5`` files; the ``summary.json`` beside each is used if there is one.
    path
        of the HTML file.
    say
        called with a line for every missing part of the page that a run does not contain.

    Raises CaseError or RecordError, with a line for each record that cannot be used, FileNotFoundError if the folder of
    the path does not exist.
    """
    require_folder(path)
    runs = read_runs(records)
    with understood(*records):
        text = _render(runs, say)
    write_text(path, text)


def _render(runs: Sequence[ReportedRun], say: Callable[[str], None]) -> str:
    """The text of the page; raises RecordError for a summary of another origin."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    for run in runs:
        with understood(run.record):  # of which run a foreign summary is
            _ = [table([run]) for table in TABLES.values()]
    made = {name: table(runs) for name, table in TABLES.items()}
    missing: list[str] = []

    def attempt(draw: Callable[[], Any]) -> Any:
        """The result of `draw`, or None after reporting the missing part in a line."""
        try:
            return draw()
        except RecordError:
            raise
        except CaseError as error:
            missing.extend(line for line in str(error).splitlines() if line not in missing)
            return None

    shown = [_shown(run, attempt) for run in runs]
    charts = list(_charts(runs, attempt))
    broken = [each.run.record for each in shown if each.pieces]
    sieve = attempt(lambda: picture_of(plot_sieve(broken))) if broken else None
    for run in runs:
        if not run.summary and not run.has_histories_alone:
            missing.append(f"{run.record.parent}: has no summary, the run is not complete; tables lack it")
    for line in missing:
        say(line)
    live: dict[str, Any] = {f"chart-{number}": each.chart for number, each in enumerate(charts)}
    for number, each in enumerate(shown):
        if each.frames is not None:
            live[f"frames-{number}"] = vars(each.frames)
        if each.energy is not None:
            live[f"energy-{number}"] = each.energy.chart
    environment = Environment(
        loader=PackageLoader("dembound.report", "template"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=_shown_text,
    )
    inline = {name: _source(environment, file) for name, file in (("style", "page.css"), ("script", "page.js"))}
    return environment.get_template("page.html").render(
        inline=inline,
        # in base64: the policy of the page allows only this style sheet and this script
        hashes={
            name: base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for name, text in inline.items()
        },
        title=", ".join(run.name for run in runs),
        version=__version__,
        runs=shown,
        charts=charts,
        sieve=sieve,
        missing=missing,
        live=_packed(live),
        tables=made,
    )


def _source(environment: Environment, name: str) -> Markup:
    """The text of the style sheet or the script of the template as browsers read it, with line feeds only."""
    from markupsafe import Markup

    loader = environment.loader
    assert loader is not None
    return Markup("\n".join(loader.get_source(environment, name)[0].splitlines()))


def _shown_text(value: Any) -> Any:
    """A value with escapes for characters that would hide or reorder text, also in the text of a case."""
    from markupsafe import Markup

    if isinstance(value, Markup) or not isinstance(value, str):
        return value
    return "\n".join(visible(line) for line in value.replace("\t", "    ").split("\n"))


def _shown(run: ReportedRun, attempt: Callable[[Callable[[], Any]], Any]) -> ShownRun:
    """The pictures of one run; none for a record of only histories."""
    if run.has_histories_alone:
        return ShownRun(run, [], None, None)
    scenes = attempt(lambda: [picture_of(figure) for name, figure in run.kind.pictures(run.record) if name == "scene"])
    frames = attempt(lambda: _frames(run))
    energy = attempt(lambda: picture_of(plot_energy(run.record)))
    pieces = None
    if have_pieces(run.record):
        pieces = attempt(lambda: picture_of(run.kind.field_picture(run.record, FRAGMENTS, None, None)))
    return ShownRun(run, scenes or [], frames, energy, pieces)


def _frames(run: ReportedRun) -> Frames | None:
    """The scene at its snapshots; None if there is only one."""
    moving = run.kind.moving_picture(run.record, None, None)
    if len(moving.times) == 1:
        return None
    pixels = round(FRAME_DOTS * moving.width)
    chosen = evenly_chosen(len(moving.times), MOST_FRAMES)
    uris = [uri_of(moving.frame(index, pixels), lossless=False) for index in chosen]
    first = int(np.argmax(_motion(run.record, chosen)))
    return Frames(uris, [*map(moving.caption, chosen)], pixels, round(FRAME_DOTS * moving.height), first)


def _motion(record: Path, chosen: Sequence[int]) -> list[float]:
    """Sum of v² (m²/s²) of the disks or nodes at some snapshots of a run."""
    with reading(record) as file:
        groups = snapshots_of(file)
        return [float(np.square(groups[index]["velocity"][:, :2]).sum()) for index in chosen]


def _charts(runs: Sequence[ReportedRun], attempt: Callable[[Callable[[], Any]], Any]) -> Iterator[Picture]:
    """Histories and spectra of all runs together, of every component that is not negligible."""
    records = [run.record for run in runs]
    components = attempt(lambda: _components(records)) or []
    draws = [partial(plot_histories, records, component) for component in components]
    if components and runs[0].is_bar:
        draws.append(partial(plot_histories, records, quantity="stress"))
    draws += [partial(plot_spectra, records, component) for component in components]
    for draw in draws:
        if figure := attempt(draw):
            yield picture_of(figure)


def _components(records: Sequence[Path]) -> list[Any]:
    """Components, x or y, along which the velocity is visible at any monitor, or the larger if both are zero."""
    histories = [read_histories(record, "velocity") for record in records]
    if not any(histories):
        raise CaseError([f"{', '.join(map(str, records))}: has no monitors to show"])
    largest = largest_values(histories)
    is_visible = largest >= VISIBLE * largest.max()
    return [
        name for name, each, shown in zip("xy", largest, is_visible, strict=True) if shown and (each or name == "x")
    ]


def _packed(values: dict[str, Any]) -> str:
    """Plain values as compressed JSON in characters that a page may contain; equal values give equal text."""
    text = json.dumps(_visible_in(values), separators=(",", ":"), allow_nan=False)
    return base64.b64encode(gzip.compress(text.encode(), mtime=0)).decode()


def _visible_in(value: Any) -> Any:
    """Plain values with hidden characters in all texts escaped, see `visible`."""
    if isinstance(value, dict):
        return {visible(name): _visible_in(inner) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_visible_in(inner) for inner in value]
    return visible(value) if isinstance(value, str) else value
