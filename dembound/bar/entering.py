"""The pressure wave that enters a bar at an end with loads or a driving boundary, before any reflection returns."""

import numpy as np

from dembound.bar.scene import end_supports
from dembound.casefile.bar import BarCase

MOMENTS = 500
"""Number of times at which the wave is computed."""


def entering_pressure(case: BarCase, side: str, time: np.ndarray, *, loads: bool = True) -> np.ndarray:
    """Pressure (Pa), of the shape of times (s), of the wave that enters at an end, with or without its loads.

    The forces F at the end are balanced by ρcA·v of the bar and C·v of the dashpots, or ρcA·v of a layer beyond it, so
    that the pressure ρcv is F·ρc/(ρcA + C). An end whose motion is prescribed has the prescribed v. The forces of
    springs are neglected.
    """
    bar = case.bar.end(side)
    inwards = 1.0 if side == "left" else -1.0
    supports = end_supports(case, side)
    driven = supports.sample(np.ravel(time), 0.0).sum(axis=1).reshape(np.shape(time))
    if supports.prescribed.any():
        return inwards * bar.density * bar.speed * driven
    force = inwards * driven
    for load in case.load:
        if loads and load.side == side:
            force = force + load.pressure * bar.area * case.wave[load.wave].velocity(time)
    impedance = bar.density * bar.speed
    beyond = impedance * bar.area if case.side(side).layer else supports.damping.sum()
    return impedance / (impedance * bar.area + beyond) * force


def moments(case: BarCase, side: str) -> np.ndarray:
    """Times (s), ascending, at which to compute the wave that enters at an end, from its beginning to its end.

    Begin and end are searched within the duration of the run or of the waves, whichever is longer. The times of the
    waves' crests are included.
    """
    waves = [case.wave[load.wave] for load in case.load if load.side == side]
    waves += [case.wave[name] for name in case.side(side).waves.values()]
    over = [wave.duration() if np.isfinite(wave.duration()) else wave.peak_time() for wave in waves]
    ends = max(over, default=0.0), case.run.duration
    looked = np.unique([np.linspace(0.0, end, MOMENTS) for end in ends])
    busy = np.flatnonzero(entering_pressure(case, side, looked))
    if len(busy) == 0:
        return looked[:1]
    begin, end = looked[max(busy[0] - 1, 0)], looked[min(busy[-1] + 1, len(looked) - 1)]
    crests = [wave.peak_time() for wave in waves if begin < wave.peak_time() < end]
    return np.union1d(np.linspace(begin, end, MOMENTS), crests)
