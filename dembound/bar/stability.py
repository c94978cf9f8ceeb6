"""The time step of a bar and its limit."""

from dembound.bar.banded import ROUNDING
from dembound.bar.scene import BarScene
from dembound.errors import CaseError


def choose_step(scene: BarScene) -> tuple[float, float]:
    """Time step to run with and its stability limit (s) at every stage of the bar's method, exact to rounding.

    The step may be given by its Courant number. Raises CaseError when the case gives a step above the limit.
    """
    limit, run = scene.step_limit(), scene.case.run
    unit = scene.rod.spacing / scene.case.bar.speed
    if run.courant is not None:
        step = run.courant * unit
        wrong = f"run.courant: is {run.courant:g}, must not be above {limit / unit:.6g}, the stability limit"
    elif isinstance(run.time_step, float | int):
        step = float(run.time_step)
        wrong = f"run.time_step: is {step:g} s, must not be above the stability limit {limit:.6g} s"
    else:
        return run.safety * limit, limit
    if step > limit * (1.0 + ROUNDING):
        raise CaseError([wrong])
    return step, limit
