"""Deconvolution: the incident wave below the ground of a case that moves its surface as a record.

What runs up below the free surface is half of its motion, early by the way up; from what runs up at the plane where the
wave enters, the incident wave follows as in disks/within.py: in the same ground, or in the rock of the side. The ground
is uniform and undamped, so this only delays and adds, and is computed for all frequencies of the record.
"""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import tomli_w

from dembound.boundaries import Motion
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.motions_of_waves import not_level
from dembound.casefile.model import as_kind
from dembound.casefile.toml import parsed
from dembound.disks.scene import build
from dembound.disks.within import Level
from dembound.errors import CaseError
from dembound.kinds import loads
from dembound.records.processing import Motion as Recorded
from dembound.records.processing import integrated
from dembound.waves.spectrum import amplitude_spectrum, faded_frequency

SIDE = "bottom"
"""The side at which the wave enters."""


@dataclass(frozen=True)
class Deconvolved:
    """An incident wave.

    velocity : (n + k,) m/s at the time step of the record. early : by how many steps k it begins before the record, so
    that the surface moves k steps later than recorded if the wave begins at t = 0. magnification : largest amplitude
    over that of the record, which noise has too; band : highest frequency that counts, Hz.
    """

    velocity: np.ndarray
    early: int
    magnification: float
    band: float

    @property
    def sentence(self) -> str:
        """The magnification in words."""
        return (
            f"the incident wave has up to {self.magnification:.3g} times the amplitude of the surface at frequencies "
            f"to {self.band:.3g} Hz, and so has the noise of the record"
        )


def deconvolve(case: DiskCase, surface: np.ndarray, time_step: float, motion: Motion | None = None) -> Deconvolved:
    """The incident wave at the bottom of a case that gives its free surface a velocity (n,) m/s, sampled at a step (s).

    motion : S or P; by default that of the wave of the bottom side. The record is zero beyond its ends.

    Raises CaseError where the ground is not level under a free surface, or not one such wave enters at the bottom.
    """
    table = case.side(SIDE)
    if problems := [f"deconvolution: needs {reason}" for reason in not_level(SIDE, table, case.tables)]:
        raise CaseError(problems, case.name)
    waves = case.driving.get(SIDE, {})
    if motion is None and len(waves) > 1:
        raise CaseError([f"boundary.{SIDE}: names wave_p and wave_s; must name that of the record alone"], case.name)
    motion = motion or next(iter(waves), None)
    if motion not in waves or {0, 1} & {*table.prescribed(1)}:
        kind = "wave_p or wave_s" if motion is None else f"wave_{motion}"
        raise CaseError([f"boundary.{SIDE}: must absorb and name a {kind}, whose ground and rock are taken"], case.name)
    return incident_below(Level.of(build(case), SIDE, motion), surface, time_step)


def incident_below(ground: Level, surface: np.ndarray, time_step: float) -> Deconvolved:
    """The incident wave below level ground whose free surface has a velocity (n,) m/s, sampled at a step (s)."""
    way = ground.height / ground.speed
    early = math.ceil((way + max(0.0, -ground.mass, -ground.stiffness) / ground.speed) / time_step)
    count = len(surface) + early
    window = 2 ** math.ceil(math.log2(2 * count))
    frequencies = np.fft.rfftfreq(window, time_step)
    turn = 2j * math.pi * frequencies
    below = 0.5 * sum(factor * np.exp(-turn * (late - way)) for late, factor in ground.echoes)
    spectrum = np.fft.rfft(surface, window) * below * np.exp(-turn * early * time_step)
    velocity = np.fft.irfft(spectrum, window)[:count]
    band = faded_frequency(*amplitude_spectrum(surface, time_step))
    magnification = float(np.abs(below[frequencies <= max(band, frequencies[1])]).max())
    return Deconvolved(velocity, early, magnification, band)


def ground_of_file(path: Path) -> DiskCase:
    """The case of a file with other waves in place of its own, whose files need not exist yet; errors as of a case."""
    data = parsed(path.read_text(encoding="utf-8-sig"))
    data["wave"] = {name: {"type": "cosine", "amplitude": 1.0, "period": 1.0} for name in data.get("wave", {})}
    case = loads(tomli_w.dumps(data), path.parent, path.stem)
    return as_kind(case, DiskCase, "is the case of a bar, deconvolution is for disks", str(path))


def below(case: DiskCase, surface: Recorded) -> Recorded:
    """The incident motion at the bottom of a case whose surface moves as a component of a record."""
    step = surface.time_step
    found, rates = (deconvolve(case, each, step) for each in (surface.velocity, surface.acceleration))
    early = surface.time[0] - step * np.arange(found.early, 0, -1)
    done = f"deconvolution: the surface of {case.name} taken down to its {SIDE}; {found.sentence}"
    return replace(
        surface,
        time=np.concatenate([early, surface.time]),
        acceleration=rates.velocity,
        velocity=found.velocity,
        displacement=integrated(found.velocity, step),
        steps=(*surface.steps, done),
    )
