"""A split Hopkinson test with a linear specimen, by d'Alembert: reverberations between the faces of two impedances."""

from collections.abc import Callable

import numpy as np

from dembound.gauge.hopkinson import Setup, Signals

SPEED, DENSITY, AREA = 5000.0, 7800.0, np.pi * 0.01**2
MODULUS = DENSITY * SPEED**2
LENGTH, SPECIMEN_AREA = 0.01, np.pi * 0.008**2
SPECIMEN_SPEED, SPECIMEN_DENSITY = 2500.0, 2000.0
SPECIMEN_MODULUS = SPECIMEN_DENSITY * SPECIMEN_SPEED**2
"""12.5 GPa, as of a weak rock."""

SETUP = Setup(SPEED, DENSITY, 0.02, 1.0, 0.8, LENGTH, SPECIMEN_AREA)
STEP = 0.2e-6


def ramp(time: np.ndarray, rise: float = 150e-6, length: float = 350e-6) -> np.ndarray:
    """A half sine of a rise, a plateau of 1, and the same fall: the pulse of a pulse shaper."""
    return np.sin(0.5 * np.pi * np.clip(np.minimum(time, length - time) / rise, 0.0, 1.0)) ** 2


def signals(
    pulse: Callable[[np.ndarray], np.ndarray] = ramp,
    amplitude: float = 1e-3,
    specimen: tuple[float, float] = (SPECIMEN_SPEED, SPECIMEN_DENSITY),
) -> Signals:
    """Strains at the gauges; the pulse passes the first one at 100 µs.

    specimen : its wave speed, m/s, and density, kg/m³.

    Force waves that leave a bar of impedance Z for one of Z' are 2Z'/(Z + Z') as large, and those that stay
    (Z' − Z)/(Z + Z').
    """
    time = STEP * np.arange(8000)
    bar, inside = DENSITY * SPEED * AREA, specimen[0] * specimen[1] * SPECIMEN_AREA
    into, out = 2.0 * inside / (bar + inside), 2.0 * bar / (bar + inside)
    back = (bar - inside) / (bar + inside)
    transit, arrives = LENGTH / specimen[0], 100e-6 + SETUP.incident_gauge / SPEED

    def incident(at: np.ndarray) -> np.ndarray:
        """The incident pulse at the front, at times since it has reached the front."""
        return amplitude * pulse(at)

    def reflected(at: np.ndarray) -> np.ndarray:
        """The reflected pulse at the front."""
        again = sum(back ** (2 * turn + 1) * incident(at - 2 * (turn + 1) * transit) for turn in range(60))
        return -back * incident(at) + into * out * again

    def transmitted(at: np.ndarray) -> np.ndarray:
        """The transmitted pulse at the back."""
        return into * out * sum(back ** (2 * turn) * incident(at - (2 * turn + 1) * transit) for turn in range(60))

    def at_gauge(distance: float) -> np.ndarray:
        """The signal of a gauge on the incident bar."""
        way = distance / SPEED
        return incident(time - arrives + way) + reflected(time - arrives - way)

    behind = transmitted(time - arrives - SETUP.transmitted_gauge / SPEED)
    return Signals(time, at_gauge(SETUP.incident_gauge), behind)
