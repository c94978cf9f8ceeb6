"""Lu & Wang (2016), figure 8: damage when the seven bars of table 1 spall, and stress near the free end before.

    python cases/lu2016/figure8.py [RESULTS]      (default: results/lu2016)

The picture is RESULTS/figures/fig08_spalls.png.
"""

import sys
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from records import MEGA, MILLI, case_of, damage_at_first_spall, first_spall, stress_along

from dembound.laws.peridynamic import CRACKED
from dembound.plot.style import COLOURS, REFERENCE, line_style, new_figure, save, styled

BEFORE = (36, 27, 18, 9, 0)
"""Microseconds before the spall, of which the nearest snapshots are shown."""


@styled
def figure_8(results: Path) -> Figure:
    """Both parts, one above the other."""
    figure = new_figure(8.5, 7.5)
    damage, stress = figure.subplots(2, 1)
    for number in range(1, 8):
        _draw_damage(damage, results / f"table1_row{number}", number)
    damage.axhline(CRACKED, color=REFERENCE, linewidth=1.0, zorder=1, label="a crack")
    damage.set_xlim(0.78, 1.0)
    damage.set_ylim(0.0, 1.0)
    damage.set_ylabel("local damage φ (–)")
    damage.legend(fontsize=8.0, loc="center", bbox_to_anchor=(0.33, 0.5))
    _draw_stress(stress, results / "table1_row1")
    return figure


def _draw_damage(panel: Axes, run: Path, number: int) -> None:
    """Damage of a row of table 1 at its first spall."""
    time = first_spall(run)["time"]
    case = case_of(run)
    x, damage = damage_at_first_spall(run)
    label = f"{number}: m = {case.method.largest_horizon}, Δx = {case.bar.spacing / MILLI:g} mm, {time / MILLI:.4f} ms"
    style = line_style(number - 1)
    panel.plot(x[damage > 0], damage[damage > 0], marker=".", label=label, **style)
    panel.set_xlabel("x (m)")


def _draw_stress(panel: Axes, run: Path) -> None:
    """Stress along the last part of the bar at several times before the first spall."""
    spall = first_spall(run)
    for index, microseconds in enumerate(BEFORE):
        x, stress, time = stress_along(run, spall["time"] - 1e-6 * microseconds)
        panel.plot(x, stress / MEGA, label=f"{time / MILLI:.3f} ms", **line_style(index))
    strength = case_of(run).bar.strength
    panel.axhline(strength / MEGA, color=REFERENCE, linewidth=1.0, zorder=1, label="strength")
    panel.axvspan(*spall["start"], color=COLOURS[1], alpha=0.3, label="spalls here")
    panel.set_xlim(0.78, 1.0)
    panel.set_xlabel("x (m)")
    panel.set_ylabel("stress, tension positive (MPa)")
    panel.legend(ncols=2, fontsize=8.0)


def main() -> None:
    """Draw the picture into RESULTS/figures."""
    results = Path(sys.argv[1] if len(sys.argv) > 1 else "results/lu2016")
    save(figure_8(results), results / "figures" / "fig08_spalls.png")


if __name__ == "__main__":
    main()
