"""Checks of every picture: numbers and units on its axes, texts that are texts, and a legend of visible lines."""

import re
from collections.abc import Iterator
from itertools import chain

import pytest
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator, NullLocator

from dembound.plot import style
from dembound.plot.style import is_seen, number_axes

LATER = "bond broken"
"""Legends of moving pictures list the contents of the last frame."""

COUNTED = {"pass", "steps", "member", "row"}
"""Names of counts, which have no unit."""


def drawn_quickly(patch: pytest.MonkeyPatch) -> None:
    """Draw pictures that no test looks at: of few dots, their panels where they happen to be."""
    patch.setattr(style, "DOTS_PER_INCH", 30)
    patch.setattr(style, "lay_out", lambda figure: figure.set_layout_engine("none"))


def problems_of(figure: Figure) -> list[str]:
    """Illegible parts of a figure as it is saved, one line each."""
    number_axes(figure)
    return [*_texts(figure), *_axes(figure), *_legends(figure)]


def _texts(figure: Figure) -> Iterator[str]:
    for text in figure.findobj(Text):
        if re.search(r"\bb['\"]|\\[a-z]|\$\\", text.get_text()):
            yield f"text: {text.get_text()}"


def _axes(figure: Figure) -> Iterator[str]:
    for number, panel in enumerate(figure.axes):
        if not panel.axison:
            continue
        for name, axis in (("x", panel.xaxis), ("y", panel.yaxis)):
            count = len(numbers_of(axis))
            if count < 3 and _has_numbers(axis) and not _is_chosen(axis):
                yield f"panel {number}, {name}: numbers {numbers_of(axis)} between {tuple(axis.get_view_interval())}"
            if count and not _is_labelled(figure, panel, name):
                yield f"panel {number}, {name}: no label with a unit"


def numbers_of(axis: Axis) -> list[str]:
    """The numbers of an axis that are shown."""
    low, high = sorted(axis.get_view_interval())
    slack = 1e-9 * (high - low)
    ticks = [tick for tick in axis.get_major_ticks() if tick.label1.get_visible() or tick.label2.get_visible()]
    texts = [label.get_text() for label in axis.get_majorticklabels()]
    places = axis.get_majorticklocs()
    shown = [text for place, text in zip(places, texts, strict=False) if text and low - slack <= place <= high + slack]
    return shown if ticks else []


def _has_numbers(axis: Axis) -> bool:
    """Whether an axis is meant to have numbers: inner common axes, and those of strips, have none."""
    return not isinstance(axis.get_major_locator(), NullLocator) and any(
        tick.label1.get_visible() or tick.label2.get_visible() for tick in axis.get_major_ticks()
    )


def _is_chosen(axis: Axis) -> bool:
    """Whether the ticks of an axis are chosen: names of members, possibly fewer than three, or whole numbers."""
    return isinstance(axis.get_major_locator(), FixedLocator) or bool(
        getattr(axis.get_major_locator(), "_integer", False)
    )


def _is_labelled(figure: Figure, panel: Axes, name: str) -> bool:
    group = (panel.get_shared_x_axes() if name == "x" else panel.get_shared_y_axes()).get_siblings(panel)
    labels = [getattr(each, f"get_{name}label")() for each in group]
    labels += [each.get_title("right") for each in group]  # above panels side by side
    labels += [figure.get_supxlabel() if name == "x" else figure.get_supylabel()]
    return any(re.search(r"\(.+\)|%", label) or label in COUNTED for label in labels)


def _legends(figure: Figure) -> Iterator[str]:
    legends = [*figure.legends, *(panel.get_legend() for panel in figure.axes if panel.get_legend())]
    for text in chain.from_iterable(legend.get_texts() for legend in legends):
        handles = [
            (handle, panel)
            for panel in figure.axes
            for handle, label in zip(*panel.get_legend_handles_labels(), strict=True)
            if label == text.get_text()
        ]
        is_later = text.get_text().startswith(LATER) and not handles
        if not is_later and not any(is_seen(handle, panel) for handle, panel in handles):
            yield f"legend: {text.get_text()} is not seen"
