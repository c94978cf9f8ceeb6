"""The time step of a bar and its limit."""

from dembound.bar.banded import ROUNDING
from dembound.bar.scene import BarScene
from dembound.errors import CaseError


def own_step(scene: BarScene, limit: float) -> float:
    """The time step (s) of the case: a share of the stability limit (s), or the given step, even above the limit."""
    run = scene.case.run
    if run.courant is not None:
        return run.courant * unit_step(scene)
    return float(run.time_step) if isinstance(run.time_step, float | int) else run.safety * limit


def choose_step(scene: BarScene) -> tuple[float, float]:
    """Time step to run with and its stability limit (s) at every stage of the bar's method, exact to rounding.

    The step may be given by its Courant number. Raises CaseError when the case gives a step above the limit.
    """
    limit = scene.step_limit()
    step = own_step(scene, limit)
    if step > limit * (1.0 + ROUNDING):
        courant = scene.case.run.courant
        if courant is None:
            raise CaseError([f"run.time_step: is {step:g} s, must not be above the stability limit {limit:.6g} s"])
        most = limit / unit_step(scene)
        raise CaseError([f"run.courant: is {courant:g}, must not be above {most:.6g}, the stability limit"])
    return step, limit


def unit_step(scene: BarScene) -> float:
    """The time step (s) at a Courant number of 1, in the range where this is shortest."""
    return min(part.spacing / part.speed for part in scene.rod.ranges)
