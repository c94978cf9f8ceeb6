"""Mistakes of ground whose layers differ at the left and right of a vertical plane, `ground.meet`."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from dembound.boundaries.free import Free
from dembound.casefile.disks.ground import SIDEWAYS, lowered_in
from dembound.casefile.disks.layer import Layer, bottoms, place_of, stack
from dembound.casefile.disks.surface import LEVEL
from dembound.casefile.messages import numbered
from dembound.packings.base import TYPED, Packing

COMMON = 6.0
"""Least height, in diameters, above the lower side of the disks at which layers of one side end.

Disks within five of a joint have corrected masses and springs (material/layered.py); those that stand on the ground
below are then the same at both sides.
"""

UNLIKE = "where the layers left and right of ground.meet differ"


def unlike_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """Check the layers of either side, and what they cannot go with; an invalid table or entry is None."""
    layers, ground, packing = tables["layer"], tables["ground"], tables["packing"]
    if not ground or None in layers:
        return
    sided = [(number, layer) for number, layer in enumerate(layers) if layer.side is not None]
    if ground.meet is None:
        yield from (
            f"{place_of(number, layer)}.side: needs ground.meet, the x (m) at which the layers of both sides meet"
            for number, layer in sided
        )
        return
    if not sided:
        yield 'ground.meet: no layer has side = "left" or "right"; give it to those of one side, or leave meet out'
        return
    if ground.size is not None:
        yield f"ground.size: is not allowed {UNLIKE}; let the disks fill the ground"
    elif packing:
        left, bottom, right, top = packing.box
        apart = LEVEL * 2.0 * packing.radius
        if not left + apart - TYPED * packing.span <= ground.meet <= right - apart + TYPED * packing.span:
            yield (
                f"ground.meet: is {ground.meet:.10g}, must be from {left + apart:.10g} to {right - apart:.10g} (m): "
                "four diameters from the sides of the disks"
            )
        yield from _unlike_below(layers, packing, bottom, top)
    yield from _not_with_them(tables)
    yield from _sides(tables)


def _unlike_below(layers: Sequence[Layer], packing: Packing, foot: float, top: float) -> Iterator[str]:
    """Ground that is not the same at both sides from somewhat above the foot (m) of the disks on down."""
    least = foot + COMMON * 2.0 * packing.radius
    near = TYPED * packing.span
    below = []
    for side in SIDEWAYS:
        own = stack(layers, side)
        if not own:
            yield f'layer: no layer is at the {side} of ground.meet; give one without side, or with side = "{side}"'
            return
        ends = zip(own, bottoms([layer for _, layer in own], top), strict=True)
        below.append([(number, end) for (number, _), end in ends if end < least - near])
    must = (
        f"must be the same at both sides from y = {least:.10g} m down, six diameters above the lower side of the disks"
    )
    wrong = False
    for side, found in zip(SIDEWAYS, below, strict=True):
        for number, _ in found:
            if layers[number].side == side:
                wrong = True
                key = "thickness" if layers[number].bottom is None else "bottom"
                yield f"{place_of(number, layers[number])}.{key}: is at the {side} only, but the ground {must}"
    alike = len(below[0]) == len(below[1]) and all(
        one == other and (end == beyond or abs(end - beyond) <= near)
        for (one, end), (other, beyond) in zip(*below, strict=True)
    )
    if not (wrong or alike):
        yield f"layer: common layers end at other heights at the left than at the right, but the ground {must}"


def _not_with_them(tables: Mapping[str, Any]) -> Iterator[str]:
    """Tables for which one motion or stress of all of the ground is needed."""
    if tables["incident"]:
        yield f"incident: is not known {UNLIKE}; let the wave enter at boundary.bottom"
    static = tables["static"]
    if static and static.stress is not None:
        yield f"static.stress: is one stress of all the ground, and not allowed {UNLIKE}; give static.k0"


def _sides(tables: Mapping[str, Any]) -> Iterator[str]:
    """Sides that stand for one ground only, or for a half-space."""
    boundary = tables["boundary"]
    sides = {side: boundary.get(side) or Free() for side in ("left", "right", "bottom", "top")}
    if not sides["top"].is_free or sides["top"].is_artificial:
        yield f'boundary.top.type: is "{sides["top"].type}", must be "free" {UNLIKE}'
    for side in SIDEWAYS:
        if sides[side].is_periodic or sides[side].is_mirror:
            yield f'boundary.{side}.type: is "{sides[side].type}", beyond which the same ground follows; {_others()}'
    beyond = [side for side, table in sides.items() if table.is_outside]
    driven = [side for side in beyond if sides[side].waves]
    columns = {side: sides[side].needs_column for side in SIDEWAYS}
    if any(sides[side].needs_column for side in sides):
        kind, unlike = "free_field", [side for side, there in columns.items() if not there]
    else:
        kind, unlike = "outside", [side for side in SIDEWAYS if driven and not sides[side].is_outside]
    for side in unlike:
        yield (
            f'boundary.{side}.type: is "{sides[side].type}", must be "{kind}" as other sides {UNLIKE}: each side has a '
            "free-field column of its own"
        )
    if not beyond or lowered_in(tables):
        return
    half_space = f"as the ground is no half-space {UNLIKE}"
    for place, load in numbered("load", tables["load"]):
        if load.is_everywhere and (load.wave is not None or not tables["static"]):
            yield f"{place}: acts on all disks, which needs a [static] stage and no wave, {half_space}"
    if static := tables["static"]:
        for side in SIDEWAYS:
            own = static.boundary.get(side)
            if side in beyond and not (own and 0 in own.prescribed(0)):
                yield f'static.boundary.{side}: must be "roller" or "fixed", {half_space}'


def _others() -> str:
    """Types of sides that may stand beside unlike ground, in words."""
    return 'give "outside", "free_field", or a side that ends the ground'
