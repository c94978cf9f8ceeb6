"""Lu & Wang (2016), figure 8: damage when the seven bars of table 1 spall, and stress near the free end before.

    python cases/lu2016/figure8.py [RESULTS]      (default: results/lu2016)

The picture is RESULTS/figures/fig08_spalls.png.
"""

import sys
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from records import MEGA, MILLI, case_of, draw_damage, first_spall, in_millimetres, stress_along

from dembound.plot.style import COLOURS, REFERENCE, line_style, new_figure, save, styled

BEFORE = (36, 27, 18, 9, 0)
"""Microseconds before the spall, of which the nearest snapshots are shown."""


@styled
def figure_8(results: Path) -> Figure:
    """Both parts of figure 8, one above the other."""
    figure = new_figure(8.5, 9.5)
    damage, stress = figure.subplots(2, 1, height_ratios=[5, 4])
    runs = [results / f"table1_row{number}" for number in range(1, 8)]
    draw_damage(
        damage, [(f"{number}: {_describe(run)}", run) for number, run in enumerate(runs, start=1)], (0.80, 0.94)
    )
    damage.set_title("rows of table 1: local damage at the first spall, from 0 to 1; which nodes crack, and when")
    damage.legend(fontsize=8.0, loc="upper center")
    _draw_stress(stress, runs[0])
    stress.set_title("row 1: stress near the free end before the spall")
    figure.suptitle("Lu & Wang (2016), fig. 8", fontsize=11)
    return figure


def _describe(run: Path) -> str:
    """A row of table 1 in words: horizon and spacing, crest and length of the pulse."""
    case = case_of(run)
    (load,) = case.load
    sizes = f"m = {case.method.largest_horizon}, Δx = {case.bar.spacing / MILLI:g} mm"
    return f"{sizes}\n{load.pressure / MEGA:g} MPa, {case.wave[load.wave].duration() / MILLI:.2f} ms"


def _draw_stress(panel: Axes, run: Path) -> None:
    """Stress along the last part of the bar at several times before the first spall."""
    spall = first_spall(run)
    for index, microseconds in enumerate(BEFORE):
        x, stress, time = stress_along(run, spall["time"] - 1e-6 * microseconds)
        panel.plot(x, stress / MEGA, label=f"{time / MILLI:.3f} ms", **line_style(index))
    strength = case_of(run).bar.strength
    panel.axhline(strength / MEGA, color=REFERENCE, linewidth=1.0, zorder=1, label=f"strength, {strength / MEGA:g} MPa")
    where = f"spalls at {in_millimetres(spall['start'])} mm, {spall['time'] / MILLI:.4f} ms"
    panel.axvspan(*spall["start"], color=COLOURS[1], alpha=0.3, label=where)
    panel.set_xlim(0.78, 1.0)
    panel.set_xlabel("x (m)")
    panel.set_ylabel("stress, tension positive (MPa)")
    panel.set_ylim(top=1.5 * strength / MEGA)
    panel.legend(ncols=2, fontsize=8.0, loc="upper left")


def main() -> None:
    """Draw the picture into RESULTS/figures."""
    results = Path(sys.argv[1] if len(sys.argv) > 1 else "results/lu2016")
    save(figure_8(results), results / "figures" / "fig08_spalls.png")


if __name__ == "__main__":
    main()
