"""A chart: the error of every choice against its cost, with the Pareto front and the names of choices."""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from dembound.plot.point_labels import Labelled, Labels
from dembound.plot.style import COLOURS, REFERENCE, new_figure, plain_numbers, styled
from dembound.results.reader import open_record, text_of
from dembound.results.structure import Members

LEVELS = (1.0, 0.1)
"""Errors (%) marked by horizontal lines."""

LEAST = 1e-4
"""Smallest error shown, in per cent; smaller ones are drawn at this value."""

SPANS = (8.0, 20.0)
"""Least ratio of the ends of the axis of costs, and of the axis of errors."""

MARGIN, DECADES = 0.6, 300.0
"""Ends of the axes over the extreme values; ratio of the ends up to which 2 and 5 have numbers, too."""

MOST_LISTED = 28
"""Largest number of choices that are all named or listed; of more only those on the front and failed ones."""

ELSEWHERE = "others: see chart.csv"

DARK = "#404040"

NO_BREAK = "\u00a0"
"""A blank at which `textwrap` does not break lines."""

MARK = "†"
"""Mark of choices whose monitors are not where the reference recorded them."""

REFERENCE_HEAD, OTHERS = "reference", "others"

LINE = 0.033
"""Height of a line of the list over that of the panels."""

PAGE, NARROW = (12.0, 6.4), 8.0
"""Width and height of the picture in inches; where it is not wider than this, the list is below the chart."""

BESIDE, BELOW = (1.8, 1.0), (2.4, 1.0)
"""Shares of the chart and the list of the width of a wide page, and of the height of a narrow one."""

LETTERS, SMALL_LETTERS = 12.5, 14.0
"""Characters to the inch in the title, and elsewhere."""

INDENT = "     "
"""Before all but the first line of an entry of the list."""

Entry = tuple[str, str, bool]
"""Text, colour and weight of an entry of the list."""


@dataclass(frozen=True)
class Dot:
    """A choice of a chart.

    number : from 1. error : RMS of the worst monitor, %; cost : s; both as used for the front; exact : the error before
    nearly equal ones are merged; nan after a failure. monitor : the worst, with its component. found : findings, as
    differences from the reference, in words. apart : m, largest distance of a monitor from where the reference recorded
    it.
    """

    number: int
    name: str
    on_front: bool
    failure: str
    error: float
    cost: float
    exact: float
    monitor: str
    found: str = ""
    apart: float = 0.0

    @property
    def marked(self) -> str:
        """The name, with a mark if its monitors are not where the reference recorded them."""
        return self.name + (MARK if self.apart > 0.0 else "")

    @property
    def place(self) -> tuple[float, float]:
        """Cost and error as drawn."""
        return self.cost, max(self.error, LEAST)


@styled
def plot_chart(path: Path, title: str | None = None) -> Figure:
    """RMS error against CPU time of stepping, both logarithmic, and a list of choices.

    Points have names or, where these do not fit, the numbers of the list; the list leaves out named choices off the
    front. Horizontal lines show 1 % and 0.1 %, a vertical line the cost of the reference if it is one of the choices.

    Parameters
    ----------
    path
        ``chart.h5`` of a chart.
    title
        Title above the sentence about the cheapest choices; by default the title of the case.

    Raises CaseError when the file cannot be read.
    """
    with open_record(path) as file:
        dots = [_read(number, choice) for number, choice in enumerate(Members(file, "choices").values(), start=1)]
        reference, truth, covered = (text_of(file["reference"].attrs[name]) for name in ("sentence", "of", "covered"))
        own = {k + 1 for k in file["reference"].attrs["choices"]}
        quantity, title = text_of(file.attrs["quantity"]), title or text_of(file.attrs["title"] or file.attrs["name"])
        sentence = text_of(file.attrs["sentence"])
        threads = max(int(run.attrs["threads"]) for run in Members(file, "runs").values())
    figure = new_figure(*PAGE)
    panels = figure.subplots(1, 2, width_ratios=BESIDE) if _is_wide() else figure.subplots(2, 1, height_ratios=BELOW)
    panel, side = panels
    good = [dot for dot in dots if not dot.failure and dot.number not in own]
    _draw(panel, good)
    for number in sorted(own):
        label, cost = f"cost of the reference, {number}", dots[number - 1].cost
        panel.axvline(cost, color=REFERENCE, linestyle=":", linewidth=1.2, label=label)
    monitors = ", ".join(dict.fromkeys(dot.monitor for dot in good))
    along = f"cost: CPU time of stepping (s), {threads} thread{'s' if threads > 1 else ''}"
    panel.set(xlabel=along, ylabel=f"RMS error of the {quantity}, worst monitor (%)")
    heading = [f"errors {truth}, beside {reference}; {monitors}", covered]
    panel.set_title("\n".join(_wrapped(line, _letters(0)) for line in heading), loc="left", fontsize=8.5)
    if any(dot.on_front for dot in dots):
        panel.legend(loc="best", fontsize=8.5)
    _list(side, dots, own, [dot.number for dot in dots])
    figure.suptitle(f"{title}\n{_wrapped(sentence, int(LETTERS * PAGE[0]))}", fontsize=10, parse_math=False)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # labels fit into this panel
    _list(side, dots, own, _label(panel, good))
    return figure


def _is_wide() -> bool:
    """Whether the list is beside the chart."""
    return PAGE[0] > NARROW


def _letters(panel: int) -> int:
    """Number of characters in a line as wide as a panel: 0, the chart, or 1, the list."""
    return int(SMALL_LETTERS * PAGE[0] * (BESIDE[panel] / sum(BESIDE) if _is_wide() else 1.0))


def _read(number, group) -> Dot:  # type: ignore[no-untyped-def]
    """A choice of an open record."""
    failure = text_of(group.attrs["failure"])
    if failure:
        return Dot(number, text_of(group.attrs["name"]), False, failure, np.nan, np.nan, np.nan, "")
    monitor = f"{group['monitor'].asstr()[0]} ({group['component'].asstr()[0]})"
    on_front, exact = bool(group.attrs["on_front"]), 100.0 * float(group["total"][0])
    error, cost = 100.0 * float(group.attrs["error"]), float(group.attrs["cost"])
    found, apart = text_of(group.attrs["found"]), float(np.max(group["apart"]))
    return Dot(number, text_of(group.attrs["name"]), on_front, "", error, cost, exact, monitor, found, apart)


def _draw(panel: Axes, dots: Sequence[Dot]) -> None:
    """Draw all points, the front as a line, and the levels."""
    panel.set(xscale="log", yscale="log")
    for dot in dots:
        size, marker = (7.0, "o") if dot.on_front else (5.0, "o" if dot.error > LEAST else "v")
        panel.plot(*dot.place, marker, color=COLOURS[int(dot.on_front)], markersize=size, zorder=3, gid=dot.name)
    line = _front(dots)
    if len(line):
        looks: dict[str, Any] = {"color": COLOURS[1], "linewidth": 1.6, "marker": "o", "markersize": 7.0}
        panel.plot(*line.T, label="Pareto front", **looks)
    _widen(panel, dots)
    low, high = panel.get_ylim()
    for level in LEVELS:
        if low < level < high:
            panel.axhline(level, color=REFERENCE, linewidth=0.9, linestyle="--", zorder=1)


def _front(dots: Sequence[Dot]) -> np.ndarray:
    """The places (k, 2) of the choices on the front, the most accurate first."""
    return np.array(sorted((dot.place for dot in dots if dot.on_front), key=lambda place: place[1])).reshape(-1, 2)


def _label(panel: Axes, dots: Sequence[Dot]) -> list[int]:
    """Write names and numbers beside the points, those on the front first; the numbers of those without a name."""
    points = [Labelled(dot.number, dot.marked, dot.place, COLOURS[int(dot.on_front)], dot.on_front) for dot in dots]
    taken = [] if (legend := panel.get_legend()) is None else [legend.get_window_extent()]
    return Labels(panel, points, [_front(dots)], taken).write(MOST_LISTED)


def _widen(panel: Axes, dots: Sequence[Dot]) -> None:
    """Axes that are at least as wide as `SPANS`, so that small differences are not magnified, with plain numbers."""
    places = np.array([dot.place for dot in dots])
    for axis, values, span in zip((panel.xaxis, panel.yaxis), places.T, SPANS, strict=True):
        low, high = MARGIN * values.min(), values.max() / MARGIN
        wider = max(1.0, np.sqrt(span * low / high))
        axis.set_view_interval(low / wider, high * wider, ignore=True)
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high / low < DECADES else (1.0,), numticks=12))
        plain_numbers(axis)


def _list(panel: Axes, dots: Sequence[Dot], own: Collection[int], numbered: Collection[int]) -> None:
    """The names, errors and costs of the choices, the front first, then the others that have a number, then failures.

    numbered : numbers of those that the picture does not name.
    """
    panel.clear()
    panel.set_axis_off()
    rest = [dot for dot in dots if dot.number in numbered and not (dot.on_front or dot.failure or dot.number in own)]
    entries = [
        *_entries("Pareto front, the cheapest first", [dot for dot in dots if dot.on_front], COLOURS[1], numbered),
        *_entries(REFERENCE_HEAD, [dot for dot in dots if dot.number in own], DARK),
        *(_entries(OTHERS, rest, COLOURS[0]) if len(dots) <= MOST_LISTED else [(ELSEWHERE, COLOURS[0], True)]),
        *_entries("failed", [dot for dot in dots if dot.failure], DARK),
        *_footnote(dots),
    ]
    lines = sum(text.count("\n") + 1 for text, _, _ in entries)
    line = LINE if _is_wide() else LINE * sum(BELOW)
    height = line / max(1.0, line * lines)
    y = 1.0
    for text, colour, bold in entries:
        looks: dict[str, Any] = {"color": colour, "fontweight": "bold" if bold else "normal", "linespacing": 1.0}
        panel.text(0.0, y, text, transform=panel.transAxes, va="top", fontsize=8.5 * height / line, **looks)
        y -= height * (text.count("\n") + 1)


def _entries(head: str, dots: Sequence[Dot], colour: str, numbered: Collection[int] | None = None) -> list[Entry]:
    """The lines of a part of the list.

    numbered : choices whose lines begin with their number; None: all.
    """
    if not dots:
        return []
    found = [(head, colour, True)]
    for dot in sorted(dots, key=lambda dot: dot.cost):
        error = f"{dot.exact:.{2 if dot.exact < 99.5 else 3}g} %, " if dot.exact >= LEAST else "0 %, "
        numbers = dot.failure or f"{'' if head == REFERENCE_HEAD else error}{dot.cost:.2g} s"
        numbers += f", {dot.found}" if dot.found and head != OTHERS else ""
        number = f"{dot.number}  " if numbered is None or dot.number in numbered else ""
        found.append((_wrapped(f"{number}{dot.marked}: {numbers}", _letters(1), INDENT), colour, False))
    return found


def _footnote(dots: Sequence[Dot]) -> list[Entry]:
    """The meaning of the mark, if any choice has it."""
    farthest = max(dot.apart for dot in dots)
    text = f"{MARK} monitors record elsewhere than in the reference, up to {farthest:.3g} m away"
    return [("", DARK, False), (_wrapped(text, _letters(1), INDENT), DARK, False)] if farthest > 0.0 else []


def _wrapped(text: str, width: int, indent: str = "") -> str:
    """A text in lines of at most `width` characters, in which every number is on one line with the word after it."""
    import textwrap

    lines = textwrap.wrap(re.sub(r"(?<=\d) (?=\S)", NO_BREAK, text), width, subsequent_indent=indent)
    return "\n".join(lines).replace(NO_BREAK, " ")
