"""Error of the slope of stress over strain of a specimen.

- Inertia. The mean of the stresses at both faces is not that of the specimen: with the velocity linear along it, they
differ by ρL_s² (d²e/dt²)/12 (Gorham 1989), which a fast rise adds to the slope. ρ follows from the impulses themselves,
∫(F_1 − F_2) dt = ρ L_s A_s (v_1 + v_2)/2. - Time. The time of each pulse is uncertain by half a sample either way,
uniformly. The standard error is the change of the slope with the reflected or transmitted pulse half a sample earlier
or later, over √3. - Line. The standard error by the deviations from the line, with one independent value per
correlation time: due to reverberations in the specimen, and a curved law. - Noise. The scatter of slopes from the same
pulses with noise added again, drawn some tens of times; as the strain is an integral, noise makes it drift. Pulses are
also rounded again as by a digitiser, at random levels. - Balance. The strain at the largest stress by impulses of both
faces that differ by more than inertia explains.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dembound.gauge.estimates import FEWEST
from dembound.gauge.hopkinson.pulses import Faces, Setup
from dembound.gauge.hopkinson.specimen import Specimen, slope_of, specimen
from dembound.gauge.noise import rounding
from dembound.gauge.peaks import CREST, smooth, white_noise, width_of
from dembound.words import percent

SEED, DRAWS = 0, 40
"""Seed and number of draws of the noise: a standard error is known to 11 % from 40 slopes."""

NO_NOISE = 1e-9
"""Noise over the largest strain below which it is rounding."""

UNKNOWN = 0.2
"""Uncertainty of a slope over the slope above which a warning is given."""

WIDE = 2.0
"""Number of standard errors that contain 95 % of errors."""


@dataclass(frozen=True)
class SlopeError:
    """Errors of a slope, Pa: the contribution of inertia, and standard errors of the other parts."""

    inertia: float
    time: float
    line: float
    noise: float
    balance: float

    @property
    def half_width(self) -> float:
        """Largest error, Pa, in 95 of 100 tests."""
        return abs(self.inertia) + WIDE * math.hypot(self.time, self.line, self.noise, self.balance)


def slope_error(faces: Faces, setup: Setup, tolerance: float, found: Specimen) -> SlopeError | None:
    """The uncertainty of `found.slope`; None where there is no slope. See `specimen` for other arguments."""
    if found.equilibrium is None or np.isnan(found.slope):
        return None
    there = slice(found.equilibrium[0], found.largest + 1)
    return SlopeError(
        slope_of(found.strain[there], _inertia(faces, setup, found)[there]),
        _of_time(faces, setup, tolerance, there),
        _of_line(found.strain[there], found.stress[there]),
        _of_noise(faces, setup, tolerance),
        _of_balance(faces, setup, found),
    )


def unbalanced(faces: Faces, setup: Setup, found: Specimen, end: int) -> float:
    """Difference of the impulses of both faces in a number of samples over their mean, less that by inertia.

    The inertia of a specimen not denser than the bars causes 0 to ρ_b L_s A_s v, with v its mean velocity.
    """
    until = slice(0, end)
    step = float(faces.time[1] - faces.time[0])
    front, back = (step * float(np.sum(each[until])) for each in (found.front, found.back))
    velocity = 0.5 * setup.bar.speed * (faces.incident - faces.reflected + faces.transmitted)
    inertia = setup.modulus / setup.bar.speed**2 * setup.specimen_length * float(np.abs(velocity[until]).max())
    difference = front - back
    return (difference - min(max(difference, 0.0), inertia)) / (0.5 * (abs(front) + abs(back)))


def doubts_of_slope(found: Specimen, error: SlopeError | None) -> Iterator[str]:
    """Messages about a slope that is missing or inaccurate, where the specimen is in equilibrium."""
    if found.equilibrium is None:
        return
    first, last = found.equilibrium[0], found.largest
    if error is None:
        yield (
            f"the specimen has its largest stress {last - first} samples after equilibrium begins, at "
            f"{1e6 * found.time[last]:.4g} µs: no slope of stress over strain"
        )
    elif not error.half_width < UNKNOWN * abs(found.slope):
        change = float(np.ptp(found.strain[first : last + 1])) / float(np.abs(found.strain).max())
        yield (
            f"the slope is uncertain, ±{percent(error.half_width / abs(found.slope))}: in equilibrium, until the "
            f"largest stress, the strain changes by {percent(change)} of its largest"
        )


def _inertia(faces: Faces, setup: Setup, found: Specimen) -> np.ndarray:
    """ρL_s² (d²e/dt²)/12 (n,) Pa, with the density by which the impulses accelerate the specimen."""
    step = faces.time[1] - faces.time[0]
    impulse = step * np.cumsum(found.front - found.back)
    velocity = 0.5 * setup.bar.speed * (faces.incident - faces.reflected + faces.transmitted)
    loaded = slice(0, found.largest + 1)
    mass = float(np.sum(impulse[loaded] * velocity[loaded]) / np.sum(velocity[loaded] ** 2))  # ρL_s, kg/m²
    return mass * setup.specimen_length / 12.0 * np.gradient(found.rate, step)


def _of_time(faces: Faces, setup: Setup, tolerance: float, there: slice) -> float:
    """Standard error of the slope, Pa, by the times of the pulses."""
    half = 0.5 * (faces.time[1] - faces.time[0])
    changes = []
    for name in ("reflected", "transmitted"):
        slopes = []
        for shift in (-half, half):
            values = np.interp(faces.time + shift, faces.time, getattr(faces, name))
            moved = specimen(faces._replace(**{name: values}), setup, tolerance)
            slopes.append(slope_of(moved.strain[there], moved.stress[there]))
        changes.append(0.5 * (slopes[1] - slopes[0]) / math.sqrt(3.0))
    return math.hypot(*changes)


def _of_balance(faces: Faces, setup: Setup, found: Specimen) -> float:
    """Standard error of the slope, Pa, by different impulses of the faces, which change the strain."""
    until = slice(0, found.largest + 1)
    impulse = 0.5 * float(np.sum(found.front[until] + found.back[until])) * float(faces.time[1] - faces.time[0])
    compliance = setup.bar.speed / setup.specimen_length * setup.specimen_area / (setup.modulus * setup.area)
    change = compliance * impulse * unbalanced(faces, setup, found, until.stop)
    return abs(found.slope * change) / abs(float(found.strain[found.largest]))


def _of_line(strain: np.ndarray, stress: np.ndarray) -> float:
    """Standard error of the slope, Pa, by the deviations of stresses from the line over strains (m,)."""
    from scipy.signal import fftconvolve

    rest = stress - np.polyval(np.polyfit(strain, stress, 1), strain)
    power = float(np.sum(rest**2))
    if len(rest) <= FEWEST or not power > 0.0:
        return 0.0
    correlation = fftconvolve(rest, rest[::-1])[len(rest) - 1 :] / power
    first = int(np.argmax(correlation <= 0.0)) or len(rest)
    count = len(rest) / (1.0 + 2.0 * float(np.sum(correlation[1:first])))
    return math.sqrt(power / len(rest) / max(count - 2.0, 1.0)) / float(np.std(strain))


def _of_noise(faces: Faces, setup: Setup, tolerance: float) -> float:
    """Standard error of the slope, Pa, by the noise of the signals; 0 without noise."""
    pulses = {name: getattr(faces, name) for name in ("incident", "reflected", "transmitted")}
    noise = {name: white_noise(values) for name, values in pulses.items()}
    digits = dict(zip(pulses, (faces.digits[0], *faces.digits), strict=True))
    if max(*noise.values(), *digits.values()) < NO_NOISE * float(np.abs(faces.incident).max()):
        return 0.0
    random, slopes = np.random.default_rng(SEED), []
    smoothed = {
        name: smooth(values, max(1, round(CREST * width_of(np.abs(values))))) for name, values in pulses.items()
    }
    for _ in range(DRAWS):
        drawn = {
            name: values
            + noise[name] * random.standard_normal(len(faces.time))
            + rounding(smoothed[name], digits[name], random)
            for name, values in pulses.items()
        }
        slopes.append(specimen(faces._replace(**drawn), setup, tolerance).slope)
    known = np.array(slopes)[~np.isnan(slopes)]
    return 0.5 * float(np.ptp(np.percentile(known, [16.0, 84.0]))) if len(known) >= FEWEST else math.inf
