"""Warnings about what a run of a bar has shown."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.bar.body import ROUNDING
from dembound.bar.scene import MOMENTS, BarScene, entering_pressure
from dembound.boundaries import normal_axis
from dembound.casefile.bar import BarCase
from dembound.kinds.bar.range_warnings import never_closing
from dembound.kinds.bar.warnings import ends_too_soon, stress_beside_strength
from dembound.results.reader import open_record, snapshots_of
from dembound.results.warnings import energy_warnings, still_moving
from dembound.words import percent, with_unit

if TYPE_CHECKING:
    import h5py

NOTHING = 0.05
"""Share of the strength that the largest tension must reach; oscillations behind a pulse reach some per cent of it."""


def warnings_after_bar(scene: BarScene, summary: Mapping[str, Any], record: Path) -> list[str]:
    """Warnings from the summary and record of a run of a bar, one line each."""
    broken = [*summary["spalls"], *summary["breaks_at_ends"].values()]
    cuts = np.array([place["end"] for place in broken]).reshape(-1, 2).mean(axis=1)
    pieces = np.searchsorted(np.sort(cuts), scene.positions[:, 0])
    with open_record(record) as file:
        return [
            *still_moving(scene, summary["duration"], file, pieces),
            *_open_contacts(scene.case, summary),
            *_torn_by_the_load(scene.case, summary),
            *_outside_the_rates(scene.case, summary),
            *_no_tension(scene.case, file),
            *energy_warnings(scene, summary["energy"], file),
        ]


def _open_contacts(case: BarCase, summary: Mapping[str, Any]) -> Iterator[str]:
    """Contacts between ranges that have never been closed, although the warnings before the run did not predict it."""
    foreseen = never_closing(case)
    for number, (left, right) in enumerate(zip(case.bar.range[:-1], case.bar.range[1:], strict=True), start=2):
        if right.name in summary["open_contacts"] and right.name not in foreseen:
            gap = f", {right.gap:g} m wide at the start," if right.gap > 0.0 else ""
            yield (
                f"bar.range[{number}, {right.name}]: its contact with {left.name}{gap} has never closed until the end "
                f"of the run at {summary['duration']:.4g} s, so nothing has passed it"
            )


def _outside_the_rates(case: BarCase, summary: Mapping[str, Any]) -> Iterator[str]:
    """Cracks at strain rates for which no strength is given."""
    laws = [part.strength_rates for part in case.bar.parts if part.strength_rates is not None]
    found = summary["crack_strain_rates"]
    if not laws or found is None:
        return
    given = min(slowest for slowest, _ in laws), max(fastest for _, fastest in laws)
    beyond = [
        f"{found[key]:.3g} 1/s, {words} {limit:g}"
        for key, words, limit in (("slowest", "below", given[0]), ("fastest", "above", given[1]))
        if (found[key] < limit) == (key == "slowest") and found[key] != limit
    ]
    if beyond:
        yield f"bar.strength_rates: cracks had strain rates of {' and '.join(beyond)}; the strength is constant there"


def _torn_by_the_load(case: BarCase, summary: Mapping[str, Any]) -> Iterator[str]:
    """A first spall at a load or a wave that enters, before a reflected wave can have returned there."""
    if not summary["spalls"]:
        return
    first, bar = summary["spalls"][0], case.bar
    for key, what, side, wave, cure in _pushing(case):
        end = bar.end(side)
        near = case.method.largest_horizon * end.length / end.cells * (1.0 + ROUNDING)
        distance = first["start"][0] if side == "left" else bar.length - first["start"][1]
        if distance <= near and first["time"] < case.wave[wave].start + 2.0 * end.length / end.speed:
            if pull := _pull(case, side, first["time"]):
                cure = f"change the sign of {f'{key}.pressure' if what == 'load' else f'wave.{wave}'} if it is to push"
                what = f"{what} pulls, with {with_unit(pull, 'Pa')}, and"
            yield (
                f"{key}: the {what} itself broke the bar, at {first['time']:.4g} s and {distance:g} m from "
                f"the {side} end, before any reflected wave had returned there; {cure}"
            )


def _pull(case: BarCase, side: str, until: float) -> float:
    """Largest tension (Pa) that enters at an end up to a time (s); 0 where it is smaller than the largest pressure."""
    pressure = entering_pressure(case, side, np.linspace(0.0, until, MOMENTS))
    return max(0.0, -float(pressure.min())) if -pressure.min() > pressure.max() else 0.0


def _pushing(case: BarCase) -> Iterator[tuple[str, str, str, str, str]]:
    """Loads and driven ends that can move: key, description, side, name of the wave, a change that avoids the break."""
    horizon, finer = case.method.largest_horizon, "take a smaller bar.spacing"
    for load in case.load:
        cure = f"give load.{load.name}.nodes = {horizon}" if load.nodes < horizon else finer
        yield f"load.{load.name}", "load", load.side, load.wave, cure
    for side, waves in case.driving.items():
        if 0 not in case.side(side).prescribed(normal_axis(side)):
            yield f"boundary.{side}", "incoming wave", side, waves["p"], f"{finer}, or a weaker or slower wave"


def _no_tension(case: BarCase, file: h5py.File) -> Iterator[str]:
    """A breakable bar whose recorded tension is far below its strength.

    No warning where a warning before the run has already reported it.
    """
    strength = case.bar.least_strength
    foreseen = [*stress_beside_strength(case), *ends_too_soon(case)]
    if np.isinf(strength) or len(file["cracks/time"]) > 0 or foreseen:
        return
    groups = [*file["histories"].values(), *snapshots_of(file)]
    if not groups:
        return
    tension = max(0.0, *(float(np.max(group["stress"][:])) for group in groups))
    if tension < NOTHING * strength:
        yield (
            f"bar: the largest tension reached is {with_unit(tension, 'Pa')}, {percent(tension / strength)} of "
            f"the strength, {with_unit(strength, 'Pa')}; nothing can break"
        )
