"""Errors by the state at rest: how a static stage leaves contacts that slide, and a stress that turns with the disks.

Steady forces take up what is out of balance, so that nothing moves without a wave. But a contact that bears a force f
less than at its limit slides only when the wave has brought f. The wave's force in a contact is ρ c v D, with the
velocity v and the diameter D, so the error is f/(ρ c v D). Of f a part is left by the stage, the mean unbalanced force;
the other is chance: a load that differs by rounding ends in another rest, whatever the ratio asked for. Without sliding
there is one rest and no such error.

A law whose contacts follow the motion (`geometry = "updated"`) differs from the elastic one all the same, if a body has
come to rest under a stress p: the stress turns with the disks. S waves then come earlier or later by p/(2ρc_s²) of
their time, and motion near a load differs by p/ρc_p² or so (docs/evidence/errors.md).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from dembound.disks.material.layered import materials_in
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.scene import DiskScene
from dembound.disks.sources import sources_of
from dembound.formulas.cause import MOTIONS, USUAL, Cause, Causes, share_of
from dembound.formulas.disks.waves import is_square_lattice
from dembound.formulas.history import Motions, error_of_delay
from dembound.motion.paths import Source
from dembound.table import EVERYWHERE

REST = "rest"
"""Name of the cause."""

CHANCE, CHANCE_STRESSED, CHANCE_LATTICE = 2e-4, 1e-5, 1e-6
"""Force by which contacts differ between equally valid rests, over the mean contact force: where loads are put on,
where contacts begin with the stress at rest, and in lattices.

The first two are fitted to three scenes of B, and to one, under waves of 1 mm/s to 0.2 m/s, with weight changed by
1e-12: largest errors were 0.2 to 1.9 times as large as found. On a lattice under weight with friction 0.2 and 0.5 such
changes gave 5e-9 to 1.6e-6, by S and P waves."""

OF_DISPLACEMENTS = 0.3
"""Part of the error in displacements, whose waves are longer than what sliding contacts radiate.

At four places in ground with K₀ and under weight their whole errors were 0.15 to 0.33 of that expected of velocities by
this cause, which was most of it."""

LOOSE = 0.5
"""Share of the stiffness in contacts above which ground was not measured: with 0.9 and a friction of 0.3 waves of
0.1 m/s differed by up to a fifth, as contacts then slide in waves, too."""

REST_FACTOR = 2.0
"""Factor of these errors, see `CHANCE`; of what is left alone they were 0.3 to 2.9 times as large."""


NEAR_LOAD = 1.3
"""Largest part of p/ρc_p² by which velocities and displacements in rock near a load were measured to differ, apart from
what comes later; at a surface both together were too small by a factor of 1.3."""


def causes_of_rest(scene: DiskScene, motions: Motions, static: Mapping[str, Any]) -> Causes:
    """The errors of a run by the end of its static stage; under the elastic law none.

    motions : by monitor. static : of the summary, see `describe_static`.
    """
    if static["elastic"]:
        return Causes([])
    stages = [each for each in (static, static["before"], static["column"]) if each is not None]
    broken = sum(each["cracks"] for each in stages)
    beside_hole = static["before"] is not None or scene.case.holes
    if broken or beside_hole or _by_contacts(scene.ground) > LOOSE:
        where = "beside a hole" if beside_hole else "in ground that they bear more than bonds"
        what = f"{broken:,} bonds broke" if broken else f"contacts slid or opened {where}"
        return Causes([Cause.unknown(REST, f"{what} while the body settled, so that its rest is one of several")])
    ground, chance = scene.ground, CHANCE_STRESSED if scene.case.begins_stressed else CHANCE
    if is_square_lattice(ground):
        chance = CHANCE_LATTICE
    left = static["mean_residual"] * (1.0 + chance / static["ratio"]) if static["ratio"] > 0.0 else 0.0
    speed = left / (ground.density * slowest_speed(ground) * ground.brick.mean_diameter)
    parts: dict[str, dict[str, np.ndarray | float]] = {}
    for name, own in motions.items():
        peak = float(np.abs(own.velocity[:, :2]).max(initial=0.0))
        share = speed / peak if peak > 0.0 else np.nan
        parts[name] = {"velocity": share, "displacement": OF_DISPLACEMENTS * share}
    words = "by the force at which contacts slide in equally valid rests, over the wave's in a contact"
    return Causes([Cause(REST, words, parts, factor=REST_FACTOR)])


def _by_contacts(ground: PackedMaterial) -> float:
    """Largest share of the stiffness of a layer that contacts bear, and not bonds."""
    moduli = [material.moduli for material in materials_in(ground)]
    return max(own.emod / (own.emod + own.pb_rmul * own.pb_emod) for own in moduli)


def causes_of_turning(scene: DiskScene, recorded: Motions, stress: float) -> list[Cause]:
    """The error by an elastic law in place of one whose contacts turn with the disks, under a stress (Pa) at rest.

    recorded : by monitor.
    """
    if stress == 0.0:
        return []
    ground, sources = scene.ground, sources_of(scene.case, scene.ground)
    p, s = (np.nanmin([ground.wave_speeds(axis)[kind] for axis in (0, 1)]) for kind in (0, 1))
    near, slower = NEAR_LOAD * stress / (ground.density * p**2), stress / (2.0 * ground.density * s**2)
    errors: dict[str, dict[str, np.ndarray | float]] = {}
    for name, own in recorded.items():
        path = max((_way(each, own.place, scene.case.size) for each in sources), default=0.0)
        delay = partial(np.full_like, fill_value=slower * path / s)
        parts = error_of_delay(own.time, own.values["velocity"], delay)
        late = dict(zip(MOTIONS, parts, strict=True))
        errors[name] = {quantity: near + share_of(part, quantity, own) for quantity, part in late.items()}
    return [Cause("law", "by the stress at rest, which does not turn with the disks", errors, factor=USUAL)]


def _way(source: Source, place: np.ndarray, size: tuple[float, float]) -> float:
    """Path (m) of waves from a source to a place; the whole scene if they enter on all sides."""
    return math.hypot(*size) if source.box == EVERYWHERE else float(source.distance(place[None])[0])
