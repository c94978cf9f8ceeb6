"""The lines of a picture as numbers, in the units of the picture."""

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import zip_longest
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from dembound.results.text_files import write_csv

Column = tuple[str, np.ndarray]
"""A head with its unit, and the values (k,) below it."""


def write_lines(figure: Figure, path: Path) -> None:
    """Write the lines of a figure as CSV, a column each, either completely or not at all.

    Lines with the same x values share one column of x values, which comes first. Columns end with their lines; cells
    below are empty. Zeros have no sign. Frames and other lines without data are left out.

    Raises FileNotFoundError if the folder of the path does not exist.
    """
    columns = list(columns_of(figure))
    cells = zip_longest(*([f"{value + 0.0:.10g}" for value in values] for _, values in columns), fillvalue="")
    write_csv(path, [[head for head, _ in columns], *cells])


def columns_of(figure: Figure) -> Iterator[Column]:
    """The columns of the table: for each group of lines with equal x values first x, then the lines' values.

    The heads of lines that are drawn against two quantities name the quantity.
    """
    groups: list[tuple[np.ndarray, list[tuple[Axes, Line2D]]]] = []
    for panel, line in ((each, line) for each in figure.axes for line in named_lines(each)):
        along = np.asarray(line.get_xdata(), dtype=float)
        for known, lines in groups:
            if np.array_equal(known, along):
                lines.append((panel, line))
                break
        else:
            groups.append((along, [(panel, line)]))
    heads = [x_label(lines[0][0]) for _, lines in groups]
    names = Counter(_head(figure, panel, line) for _, lines in groups for panel, line in lines)
    for head, (along, lines) in zip(heads, groups, strict=True):
        same_head = [others[0][1] for of, (_, others) in zip(heads, groups, strict=True) if of == head]
        yield f"{head}{_of(lines[0][1], same_head)}", along
        for panel, line in lines:
            name = _head(figure, panel, line)
            against = f", against {head}" if names[name] > 1 and len(set(heads)) > 1 else ""
            yield f"{name}{against}", np.asarray(line.get_ydata(), dtype=float)


def _of(line: Line2D, lines: Sequence[Line2D]) -> str:
    """Name of the lines with some x values: their run; if runs have several lines, also the line's name."""
    if len(lines) == 1:
        return ""
    is_only_one = [each.get_label() for each in lines].count(line.get_label()) == 1
    is_only_one &= not str(line.get_label()).startswith("_")
    return f" of {line.get_label()}" if is_only_one else f" of {', '.join(filter(None, _name_and_run(line)))}"


def _name_and_run(line: Line2D) -> tuple[str, str]:
    """A line's name, and its run: empty for matplotlib's label for none, or the name again."""
    name, label = str(line.get_gid()), str(line.get_label())
    label = "" if label.startswith("_child") else label.removeprefix("_")  # "_" keeps it out of legends
    return name, "" if label.startswith(name) else label


def named_lines(panel: Axes) -> list[Line2D]:
    """The lines of a panel that have a name."""
    return [line for line in panel.lines if line.get_gid() is not None]


def _head(figure: Figure, panel: Axes, line: Line2D) -> str:
    """A line's name, its run, and the quantity of its axis with the unit."""
    sharing = [panel, *panel.get_shared_y_axes().get_siblings(panel)]
    own = next(filter(None, (each.get_ylabel() for each in sharing)), "")
    axis = ", ".join(filter(None, (figure.get_supylabel(), own))).replace("\n", " ")
    return f"{', '.join(filter(None, _name_and_run(line)))}: {axis}"


def x_label(panel: Axes) -> str:
    """The label below a panel, or below the lowest panel with the same axis."""
    sharing = [panel, *panel.get_shared_x_axes().get_siblings(panel)]
    return next(filter(None, (each.get_xlabel() for each in sharing)), "x")
