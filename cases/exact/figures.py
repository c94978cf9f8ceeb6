"""The pictures of docs/evidence/exact.md: a pressure in a cavity, a cavity under plane waves, and Garvin's problem.

    python figures.py [FOLDER]      (default: the current folder)

It takes a minute. All are of a rock with c_p = 3000 m/s and Poisson's ratio 1/4.
"""

import math
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from dembound.exact import PlaneWave, Solid, buried_explosion, cavity_moment, cavity_motion, scattered_motion
from dembound.plot.style import COLOURS, REFERENCE, new_figure, outside_legend, save, styled
from dembound.waves import Cosine

ROCK = Solid(density=2600.0, p_wave_speed=3000.0, s_wave_speed=3000.0 / math.sqrt(3.0))
RADIUS = 5.0
"""m, of the cavity."""

PEAK = 1e7
"""Pa, of the pressure in it."""

PULSE = Cosine(type="cosine", amplitude=1.0, period=0.01)
BORE, DEPTH = 2.0, 12.0
"""m, radius and depth of the hole below a free surface."""


def pressure(t: np.ndarray) -> np.ndarray:
    """Pa on the wall."""
    return PEAK * PULSE.velocity(t)


@styled
def cavity() -> Figure:
    """Radial velocity and hoop stress at several distances from a cavity under a pulse of pressure."""
    figure = new_figure(10.0, 4.2)
    left, right = figure.subplots(1, 2)
    times = np.linspace(0.0, 0.04, 801)
    for index, share in enumerate((1.0, 2.0, 5.0, 10.0)):
        motion = cavity_motion(times, share * RADIUS, pressure, RADIUS, ROCK)
        left.plot(1e3 * times, motion.velocity, color=COLOURS[index], label=f"r = {share:g} a")
        right.plot(1e3 * times, motion.hoop_stress / PEAK, color=COLOURS[index])
    left.set_ylabel("radial velocity (m/s)")
    right.set_ylabel("hoop stress / largest pressure (–)")
    for panel in (left, right):
        panel.set_xlabel("time (ms)")
    figure.suptitle("Pressure pulse of 10 ms and 10 MPa in a cavity of radius a = 5 m", fontsize=11)
    outside_legend(figure, (left,), columns=4)
    return figure


@styled
def scattering() -> Figure:
    """Hoop stress on the wall under P and SV pulses: histories, and the largest around the wall for several periods."""
    figure = new_figure(10.0, 7.4)
    panels = figure.subplots(2, 2)
    angles = np.radians(np.arange(0.0, 181.0, 5.0))
    wall = RADIUS * np.column_stack([np.cos(angles), np.sin(angles)])
    for (histories, largest), kind, speed in zip(
        panels, ("p", "sv"), (ROCK.p_wave_speed, ROCK.s_wave_speed), strict=True
    ):
        stress = ROCK.density * speed  # of a wave of 1 m/s
        for index, ratio in enumerate((2.0, 5.0, 20.0, 100.0)):
            wave = Cosine(type="cosine", amplitude=1.0, period=ratio * RADIUS / speed)
            times = np.linspace(-RADIUS / speed, 1.5 * wave.period + 4.0 * RADIUS / speed, 301)
            found = scattered_motion(times, wall, PlaneWave(kind, 0.0, wave.velocity), RADIUS, ROCK, 1e-4)
            hoop = found.stress[:, 1] / stress
            name = f"c T = {ratio:g} a"
            at = 18 if kind == "p" else 9
            histories.plot(times / wave.period, hoop[at], color=COLOURS[index], label=name)
            largest.plot(np.degrees(angles), np.abs(hoop).max(axis=1), color=COLOURS[index])
        still = np.abs(at_rest(kind, angles))
        largest.plot(np.degrees(angles), still, color=REFERENCE, linestyle="--", label="static (Kirsch)")
        histories.set_title(f"{kind.upper()} wave, wall at {5 * at}° from its direction")
        largest.set_title(f"{kind.upper()} wave, largest of all times")
        histories.set_xlabel("time / period of the pulse (–)")
        largest.set_xlabel("angle from the direction of the wave (degrees)")
        for panel in (histories, largest):
            panel.set_ylabel("hoop stress / ρcv (–)")
    figure.suptitle("Hoop stress on the wall of a cavity under a plane wave, ν = 1/4", fontsize=11)
    outside_legend(figure, panels[0], columns=5)
    return figure


def at_rest(kind: str, angles: np.ndarray) -> np.ndarray:
    """σ_θ on the wall over the stress of a wave that is slow: Kirsch's solution."""
    if kind == "sv":
        return 4.0 * np.sin(2.0 * angles)
    ratio = ROCK.lame / ROCK.uniaxial
    return 1.0 + ratio - 2.0 * (1.0 - ratio) * np.cos(2.0 * angles)


@styled
def garvin() -> Figure:
    """Velocity of the surface at several distances from a blast in a small hole."""
    figure = new_figure(10.0, 4.2)
    panels = figure.subplots(1, 2)
    times, advance = np.linspace(0.0, 0.16, 801), BORE / ROCK.p_wave_speed
    source = np.linspace(0.0, 0.16 + advance, 6001)
    second = cavity_moment(source - advance, pressure, BORE, ROCK)[2]

    def signal(t: np.ndarray) -> np.ndarray:
        return np.interp(t, source, second)

    for index, distance in enumerate((0.0, 25.0, 50.0, 100.0, 200.0)):
        velocity = buried_explosion(times + advance, distance, 0.0, DEPTH, signal, ROCK, 1e-4)
        for panel, history in zip(panels, (velocity[0], -velocity[1]), strict=True):
            panel.plot(1e3 * times, history, color=COLOURS[index], label=f"x = {distance:g} m")
    for panel, name in zip(
        panels, ("horizontal velocity, away (m/s)", "vertical velocity, upwards (m/s)"), strict=True
    ):
        panel.set_xlabel("time (ms)")
        panel.set_ylabel(name)
    figure.suptitle(
        "The surface above a hole of 2 m radius at 12 m depth, pressure pulse of 10 ms and 10 MPa", fontsize=11
    )
    outside_legend(figure, panels[:1], columns=5)
    return figure


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    for draw in (cavity, scattering, garvin):
        save(draw(), folder / f"exact_{draw.__name__}.png")
