"""Lu & Wang (2016), figure 12: damage along the end of the bar when it spalls, a panel for each spacing.

There is a row for each method, 1 high where a node has lost all its bonds.

    python cases/lu2016/figure12.py PICTURE RUN...

The vertical line is where the closed form has the first run spall.
"""

import sys
from pathlib import Path

from matplotlib.figure import Figure
from records import MILLI, case_of, draw_damage, expected_spall, name_of

from dembound.plot.style import REFERENCE, new_figure, outside_legend, save, styled


@styled
def figure_12(runs: list[Path]) -> Figure:
    """Panels in the order of their spacings' first runs."""
    by_spacing: dict[float, list[Path]] = {}
    for run in runs:
        by_spacing.setdefault(case_of(run).bar.spacing, []).append(run)
    figure = new_figure(3.6 * len(by_spacing) + 1.0, 5.0)
    panels = figure.subplots(1, len(by_spacing), sharey=True, squeeze=False)[0]
    for panel, (spacing, alike) in zip(panels, by_spacing.items(), strict=True):
        expected, when = expected_spall(case_of(alike[0]))
        limits = expected - 4.0 * spacing, expected + 9.0 * spacing
        draw_damage(panel, [(name_of(case_of(run)), run) for run in alike], limits)
        label = f"spall by the closed form, {expected / MILLI:.1f} mm, {when / MILLI:.4f} ms"
        panel.axvline(expected, color=REFERENCE, zorder=1, label=label)
        panel.set_title(f"Δx = {spacing / MILLI:g} mm")
        panel.locator_params(axis="x", nbins=5)
    title = "fig. 12: local damage at the first spall, from 0 to 1; which nodes crack, and when"
    figure.suptitle(f"Lu & Wang (2016), {title}", fontsize=11)
    outside_legend(figure, panels, columns=2)
    return figure


def main() -> None:
    """Draw the picture."""
    picture, *runs = map(Path, sys.argv[1:])
    save(figure_12(runs), picture)


if __name__ == "__main__":
    main()
