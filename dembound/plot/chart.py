"""A chart: the error of every choice against its cost, with the Pareto front and the names of all choices."""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.text import Annotation
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from dembound.plot.style import COLOURS, REFERENCE, new_figure, styled
from dembound.results.reader import open_record, text_of
from dembound.results.structure import Members, run_of

LEVELS = (1.0, 0.1)
"""Errors (%) marked by horizontal lines."""

LEAST = 1e-4
"""Smallest error shown, in per cent; smaller ones are drawn there."""

SPANS = (8.0, 20.0)
"""Least ratio of the ends of the axis of costs, and of that of errors."""

MARGIN, DECADES = 0.6, 300.0
"""Ends of the axes over the extreme values; ratio of the ends up to which 2 and 5 have numbers, too."""

MOST_LISTED = 28
"""Number of choices that are listed; of more only those on the front and those that failed are."""

ELSEWHERE = "others: see chart.csv"

DARK = "#404040"

NO_BREAK = "\u00a0"
"""A blank at which `textwrap` breaks no line."""

MARK = "†"
"""Mark of choices whose monitors are not where the reference recorded them."""

REFERENCE_HEAD, OTHERS = "reference", "others"

LINE = 0.033
"""Height of a line of the list over that of the panel."""

WIDTH = 68
"""Characters in a line of the list."""

PLACES = [
    (radius * np.cos(angle), radius * np.sin(angle))
    for radius in (12.0, 17.0, 25.0)
    for angle in np.radians([45, 225, 135, 315, 0, 90, 180, 270, *range(22, 360, 45)])
]
"""Places of a number beside its point, in points, in the order in which they are tried."""


@dataclass(frozen=True)
class Dot:
    """A choice of a chart.

    number : from 1. error : RMS of the worst monitor, %; cpu (r,) s of each run; both empty after a failure. monitor :
    the worst, with its component. found : other numbers beside those of the reference, in words. apart : m, largest
    distance of a monitor from where the reference recorded it.
    """

    number: int
    name: str
    on_front: bool
    failure: str
    error: float
    cpu: np.ndarray
    monitor: str
    found: str = ""
    apart: float = 0.0

    @property
    def cost(self) -> float:
        """Median CPU time, s."""
        return float(np.median(self.cpu))

    @property
    def shown(self) -> float:
        """The error as drawn, %."""
        return max(self.error, LEAST)


@styled
def plot_chart(path: Path, title: str | None = None) -> Figure:
    """RMS error against CPU time of stepping, both logarithmic, and a list of the choices.

    Points have the numbers of the list; horizontal bars show the range of the timed runs, horizontal lines 1 % and
    0.1 %, a vertical line the cost of the reference if it is one of the choices.

    Parameters
    ----------
    path
        ``chart.h5`` of a chart.
    title
        Above the sentence about the cheapest choices; by default that of the case.

    Raises CaseError when the file cannot be read.
    """
    with open_record(path) as file:
        choices, runs = Members(file, "choices"), Members(file, "runs")
        dots = [_read(number, choice, runs) for number, choice in enumerate(choices.values(), start=1)]
        reference = text_of(file["reference"].attrs["sentence"])
        own = {k + 1 for k in file["reference"].attrs["choices"]}
        quantity, title = text_of(file.attrs["quantity"]), title or text_of(file.attrs["title"] or file.attrs["name"])
        sentence, threads = text_of(file.attrs["sentence"]), _threads(runs)
    figure = new_figure(12.0, 6.4)
    panel, side = figure.subplots(1, 2, width_ratios=(1.45, 1.0))
    good = [dot for dot in dots if not dot.failure and dot.number not in own]
    _draw(panel, good)
    for number in sorted(own):
        label, cost = f"cost of the reference, {number}", dots[number - 1].cost
        panel.axvline(cost, color=REFERENCE, linestyle=":", linewidth=1.2, label=label)
    monitors = ", ".join(dict.fromkeys(dot.monitor for dot in good))
    panel.set_xlabel(f"CPU time of stepping (s), {threads} thread{'s' if threads > 1 else ''}")
    panel.set_ylabel(f"RMS error of the {quantity}, worst monitor (%)")
    panel.set_title(_wrapped(f"errors are those against {reference}; {monitors}", 88), loc="left", fontsize=8.5)
    if any(dot.on_front for dot in dots):
        panel.legend(loc="best", fontsize=8.5)
    _list(side, dots, own)
    figure.suptitle(f"{title}\n{_wrapped(sentence, 150)}", fontsize=10, parse_math=False)
    figure.draw_without_rendering()
    _number(figure, panel, good)
    return figure


def _read(number, group, runs) -> Dot:  # type: ignore[no-untyped-def]
    """A choice of an open record, with its run."""
    failure = text_of(group.attrs["failure"])
    if failure:
        return Dot(number, text_of(group.attrs["name"]), False, failure, np.nan, np.zeros(0), "")
    monitor = f"{group['monitor'].asstr()[0]} ({group['component'].asstr()[0]})"
    on_front, error = bool(group.attrs["on_front"]), 100.0 * float(group["rms"][0])
    found, apart = text_of(group.attrs["found"]), float(np.max(group["apart"]))
    cpu = runs[run_of(group)]["cpu"][:]
    return Dot(number, text_of(group.attrs["name"]), on_front, "", error, cpu, monitor, found, apart)


def _threads(runs) -> int:  # type: ignore[no-untyped-def]
    """The largest number of threads of any run."""
    return max(int(run.attrs["threads"]) for run in runs.values())


def _draw(panel: Axes, dots: Sequence[Dot]) -> None:
    """All points with the ranges of their costs, the front as a line, and the levels."""
    panel.set(xscale="log", yscale="log")
    for dot in dots:
        colour = COLOURS[1] if dot.on_front else COLOURS[0]
        panel.plot([dot.cpu.min(), dot.cpu.max()], [dot.shown] * 2, color=colour, linewidth=1.0, alpha=0.5)
        size, marker = (7.0, "o") if dot.on_front else (5.0, "o" if dot.error > LEAST else "v")
        panel.plot(dot.cost, dot.shown, marker, color=colour, markersize=size, zorder=3, gid=dot.name)
    line = sorted((dot for dot in dots if dot.on_front), key=lambda dot: dot.shown)
    if line:
        looks: dict[str, Any] = {"color": COLOURS[1], "linewidth": 1.6, "marker": "o", "markersize": 7.0}
        panel.plot([dot.cost for dot in line], [dot.shown for dot in line], label="Pareto front", **looks)
    _widen(panel, dots)
    low, high = panel.get_ylim()
    for level in LEVELS:
        if low < level < high:
            panel.axhline(level, color=REFERENCE, linewidth=0.9, linestyle="--", zorder=1)


def _widen(panel: Axes, dots: Sequence[Dot]) -> None:
    """Axes that are at least as wide as `SPANS`, so that small differences are not magnified, with plain numbers."""
    costs = np.concatenate([dot.cpu for dot in dots])
    errors = np.array([dot.shown for dot in dots])
    for axis, values, span in zip((panel.xaxis, panel.yaxis), (costs, errors), SPANS, strict=True):
        low, high = MARGIN * values.min(), values.max() / MARGIN
        wider = max(1.0, np.sqrt(span * low / high))
        axis.set_view_interval(low / wider, high * wider, ignore=True)
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high / low < DECADES else (1.0,), numticks=12))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())


def _number(figure: Figure, panel: Axes, dots: Sequence[Dot]) -> None:
    """Write the number of every point beside it, inside the panel, nearer to it than to other points.

    A number covers no other number or point; those on the front are written first, and some may find no place.
    """
    centres = panel.transData.transform([(dot.cost, dot.shown) for dot in dots])
    taken: list[tuple[float, float]] = []
    point = figure.dpi / 72.0
    inside = panel.get_window_extent().padded(-7.0 * point)
    for k in sorted(range(len(dots)), key=lambda k: not dots[k].on_front):
        points = np.delete(centres, k, axis=0)
        for place in PLACES:
            x, y = centres[k] + point * np.array(place)
            is_clear = all(abs(x - u) > 12.5 * point or abs(y - v) > 9.5 * point for u, v in (*taken, *points))
            is_nearest = all(np.hypot(x - u, y - v) > point * np.hypot(*place) for u, v in points)
            if is_clear and is_nearest and inside.contains(x, y):
                taken.append((float(x), float(y)))
                _annotate(panel, dots[k], place)
                break


def _annotate(panel: Axes, dot: Dot, place: tuple[float, float]) -> Annotation:
    """The number of a point, at a place in points beside it."""
    return panel.annotate(
        str(dot.number),
        (dot.cost, dot.shown),
        place,
        textcoords="offset points",
        ha="center",
        va="center",
        fontsize=9.5 if dot.on_front else 8.0,
        fontweight="bold" if dot.on_front else "normal",
        color=COLOURS[1] if dot.on_front else COLOURS[0],
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
    )


def _list(panel: Axes, dots: Sequence[Dot], own: Collection[int]) -> None:
    """The names, errors and costs of the choices, the front first, then the others, then failures."""
    panel.set_axis_off()
    rest = [dot for dot in dots if not (dot.on_front or dot.failure or dot.number in own)]
    entries = [
        *_entries("Pareto front, the cheapest first", [dot for dot in dots if dot.on_front], COLOURS[1]),
        *_entries(REFERENCE_HEAD, [dot for dot in dots if dot.number in own], DARK),
        *(_entries(OTHERS, rest, COLOURS[0]) if len(dots) <= MOST_LISTED else [(ELSEWHERE, COLOURS[0], True)]),
        *_entries("failed", [dot for dot in dots if dot.failure], DARK),
        *_footnote(dots),
    ]
    lines = sum(text.count("\n") + 1 for text, _, _ in entries)
    height = min(LINE, 1.0 / lines)
    y = 1.0
    for text, colour, bold in entries:
        panel.text(
            0.0,
            y,
            text,
            transform=panel.transAxes,
            va="top",
            fontsize=8.5 * height / LINE,
            color=colour,
            fontweight="bold" if bold else "normal",
            linespacing=1.0,
        )
        y -= height * (text.count("\n") + 1)


def _entries(head: str, dots: Sequence[Dot], colour: str) -> list[tuple[str, str, bool]]:
    """Text, colour and weight of every line of a part of the list; none for an empty part."""
    if not dots:
        return []
    found = [(head, colour, True)]
    for dot in sorted(dots, key=lambda dot: dot.cost if len(dot.cpu) else 0.0):
        error = f"{dot.error:.{2 if dot.error < 99.5 else 3}g} %, " if dot.error >= LEAST else "0 %, "
        numbers = dot.failure or f"{'' if head == REFERENCE_HEAD else error}{dot.cost:.2g} s"
        numbers += f", {dot.found}" if dot.found and head != OTHERS else ""
        mark = MARK if dot.apart > 0.0 else ""
        found.append((_wrapped(f"{dot.number}  {dot.name}{mark}: {numbers}", WIDTH), colour, False))
    return found


def _footnote(dots: Sequence[Dot]) -> list[tuple[str, str, bool]]:
    """The meaning of the mark, if any choice has it."""
    farthest = max(dot.apart for dot in dots)
    text = f"{MARK} monitors record elsewhere than in the reference, up to {farthest:.2g} m away"
    return [("", DARK, False), (_wrapped(text, WIDTH), DARK, False)] if farthest > 0.0 else []


def _wrapped(text: str, width: int) -> str:
    """A text in lines of at most `width` characters, in which every number is on one line with the word after it."""
    import textwrap

    together = re.sub(r"(?<=\d) (?=\S)", NO_BREAK, text)
    lines = textwrap.wrap(together, width, subsequent_indent="     " if width == WIDTH else "")
    return "\n".join(lines).replace(NO_BREAK, " ")
