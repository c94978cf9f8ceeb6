"""Deconvolution: the incident wave below the ground of a case that moves its surface as a record.

What runs up below the free surface is half of its motion, early by the way up; from what runs up at the plane where the
wave enters, the incident wave follows as in disks/incident_wave.py: in the same ground, or in the rock of the side.
Undamped ground only delays and adds, so that this is computed for all frequencies of the record. Waves that damped
ground weakens on their way up must be larger below, the more so the higher their frequency: beyond the band of the
record, where it has little but noise, they are not magnified further than within it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import tomli_w

from dembound.boundaries import Motion
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.incident import not_level
from dembound.casefile.model import as_kind
from dembound.casefile.reader import parsed
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.kinds import loads
from dembound.kinds.disks.incident_wave import Level, Modulus
from dembound.records.processing import Motion as Recorded
from dembound.records.processing import integrated
from dembound.waves.wave import FADED, amplitude_spectrum, faded_frequency

SIDE = "bottom"
"""The side at which the wave enters."""

ROUNDING = 1e-6
"""Steps by which a whole number of them may be missed."""


FREQUENCIES = 2000
"""Frequencies of transfer functions."""

PEAKS = 5.0
"""Frequency up to which they are computed at least, over the lowest of the ground, 1 over four times the way up."""

MODULI: dict[Modulus, str] = {"as_run": "Q as in runs", "hysteretic": "hysteretic", "constant_q": "constant Q"}
UNDAMPED: dict[Modulus, str] = {"as_run": "undamped"}
"""How damped, and undamped, layers are taken -> words."""


@dataclass(frozen=True)
class Deconvolved:
    """An incident wave.

    velocity : (n + k,) m/s at the time step of the record. early : by how long (s) it begins before the record: if the
    wave begins at t = 0, the surface moves so much later than recorded. magnification : largest amplitude over that of
    the record, which noise has too; band : highest frequency that counts, Hz. is_limited : whether larger
    magnifications beyond the band have been limited to that.
    """

    velocity: np.ndarray
    early: float
    magnification: float
    band: float
    is_limited: bool = False

    @property
    def sentence(self) -> str:
        """The magnification in words."""
        return (
            f"the incident wave, and in it the noise of the record, has up to {self.magnification:.3g} times the "
            f"amplitude of the surface at frequencies to {self.band:.3g} Hz, above which the record's velocity has "
            f"less than {100.0 * FADED:g} % of its largest amplitude"
            + (", and is magnified by no more" if self.is_limited else "")
        )


def level_ground(case: DiskCase, motion: Motion | None = None) -> Level:
    """The ground above the bottom of a case as waves of a kind see it.

    motion : S or P; by default that of the wave of the bottom side.

    Raises CaseError where the ground is not level under a free surface, or no such wave enters at the bottom.
    """
    table = case.side(SIDE)
    if problems := [f"deconvolution: needs {reason}" for reason in not_level(SIDE, table, case.tables)]:
        raise CaseError(problems, case.name)
    waves = case.driving.get(SIDE, {})
    if motion is None and len(waves) > 1:
        recipe = "give for each component, in their order, which it becomes, as in --as s --as p"
        raise CaseError([f"boundary.{SIDE}: names wave_p and wave_s; {recipe}"], case.name)
    motion = motion or next(iter(waves), None)
    if motion not in waves or {0, 1} & {*table.prescribed(1)}:
        kind = "wave_p or wave_s" if motion is None else f"wave_{motion}"
        raise CaseError([f"boundary.{SIDE}: must absorb and name a {kind}, whose ground and rock are taken"], case.name)
    return Level.of(build(case), SIDE, motion)


def incident_below(
    ground: Level, surface: np.ndarray, time_step: float, early: float | None = None, modulus: Modulus = "as_run"
) -> Deconvolved:
    """The incident wave below level ground whose free surface has a velocity (n,) m/s, sampled at a step (s).

    early : by how long (s) it begins before the record; by default in whole steps as early as it must.
    """
    early = earliest(ground, time_step, modulus) if early is None else early
    count = len(surface) + math.ceil(early / time_step - ROUNDING)
    window = 2 ** math.ceil(math.log2(2 * count))
    frequencies = np.fft.rfftfreq(window, time_step)
    with np.errstate(over="ignore", invalid="ignore"):  # damped waves of high frequencies
        below = ground.incident(frequencies, modulus)
    band = faded_frequency(*amplitude_spectrum(surface, time_step))
    size = np.abs(below)
    magnification = float(size[frequencies <= max(band, frequencies[1])].max())
    limited = ground.is_damped & ~(size <= magnification)
    below = np.where(np.isfinite(size), below * np.where(limited, magnification / size, 1.0), 0.0)
    spectrum = np.fft.rfft(surface, window) * below * np.exp(-2j * math.pi * frequencies * early)
    velocity = np.fft.irfft(spectrum, window)[:count]
    return Deconvolved(velocity, early, magnification, band, bool(limited.any()))


def earliest(ground: Level, time_step: float, modulus: Modulus = "as_run") -> float:
    """The time (s) by which the incident wave must begin before the record, in whole time steps (s)."""
    needed = ground.way(modulus) + max(0.0, -ground.mass, -ground.stiffness) / ground.speed
    return time_step * math.ceil(needed / time_step)


def ground_of_file(path: Path) -> DiskCase:
    """The case of a file without loads, static stage, walls and holes; its name says that it had holes.

    Other waves take the place of its own, whose files need not exist yet. Errors as of a case, and CaseError for damped
    ground whose band is that of its waves.
    """
    data = parsed(path.read_text(encoding="utf-8-sig"))
    holes = data.pop("hole", [])
    for name in ("load", "static", "wall"):
        data.pop(name, None)
    damped = any("quality_factor" in table for table in (data.get("material", {}), *data.get("layer", ())))
    if damped and "band" not in data.get("damping", {}):
        recipe = "a run takes it from its waves, which are yet to be made: give it, such as band = [0.3, 10.0]"
        raise CaseError([f"damping.band: is missing; {recipe}"], str(path))
    data["wave"] = {name: {"type": "cosine", "amplitude": 1.0, "period": 1.0} for name in data.get("wave", {})}
    name = path.stem if not holes else f"{path.stem} without its hole{'s' if len(holes) > 1 else ''}"
    case = loads(tomli_w.dumps(data), path.parent, name)
    return as_kind(case, DiskCase, "is the case of a bar, deconvolution is for disks", str(path))


def below(
    case: DiskCase, surfaces: Sequence[Recorded], kinds: Sequence[Motion | None], modulus: Modulus = "as_run"
) -> list[Recorded]:
    """The incident motions at the bottom of a case whose surface moves as components of a record, in step.

    kinds : of wave that each component becomes; None for that of the bottom side. All motions begin at one time.
    modulus : of damped layers. Raises CaseError as `level_ground`.
    """
    grounds = {kind: level_ground(case, kind) for kind in dict.fromkeys(kinds)}
    ways = [grounds[kind] for kind in kinds]
    first = min(float(each.time[0]) for each in surfaces)
    lead = max(earliest(ground, each.time_step, modulus) for ground, each in zip(ways, surfaces, strict=True))
    shift = f"waves begin {lead:.4g} s before the record: the surface moves {lead:.4g} s later than recorded"
    motions = []
    for surface, ground in zip(surfaces, ways, strict=True):
        step, early = surface.time_step, lead + float(surface.time[0]) - first
        histories = surface.velocity, surface.acceleration
        found, rates = (incident_below(ground, each, step, early, modulus) for each in histories)
        done = f"deconvolution: ground of {case.name}, from its surface down to its {SIDE}; {found.sentence}"
        motions.append(
            replace(
                surface,
                time=first - lead + step * np.arange(len(found.velocity)),
                acceleration=rates.velocity,
                velocity=found.velocity,
                displacement=integrated(found.velocity, step),
                steps=(*surface.steps, done, shift),
            )
        )
    return motions


def transfers(
    case: DiskCase, surfaces: Sequence[Recorded], kinds: Sequence[Motion | None]
) -> dict[Motion, tuple[np.ndarray, dict[str, dict[str, np.ndarray]]]]:
    """Transfer functions of the ground of a case, over the band of the components of a record and its first peaks.

    By kind of wave: frequencies (k,) Hz, and by input, and by modulus in damped ground, |surface over input| (k,).
    """
    found = dict[Motion, tuple[np.ndarray, dict[str, dict[str, np.ndarray]]]]()
    bands = [faded_frequency(*amplitude_spectrum(each.velocity, each.time_step)) for each in surfaces]
    for only in [kind for kind in case.driving.get(SIDE, {}) if kind in kinds or None in kinds]:
        ground = level_ground(case, only)
        frequencies = np.linspace(0.0, max(*bands, PEAKS * 0.25 / ground.way()), FREQUENCIES)
        inputs: dict[str, dict[str, np.ndarray]] = {"outcrop": {}, "within": {}}
        for modulus, words in MODULI.items() if ground.is_damped else UNDAMPED.items():
            column = ground.column(modulus, on_rock=True)
            moved = column.motion(frequencies, [0.0, ground.height])[0]
            rising = 1.0 if ground.alpha is not None else column.rising(frequencies, ground.height)
            inputs["outcrop"][words] = np.abs(moved[0] / (2.0 * rising))
            inputs["within"][words] = np.abs(moved[0] / moved[1])
        found[only] = frequencies, inputs
    return found
