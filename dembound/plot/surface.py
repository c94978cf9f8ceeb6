"""Amplification along the surface of the ground: peaks, spectra and displacements at the end beside the free field."""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator

from dembound.casefile.disks.load import FREE_FIELD
from dembound.plot.histories import Component
from dembound.plot.style import REFERENCE, SIGNED_MAP, UNSIGNED_MAP, Powers, finished, new_figure, point_style, styled
from dembound.results.reader import record_names
from dembound.results.surface import Amplification

COMPONENTS = {"x": (0,), "y": (1,), "both": (0, 1)}
"""Components of which there is a map of spectra."""

LEAST, MOST = 2.0, 10.0
"""Limits of the largest ratio of spectra that has a colour of its own; the smallest is one over it."""

USUAL = 0.97
"""Share of the ratios whose colours differ; what is beyond has the last colour."""

RATIOS = (0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0)
"""Ratios that have a number beside the colours."""

STEPS = (1.0, 2.0, 5.0)
"""Multiples of powers of ten that have a number on the axis of frequencies."""

SPARSE = 40
"""Number of monitors above which their points are smaller."""

HEIGHTS = {"peaks": 1.5, "map": 2.2, "end": 1.5, "ground": 1.3}
"""Heights (inches) of the panels."""


@styled
def plot_surface(path: Path, found: Amplification, component: Component | None = None) -> Figure:
    """Panels along x: peaks and smoothed Fourier spectra over those of the free field, displacement at the end, ground.

    component
        x, y or both; by default lines have both, and the map of spectra over x and frequency has the one that moves
        most in the free field, x if that has no component alone.
    """
    maps, lines = COMPONENTS[component or ("y" if found.over_size[0] else "x")], COMPONENTS[component or "both"]
    kinds = [*("peaks" for _ in found.peaks), *("map" for _ in maps), "end", "ground"]
    heights = [HEIGHTS[kind] for kind in kinds]
    figure = new_figure(9.0, 1.2 + sum(heights))
    grid = figure.subplots(len(kinds), 2, width_ratios=(1.0, 0.02), height_ratios=heights, squeeze=False)
    panels, beside = grid.T
    for panel in panels[1:]:
        panel.sharex(panels[0])
    for panel in panels[:-1]:
        panel.tick_params(labelbottom=False)
    for kind, cell in zip(kinds, beside, strict=True):
        cell.set_axis_off() if kind != "map" else None
    rows = iter(panels)
    for quantity, values in found.peaks.items():
        _draw_lines(next(rows), found, values, f"peak {quantity}\nover free field (–)", 1.0, lines)
    for c, bar in zip(maps, beside[len(found.peaks) :], strict=False):
        _draw_map(figure, next(rows), bar, found, c)
    end = next(rows)
    _draw_lines(end, found, found.at_end, "displacement at end\nless free field (m)", 0.0, lines)
    end.yaxis.set_major_formatter(Powers())
    _draw_ground(next(rows), found)
    panels[-1].set_xlabel("x (m)")
    panels[0].set_xlim(*_ends(found.places[:, 0])[[0, -1]])
    (name,) = record_names([path])
    return finished(figure, f"{name}: motion along the surface over that of the free field", [panels[0]], 3)


def _draw_lines(
    panel: Axes, found: Amplification, values: np.ndarray, label: str, level: float, components: Sequence[int]
) -> None:
    """Draw values (k, 2) of some components, and a thin line at a level."""
    panel.axhline(level, color=REFERENCE, linewidth=0.8)
    for c in components:
        name = "xy"[c]
        over = f", over √(x² + y²) of the free field, which has no {name}" if found.over_size[c] else ""
        style = point_style(c) | {"markersize": 3.0 if len(found.names) <= SPARSE else 1.5}
        changes = 1 + np.flatnonzero([one != other for one, other in pairwise(found.fields)])  # where lines end
        x, y = (np.insert(each, changes, np.nan) for each in (found.places[:, 0], values[:, c]))
        panel.plot(x, y, label=f"{name}{over}", gid=name, **style)
    if level > 0.0:
        panel.set_ylim(bottom=0.0)
    panel.set_ylabel(label, fontsize=9)
    _mark_changes(panel, found)


def _mark_changes(panel: Axes, found: Amplification) -> None:
    """Draw a dotted line where the free field changes."""
    for x in _changes(found):
        panel.axvline(x, color=REFERENCE, linewidth=0.8, linestyle=":")


def _draw_map(figure: Figure, panel: Axes, bar: Axes, found: Amplification, component: int) -> None:
    """Draw ratios of spectra over x and frequency: white as the free field, grey where this has no energy.

    Of a component that the free field does not have colours begin at zero.
    """
    ratios = found.spectra[:, :, component].T
    colours: dict[str, Any] = {"cmap": UNSIGNED_MAP, "vmin": 0.0}
    if not found.over_size[component]:
        sizes = ratios[np.isfinite(ratios) & (ratios > 0.0)]
        usual = np.quantile(np.maximum(sizes, 1.0 / sizes), USUAL) if len(sizes) else LEAST
        most = float(np.clip(usual, LEAST, MOST))
        colours = {"cmap": SIGNED_MAP, "norm": LogNorm(1.0 / most, most)}
        ratios = np.maximum(ratios, 1e-3 / most)
    edges = np.sqrt(found.frequency[1:] * found.frequency[:-1])
    edges = np.concatenate([found.frequency[:1], edges, found.frequency[-1:]])
    mesh = panel.pcolormesh(_ends(found.places[:, 0]), edges, ratios, rasterized=True, **colours)
    panel.set_facecolor("#BFBFBF")
    panel.grid(visible=False)
    _mark_changes(panel, found)
    panel.set_yscale("log")
    panel.set_ylabel(f"spectrum of v_{'xy'[component]}:\nfrequency (Hz)", fontsize=9)
    panel.yaxis.set_major_locator(LogLocator(subs=STEPS))
    panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    panel.yaxis.set_minor_formatter(NullFormatter())
    limits = mesh.get_clim()
    beyond = bool(np.nanmin(ratios) < limits[0]), bool(np.nanmax(ratios) > limits[1])
    extend = {(True, False): "min", (False, True): "max", (True, True): "both"}.get(beyond, "neither")
    figure.colorbar(mesh, cax=bar, extend=extend).set_label(f"over {found.words(component)} (–)", fontsize=8)
    if "norm" in colours:
        shown = [each for each in RATIOS if limits[0] <= 1.001 * each and each <= 1.001 * limits[1]]
        bar.yaxis.set_major_locator(FixedLocator(shown))
        bar.yaxis.set_minor_locator(NullLocator())
        bar.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def _draw_ground(panel: Axes, found: Amplification) -> None:
    """Draw the monitors at their heights, with the ground below, and write where the free field is."""
    x, y = found.places.T
    low = y.min() - 0.3 * max(np.ptp(y), 0.1 * np.ptp(x))
    panel.fill_between(x, low, y, color="#D9D9D9", linewidth=0.0)
    panel.plot(x, y, color="black", linewidth=1.0)
    panel.set_ylim(bottom=low)
    panel.set_ylabel("y (m)", fontsize=9)
    changes = [-np.inf, *_changes(found), np.inf]
    for begin, end in pairwise(changes):
        inside = np.flatnonzero((x > begin) & (x < end))
        height = found.field_places[inside[0], 1]
        name = found.fields[inside[0]]
        what = "free field" if name.endswith(FREE_FIELD) else name
        panel.annotate(
            f"{what} at y = {height:.4g} m", (float(x[inside].mean()), 0.06), xycoords=("data", "axes fraction"),
            ha="center", va="bottom", fontsize=8,
        )  # fmt: skip
    _mark_changes(panel, found)


def _changes(found: Amplification) -> list[float]:
    """The x (m) between neighbours that have other free fields."""
    x, fields = found.places[:, 0], np.array(found.fields)
    return [float(each) for each in (0.5 * (x[1:] + x[:-1]))[fields[1:] != fields[:-1]]]


def _ends(x: np.ndarray) -> np.ndarray:
    """Edges (k + 1,) m of the cells of places x (k,) m, half-way between neighbours."""
    if len(x) == 1:
        return np.array([x[0] - 0.5, x[0] + 0.5])
    middle = 0.5 * (x[1:] + x[:-1])
    return np.concatenate([[1.5 * x[0] - 0.5 * x[1]], middle, [1.5 * x[-1] - 0.5 * x[-2]]])
