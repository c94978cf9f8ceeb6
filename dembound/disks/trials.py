"""Bodies of disks at rest, under the linear law and their own, in which noise is stepped; see motion/stability.py."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import Load
from dembound.casefile.types import LAWS, linear_law
from dembound.disks import stability, step_cost
from dembound.disks.scene import DiskScene, build, ground_of
from dembound.disks.small_motion import small_motion
from dembound.disks.stepping.scene_parts import Start, contact_lists
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.part import System
from dembound.motion.stability import NOISE, Trial, at_rest, left_out
from dembound.waves.wave import Wave

PARTICLES = 2500
"""Approximate number of particles of a reduced copy; one brick may have more."""

NOTHING = Load.model_construct(name="nothing", acceleration=(0.0, 0.0))
"""A load of zero on all of the ground, for which a case keeps its free-field column beside a continuum."""

UNLOADED = (
    "unloaded: contacts that nothing presses together open and close in the noise, so a larger step is stable than "
    "under loads, which close them and bring the largest one down to that of the linear law"
)
"""Note on the largest step measured under a law with contacts that open."""


STIFFENS = (
    'the elastic law with the stiffness at rest: contacts of law "{}" grow stiffer, which a run watches, and its step '
    "limit includes a reserve"
)
"""Note on the trial of a law that does not start elastic."""


def trials_of_disks(case: DiskCase, *, full: bool) -> tuple[list[Trial], list[str]]:
    """A body of disks under the linear law, and under the case's own law if that differs.

    Returns also one sentence for each difference from the case. full : the whole scene, instead of fewer copies of
    the brick. Raises the errors of building a scene.
    """
    words = [] if LAWS[case.material.law].starts_elastic else [STIFFENS.format(case.material.law)]
    case = small_motion(case)
    plain = replace(at_rest(case), static=None, wall=(), monitor=(), incident=None)
    whole = build(case)
    if whole.outside is not None:  # whose settings were chosen from the waves
        plain = replace(plain, outside=case.outside.model_copy(update=whole.outside.settings.given))
        plain = replace(plain, load=(NOTHING,) if whole.seams else ())
        if len(whole.seams) > 1:  # kept only under waves
            waves = {name: _still(wave) for name, wave in case.wave.items()}
            plain = replace(plain, boundary=case.boundary, wave=waves)
    words += left_out(case) + ["no walls"] * bool(case.wall)
    words += ["no static stage: contacts begin as packed"] * (case.static is not None)
    if len(whole.seams) > 1:  # of other columns on each side, which meet in the continuum below
        words = ["the whole scene, as the ground has two heights", *words]
    elif not full:
        plain, about = _reduced(plain)
        words = [*about, *words]
    own = LAWS[case.material.law]
    linear = plain.material.model_copy(update={"law": linear_law(own.name)})
    scene = build(replace(plain, material=linear))
    size = f"{scene.size[0]:.4g} m × {scene.size[1]:.4g} m, {scene.disk_count:,} disks"
    if scene.continua:
        size += f" and {sum(each.count for each in scene.continua):,} nodes of a continuum"
    if scene.seams:
        size += ", with the free-field column"
    found = [_under(scene, own.linear)]
    if not own.is_linear:
        opens = own.has_history and scene.ground.moduli.emod > 0.0 and case.material.locked_in is None
        found.append(_under(build(plain), f"{own.name}{', unloaded' if opens else ''}"))
        words += [f"noise of {NOISE:g} m/s, in which no bond breaks", *([UNLOADED] if opens else [])]
    return found, [size, *words]


def _still(wave: Wave) -> Wave:
    """A wave without motion, for which a case keeps its two free-field columns beside a continuum."""
    sizes = {"amplitude", "scale"} & type(wave).model_fields.keys()
    return wave.model_copy(update=dict.fromkeys(sizes, 0.0))


def _under(scene: DiskScene, name: str) -> Trial:
    """A body under its law."""
    limit = stability.step_limit(scene)

    def system(time_step: float) -> System:
        nothing = np.zeros((3, scene.count))
        start = None
        if scene.has_history and scene.case.material.locked_in is not None:
            start = Start(nothing, contact_lists(scene))  # what is locked in is balanced, also at cut faces
        return DiskSystem(scene, time_step, start, load=nothing)

    linear = scene.ground.law.is_linear
    step, cost = stability.own_step(scene.case, limit), sum(step_cost.times_of_scene(scene).values())
    return Trial(name, scene, limit, step, system, is_linear=linear, step_cost=cost)


def _reduced(case: DiskCase) -> tuple[DiskCase, list[str]]:
    """The case with fewer copies of its brick, if it has more than `PARTICLES`, and the change in words.

    Layers remain whole. Sides stay the same. Holes are left out: removing particles and contacts takes rows and
    stiffness from K, which cannot increase its largest eigenvalue; joints likewise.
    """
    across, up = case.packing.copies
    disks = len(ground_of(case).brick.radii)
    most = max(1, PARTICLES // disks)
    stiff = any(group.is_stiff for group in case.group)
    if across * up <= most or (case.layer and across == 1) or stiff:
        return case, ["the whole scene"]
    fewer_up = up if case.layer else int(np.clip(round(up * np.sqrt(most / (across * up))), 1, up))
    fewer = int(np.clip(most // fewer_up, 1, across)), fewer_up
    words = [f"{fewer[0]} × {fewer[1]} of its {across} × {up} bricks, the same sides"]
    stiffest = {side: table.stiffest(side, case.packing.box) for side, table in case.boundary.items()}
    if stiffest != case.boundary:
        words.append("springs that depend on the distance of a source are those nearest to it")
    words += ["no holes, whose free walls do not lower the limit"] * bool(case.holes)
    words += ["no joints, which are softer than the contacts that they replace"] * bool(case.joint)
    case = replace(case, boundary=stiffest, packing=case.packing.with_copies(*fewer), ground=case.ground.level())
    return replace(case, group=(), hole=(), joint=()), words
