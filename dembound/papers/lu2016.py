"""Lu & Wang (2016), "L": dispersion of peridynamic bars, and spalls of rock bars, figure by figure."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Picture

from dembound import shipped
from dembound.exact.bar import Lattice
from dembound.gauge.gauge_io import read_free_end, read_gauge
from dembound.gauge.spalling import evaluate
from dembound.papers.figure import Figure, Paper, Row, Work
from dembound.papers.overlay import Line, overlay
from dembound.papers.spalled import (
    MEGA,
    MILLI,
    case_of,
    draw_damage,
    errors,
    exact_stress,
    expected_spall,
    first_spall,
    history,
    in_millimetres,
    name_of,
    stress_along,
)
from dembound.plot.laboratory import plot_gauge
from dembound.plot.style import COLOURS, REFERENCE, line_style, new_figure, outside_legend, styled

Drawn = tuple[Picture, Sequence[Row]]

WAVE_SPEED = 2763.0
"""√(20 GPa / 2620 kg/m³), m/s."""

PARTS: dict[str, tuple[str, Sequence[tuple[int, float, float]]]] = {
    "a: Δx = 5 mm": ("more dispersion for larger m", [(m, 0.005, 1e-6) for m in (1, 2, 4, 8)]),
    "b: m = 3": ("more dispersion for larger Δx", [(3, dx, 1e-6) for dx in (0.005, 0.01, 0.02)]),
    "c: δ = 20 mm": ("less dispersion for larger m", [(m, 0.02 / m, 1e-6) for m in (1, 2, 3, 4)]),
    "d: m = 3, Δx = 5 mm": ("hardly any difference", [(3, 0.005, dt) for dt in (1e-6, 1e-7)]),
}
"""Parts of figure 5: what is printed about each, and horizon, spacing (m) and step (s) of its lines."""

AT = 100.0
"""Wave number (rad/m) at which the frequencies of figure 5 are compared."""


def figure_5(_: Work) -> Drawn:
    """Frequency against wave number, beside a bar without nodes."""
    panels, rows = [], []
    for part, (printed, settings) in PARTS.items():
        lattices = [Lattice(m, spacing, step, WAVE_SPEED) for m, spacing, step in settings]
        k = np.linspace(0.0, max(each.shortest for each in lattices), 400)
        lines = [Line(k, 1e-3 * WAVE_SPEED * k / (2.0 * np.pi), "no dispersion", 6, 2)]
        shares = []
        for index, each in enumerate(lattices):
            own = k[k <= each.shortest * (1.0 + 1e-9)]
            said = f"m = {each.horizon}, Δx = {1e3 * each.spacing:.3g} mm, Δt = {1e6 * each.time_step:g} µs"
            lines.append(Line(own, 1e-3 * np.asarray(each.frequency(own)) / (2.0 * np.pi), said, index, index))
            shares.append(f"{float(each.frequency(np.array([AT]))[0]) / (WAVE_SPEED * AT):.4f}")
        panels.append((part, lines))
        rows.append(Row(f"{part}: frequency over kc at k = {AT:g} rad/m", ", ".join(shares), printed))
    title = "Lu & Wang (2016), fig. 5: dispersion of peridynamic bars"
    return overlay(title, panels, "wave number k (rad/m)", "frequency ω/2π (kHz)"), rows


def passing(work: Work, name: str, method: str, **changes: Any) -> Path:
    """A run in which a pulse runs to and fro in an unbreakable bar; method : fdm, or m and a horizon."""
    table: dict[str, Any] = {"type": "finite_difference"}
    if method != "fdm":
        table = {"type": "peridynamics", "horizon": int(method[1:])}
    return work.run("fig7", f"fig7_{name}", method=table, **changes).folder


def figure_6(work: Work) -> Drawn:
    """The pressure on the left end."""
    case = work.case("fig7", {}, "fig6")
    (load,) = case.tables["load"]
    wave = case.wave[load.wave]
    time = np.linspace(0.0, 1.5 * wave.duration(), 901)
    pressure = load.pressure * wave.velocity(time)
    crest = int(pressure.argmax())
    rows = [
        Row("crest p_m (MPa)", f"{pressure[crest] / MEGA:.2f}", "8.9"),
        Row("its time t_p (ms)", f"{time[crest] / MILLI:.3f}", "0.04"),
        Row("length t_0 (ms)", f"{wave.duration() / MILLI:.3f}", "0.12"),
    ]
    title = "Lu & Wang (2016), fig. 6: the pulse"
    line = Line(time / MILLI, pressure / MEGA, "triangle", 0)
    return overlay(title, [("", [line])], "time (ms)", "pressure on the left end (MPa)"), rows


def figure_7(work: Work) -> Drawn:
    """Stress in the middle of the bar: methods and horizons; spacings and pulses."""
    coarse: dict[str, Any] = {"bar__spacing": 0.01}
    longer = coarse | {"wave__triangle__rise": 0.08e-3, "wave__triangle__fall": 0.16e-3}
    upper = [passing(work, name, name) for name in ("fdm", "m1", "m2", "m4", "m8")]
    lower = [passing(work, "m3", "m3"), passing(work, "m3_coarse", "m3", **coarse)]
    lower.append(passing(work, "m3_coarse_long", "m3", **longer))
    panels, rows = [], []
    printed = dict(zip([*upper, *lower], PRINTED_7, strict=True))
    names = "a: finite differences, m = 1 to 8", "b: m = 3; coarser; coarser, longer pulse"
    for part, runs in zip(names, (upper, lower), strict=True):
        lines = []
        for index, run in enumerate(runs):
            case, (time, stress, place) = case_of(run), history(run, "middle")
            length = case.wave[case.load[0].wave].duration() / MILLI
            said = f"{name_of(case)}, Δx = {case.bar.spacing / MILLI:g} mm, t₀ = {length:.2f} ms"
            lines.append(Line(time / MILLI, stress / MEGA, said, index, index))
            found = errors(run)
            words = f"{found[0]:.1%}, {found[-1]:.1%}"
            rows.append(Row(f"{said}: RMS error, first and last passage", words, printed[run]))
        time, _, place = history(runs[0], "middle")
        lines.append(Line(time / MILLI, exact_stress(case_of(runs[0]), place, time) / MEGA, "d'Alembert", 6, 2))
        panels.append((part, lines))
    title = "Lu & Wang (2016), fig. 7: stress in the middle of the bar"
    return overlay(title, panels, "time (ms)", "stress at 0.5 m, tension positive (MPa)"), rows


PRINTED_7 = (
    *("the reference", "close to FDM", "close to FDM", "differs after 0.5 ms", "useless after 0.8 ms"),
    *("no clear dispersion", "dispersion after 0.5 ms", "keeps its shape"),
)
"""What is printed about the lines of figure 7."""

BEFORE = (36, 27, 18, 9, 0)
"""Microseconds before the spall, of which the nearest snapshots are shown."""


def figure_8(work: Work) -> Drawn:
    """Damage at the spalls of table 1, and stress near the free end before the first."""
    printed = np.genfromtxt(shipped.folder() / "lu2016" / "table1.csv", delimiter=",", names=True, skip_header=1)
    runs, rows = [], []
    for number, row in enumerate(printed, start=1):
        name = f"table1_row{number}"
        run = work.run(name, name, output__snapshots=200 if number == 1 else 0).folder
        found = first_spall(run)
        place = f"{in_millimetres(found['start'])} mm at {found['time'] / MILLI:.4f} ms"
        beside = f"{row['x_from_mm']:g}–{row['x_to_mm']:g} mm at {row['t_F_ms']:.4f} ms"
        rows.append(Row(f"table 1, row {number}: {_settings(run)}", place, beside))
        runs.append((f"{number}: {_settings(run)}".replace(", p", "\np"), run))
    return _draw_8(runs), rows


@styled
def _draw_8(runs: Sequence[tuple[str, Path]]) -> Picture:
    """Both parts of figure 8, one above the other."""
    figure = new_figure(8.5, 9.5)
    damage, stress = figure.subplots(2, 1, height_ratios=[5, 4])
    draw_damage(damage, runs, (0.80, 0.94))
    damage.set_title("rows of table 1: local damage at the first spall, from 0 to 1; which nodes crack, and when")
    damage.legend(fontsize=8.0, loc="upper center")
    _draw_stress(stress, runs[0][1])
    stress.set_title("row 1: stress near the free end before the spall")
    figure.suptitle("Lu & Wang (2016), fig. 8", fontsize=11)
    return figure


def _settings(run: Path) -> str:
    """A row of table 1 in words: horizon and spacing, crest and length of the pulse."""
    case = case_of(run)
    (load,) = case.load
    sizes = f"m = {case.method.largest_horizon}, Δx = {case.bar.spacing / MILLI:g} mm"
    return f"{sizes}, p_m = {load.pressure / MEGA:g} MPa, t_0 = {case.wave[load.wave].duration() / MILLI:.2f} ms"


def _draw_stress(panel: Axes, run: Path) -> None:
    """Stress along the last part of the bar at several times before the first spall."""
    spall = first_spall(run)
    for index, microseconds in enumerate(BEFORE):
        x, stress, time = stress_along(run, spall["time"] - 1e-6 * microseconds)
        look: dict[str, Any] = dict(line_style(index))
        panel.plot(x, stress / MEGA, label=f"{time / MILLI:.3f} ms", **look)
    bar = case_of(run).bar
    strength = bar.modulus * bar.breaking_stretch
    panel.axhline(strength / MEGA, color=REFERENCE, linewidth=1.0, zorder=1, label=f"strength, {strength / MEGA:g} MPa")
    where = f"spalls at {in_millimetres(spall['start'])} mm, {spall['time'] / MILLI:.4f} ms"
    panel.axvspan(*spall["start"], color=COLOURS[1], alpha=0.3, label=where)
    panel.set(xlim=(0.78, 1.0), xlabel="x (m)", ylabel="stress, tension positive (MPa)")
    panel.set_ylim(top=1.5 * strength / MEGA)
    panel.legend(ncols=2, fontsize=8.0, loc="upper left")


def figure_10(work: Work) -> Drawn:
    """A weak pulse at the gauge: wave speed and attenuation from its tension peaks."""
    record = work.run("rod_test_weak", "rod_test_weak").folder / "run.h5"
    gauge = read_gauge(record)
    found = evaluate(gauge, count=5)
    picture = plot_gauge(gauge, found)
    picture.suptitle("Lu & Wang (2016), fig. 10: a weak pulse at the gauge, its tension peaks", fontsize=11)
    rows = [Row("wave speed (m/s)", f"{found.speed.value:.1f}", "2740")]
    if found.attenuation is not None:
        rows.append(Row("attenuation (1/m)", f"{found.attenuation.value:.3f}", "0.52"))
    return picture, rows


def figure_11(work: Work) -> Drawn:
    """A strong pulse at the gauge, and with its image near the free end: strength from the place of the spall."""
    changes: dict[str, Any] = {"bar__spacing": 0.001, "run__time_step": 0.2e-6, "run__duration": 0.7e-3}
    changes |= {"bar__attenuation": 0.52, "method": {"type": "patch", "horizon": 3}}
    changes["load"] = [{"name": "pulse", "pressure": 53e6, "wave": "triangle"}]
    record = work.run("rod_test", "rod_strong", **changes).folder / "run.h5"
    gauge = read_gauge(record, "gauge")
    found = evaluate(gauge, spall=0.79, free_end=read_free_end(record, "end"), speed=2740.0, coefficient=0.52)
    picture = plot_gauge(gauge, found)
    picture.suptitle("Lu & Wang (2016), fig. 11: a strong pulse at the gauge, and its image near the end", fontsize=11)
    rows = []
    if (strength := found.strength) is not None:
        rows.append(
            Row(
                "nominal strength (MPa), under a triangle, as the pulse is not printed",
                f"{strength.nominal / MEGA:.1f}",
                "25.5",
            )
        )
        if strength.attenuated is not None:
            rows.append(Row("the same less attenuation (MPa)", f"{strength.attenuated / MEGA:.1f}", "18.8"))
    return picture, rows


METHODS: dict[str, tuple[dict[str, Any], str]] = {
    "pd3": ({"type": "peridynamics", "horizon": 3}, "0.478 ms"),
    "pd1_pd3": ({"type": "switch", "horizon": 3, "before": "peridynamics"}, "0.466 ms"),
    "fdm_pd3": ({"type": "switch", "horizon": 3}, "0.464 ms"),
}
"""Methods of table 2, and the printed times of the spall."""


def figure_12(work: Work) -> Drawn:
    """Damage at the end of the test's bar when it spalls, by three methods."""
    runs, rows = [], []
    for name, (method, printed) in METHODS.items():
        run = work.run("rod_test", f"rod_{name}", method=method).folder
        found = first_spall(run)
        runs.append((name_of(case_of(run)), run))
        place = f"{in_millimetres(found['start'])} mm at {found['time'] / MILLI:.4f} ms"
        rows.append(Row(f"table 2, {runs[-1][0]}: spall", place, f"790 mm at {printed}"))
    return _draw_12(runs), rows


@styled
def _draw_12(runs: Sequence[tuple[str, Path]]) -> Picture:
    """Rows of damage, with the place by the closed form."""
    expected, when = expected_spall(case_of(runs[0][1]))
    figure = new_figure(7.0, 4.5)
    panel = figure.subplots()
    draw_damage(panel, runs, (expected - 0.06, expected + 0.12))
    label = f"spall by the closed form, {expected / MILLI:.1f} mm, {when / MILLI:.4f} ms"
    panel.axvline(expected, color=REFERENCE, zorder=1, label=label)
    panel.set_ylabel("local damage at the first spall, 0 to 1 (–)")
    figure.suptitle("Lu & Wang (2016), fig. 12: the bar of the test; which nodes crack, and when", fontsize=11)
    outside_legend(figure, [panel], columns=2)
    return figure


PAPER = Paper(
    "Lu Z. T., Wang Z. L. (2016), Journal of Harbin Institute of Technology 48(2), 131–137",
    {
        "5": Figure("dispersion", "频散特性影响因素", 4, figure_5, adjustable=False),
        "6": Figure("the pulse", "冲击荷载时程曲线", 4, figure_6),
        "7": Figure("stress in the middle of the bar", "杆中点应力时程曲线", 18, figure_7),
        "8": Figure("spalls, and table 1", "层裂现象 PD 法模拟, 表 1", 15, figure_8),
        "10": Figure("attenuation from a weak pulse", "应力波衰减过程", 6, figure_10),
        "11": Figure("strength from a strong pulse", "自由面附近应力波形", 6, figure_11),
        "12": Figure("damage in the test, and table 2", "岩杆断裂时损伤分布, 表 2", 7, figure_12),
    },
    "figures 1 to 4 and 9 are sketches and photographs",
)
