"""Lu & Wang (2016), figures 6 and 7: the pulse, and the stress in the middle of the bar, beside d'Alembert's solution.

    python cases/lu2016/figures_6_7.py [RESULTS]      (default: results/lu2016)

The pictures are RESULTS/figures/fig06_pulse.png and fig07_passages.png.
"""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from passages import errors, exact_stress
from records import MEGA, MILLI, case_of, history, name_of

from dembound.plot.style import COLOURS, REFERENCE, line_style, new_figure, save, styled


@styled
def pulse(run: Path) -> Figure:
    """Figure 6: the pressure on the left end."""
    case = case_of(run)
    (load,) = case.load
    time = np.linspace(0.0, 1.5 * case.wave[load.wave].duration(), 500)
    figure = new_figure(6.0, 3.6)
    panel = figure.subplots()
    pressure = load.pressure * case.wave[load.wave].velocity(time)
    panel.plot(time / MILLI, pressure / MEGA, color=COLOURS[0])
    crest = int(np.argmax(pressure))
    words = f"{pressure[crest] / MEGA:.1f} MPa at {time[crest] / MILLI:.3f} ms"
    beside: dict[str, Any] = {"textcoords": "offset points", "va": "center", "fontsize": 8.0}
    panel.annotate(words, (time[crest] / MILLI, pressure[crest] / MEGA), (10, 0), **beside)
    over = case.wave[load.wave].duration() / MILLI
    panel.annotate(f"over after {over:.2f} ms", (over, 0.0), (6, 10), **beside)
    figure.suptitle("Lu & Wang (2016), fig. 6: the pulse", fontsize=11)
    panel.set_xlabel("time (ms)")
    panel.set_ylabel("pressure on the left end (MPa)")
    return figure


@styled
def passages(horizons: Sequence[Path], others: Sequence[Path]) -> Figure:
    """Figure 7: methods and horizons above; below spacings and pulses."""
    figure = new_figure(9.0, 8.6)
    upper, lower = figure.subplots(2, 1, sharex=True, sharey=True)
    _draw(upper, horizons)
    _draw(lower, others)
    upper.set_title("a: finite differences and horizons of 1 to 8 spacings", loc="left")
    lower.set_title("b: three spacings to the horizon; coarser; coarser under a longer pulse", loc="left")
    figure.suptitle(
        "Lu & Wang (2016), fig. 7: stress in the middle of the bar; its RMS errors in the first and last passage",
        fontsize=11,
    )
    lower.set_xlabel("time (ms)")
    return figure


def _draw(panel: Axes, runs: Sequence[Path]) -> None:
    """Stress in the middle of several bars, and the exact one of each of their pulses."""
    for index, run in enumerate(runs):
        case = case_of(run)
        time, stress, place = history(run, "middle")
        duration = case.wave[case.load[0].wave].duration()
        found = errors(run)
        label = f"{name_of(case)}, Δx = {case.bar.spacing / MILLI:g} mm, t₀ = {duration / MILLI:.2f} ms"
        label += f": {100.0 * found[0]:.1f} %, {100.0 * found[-1]:.1f} %"
        panel.plot(time / MILLI, stress / MEGA, label=label, **line_style(index))
    pulses = {case_of(run).wave["triangle"].duration(): run for run in runs}
    for label, run in zip(["d'Alembert", *[None] * len(pulses)], pulses.values(), strict=False):
        time, _, place = history(run, "middle")
        exact = exact_stress(case_of(run), place, time) / MEGA
        panel.plot(time / MILLI, exact, color=REFERENCE, linewidth=3.0, alpha=0.5, zorder=1, label=label)
    panel.set_ylabel("stress at 0.5 m, tension positive (MPa)")
    panel.legend(ncols=2, fontsize=8.0, loc="upper right")
    panel.set_ylim(-11.0, 22.0)


def main() -> None:
    """Draw both pictures into RESULTS/figures."""
    results = Path(sys.argv[1] if len(sys.argv) > 1 else "results/lu2016")
    save(pulse(results / "fig7_fdm"), results / "figures" / "fig06_pulse.png")
    horizons = [results / f"fig7_{name}" for name in ("fdm", "m1", "m2", "m4", "m8")]
    others = [results / f"fig7_{name}" for name in ("m3", "m3_coarse", "m3_coarse_long")]
    save(passages(horizons, others), results / "figures" / "fig07_passages.png")


if __name__ == "__main__":
    main()
