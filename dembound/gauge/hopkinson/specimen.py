"""Stress, strain and strain rate of a specimen between the two bars of a split Hopkinson test (Kolsky 1949).

The waves at the faces of the specimen are the incident and the reflected pulse, e_i and e_r, on its front, and the
transmitted one, e_t, on its back, strains counted in the sense of the load. With c, E, A of the bars and L_s, A_s of
the specimen the faces move and are loaded by

    v_1 = c(e_i − e_r),  v_2 = c e_t,      F_1 = EA(e_i + e_r),  F_2 = EA e_t .

One wave gives the stress F_2/A_s and the rate −2c e_r/L_s, two the stress F_1/A_s, three (F_1 + F_2)/2A_s and
(v_1 − v_2)/L_s. They agree where the specimen is in equilibrium, F_1 = F_2; only there they are the law of its
material.
"""

from dataclasses import dataclass

import numpy as np

from dembound.gauge.estimates import FEWEST
from dembound.gauge.hopkinson.pulses import Faces, Setup
from dembound.gauge.peaks import denoised

EQUILIBRIUM = 0.05
"""Largest |F_1 − F_2| over their mean in equilibrium."""

LOADED = 0.1
"""Least force, over the largest one, at which equilibrium is checked."""


@dataclass(frozen=True)
class Specimen:
    """Stresses, strains and rates of a specimen.

    time : (n,) s from when the pulse has reached it; front, back : stresses F_1/A_s and F_2/A_s (n,) Pa; rate : (n,)
    1/s by three waves, one_wave_rate by the reflected one; strain, one_wave_strain : their integrals (n,); ratio :
    F_1/F_2 (n,), smoothed, nan below a tenth of the largest force; equilibrium : (first, behind last) sample of the
    longest time in equilibrium, None without any; slope : of stress over strain in equilibrium until the
    `largest` stress there, a single sample, Pa, nan where it cannot be fitted.
    """

    time: np.ndarray
    front: np.ndarray
    back: np.ndarray
    rate: np.ndarray
    one_wave_rate: np.ndarray
    strain: np.ndarray
    one_wave_strain: np.ndarray
    ratio: np.ndarray
    equilibrium: tuple[int, int] | None
    largest: int
    slope: float

    @property
    def stress(self) -> np.ndarray:
        """Stress (n,) Pa by three waves."""
        return 0.5 * (self.front + self.back)

    @property
    def in_equilibrium(self) -> np.ndarray:
        """Whether each sample (n,) is within the longest time in equilibrium."""
        there = np.zeros(len(self.time), dtype=bool)
        if self.equilibrium is not None:
            there[slice(*self.equilibrium)] = True
        return there


def specimen(faces: Faces, setup: Setup, tolerance: float = EQUILIBRIUM) -> Specimen:
    """Stresses and strains of the specimen from the waves at its faces.

    tolerance : largest difference of the forces over their mean in equilibrium.
    """
    speed, scale = setup.bar.speed, setup.modulus * setup.area / setup.specimen_area
    front, back = scale * (faces.incident + faces.reflected), scale * faces.transmitted
    rate = speed / setup.specimen_length * (faces.incident - faces.reflected - faces.transmitted)
    one_wave_rate = -2.0 * speed / setup.specimen_length * faces.reflected
    strain, one_wave_strain = (_integral(faces.time, each) for each in (rate, one_wave_rate))
    ratio = _ratio(front, back)
    # |F_1 − F_2| ≤ tolerance · (F_1 + F_2)/2 in terms of R = F_1/F_2
    balanced = np.abs(ratio - 1.0) <= 0.5 * tolerance * (ratio + 1.0)
    equilibrium = _longest(balanced)
    first, end = equilibrium or (0, len(rate))
    stress = 0.5 * (front + back)
    largest = first + int(np.argmax(denoised(stress)[first:end]))
    slope = np.nan if equilibrium is None else slope_of(strain[first : largest + 1], stress[first : largest + 1])
    strains = strain, one_wave_strain
    return Specimen(faces.time, front, back, rate, one_wave_rate, *strains, ratio, equilibrium, largest, slope)


def _integral(time: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Time integral (n,) from the first sample, by trapezoids."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(time))])


def _ratio(front: np.ndarray, back: np.ndarray) -> np.ndarray:
    """F_1/F_2 (n,) of the smoothed forces; nan where either is small."""
    first, second = denoised(front), denoised(back)
    least = LOADED * max(float(first.max()), float(second.max()))
    loaded = (first > least) & (second > least)
    return np.divide(first, second, out=np.full(len(front), np.nan), where=loaded)


def _longest(there: np.ndarray) -> tuple[int, int] | None:
    """First sample, and the one after the last, of the longest run of true values (n,); None without any."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], there.astype(int), [0]])))
    if not len(edges):
        return None
    starts, ends = edges[::2], edges[1::2]
    longest = int((ends - starts).argmax())
    return int(starts[longest]), int(ends[longest])


def slope_of(strain: np.ndarray, stress: np.ndarray) -> float:
    """Slope of the line through stresses over strains (m,), in the unit of the stresses; nan for too few."""
    if len(strain) < FEWEST or not np.ptp(strain) > 0.0:
        return np.nan
    return float(np.polyfit(strain, stress, 1)[0])
