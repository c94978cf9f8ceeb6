"""Facts and warnings about the forces at rest at the sides of a body in which bonds may break, and what bears them."""

from collections.abc import Iterator

import numpy as np

from dembound.boundaries.platen import Keeping
from dembound.casefile.disks.intact import can_break, keeps_forces
from dembound.disks.scene import DiskScene
from dembound.disks.supports import forces_of
from dembound.words import Entries, with_unit

TENTH = 0.1
"""Share of the weight in examples of sag and creep."""

STEADY, LATE, SAMPLES = 0.01, 0.75, 50
"""A wave counts as lasting if its value, sampled so often after this share of the run, changes by less than STEADY."""


def intact_facts(scene: DiskScene) -> Entries:
    """Where the zones lie in which bonds do not break, and the springs of the bottom."""
    zones = scene.intact_zones
    if zones:
        depths: dict[int, list[str]] = {scene.case.intact[side]: [] for side in zones}
        for side in zones:
            depths[scene.case.intact[side]].append(side)
        parts = [
            f"{depth} {'disk' if depth == 1 else 'disks'} from {' and '.join(sides)}" for depth, sides in depths.items()
        ]
        inside = len(np.unique(np.concatenate(list(zones.values()))))
        count = scene.disk_count - scene.column_count
        column = "; all of the free-field column" if any(side in scene.case.column_sides for side in zones) else ""
        yield "bonds kept", f"{', '.join(parts)}: {inside:,} of {count:,} disks have bonds that do not break{column}"
    if (springs := scene.bearing) is not None:
        assert scene.case.bearing is not None
        beyond = "the free-field column" if scene.twin is not None else "its own mean, so that they bear no net force"
        factors = f"α_n {scene.case.bearing.alpha_n:g} and α_s {scene.case.bearing.alpha_s:g}"
        stiffness = float(springs.stiffness[:, 1].sum())
        sags = ""
        if scene.twin is not None and stiffness > 0.0 and (weight := _weight(scene)) > 0.0:
            sag = TENTH * weight / stiffness
            sags = f"; a tenth of the weight more sags by {with_unit(sag, 'm')}, in proportion to the width of the body"
        yield "bottom springs", f"{factors}, on the motion relative to {beyond}{sags}"


def intact_warnings(scene: DiskScene) -> Iterator[str]:
    """Warnings about forces at rest without a zone, and about loads that dashpots alone bear."""
    yield from _without_zone(scene)
    yield from _change_of_weight(scene)
    yield from _lasting_loads(scene)


def _without_zone(scene: DiskScene) -> Iterator[str]:
    """Sides without a zone although forces at rest act on them."""
    case = scene.case
    if not (scene.has_history and can_break(case.materials)):
        return
    sides = [
        side
        for side, table in case.boundary.items()
        if isinstance(table, Keeping) and table.intact == 0 and keeps_forces(case.static, side, table)
    ]
    if sides:
        keys = " and ".join(f"boundary.{side}.intact" for side in sides)
        yield (
            f"{keys}: {'is' if len(sides) == 1 else 'are'} 0, but forces of the static stage go on acting there when "
            "bonds break, on whatever is left of the ground, and may move it without end; leave it out, or give 2"
        )


def creep(scene: DiskScene, axis: int) -> float | None:
    """Velocity (m/s) of a body per newton of a lasting force along an axis, if dashpots alone bear it; else None."""
    supports = scene.supports
    own = (supports.component == axis) & (supports.node >= scene.column_count) & (supports.node < scene.disk_count)
    springs = scene.bearing is not None and scene.twin is not None and scene.bearing.stiffness[:, axis].any()
    held = scene.free[axis] == 0.0 or supports.prescribed[own].any() or supports.stiffness[own].any()
    damping = float(supports.damping[own].sum())
    return None if held or springs or scene.continua or damping == 0.0 else 1.0 / damping


def _change_of_weight(scene: DiskScene) -> Iterator[str]:
    """Ground in which bonds may break and that dashpots alone bear: weight that falls off makes it drift."""
    rate = creep(scene, 1)
    if not scene.intact_zones or not scene.has_history or rate is None or (weight := _weight(scene)) == 0.0:
        return
    drift = with_unit(TENTH * weight * rate, "m/s")
    yield (
        "boundary: dashpots alone bear this ground, whose weight is in balance at rest; where ground falls off or is "
        f"added it moves without end, at {drift} for a tenth of the weight; anchor it: hold a side, or take "
        '"free_field" or "outside" sides'
    )


def _lasting_loads(scene: DiskScene) -> Iterator[str]:
    """Loads that last until the end of a run, beside dashpots alone."""
    times = scene.case.run.duration * np.linspace(LATE, 1.0, SAMPLES)
    for load in scene.case.load:
        if load.wave is None:
            continue
        values = scene.case.wave[load.wave].velocity(times)
        if not values.any() or np.ptp(values) > STEADY * np.abs(values).max():
            continue
        force = forces_of(load, scene)[1].sum(axis=0) * values.mean()
        for axis in (0, 1):
            rate = creep(scene, axis)
            if rate is not None and abs(force[axis]) > STEADY * np.hypot(*force[:2]):
                speed = with_unit(abs(force[axis]) * rate, "m/s", 4)
                yield (
                    f"load.{load.name}: lasts until the end of the run, {with_unit(abs(force[axis]), 'N', 4)} along "
                    f"{'xy'[axis]}, and dashpots alone bear it: the body creeps at {speed}; hold a side, or take "
                    '"outside" sides'
                )


def _weight(scene: DiskScene) -> float:
    """Size (N) of the steady force along y on the disks of the body."""
    return abs(float(scene.steady_load[1, scene.column_count : scene.disk_count].sum()))
