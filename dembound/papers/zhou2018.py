"""Zhou et al. (2018), "Z": dynamic artificial boundaries for particle discrete elements, figure by figure."""

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure as Picture

from dembound.disks.scene import build
from dembound.papers.figure import Figure, Paper, Row, Work, dotted
from dembound.papers.overlay import Line, history, overlay
from dembound.plot.packing import brick_disks, plot_brick, plot_patterns
from dembound.plot.side import Side, read_side
from dembound.results.results import Results
from dembound.schemas import loads

Drawn = tuple[Picture, Sequence[Row]]

Pattern = tuple[str, str, dict[str, Any]]
"""Its name, the case of its long bar, and the changes of that case."""

POINTS = ("P1", "P2", "P3", "P4", "P5")

TIME, VELOCITY, PASS = "time (s)", "velocity along x (m/s)", "pass of the iteration"


def patterns(work: Work, names: str = "ABC") -> list[Pattern]:
    """Name, case and changes of the long bars of some patterns, of B one for each ratio of radii λ."""
    random: list[Pattern] = [
        (f"B, λ = {ratio:g}", "long_bar_b", {"packing__radius_ratio": ratio}) for ratio in work.ratios
    ]
    bars: dict[str, list[Pattern]] = {"A": [("A", "long_bar_a", {})], "B": random, "C": [("C", "long_bar_c", {})]}
    return [each for name in names for each in bars[name]]


def label_of(pattern: str) -> str:
    """The name of a run of a pattern."""
    return f"long_bar_{pattern.replace(', λ = ', '_').replace('.', 'p')}"


def bars(work: Work, names: str) -> dict[str, Results]:
    """Runs of the long bars by their patterns, with β = 1 on the right."""
    return {name: work.run(case, label_of(name), **changes) for name, case, changes in patterns(work, names)}


def packings(work: Work, number: str, names: str) -> Drawn:
    """Close-ups of the packings at the right side (figs 2, 10)."""
    parts, rows = {}, []
    for name, case, changes in patterns(work, names):
        scene = build(work.disks(case, dotted(changes), name))
        body = scene.assembly
        parts[f"pattern {name}"] = body.positions, body.radii, scene.edges["right"].nodes
        printed = {"A": "0.5", "C": "0.52 at the sides"}.get(name, "0.5, uniform radii")
        rows.append(Row(f"{name}: mean diameter of all disks (m)", f"{2.0 * body.radii.mean():.4g}", printed))
    picture = plot_patterns(parts)
    picture.suptitle(f"Zhou et al. (2018), fig. {number}: packings, and the disks of the right side", fontsize=11)
    return picture, rows


def brick(work: Work) -> Drawn:
    """A brick, its controllers and followers (fig. 9), so small that single disks are seen."""
    _, name, changes = patterns(work, "B")[0]
    small = {"packing.brick": [10.0, 10.0], "packing.size": [10.0, 10.0], "monitor": []}
    made = build(work.disks(name, dotted(changes) | small, "brick")).ground.brick
    picture = plot_brick(made.positions, made.radii, made.edge_rows, made.size, made.pairs, made.images)
    picture.suptitle("Zhou et al. (2018), fig. 9: a brick, here of 10 m, so that single disks are seen", fontsize=11)
    *_, kinds = brick_disks(made.positions, made.radii, made.edge_rows, made.size)
    return picture, [Row("kinds of disks", ", ".join(sorted(set(kinds))), "controllers, followers, interior")]


def returned(run: Results) -> float:
    """Share of the incident peak that returns to P4: the largest |v_x| once the pulse has passed."""
    time, velocity = history(run, "P4", "velocity")
    crest = int(np.argmax(np.abs(velocity)))
    after = time > time[crest] + 0.55 * period_of(run)
    return float(np.abs(velocity[after]).max(initial=0.0) / np.abs(velocity[crest]))


def period_of(run: Results) -> float:
    """Length of a run's pulse, s."""
    return loads(run.case).wave["pulse"].duration()


def figure_3(work: Work) -> Drawn:
    """Velocity at five points: A absorbs all, B returns a part with β = 1."""
    runs = bars(work, "AB")
    lines = [
        Line(*history(run, point, "velocity"), f"{name}, {point}", index, dashes)
        for dashes, (name, run) in enumerate(runs.items())
        for index, point in enumerate(POINTS)
    ]
    printed = {"A": "no reflection seen"}
    rows = [
        Row(f"{name}: returned to P4", f"{returned(run):.2%}", printed.get(name, "seen, no number"))
        for name, run in runs.items()
    ]
    title = "Zhou et al. (2018), fig. 3: a P pulse in the long bar, right end viscous with β = 1"
    return overlay(title, [("", lines)], TIME, VELOCITY), rows


def iterations(work: Work, number: str, names: str, starts: Sequence[float], printed: str) -> Drawn:
    """Peak of the right side by pass, for several patterns or several first β (figs 6, 13)."""
    lines: list[Line] = []
    rows, incident = [], math.nan
    for name, case, changes in patterns(work, names):
        for start in starts:
            found = work.calibration(case, label_of(name), start, **changes)
            said = name if len(starts) == 1 else f"from β = {start:g}"
            passes = np.arange(1, len(found.beta) + 1)
            incident = found.incident
            lines.append(Line(passes, np.array(found.outgoing), said, len(lines), len(lines), marked=True))
            reached = f"{len(found.beta)}, {found.outgoing[-1]:.4f} m/s, {found.beta[-1]:.4f}"
            rows.append(Row(f"{said}: passes, M_out, β0", reached, printed))
    first = "from β = 1, all patterns" if len(starts) == 1 else f"of pattern {patterns(work, names)[0][0]}"
    title = f"Zhou et al. (2018), fig. {number}: ratio iteration {first}; thin line: incident peak M_in"
    return overlay(title, [("", lines)], PASS, "peak velocity M_out of the right side (m/s)", incident), rows


def passes(work: Work, number: str, start: float) -> Drawn:
    """Velocity at P4 in the passes of an iteration (figs 7, 8)."""
    name, case, changes = patterns(work, "B")[0]
    found = work.calibration(case, label_of(name), start, **changes)
    lines: list[Line] = []
    rows: list[Row] = []
    for turn in sorted({*(each for each in (1, 2, 4) if each < len(found.beta)), len(found.beta)}):
        beta = found.beta[turn - 1]
        label = f"{label_of(name)}_from_{start:g}_pass_{turn}".replace(".", "p")
        run = work.run(case, label, boundary__right__beta_p=beta, **changes)
        said = f"pass {turn}, β = {beta:.4f}"
        lines.append(Line(*history(run, "P4", "velocity"), said, len(lines), len(lines)))
        printed = {1: "a clear second peak", len(found.beta): "next to nothing (pass 11)"}.get(turn, "ever less")
        rows.append(Row(f"{said}: returned to P4", f"{returned(run):.2%}", printed))
    title = f"Zhou et al. (2018), fig. {number}: P4 in passes of the ratio iteration from β = {start:g}, pattern {name}"
    return overlay(title, [("", lines)], TIME, VELOCITY), rows


def sides(work: Work) -> dict[str, Side]:
    """The disks of the right side of all patterns."""
    return {name: read_side(run.folder / "run.h5", "right") for name, run in bars(work, "ABC").items()}


def figure_11(work: Work) -> Drawn:
    """Diameters along the right side."""
    lines: list[Line] = []
    rows: list[Row] = []
    for name, side in sides(work).items():
        lines.append(Line(side.along, side.diameters, name, len(lines), len(lines), marked=True))
        printed = {"A": "0.5", "C": "0.52"}.get(name, "0.5 in the mean")
        spread = f"{side.diameters.mean():.4f} ({side.diameters.min():.3f} to {side.diameters.max():.3f})"
        rows.append(Row(f"{name}: diameter at the side (m)", spread, printed))
    title = "Zhou et al. (2018), fig. 11: diameters of the disks along the right side"
    return overlay(title, [("", lines)], "y, along the side (m)", "diameter (m)"), rows


def figure_12(work: Work) -> Drawn:
    """Peak velocities along the right side with β = 1."""
    lines: list[Line] = []
    rows: list[Row] = []
    for name, side in sides(work).items():
        peaks = side.peaks[:, 0]
        lines.append(Line(side.along, peaks, name, len(lines), len(lines), marked=True))
        spread = f"{peaks.mean():.4f} ± {peaks.std():.4f}"
        rows.append(Row(f"{name}: peak at the side (m/s)", spread, "0.5" if name == "A" else "above 0.5, C > B > A"))
    title = "Zhou et al. (2018), fig. 12: peak velocity of the disks along the right side, β = 1"
    return overlay(title, [("", lines)], "y, along the side (m)", "peak |velocity| along x (m/s)"), rows


def figure_14(work: Work) -> Drawn:
    """Displacement at five points of the bar under an external source."""
    # plane waves: a bar half as high has half the disks
    thin: dict[str, Any] = {"packing__size": [1000.0, 25.0], "packing__brick": [25.0, 25.0]}
    thin["monitor"] = [{"name": point, "position": [250.0 * i, 12.5]} for i, point in enumerate(POINTS)]
    thin |= {"boundary__left__beta_p": "matched", "boundary__right__beta_p": "matched"}  # also for another λ
    run = work.run("external_source", "external_source", packing__radius_ratio=work.ratios[0], **thin)
    lines = [Line(*history(run, point, "displacement"), point, i, i) for i, point in enumerate(POINTS)]
    pulse = 0.5 * period_of(run) * loads(run.case).wave["pulse"].peak()  # half the peak velocity over its length
    rows = [
        Row("P1: largest displacement (m)", f"{lines[0].y.max():.4f}", f"as in theory, {pulse:.4g}"),
        *(Row(f"{each.name}: displacement at the end (m)", f"{each.y[-1]:.4f}", "0") for each in lines),
    ]
    title = "Zhou et al. (2018), fig. 14: viscous input on the left, viscoelastic right end"
    return overlay(title, [("", lines)], TIME, "displacement along x (m)"), rows


def figure_16(work: Work) -> Drawn:
    """Displacement at the receiver of Lamb's problem on the paper's lattice, without friction and with closed contacts.

    A continuum beyond the sides stands for the extended model of 500 m, of 25 times the disks.
    """
    plain: dict[str, Any] = {"material__fric": 0.0}
    endless = {f"boundary__{side}": {"type": "outside"} for side in ("right", "bottom")}
    runs = {
        "extended (a continuum)": work.run("lamb_viscous", "lamb_endless", **plain, **endless),
        "viscoelastic sides": work.run("lamb_viscoelastic", "lamb_viscoelastic", **plain),
        "viscous sides": work.run("lamb_viscous", "lamb_viscous", **plain),
    }
    lines = [
        Line(*history(run, "receiver", "displacement", 1), name, index, index)
        for index, (name, run) in enumerate(runs.items())
    ]
    whole, rows = lines[0], []
    for each, printed in zip(lines, ("the reference", "close to it, hardly an offset", "a clear offset"), strict=True):
        error = np.interp(whole.x, each.x, each.y) - whole.y
        rms = np.linalg.norm(error) / np.linalg.norm(whole.y)
        found = f"{each.y[-1] / 1e-3:.3f} mm" + ("" if each is whole else f", {rms:.1%}")
        rows.append(Row(f"{each.name}: displacement at the end, RMS error", found, printed))
    title = "Zhou et al. (2018), fig. 16: Lamb's problem, 10 m from the load"
    return overlay(title, [("", lines)], TIME, "displacement along y (m)"), rows


def figure_18(work: Work) -> Drawn:
    """Velocity at the wall and the crown of a tunnel beside an elastic continuum of E = E_c and ν = 0."""
    disks = work.run("tunnel", "tunnel")
    speed = 1000.0 / math.sqrt(2.0)  # E = E_c = ½ρc_p²
    other = {"material__p_wave_speed": speed, "material__fric": 0.5}
    continuum = work.run("tunnel_window", "tunnel_continuum", **other)
    panels, rows = [], []
    for point in ("P1", "P2"):
        time, own = history(disks, point, "velocity")
        beside = history(continuum, point, "velocity")
        lines = [Line(time, own, "disks, pattern C", 0), Line(*beside, "continuum, E = E_c, ν = 0", 1, 1)]
        panels.append((point, lines))
        tops = [(line.y.max(), line.x[line.y.argmax()]) for line in lines]
        peaks = " and ".join(f"{top:.3f} at {at:.3f}" for top, at in tops)
        rows.append(Row(f"{point}: largest v_x (m/s) at its time (s), disks and continuum", peaks, "they agree well"))
    title = "Zhou et al. (2018), fig. 18: tunnel under an SV pulse, free-field sides"
    return overlay(title, panels, TIME, VELOCITY), rows


ONE, TWO = (1.5,), (1.5, 2.0)
"""Printed ratios of radii λ."""

PAPER = Paper(
    "Zhou X. T., Sheng Q., Cui Z., Leng X. L., Fu X. D., Ma Y. L. N. (2018), Rock and Soil Mechanics 39(7), 2671–2681",
    {
        "2": Figure("two packings", "两种颗粒单元分布模式", 7, partial(packings, number="2", names="AB"), ONE),
        "3": Figure("a pulse in the long bar, β = 1", "各监测点 X 方向速率", 32, figure_3, ONE),
        "6": Figure(
            "ratio iteration from β = 0.5 and 2",
            "右侧黏性边界 P5 速度峰值随迭代次数变化",
            41,
            partial(iterations, number="6", names="B", starts=(0.5, 2.0), printed="10, 0.500 m/s"),
            ONE,
        ),
        "7": Figure(
            "P4 by pass from β = 0.5", "β 初值 0.5, P4 速度时程", 135, partial(passes, number="7", start=0.5), ONE
        ),
        "8": Figure(
            "P4 by pass from β = 2", "β 初值 2.0, P4 速度时程", 133, partial(passes, number="8", start=2.0), ONE
        ),
        "9": Figure("a brick", "基块 (pbrick)", 4, brick, ONE),
        "10": Figure(
            "packings at the right side", "右侧边界颗粒分布", 14, partial(packings, number="10", names="ABC"), TWO
        ),
        "11": Figure("diameters along the right side", "右侧边界颗粒粒径分布", 96, figure_11, TWO),
        "12": Figure("peaks along the right side, β = 1", "右侧边界速度峰值分布", 98, figure_12, TWO),
        "13": Figure(
            "ratio iteration of all patterns from β = 1",
            "颗粒分布模式对比值迭代过程影响",
            40,
            partial(iterations, number="13", names="ABC", starts=(1.0,), printed="9, 0.500 m/s"),
            TWO,
        ),
        "14": Figure("external source", "外源波动, 各监测点位移时程", 64, figure_14, ONE),
        "16": Figure("Lamb's problem", "Lamb 问题, 监测点竖向位移时程", 30, figure_16),
        "18": Figure("a tunnel under an SV wave", "隧洞 P1, P2 水平速率时程", 23, figure_18),
    },
    "figures 1, 4, 5, 15 and 17 are sketches",
)
