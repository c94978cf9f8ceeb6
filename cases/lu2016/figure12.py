"""Lu & Wang (2016), figure 12: damage along the end of the bar when it spalls, by method, a panel for each spacing.

    python cases/lu2016/figure12.py PICTURE RUN...

The vertical line is where the closed form has the first run spall.
"""

import sys
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from records import MILLI, case_of, damage_at_first_spall, expected_spall, name_of

from dembound.laws.peridynamic import CRACKED
from dembound.plot.style import REFERENCE, line_style, new_figure, outside_legend, save, styled


@styled
def figure_12(runs: list[Path]) -> Figure:
    """Panels in the order of their spacings' first runs."""
    by_spacing: dict[float, list[Path]] = {}
    for run in runs:
        by_spacing.setdefault(case_of(run).bar.spacing, []).append(run)
    figure = new_figure(8.0, 1.2 + 2.4 * len(by_spacing))
    panels = figure.subplots(len(by_spacing), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for panel, (spacing, alike) in zip(panels, by_spacing.items(), strict=True):
        _draw(panel, alike)
        panel.set_title(f"Δx = {spacing / MILLI:g} mm")
        panel.set_ylabel("local damage φ (–)")
    panels[-1].set_xlim(0.74, 0.9)
    panels[-1].set_ylim(0.0, 1.0)
    panels[-1].set_xlabel("x (m)")
    outside_legend(figure, panels, columns=3)
    return figure


def _draw(panel: Axes, runs: list[Path]) -> None:
    """Damage of runs of one spacing, each at its first spall."""
    panel.axhline(CRACKED, color=REFERENCE, linewidth=1.0, zorder=1)
    panel.axvline(expected_spall(case_of(runs[0]))[0], color=REFERENCE, zorder=1, label="closed form")
    for index, run in enumerate(runs):
        x, damage = damage_at_first_spall(run)
        panel.plot(x, damage, label=name_of(case_of(run)), **line_style(index))


def main() -> None:
    """Draw the picture."""
    picture, *runs = map(Path, sys.argv[1:])
    save(figure_12(runs), picture)


if __name__ == "__main__":
    main()
