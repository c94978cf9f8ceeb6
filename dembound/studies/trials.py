"""Scenes without loads and waves, in which noise is stepped to measure how large a time step is stable."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from dembound.bar import stability as of_bars
from dembound.bar.scene import build_bar
from dembound.casefile import Case
from dembound.casefile.bar import BarCase
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import Load
from dembound.casefile.model import as_kind
from dembound.casefile.types import LAWS
from dembound.disks import stability as of_disks
from dembound.disks.scene import DiskScene, build, ground_of
from dembound.disks.stepping.contact_lists import contact_lists
from dembound.disks.stepping.start import Start
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.part import System
from dembound.motion.scene import Scene

AnyCase = TypeVar("AnyCase", bound=Case)

PARTICLES = 2500
"""Particles of a reduced copy, about; one brick may have more. 100,000 steps of them take some ten seconds."""

NOISE = 1e-5
"""Root mean square velocity (m/s) of the noise: strains of 1e-8, at which no bond breaks."""


NOTHING = Load.model_construct(name="nothing", acceleration=(0.0, 0.0))
"""A load of zero on all of the ground, for which a case keeps its free-field column beside a continuum."""


@dataclass(frozen=True)
class Trial:
    """A scene under one law, or a bar at one stage of its method, at rest and without loads and waves.

    Attributes
    ----------
    name : of the law or stage.
    scene : its arrays.
    limit : s, the stability limit computed from the largest eigenvalue; step : s, that of the case.
    system : its parts and ties for a time step (s); anew for every run.
    is_linear : whether forces are linear, so that central differences conserve an energy exactly.
    """

    name: str
    scene: Scene
    limit: float
    step: float
    system: Callable[[float], System]
    is_linear: bool

    def noise(self, part: str | None = None) -> np.ndarray:
        """Random velocities (3, n), m/s and rad/s, of all nodes or of those of one part; the same in every call.

        Times the root of the mass, all directions are equally likely: every mode of vibration has the same expected
        energy.
        """
        scene = self.scene
        mass = np.stack([scene.mass, scene.mass, scene.inertia])
        velocity = np.random.default_rng(0).standard_normal(mass.shape) * scene.moves
        velocity *= NOISE * np.sqrt(scene.mass.mean() / mass)
        if part is not None:
            chosen = np.zeros(scene.count, dtype=bool)
            chosen[next(each.nodes for each in self.system(self.step).parts if each.name == part)] = True
            velocity[:, ~chosen] = 0.0
        return velocity


UNLOADED = (
    "unloaded: contacts that nothing presses together open and close in the noise, so a larger step is stable than "
    "under loads, which close them and bring the largest one down to that of the linear law"
)
"""About the largest step measured under a law with contacts that open."""


def trials(case: Case, *, full: bool = False) -> tuple[list[Trial], list[str]]:
    """The scenes to measure for a case, and how they differ from it, one sentence each.

    full : the whole scene, instead of fewer copies of the brick.

    Raises the errors of building a scene.
    """
    if isinstance(case, BarCase):
        return of_bar(case)
    return of_disk_case(as_kind(case, DiskCase, "is a case of an unknown kind of body"), full=full)


def of_bar(case: BarCase) -> tuple[list[Trial], list[str]]:
    """A bar with the bonds of every stage of its method."""
    scene = build_bar(_at_rest(case))
    step = of_bars.own_step(scene, scene.step_limit())
    stages = case.method.stages(scene.rod)
    found = []
    for index, bonds in enumerate(stages):

        def system(time_step: float, index: int = index) -> System:
            return scene.system(time_step, case.method.stages(scene.rod)[index])

        name = case.method.name if len(stages) == 1 else f"{case.method.type}, stage {index + 1}"
        found.append(Trial(name, scene, scene.stable_step(bonds), step, system, is_linear=True))
    left_out = ["the method stays at each stage"] if len(stages) > 1 else []
    return found, [f"{scene.count:,} nodes, the whole bar", *_left_out(case), *left_out]


def of_disk_case(case: DiskCase, *, full: bool) -> tuple[list[Trial], list[str]]:
    """A body of disks under the linear law, and under the case's own if that has a history."""
    plain = replace(_at_rest(case), static=None, monitor=(), incident=None)
    whole = build(case)
    if whole.outside is not None:  # whose settings were chosen from the waves
        plain = replace(plain, outside=case.outside.model_copy(update=whole.outside.settings.given))
        plain = replace(plain, load=(NOTHING,) if whole.seam is not None else ())
    words = _left_out(case) + ["no static stage: contacts begin as packed"] * (case.static is not None)
    if not full:
        plain, about = _reduced(plain)
        words = [*about, *words]
    own = LAWS[case.material.law]
    linear = plain.material.model_copy(update={"law": own.linear})
    scene = build(replace(plain, material=linear))
    size = f"{scene.size[0]:.4g} m × {scene.size[1]:.4g} m, {scene.disk_count:,} disks"
    if scene.continua:
        size += f" and {sum(each.count for each in scene.continua):,} nodes of a continuum"
    if scene.seam is not None:
        size += ", with the free-field column"
    found = [_under(scene, own.linear)]
    if own.has_history:
        opens = scene.ground.moduli.emod > 0.0 and case.material.locked_in is None
        found.append(_under(build(plain), f"{own.name}{', unloaded' if opens else ''}"))
        words += [f"noise of {NOISE:g} m/s, in which no bond breaks", *([UNLOADED] if opens else [])]
    return found, [size, *words]


def _under(scene: DiskScene, name: str) -> Trial:
    """A body under its law."""
    limit = of_disks.step_limit(scene)

    def system(time_step: float) -> System:
        nothing = np.zeros((3, scene.count))
        start = None
        if scene.has_history and scene.case.material.locked_in is not None:
            start = Start(nothing, contact_lists(scene))  # what is locked in is balanced, also at cut faces
        return DiskSystem(scene, time_step, start, load=nothing)

    return Trial(name, scene, limit, of_disks.own_step(scene, limit), system, is_linear=not scene.has_history)


def _at_rest(case: AnyCase) -> AnyCase:
    """The case without loads and waves; its sides keep their dashpots and springs."""
    boundary = {side: table.at_rest() for side, table in case.boundary.items()}
    return replace(case, boundary=boundary, wave={}, load=())


def _left_out(case: Case) -> list[str]:
    """What `_at_rest` leaves out, in words."""
    return ["no loads and waves"] * bool(case.load or case.wave)


def _reduced(case: DiskCase) -> tuple[DiskCase, list[str]]:
    """The case with fewer copies of its brick under the same sides, if it has more than `PARTICLES`, and how in words.

    Holes are left out: removing particles and contacts takes rows and stiffness from K, which cannot increase its
    largest eigenvalue.
    """
    across, up = case.packing.copies
    disks = len(ground_of(case).brick.radii)
    most = max(1, PARTICLES // disks)
    if across * up <= most:
        return case, ["the whole scene"]
    fewer_up = int(np.clip(round(up * np.sqrt(most / (across * up))), 1, up))
    fewer = int(np.clip(most // fewer_up, 1, across)), fewer_up
    words = [f"{fewer[0]} × {fewer[1]} of its {across} × {up} bricks, the same sides"]
    stiffest = {side: table.stiffest(side, case.packing.extent) for side, table in case.boundary.items()}
    if stiffest != case.boundary:
        words.append("springs that depend on the distance of a source are those nearest to it")
    words += ["no holes, whose free walls do not lower the limit"] * bool(case.hole)
    return replace(case, boundary=stiffest, packing=case.packing.with_copies(*fewer), hole=()), words


def parts_of(trial: Trial) -> Iterator[str]:
    """Names of the parts to put noise in: all of them, each of which moves independently of those after it.

    A body and its continuum are tied: the energy of each is at most that of the noise in it. Under a law with a history
    only the last one of disks, the body, as the energies of a ledger are those of all parts.
    """
    system = trial.system(trial.step)
    parts = system.parts if trial.is_linear else system.recorded_parts[-1:]
    yield from (part.name for part in parts)
