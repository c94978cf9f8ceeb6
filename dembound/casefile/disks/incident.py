"""The ``[incident]`` and ``[motion]`` tables: which motion the histories of waves are of; and ``[damping]``."""

from collections.abc import Iterator, Mapping
from typing import Any, Literal

from pydantic import field_validator

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.edge import SIDES, normal_axis
from dembound.boundaries.free import Free
from dembound.casefile.messages import numbered
from dembound.casefile.model import driving_waves
from dembound.casefile.types import LAWS
from dembound.table import Table, quantity

LEAST_RATIO = 1.5
"""Least ratio of the highest to the lowest frequency of a band."""


class Damping(Table):
    """How `material.quality_factor` damps: Q is nearly constant over a band of frequencies, the same for P and S.

    The stiffness of damped ground grows with the frequency, so that wave speeds hold at one frequency.
    """

    type: Literal["quality", "rayleigh"] = quantity("quality")
    """"quality": nearly constant Q; "rayleigh": ξ = 1/(2Q) at both ends of the band"""
    band: tuple[float, float] | None = quantity(None, unit="Hz")
    """lowest and highest frequency of Q; absent: that of the waves, or 0.3 to 10 Hz"""
    frequency: float | None = quantity(None, unit="Hz", gt=0.0)
    """frequency at which speeds and moduli hold; absent: the geometric mean of the band"""
    mechanisms: int = quantity(3, means="count", ge=2, le=6)
    """relaxation mechanisms"""

    def mistakes(self) -> Iterator[str]:
        """A band that does not ascend, and keys of mechanisms without any."""
        if self.band is not None and not 0.0 < LEAST_RATIO * self.band[0] <= self.band[1]:
            low, high = self.band
            yield (
                f"band: is [{low:g}, {high:g}], must be two frequencies above 0, the second at least {LEAST_RATIO:g} "
                "times the first"
            )
        for key in ("frequency", "mechanisms") if self.type == "rayleigh" else ():
            if key in self.model_fields_set:
                yield f'{key}: is only allowed with type = "quality"'

    @property
    def memories(self) -> int:
        """Number of memories of each force."""
        return 2 if self.type == "rayleigh" else self.mechanisms


def qualities(tables: Mapping[str, Any]) -> set[float | None]:
    """The quality factors of all layers, None for undamped ones; an invalid table is None."""
    own = tables["material"] and tables["material"].quality_factor
    layers = [layer for layer in tables["layer"] if layer is not None]
    return {own if layer.quality_factor is None else layer.quality_factor for layer in layers} or {own}


def is_damped(tables: Mapping[str, Any]) -> bool:
    """Whether the ground, or a layer of it, has a quality factor; an invalid table is None."""
    return qualities(tables) != {None}


def damping_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """A table [damping] that changes nothing, or Rayleigh damping of ground that goes on as a continuum or breaks."""
    if tables["damping"].model_fields_set and not is_damped(tables):
        yield "damping: is of no use without material.quality_factor"
    material = tables["material"]
    if tables["damping"].type == "rayleigh" and material and LAWS[material.law].has_history:
        yield (
            f'damping.type: is "rayleigh", which ground under material.law = "{material.law}" cannot have; take '
            'type = "quality"'
        )
    beyond = [side for side, table in tables["boundary"].items() if table and table.is_outside]
    if tables["damping"].type == "rayleigh" and beyond:
        yield (
            f'damping.type: is "rayleigh", which ground beyond boundary.{beyond[0]} cannot have; take sides of type '
            '"viscous", "viscoelastic" or "free_field", or damping.type = "quality"'
        )


Freedom = Literal["x", "y", "rotation"]


class Motion(Table):
    """Components of the motion that are held for all particles."""

    held: tuple[Freedom, ...] = quantity(())
    """components held at zero for every particle"""

    @field_validator("held")
    @classmethod
    def _names_each_once(cls, held: tuple[Freedom, ...]) -> tuple[Freedom, ...]:
        if len(set(held)) < len(held):
            raise ValueError("names a motion twice, must name each once")
        return held


class IncidentWave(Table):
    """A plane wave at an angle, with its reflections at the free surface and between layers.

    For sides of type "outside". The incident wave moves along its direction (P), or to the right of it (SV).
    """

    type: Literal["sv", "p"] = quantity()
    """kind of wave: SV or P"""
    angle: float = quantity(unit="degrees", means="direction", gt=-90.0, lt=90.0)
    """of its direction from the vertical, in the lowest layer; positive to the right"""
    wave: str = quantity()
    """wave whose velocity it has"""
    point: tuple[float, float] | None = quantity(None, unit="m", means="place")
    """where the incident wave has this velocity; absent: the lower corner of the ground it reaches first"""


def incident_problems(incident: IncidentWave, tables: Mapping[str, Any]) -> Iterator[str]:
    """Check the wave against the sides; an invalid side is None."""
    if incident.angle != 0.0 and is_damped(tables):
        yield (
            f"incident.angle: is {incident.angle:g}, must be 0 in damped ground (quality_factor), where waves at an "
            "angle are not known"
        )
    if len(qualities(tables)) > 1:
        yield (
            "incident: needs one quality_factor in all layers, as forces that enter beside a joint would not balance; "
            "let the wave enter at boundary.bottom"
        )
    for side in SIDES:
        table = tables["boundary"].get(side, Free())
        if table is None or table.is_outside or (side == "top" and table.is_free):
            continue
        allowed = '"outside"' if side != "top" else '"outside" or "free"'
        yield (
            f'boundary.{side}.type: is "{table.type}", but the wave of [incident] comes through the ground beyond all '
            f"sides; must be {allowed}"
        )
    for side, table in tables["boundary"].items():
        for motion in table.waves if table else ():
            yield f"boundary.{side}.wave_{motion}: is not allowed together with [incident]; give one of them"


def motion_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """Kinds of motion where they have no meaning, one line each; invalid tables are None."""
    waves: dict[str, Any] = {name: wave for name, wave in tables["wave"].items() if wave and wave.motion is not None}
    for name, wave in waves.items():
        if wave.motion == "outcrop" and not wave.halves:
            why = f'which type "{wave.type}" does not know; give half of it as incident'
            yield f'wave.{name}.motion: is "outcrop", {why}'
    for place, load in numbered("load", tables["load"]):
        if load.wave in waves:
            yield f"wave.{load.wave}.motion: is for waves of sides, but this one is the factor of {place}; leave it out"
    incident = tables["incident"]
    if incident and incident.wave in waves and waves[incident.wave].motion == "within":
        why = 'but [incident] takes the wave below; give "incident" or "outcrop"'
        yield f'wave.{incident.wave}.motion: is "within", {why}'
    driving = [name for _, name in driving_waves(tables["boundary"])]
    for side, table in tables["boundary"].items():
        for name in dict.fromkeys(table.waves.values() if table else ()):
            if name not in waves:
                continue
            motion, held = waves[name].motion, {0, 1} & {*table.prescribed(normal_axis(side))}
            if held and motion != "within":
                yield (
                    f'wave.{name}.motion: is "{motion}", but boundary.{side} prescribes the motion within the ground; '
                    'give "within", or type = "viscous_input" there'
                )
            elif motion == "within" and not held:
                reasons = [*not_level(side, table, tables)]
                reasons += ["every wave_p and wave_s to name a wave of its own"] if driving.count(name) > 1 else []
                yield from (f'wave.{name}.motion: is "within", which needs {reason}' for reason in reasons)


def not_level(side: str, table: Boundary, tables: Mapping[str, Any]) -> Iterator[str]:
    """What is missing for level ground between a side and a free surface, whose motion gives the incident wave."""
    sides = tables["boundary"]
    if side != "bottom":
        yield f"its side to be the bottom, not {side}"
    elif not (top := sides.get("top") or Free()).is_outside and (not top.is_free or top.is_artificial):
        yield "a free surface at the top"  # of the ground, where disks end below it
    if table.dashpots_alone() != table:
        yield f"boundary.{side} without springs"
    if tables["hole"]:
        yield "ground without holes"
    if tables["ground"] and tables["ground"].points:
        yield "level ground up to the top of the disks, without ground.surface"
    if tables["ground"] and tables["ground"].meet is not None:
        yield "layers that are the same at both sides, without ground.meet"
    held = tables["motion"] and tables["motion"].held
    lateral = {name: sides.get(name) for name in ("left", "right")}
    taking = [name for name, each in lateral.items() if each and each.factors and not each.needs_column and not held]
    if taking:
        names = " and ".join(f"boundary.{name}" for name in taking)
        yield f"level ground: {names} take from the wave; give periodic, free_field or outside"
