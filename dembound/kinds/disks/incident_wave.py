"""An oblique plane wave in words, and waves whose motion within the ground, where they enter, is given.

Of an oblique wave: its speed along the surface, its reflections, and where monitors err.

Level ground of depth H and impedance ρc on rock of α times that moves at that plane by v = U(t) + U(t − τ), τ = 2H/c:
what runs up, and what the free surface returns. So U(t) = v(t) − U(t − τ) = Σ (−1)ⁿ v(t − nτ), which needs no sampling
and no window. The rock pulls with ρc(U(t) − U(t − τ)); its incident wave is half of v plus that over α ρc. Dashpots of
disks move with the ground at a depth s below their plane, and their mass begins at m (formulas/disks/entry.py).

In layered or damped ground the same follows from its column at every frequency (exact/column.py).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np

from dembound.boundaries import Motion, normal_axis
from dembound.boundaries.edge import OPPOSITE
from dembound.boundaries.support import Incident, Signal
from dembound.continuum.medium import GRAZING, ElasticPlaneWave, critical_angle
from dembound.disks.matching import factors_in, homogenised_beta
from dembound.disks.material.layered import LayeredGround, Zone
from dembound.disks.scene import DiskScene, with_waves
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.ground_waves import GroundWaves, reference_point
from dembound.disks.surroundings.layered_waves import LayeredWaves, Undisturbed, critical_in_layers
from dembound.disks.surroundings.oblique_layers import ObliqueLayers
from dembound.exact.column import Column, ColumnMotion, Damping, Layer, Quantity
from dembound.formulas.disks.entry import MOTIONS, entries_of, mass_begins, side_ends
from dembound.waves import Wave
from dembound.words import Entries

NAMES = {"sv": "SV", "p": "P"}

STRAIGHT = 1e-9
"""Degrees from the vertical up to which a wave runs straight up."""


def incident_facts(scene: DiskScene) -> Entries:
    """Facts about the oblique wave of a scene that has one."""
    waves, table, outside = scene.ground_waves, scene.case.incident, scene.outside
    assert waves is not None
    assert table is not None
    assert outside is not None
    x, y = reference_point(scene.case)
    along = ""
    if not isinstance(waves, LayeredWaves):
        along = _along((waves.layers[-1] if isinstance(waves, ObliqueLayers) else waves).waves[0], outside)
    yield (
        "incident wave",
        f"{NAMES[table.type]}, {_way(table.angle)}, with the velocity of wave {table.wave} at "
        f"({x:.10g}, {y:.10g}) m{along}; reaches the disks at {arrival(scene, waves):.4g} s",
    )
    surface = " and by the surface" * (outside.free_surface is not None)
    if isinstance(waves, LayeredWaves):
        yield "reflected waves", f"by the layers{surface}, from the column of layers at each frequency"
        return
    if isinstance(waves, ObliqueLayers):
        critical, name = critical_in_layers(scene.case, [layer.medium for layer in waves.layers])
        below = "no critical angle" if abs(critical) == GRAZING else f"critical from {abs(critical):.4g}° on, by {name}"
        yield "reflected waves", f"by the layers{surface}, from P and SV waves of each layer at each frequency; {below}"
        return
    if outside.free_surface is None:
        yield "reflected waves", "none, as the ground has no surface"
        return
    critical = critical_angle(waves.medium, table.type, math.copysign(1.0, table.angle))
    below = "no critical angle" if critical == GRAZING else f"critical from {critical:.4g}° on"
    yield "reflected waves", f"{'; '.join(_reflected(waves))}; {below}"
    if corners := _corners(scene):
        yield "less exact monitors", f"near the corners where layers begin: {', '.join(corners)} m"


def _way(angle: float) -> str:
    """The direction of a wave."""
    if abs(angle) < STRAIGHT:
        return "straight up"
    return f"{abs(angle):g}° from the vertical to the {'right' if angle > 0.0 else 'left'}"


def _along(wave: ElasticPlaneWave, outside: Surroundings) -> str:
    """The speed of the wave's trace along the surface, or along x where there is none."""
    slowness, where = abs(wave.slowness[0]), "x" if outside.free_surface is None else "the surface"
    return f", at {1.0 / slowness:.5g} m/s along {where}" if slowness > STRAIGHT * abs(wave.slowness[1]) else ""


def arrival(scene: DiskScene, waves: Undisturbed) -> float:
    """Time (s) at which the wave reaches the first of the disks."""
    assert scene.case.incident is not None
    return scene.case.wave[scene.case.incident.wave].start + waves.arrives(scene.assembly.positions)


def _reflected(waves: GroundWaves) -> Iterator[str]:
    """Kind, angle and amplitude of the waves reflected by the surface, the slower one first."""
    each: dict[tuple[float, float], np.ndarray] = {}
    for wave in waves.waves[1:]:
        each[wave.slowness] = each.get(wave.slowness, np.zeros(2)) + wave.motion
    for slowness, motion in each.items():
        is_along = abs(motion @ slowness) > np.hypot(*motion) * np.hypot(*slowness) * math.sqrt(0.5)
        angle = math.degrees(math.atan2(slowness[0], -slowness[1]))
        yield f"{'P' if is_along else 'SV'} at {abs(angle):.4g}° with {np.hypot(*motion):.3g} of the amplitude"


def _corners(scene: DiskScene) -> list[str]:
    """Corners (m) of the region within the layers, at which two layers begin."""
    assert scene.outside is not None
    mesh = scene.outside.body.mesh
    (left, bottom), (right, top) = mesh.between_layers
    each = [(x, y) for y, there in ((bottom, mesh.layer.bottom), (top, mesh.layer.top)) if there for x in (left, right)]
    return [f"({x:.4g}, {y:.4g})" for x, y in each]


SLOW = 0.01
"""Frequency of slow waves over that at which the speeds of damped layers hold."""


Modulus = Damping | Literal["as_run"]
"""How damped layers are taken: as in a run, with its mechanisms, or by a formula (exact/column.py)."""


@dataclass(frozen=True)
class Level:
    """Level ground from the plane where a wave enters up to the free surface.

    layers : from the surface down, the last one to the plane, and on below it where the ground goes on as a continuum.
    alpha : impedance of the dashpots there over that of the last layer; None for a continuum. mass, stiffness : m above
    the plane, where the mass of the disks begins, and where their dashpots act. frequency : Hz, at which speeds hold.
    """

    layers: tuple[Layer, ...]
    alpha: float | None = None
    mass: float = 0.0
    stiffness: float = 0.0
    frequency: float = 1.0

    @classmethod
    def of(cls, scene: DiskScene, side: str, motion: Motion) -> Level:
        """The ground of a scene above a side where waves of a kind enter."""
        entry, (_, bottom, _, top) = entries_of(scene)[side][motion], scene.case.box
        layers, frequency = _layers(scene, motion, bottom - entry.late, top - mass_begins(scene, OPPOSITE[side]))
        if not scene.case.side(side).factors:
            return cls(layers, frequency=frequency)
        alpha = factors_in(scene, side)[motion] / homogenised_beta(scene, side, motion)
        mass, stiffness = side_ends(scene, side)[motion]
        return cls(layers, alpha, mass + entry.late, stiffness + entry.late, frequency)

    @property
    def height(self) -> float:
        """Height of the surface above the plane, m."""
        return sum(layer.thickness for layer in self.layers)

    @property
    def speed(self) -> float:
        """Speed of waves at the plane, m/s."""
        return self.layers[-1].speed

    @property
    def impedance(self) -> float:
        """ρc of the dashpots, or of the last layer, Pa·s/m."""
        return (self.alpha or 1.0) * self.layers[-1].density * self.speed

    @property
    def is_damped(self) -> bool:
        """Whether any layer is damped."""
        return any(layer.relative is not None or math.isfinite(layer.quality) for layer in self.layers)

    @property
    def is_simple(self) -> bool:
        """Whether it is one undamped layer, in which waves keep their form."""
        return len(self.layers) == 1 and not self.is_damped

    def column(self, modulus: Modulus = "as_run", on_rock: bool = False) -> Column:
        """Its layers, the last one going on below; or on a half-space with the impedance of the dashpots."""
        layers = list(self.layers)
        if modulus != "as_run":
            layers = [replace(layer, relative=None, heavier=None) for layer in layers]
        if on_rock and self.alpha is not None:
            layers.append(Layer(1.0, layers[-1].density, self.alpha * self.speed))
        return Column(layers, "elastic" if modulus == "as_run" else modulus, self.frequency)

    def incident(self, frequencies: np.ndarray, modulus: Modulus = "as_run") -> np.ndarray:
        """The incident wave (k,) over the motion of the surface, at frequencies (k,) Hz.

        The dashpots Z of the rock and its incident wave V pull with Z(2V − v), v the motion where they act.
        """
        column, plane = self.column(modulus), self.height
        moved, _, pulled = column.motion(frequencies, [0.0, plane - self.stiffness, plane - self.mass])
        if self.alpha is None:
            return np.asarray(column.rising(frequencies, plane) / moved[0])
        omega = 2.0 * math.pi * np.maximum(frequencies, 1e-9 * self.frequency)
        return np.asarray(0.5 * (moved[1] - pulled[2] / (1j * omega * self.impedance)) / moved[0])

    def way(self, modulus: Modulus = "as_run") -> float:
        """Time (s) to the surface; that of slow, long waves where speeds depend on the frequency."""
        column, slow = self.column(modulus), np.array([2.0 * math.pi * SLOW * self.frequency])
        moduli = [layer.modulus(slow, column.damping, column.reference) for layer in column.layers]
        return sum(
            layer.thickness * float(np.sqrt(layer.density / each).real[0])
            for layer, each in zip(column.layers, moduli, strict=True)
        )

    @property
    def trip(self) -> float:
        """Time (s) to the free surface and back, of one undamped layer."""
        return 2.0 * self.height / self.speed

    @property
    def echoes(self) -> list[tuple[float, float]]:
        """The incident wave as a sum of what runs up at the plane: by how much it is late (s), and its factor."""
        stiff, heavy, pull = self.stiffness / self.speed, self.mass / self.speed, 0.5 / (self.alpha or 1.0)
        return [(stiff, 0.5), (self.trip - stiff, 0.5), (heavy, pull), (self.trip - heavy, -pull)]


def _layers(scene: DiskScene, motion: Motion, bottom: float, top: float) -> tuple[tuple[Layer, ...], float]:
    """The layers between two heights (m) for waves of a kind, and the frequency (Hz) at which their speeds hold."""
    ground, found, frequency = scene.ground, [], 1.0
    zones = ground.layers[::-1] if isinstance(ground, LayeredGround) else [Zone(-math.inf, math.inf, 0, ground)]
    for table, (low, high, _, material) in zip(scene.case.materials, zones, strict=True):
        if (thickness := min(high, top) - max(low, bottom)) > 0.0:
            speed, mechanisms = material.wave_speeds(1)[MOTIONS.index(motion)], material.mechanisms
            layer = Layer(thickness, material.density, speed)
            if mechanisms is not None:
                layer = replace(layer, quality=table.quality_factor or math.inf, relative=mechanisms.relative_modulus)
                if mechanisms.drag > 0.0:
                    layer = replace(layer, heavier=mechanisms.relative_density)
                frequency = mechanisms.frequency
            found.append(layer)
    return tuple(found), frequency


@dataclass(frozen=True)
class OfMotionWithin:
    """The incident wave that moves level ground as a wave at the plane where it enters; until : end of a run, s."""

    wave: Wave
    ground: Level
    until: float

    def velocity(self, t: np.ndarray) -> np.ndarray:
        """Particle velocity, m/s, at the times t, s; same shape as t."""
        return self._incident("velocity", "traction", np.asarray(t, dtype=float))

    def displacement(self, t: np.ndarray) -> np.ndarray:
        """Particle displacement, m, at the times t, s; same shape as t."""
        return self._incident("displacement", "impulse", np.asarray(t, dtype=float))

    def _incident(self, of: Literal["velocity", "displacement"], pulled: Quantity, t: np.ndarray) -> np.ndarray:
        """The incident wave at times t (s) from the motion within the ground."""
        ground = self.ground
        if ground.is_simple:
            within: Signal = getattr(self.wave, of)
            return np.asarray(sum(factor * self._rising(within, t - late) for late, factor in ground.echoes))
        places = ground.height - ground.stiffness, ground.height - ground.mass
        moved = self._column.at(of, t.ravel(), places[:1])
        force = self._column.at(pulled, t.ravel(), places[1:])
        return np.asarray(0.5 * (moved - force / ground.impedance)).reshape(t.shape)

    @cached_property
    def _column(self) -> ColumnMotion:
        """The motion of the ground."""
        column, begin = self.ground.column(), self.wave.begin()
        return ColumnMotion(column, self.wave.velocity, self.ground.height, begin, self.until, within=True)

    def _rising(self, within: Signal, t: np.ndarray) -> np.ndarray:
        """What runs up at the plane, at times t (s)."""
        trip, rising = self.ground.trip, np.zeros_like(t)
        trips = (float(t.max(initial=-math.inf)) - self.wave.begin()) / trip
        for number in range(math.floor(trips) + 1 if trips >= 0.0 else 0):
            rising += (-1.0) ** number * within(t - number * trip)
        return rising


def with_incident_waves(scene: DiskScene) -> DiskScene:
    """The scene with incident waves in place of those that are motion within the ground at sides that absorb."""
    case, found = scene.case, dict[str, Incident]()
    for side, waves in case.driving.items():
        held = {0, 1} & {*case.side(side).prescribed(normal_axis(side))}
        for motion, name in waves.items():
            if case.wave[name].motion == "within" and not held:
                found[name] = OfMotionWithin(case.wave[name], Level.of(scene, side, motion), case.run.duration)
    return with_waves(scene, {**case.wave, **found}) if found else scene
