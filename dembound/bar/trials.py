"""Bars at rest, one for every stage of their method, in which noise is stepped; see motion/trial.py."""

from __future__ import annotations

from dembound.bar import step_cost
from dembound.bar.scene import build_bar
from dembound.bar.stability import own_step
from dembound.casefile.bar import BarCase
from dembound.motion.part import System
from dembound.motion.trial import Trial, at_rest, left_out


def trials_of_bar(case: BarCase) -> tuple[list[Trial], list[str]]:
    """For every stage of its method a bar with its bonds, and a sentence on how it differs from the case.

    Raises the errors of building a scene.
    """
    scene = build_bar(at_rest(case))
    step, cost = own_step(scene, scene.step_limit()), step_cost.of_bar(scene)
    stages = case.method.stages(scene.rod)
    found = []
    for index, bonds in enumerate(stages):

        def system(time_step: float, index: int = index) -> System:
            return scene.system(time_step, case.method.stages(scene.rod)[index])

        name = case.method.name if len(stages) == 1 else f"{case.method.type}, stage {index + 1}"
        found.append(Trial(name, scene, scene.stable_step(bonds), step, system, is_linear=True, step_cost=cost))
    stays = ["the method stays at each stage"] if len(stages) > 1 else []
    return found, [f"{scene.count:,} nodes, the whole bar", *left_out(case), *stays]
