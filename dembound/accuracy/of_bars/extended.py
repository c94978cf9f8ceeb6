"""Bars with more spacings beyond their ends."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from dembound.accuracy.moved_sides import Extended, movable, must_not_exceed, same_step, sentence_of
from dembound.bar.paths import front_of_bar, sources_of_bar
from dembound.bar.scene import build_bar
from dembound.bar.stability import choose_step
from dembound.casefile.bar import BarCase
from dembound.casefile.bar.bar import MOST_CELLS, Bar
from dembound.motion.paths import plane_needed
from dembound.motion.silence import monitored


def extended_bar(case: BarCase, most: int) -> Extended:
    """A bar with more spacings beyond its ends; parameters and errors as of `accuracy.extended.extended`."""
    scene = build_bar(case)
    bar, step = case.bar, choose_step(scene)[0]
    moving = movable(case, [load.side for load in case.load])
    front = front_of_bar(scene, step)
    spacing = {side: bar.end(side).length / bar.end(side).cells for side in ("left", "right")}
    targets = monitored(scene) if case.monitor else scene.positions[[0, -1]]
    cells = {"left": 0, "right": 0}
    for side in moving:
        plane = bar.length if side == "right" else 0.0
        needed = plane_needed(side, sources_of_bar(case), targets, front, case.run.duration)
        beyond = needed - plane if side == "right" else plane - needed
        cells[side] = max(0, int(np.ceil(beyond / spacing[side] - 1e-9))) if np.isfinite(beyond) else 0
    count = bar.nodes - 1 + sum(cells.values())
    longer = {side: cells[side] * spacing[side] for side in cells}
    length = bar.length + sum(longer.values()) if bar.range else count * spacing["left"]
    must_not_exceed(count + 1, min(most, MOST_CELLS), f"{length:g} m", case)
    sentence = sentence_of(case, f"the same bar {length:g} m long, {count + 1:,} nodes", moving)
    if not any(cells.values()):
        return Extended(case, sentence, (0.0, 0.0, bar.length, 0.0))
    shift = longer["left"]
    monitors = tuple(
        monitor.model_copy(update={"position": min(monitor.position + shift, length)}) for monitor in case.monitor
    )
    larger = replace(
        case,
        bar=_lengthened(bar, longer, length),
        monitor=monitors,
        run=same_step(case.run, step),
        name=f"{case.name}_extended",
    )
    return Extended(larger, sentence, (shift, 0.0, shift + bar.length, 0.0))


def _lengthened(bar: Bar, longer: Mapping[str, float], length: float) -> Bar:
    """A bar of another length (m), its end ranges longer by `longer` (m) if it has ranges."""
    ranges = list(bar.range)
    for side, index in (("left", 0), ("right", -1)):
        if ranges:
            ranges[index] = ranges[index].model_copy(update={"length": ranges[index].length + longer[side]})
    return bar.model_copy(update={"length": length, "range": tuple(ranges)} if ranges else {"length": length})
