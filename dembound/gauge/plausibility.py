"""Mistakes that a measured signal reveals: only noise, clipped, sampled too coarsely, or in unexpected units."""

from collections.abc import Iterator

import numpy as np

from dembound.gauge.estimates import Estimate, tension_peaks
from dembound.gauge.findings import Findings
from dembound.gauge.passages import first_return
from dembound.gauge.peaks import NOISE_FACTOR, SMALLEST, positive_peaks, white_noise, width_of
from dembound.meanings import MEANINGS
from dembound.words import percent, with_unit

LONGEST = 100.0
"""Length of a bar, m, above which it was probably given in millimetres."""

SLOWEST, FASTEST = 100.0, 10_000.0
"""Wave speeds of solids, m/s: rubber is slower, and only diamond and beryllium are faster."""

COARSE, FEW = 5, 10
"""Samples of the largest wave, at half its height, below which it is refused, and below which a warning is given."""

SHARE_CLIPPED, LEAST_CLIPPED = 0.1, 5
"""Equal samples at a largest value above which it is taken for clipped: over the wave's width, and their number."""

ABRUPT = 8.0
"""Fall beside a crest, in steps of the digitiser, that indicates clipping; a round crest falls by four."""

OWN = 0.95
"""Largest height of a returning wave over a plateau before it, for which the return cannot be clipped."""

SCATTER = 10.0
"""Largest difference of two estimates of the wave speed, in standard errors."""

CLOSE, FAR = 0.01, 0.2
"""Relative differences of two wave speeds: always accepted, and refused."""

PART_SPEED, PART_DECAY, PART_FALL = 0.003, 0.05, 0.005
"""Relative differences of wave speed and attenuation by parts of the passages, and difference of attenuations (1/m),
above which a warning is given.
"""

CAUSES = "look for another impact, lost samples, a jump of the baseline, an amplifier at its limit, AC coupling"
"""Possible causes if passages do not belong to one pulse."""

NOISY = 0.015
"""Noise over the height of a wave above which strengths get a warning: noise has then raised them by 2 to 3 %."""

TIED = 2.0
"""Ratio of E and ρc² up to which both may belong to one bar: measured values differ by some per cent."""

APART = 0.05
"""Relative difference of E and ρc² that causes a warning, as it affects all stresses."""

LARGEST_STRAIN = 0.05
"""Strain that no bar reaches in a test: steel bars yield at 1 %."""

UNCERTAIN_SPEED, UNCERTAIN_DECAY = 0.01, 0.2
"""Relative standard errors of wave speed and attenuation above which a warning is given."""


def implausible_length(length: float) -> Iterator[str]:
    """Message about a length, m, that is probably in mm."""
    if LONGEST < length < np.inf:
        yield f"--length: is {length:g} m, must be at most {LONGEST:g} m; positions and lengths are in m, not mm"


def implausible_size(option: str, value: float | None, means: str, unit: str) -> Iterator[str]:
    """Message about an option whose value, in its unit, has an unlikely size for its meaning (`dembound.meanings`)."""
    if value is not None and np.isfinite(value) and (doubt := MEANINGS[means].doubt(value, unit)):
        yield f"{option}: {doubt}"


def implausible_modulus(modulus: float | None, density: float | None, speed: float) -> Iterator[str]:
    """Message about a modulus E, Pa, that no bar with this wave speed, m/s, and density, kg/m³, has: E = ρc².

    Without a density E is compared with likely densities.
    """
    if modulus is None or not (0.0 < modulus < np.inf and 0.0 < speed < np.inf):
        return
    likely = MEANINGS["density"]
    least, most = (likely.low, likely.high) if density is None else (density / TIED, density * TIED)
    if least <= modulus / speed**2 <= most:
        return
    says = f"--youngs-modulus: is {with_unit(modulus, 'Pa')}, "
    if density is None:
        says += f"with the wave speed, {speed:.4g} m/s, that of a density E/c² of {modulus / speed**2:.3g} kg/m³"
    else:
        says += f"must be within a factor of {TIED:g} of ρc², {with_unit(density * speed**2, 'Pa')}"
    units = [slip for slip in MEANINGS["modulus"].slips if least <= slip.mend(modulus) / speed**2 <= most]
    yield says + "".join(f"; likely {slip.what}: write {slip.mend(modulus):.4g}" for slip in units)


def differing_modulus(modulus: float | None, density: float | None, speed: float) -> Iterator[str]:
    """Message about a modulus E, Pa, that differs from ρc²; density : ρ, kg/m³, None if unknown; speed : c, m/s."""
    if modulus is not None and density is not None and abs(apart := modulus / (density * speed**2) - 1.0) > APART:
        yield (
            f"--youngs-modulus: is {with_unit(modulus, 'Pa')}, {'+' * (apart > 0.0)}{percent(apart)} from ρc², "
            f"{with_unit(density * speed**2, 'Pa')}, and so are stresses made of strains, or strains of stresses: "
            "check it, --density and --wave-speed"
        )


def implausible_signal(values: np.ndarray, *, may_be_clipped: bool = False) -> Iterator[str]:
    """Messages about a signal (k,) that is noise, clipped, or sampled too coarsely for its shortest wave."""
    sizes, noise = np.abs(values - np.median(values)), white_noise(values)
    if width_of(sizes) < COARSE and sizes.max() < NOISE_FACTOR * noise:
        yield f"the signal is noise: its largest value is {sizes.max() / noise:.2g} standard deviations, and no wave"
        return
    if (width := width_of(np.abs(values))) < COARSE:
        yield _too_narrow(values, width)
    for sense, extreme in ((1.0, "largest"), (-1.0, "smallest")):
        if not may_be_clipped and (count := clipped(sense * values)):
            value = sense * float((sense * values).max())
            yield (
                f"the signal is clipped: {count} samples in a row have its {extreme} value, {value:.4g}; record it "
                "with a larger range, or allow it with --clipped if it is the wave's own plateau"
            )


def _too_narrow(values: np.ndarray, width: int) -> str:
    """Message if the largest values (k,), `width` samples wide, are not a wave: spikes, or nothing is wider."""
    from scipy.ndimage import median_filter

    rest = median_filter(values, 2 * COARSE - 1, mode="nearest")  # without all that is less than COARSE samples wide
    sizes, wave = np.abs(values - np.median(values)), np.abs(rest - np.median(rest))
    if wave.max() > NOISE_FACTOR * white_noise(values) and width_of(wave) >= COARSE:
        spikes = np.abs(values - rest) > max(0.5 * float(wave.max()), NOISE_FACTOR * white_noise(values))
        count = int(np.count_nonzero(np.diff(spikes.astype(int), prepend=0) > 0))
        return (
            f"{count} spikes of less than {COARSE} samples stand beside the waves, the largest, "
            f"{values[int(sizes.argmax())]:.4g}, in sample {int(sizes.argmax()) + 1}: they are no waves, remove them"
        )
    return (
        f"the sampling is too coarse: the largest wave has {width} samples above half its height, needs {COARSE}; "
        "or it is a spike, and the record has no wave"
    )


def clipped(values: np.ndarray) -> int:
    """Number of equal samples at the largest value of a signal (k,) whose slope breaks off there; 0 if it does not.

    The result is also 0 if the plateau belongs to the wave, as it comes back lower with the wave.
    """
    count = _equal_at_top(values)
    return 0 if count and _comes_back_flat(values, count) else count


def _comes_back_flat(values: np.ndarray, count: int) -> bool:
    """Whether the next largest wave of a signal (k,) has half as many equal samples as the largest, `count`."""
    top = float(values.max())
    if abs(-float(values.min()) / top - 1.0) < CLOSE:
        return False  # both senses are cut where the range ends
    last = int(np.flatnonzero(values == top)[-1])
    low = np.flatnonzero(values[last:] < 0.5 * top)
    if not len(low):
        return False
    behind = values[last + int(low[0]) :]
    peaks = positive_peaks(np.arange(len(behind), dtype=float), behind, 1)
    if not len(peaks.time) or not SMALLEST < peaks.height[0] / top < OWN:
        return False
    place = round(float(peaks.time[0]))
    around = behind[max(0, place - count) : place + count + 1]
    return int(np.count_nonzero(around == around.max())) >= count // 2


def _equal_at_top(values: np.ndarray) -> int:
    """Number of equal samples at the largest value of a signal (k,) whose slope breaks off there; 0 if it does not."""
    top = float(values.max())
    at = np.flatnonzero(np.diff(np.concatenate([[0], values == top, [0]])))
    starts, ends = at[::2], at[1::2]
    longest = int((ends - starts).argmax())
    first, count = int(starts[longest]), int(ends[longest] - starts[longest])
    if top <= 0.0 or count < max(LEAST_CLIPPED, SHARE_CLIPPED * width_of(np.maximum(values, 0.0))):
        return 0
    levels = np.unique(values)
    step = float(np.diff(levels[-50:]).min())
    fall = top - float(values[max(first - count // 2, 0)])
    return count if fall > ABRUPT * step else 0


def few_returns(time: np.ndarray, values: np.ndarray, position: float, length: float) -> str:
    """Message about a record that shows its pulse as tension less than twice.

    time, values : (k,) s and any unit; position, length : m.
    """
    end, out = float(time[-1]), positive_peaks(time, -values, 1)
    if not len(out.time):
        within = -float(values.min()) > float(values.max())
        return "it ends within the first wave" if within else "no compression comes first, has --scale the wrong sign?"
    since, way = end - float(out.time[0]), 2.0 * (length - position)
    first = first_return(time, values, position, length)
    if first is None or not len(tension_peaks(time, values).time):
        return (
            f"it ends {since:.3g} s after the first wave, in which only waves faster than {way / since:.4g} m/s go the "
            f"{way:.4g} m to the far end and back; or that end is not free"
        )
    due = float(out.time[0]) + (way + 2.0 * length) / first.value
    if due + 0.5 * float(time[1] - time[0]) * width_of(np.abs(values)) > end:
        return f"it ends at {end:.4g} s, the second return of the pulse is due at {due:.4g} s"
    return f"the second return of the pulse, due at {due:.4g} s, is below 1 % of the first or within the noise"


OSCILLATIONS = (
    "small oscillations between the returns, as of bending or ringing, may be taken for returns: take the mean of two "
    "gauges on opposite faces or a --low-pass, or give --wave-speed and --attenuation of another test"
)
"""Possible cause of peaks that are too near to each other, and a remedy."""


def unlikely_speed(speed: float) -> Iterator[str]:
    """Message about a wave speed, m/s, that no solid bar has, with the unit that would explain it."""
    if SLOWEST <= speed <= FASTEST:
        return
    hints = {
        1e-3: "is the length in mm, or is a unit of time too small?",
        1e-6: "is a unit of time too small?",
        1e3: "are the times in ms? --time-unit ms",
        1e6: "are the times in µs? --time-unit us",
    }
    fitting = [hint for factor, hint in hints.items() if SLOWEST <= factor * speed <= FASTEST]
    said = f"the tension peaks give {speed:.4g} m/s, must be {SLOWEST:g} to {FASTEST:g} m/s"
    yield f"RECORD: {said}; {fitting[0] if fitting else OSCILLATIONS}"


def contradicting_speeds(speed: Estimate, first: Estimate | None) -> Iterator[str]:
    """Message if wave speeds from the returns and from the first passages differ by more than their scatter."""
    if first is None:
        yield (
            "the first wave is no compression with its reflection behind it: has --scale the wrong sign, or is "
            "something else in the record, an oscillation that --high-pass or --notch takes out?"
        )
        return
    off = abs(speed.value / first.value - 1.0)
    allowed = min(max(SCATTER * np.hypot(np.nan_to_num(speed.error), first.error) / first.value, CLOSE), FAR)
    if off > FAR:
        yield (
            f"the returns give {speed.value:.5g} m/s, the first passages {first.value:.5g} m/s: {percent(off)} "
            f"apart: these are not the returns of one pulse; {CAUSES}, check --position and --length, "
            "and try --peaks 2"
        )
    elif off > allowed:
        yield (
            f"the returns give {speed.value:.5g} m/s, the first passages {first.value:.5g} m/s: {percent(off)} "
            f"apart, must be within {percent(allowed)}; check --position and --length"
        )


def misfit(found: Findings, of: str) -> Iterator[str]:
    """Message about a part of the passages that contradicts the wave speed or the attenuation."""
    for each in found.misfits:
        off = abs(each.there - each.value)
        least = max(PART_DECAY * each.value, PART_FALL) if of == "attenuation" else PART_SPEED * each.value
        if each.of == of and off > least:
            unit = "1/m" if of == "attenuation" else "m/s"
            yield (
                "one pulse to and fro does not explain the record: "
                f"the {of} is {each.value:.4g} {unit} by all returns, {each.there:.4g} by {each.part}, "
                f"{off:.2g} apart where noise explains {each.noise:.1g}; {CAUSES}"
            )


def raised_by_noise(noise: float, crest: float) -> Iterator[str]:
    """Message if noise of a standard deviation raises the strength, a largest value, from a wave of some height."""
    if noise > NOISY * crest:
        yield (
            f"the noise is {percent(noise / crest)} of the wave and makes the strength too large, by about as "
            "much: use --low-pass"
        )


def as_doubtful(found: Findings) -> Iterator[str]:
    """Message about results that rest on a doubtful estimated wave speed, or on the same peaks."""
    strength = found.strength
    resting = {
        "the attenuation": found.attenuation is not None and bool(found.attenuation.points),
        "the nominal strength": strength is not None,
        "the attenuated strength": strength is not None and strength.attenuated is not None,
        "the pull-back strength": found.pull_back is not None,
    }
    if named := [name for name, rests in resting.items() if rests]:
        yield f"also doubtful, from the same peaks or with this speed: {', '.join(named)}"


def uncertain_speed(speed: Estimate) -> Iterator[str]:
    """Message about an estimated wave speed with a large standard error."""
    if speed.points and not speed.error <= UNCERTAIN_SPEED * speed.value and not np.isnan(speed.error):
        yield f"the wave speed is uncertain, its standard error is {percent(speed.error / speed.value)}"


def uncertain_decay(decay: Estimate | None) -> Iterator[str]:
    """Message about an estimated attenuation with a large standard error."""
    if decay is not None and decay.points and decay.error > UNCERTAIN_DECAY * abs(decay.value):
        yield f"the attenuation is uncertain, its standard error is {decay.error:.2g} of {decay.value:.2g} 1/m"
