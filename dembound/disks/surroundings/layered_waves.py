"""The motion of undisturbed layered ground under waves from straight below.

Waves of every layer move along the polarisations of its medium, P and S alike: a column (exact/column.py) for each. In
layers of one brick whose springs have one ratio the polarisations are the same, and the columns independent; where they
turn by an angle from layer to layer, this angle is the error of the smaller component.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.boundaries.edge import SIDES
from dembound.boundaries.support import Incident
from dembound.casefile.disks import DiskCase
from dembound.continuum.axis import Rule
from dembound.continuum.medium import Medium, critical_angle
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.cut_bonds import GRADIENT
from dembound.disks.surroundings.ground_waves import (
    DELAYS,
    NO_PART,
    GroundWaves,
    ground_waves,
    incident_in,
    layer_at,
    must_not_be_there,
    reference_point,
)
from dembound.disks.surroundings.media import homogeneous
from dembound.disks.surroundings.oblique_layers import ObliqueLayers, oblique_in_layers
from dembound.errors import CaseError
from dembound.exact.column import Column, ColumnMotion, Layer, Quantity

Relative = Callable[[np.ndarray], np.ndarray]
"""M(ω)/M₀ (k,) of damped ground at frequencies (k,) Hz, which may be complex."""


@dataclass(frozen=True, eq=False)
class LayeredWaves:
    """The motion of layered ground, of which `GroundWaves` is that of uniform ground.

    Attributes
    ----------
    surface : height y (m) of its top. joints : heights (m) of the planes between layers, from the uppermost down.
    columns : a column for each wave. polarisations : (w, l, 2) unit motion of each wave in each layer. impedances :
    (w, l) ρc of each, Pa·s/m. grain : mean diameter of the disks, m. height : of the reference of the incident wave, m.
    speeds : (w, l) m/s.
    """

    surface: float
    joints: tuple[float, ...]
    columns: tuple[ColumnMotion, ...]
    polarisations: np.ndarray
    impedances: np.ndarray
    grain: float
    height: float
    speeds: np.ndarray

    @property
    def across(self) -> float:
        """Time (s) of the slowest wave through a mean diameter of the disks."""
        return self.grain / float(self.speeds.min())

    def arrives(self, places: np.ndarray) -> float:
        """Time (s) from the incident wave at its reference to that at the first of places (k, 2) m."""
        low, high = sorted((self.height, float(places[:, 1].min())))
        planes = np.clip([np.inf, *self.joints, -np.inf], low, high)
        way = float((-np.diff(planes) / self.speeds.max(axis=0)).sum())
        return way if low == self.height else -way

    def layer_of(self, heights: np.ndarray) -> np.ndarray:
        """The number (k,) of the layer at heights (k,) m, from 0 at the surface; on a joint that above."""
        return layer_at(heights, self.joints, self.grain)

    def near(self, places: np.ndarray) -> NearLayers:
        """The waves near places (k, 2) m only."""
        layers, heights = self.layer_of(places[:, 1]), places[:, 1]
        spans = {}
        for layer in np.unique(layers).tolist():
            own = heights[layers == layer]
            spans[layer] = float(own.min()) - 0.5 * self.grain, float(own.max()) + 0.5 * self.grain
        return NearLayers(self, spans)

    def along(self, wave: int, of: Quantity, times: np.ndarray, heights: np.ndarray, layer: int) -> np.ndarray:
        """A quantity (k, d) along the polarisation of a wave at times (k,) s and heights (d,) m of a layer."""
        return self.columns[wave].at(of, times, tuple((self.surface - heights).tolist()), layer)

    def motion(self, of: str, times: np.ndarray, places: np.ndarray, corrector: np.ndarray | None = None) -> np.ndarray:
        """Motion (k, d, 3) of disks at places (d, 2) m with correctors (3, 4, d), by default none, at times (k,) s.

        of : "displacement" (m and rad) or "velocity" (m/s and rad/s).
        """
        moved = np.zeros((len(times), len(places), 3))
        kinds: tuple[Quantity, Quantity] = ("velocity", "rate") if of == "velocity" else ("displacement", "gradient")
        layers = self.layer_of(places[:, 1])
        for layer in np.unique(layers).tolist():
            own = np.flatnonzero(layers == layer)
            heights, which = np.unique(places[own, 1], return_inverse=True)
            for wave in range(len(self.columns)):
                motion = self.polarisations[wave, layer]
                moved[:, own, :2] += self.along(wave, kinds[0], times, heights, layer)[:, which, None] * motion
                if corrector is not None:
                    strain = self.along(wave, kinds[1], times, heights, layer)[:, which, None]
                    moved[:, own] += strain * np.einsum("cgd,g->dc", corrector[:, :, own], _gradient(motion))
        return moved

    def power_through(self, side: str, edges: Sequence[float], thickness: float) -> Callable[[np.ndarray], np.ndarray]:
        """Power (W), at times (k,) s, of the waves that run inwards through a side; as of `incident.power_through`.

        In damped ground to the order of 1/Q.
        """
        number = SIDES.index(side)
        inwards = {"bottom": -1.0, "top": 1.0}.get(side)
        height = np.array([edges[number]])
        (layer,) = self.layer_of(height).tolist()

        def power(times: np.ndarray) -> np.ndarray:
            total = np.zeros(len(times))
            for wave, impedance in enumerate(self.impedances[:, layer]) if inwards else ():
                velocity, traction = (
                    self.along(wave, of, times, height, layer)[:, 0] for of in ("velocity", "traction")
                )
                own = 0.5 * (velocity + inwards * traction / impedance)
                total += thickness * (edges[1] - edges[0]) * impedance * own**2
            return total

        return power


def _gradient(motion: np.ndarray) -> np.ndarray:
    """(4,) gradients ∂u_a/∂b by their numbers in `homogenise.GRADIENTS`, of a motion (2,) per unit of ∂/∂y."""
    gradient = np.zeros(4)
    gradient[[GRADIENT[0][1], GRADIENT[1][1]]] = motion
    return gradient


@dataclass(frozen=True, eq=False)
class NearLayers:
    """The motion of layered ground near some places, as a sum of amplitudes.

    These are the displacements at some heights of each layer and wave, then the velocities there.

    Attributes
    ----------
    ground : the motion. spans : lowest and highest height (m) by layer.
    """

    ground: LayeredWaves
    spans: dict[int, tuple[float, float]]

    @cached_property
    def _rule(self) -> Rule:
        """The points of the heights."""
        return Rule(DELAYS - 1)

    @cached_property
    def _parts(self) -> list[tuple[int, int, np.ndarray]]:
        """Layer, wave and heights (DELAYS,) m of each group of amplitudes."""
        return [
            (layer, wave, 0.5 * (low + high) + 0.5 * (high - low) * self._rule.points)
            for layer, (low, high) in self.spans.items()
            for wave in range(len(self.ground.columns))
        ]

    @property
    def count(self) -> int:
        """Number of amplitudes."""
        return 2 * DELAYS * len(self._parts)

    def amplitudes(self, times: np.ndarray, behind: float) -> np.ndarray:
        """Displacements m at times (k,) s and velocities m/s `behind` (s) earlier: (k, count).

        Of damped ground those that give the forces of damping in unrelaxed springs.
        """
        late: tuple[tuple[Quantity, np.ndarray], ...] = ("relaxed", times), ("relaxed_rate", times - behind)
        return np.hstack(
            [self.ground.along(wave, of, t, heights, layer) for of, t in late for layer, wave, heights in self._parts]
        )

    def velocities(self, behind: float) -> np.ndarray:
        """Matrix (count, count) from the amplitudes to the velocities that they have for the displacements."""
        return np.eye(self.count, k=self.count // 2)

    def strained(self, places: np.ndarray, values: np.ndarray, heights: np.ndarray | None = None) -> np.ndarray:
        """Values (3, 4, d) per unit gradient at places (d, 2) m, per unit of amplitudes: (3, d, count).

        heights : (d,) m in the layers whose gradients these are, by default the places', which may be across a joint.
        """
        found = np.zeros((3, len(places), self.count))
        for own, columns, scale, at, motion in self._groups(places, places[:, 1] if heights is None else heights):
            slope = scale * self._rule.slope(at)
            found[:, own, columns] = np.einsum("cgd,g->cd", values[:, :, own], _gradient(motion))[:, :, None] * slope
        return found

    def motion(self, places: np.ndarray, corrector: np.ndarray) -> np.ndarray:
        """Motion (3, d, count) of disks at places (d, 2) m with correctors (3, 4, d), per unit of amplitudes."""
        moved = self.strained(places, corrector)
        for own, columns, _, at, motion in self._groups(places, places[:, 1]):
            moved[:2, own, columns] += motion[:, None, None] * self._rule.shape(at)
        return moved

    def _groups(
        self, places: np.ndarray, within: np.ndarray
    ) -> Iterator[tuple[np.ndarray, slice, float, np.ndarray, np.ndarray]]:
        """Of each group of displacements: its places and columns, d/dy of the scaled height, this, and motion (2,).

        within : (d,) m, heights in the layers of the places.
        """
        layers = self.ground.layer_of(within)
        for number, (layer, wave, heights) in enumerate(self._parts):
            if len(own := np.flatnonzero(layers == layer)) > 0:
                scale = 2.0 / float(heights[-1] - heights[0])
                at = scale * (places[own, 1] - heights.mean())
                columns = slice(DELAYS * number, DELAYS * (number + 1))
                yield own, columns, scale, at, self.ground.polarisations[wave, layer]


def rising_in_layers(
    media: Sequence[Medium],
    joints: Sequence[float],
    surface: tuple[float, float] | None,
    signals: tuple[Incident | None, Incident | None],
    height: float,
    span: tuple[float, float],
    grain: float,
    relative: Sequence[Relative | None] = (),
) -> LayeredWaves:
    """The motion of layers under waves that run straight up, from the surface down.

    media, joints : of the layers, and heights (m) between them. surface : height (m) and mass (kg/m²) of the free
    surface; None: the uppermost layer goes on above. signals : with velocities along x and y of the incident wave
    alone, at a height (m) in the lowest layer, or continued from there; None for none. span : times (s) before which
    they are zero, and at which a run ends. grain : mean diameter, m. relative : M/M₀ of each layer, if any is damped.
    """
    top, mass = surface or (joints[0] if joints else height, None)
    thickness = [high - low for high, low in zip((top, *joints), joints, strict=False)] + [1.0]
    waves = [medium.plane_waves((0.0, 1.0)) for medium in media]
    columns, polarisations, impedances = [], [], []
    for number in (0, 1):
        motions = np.array([own[:, number] * np.copysign(1.0, own[number, number]) for _, own in waves])
        speeds = [float(speed[number]) for speed, _ in waves]
        each = zip(thickness, media, speeds, relative or [None] * len(media), strict=True)
        layers = [Layer(thick, medium.density, speed, relative=modulus) for thick, medium, speed, modulus in each]
        velocity = _summed(signals, motions[-1])
        if velocity is not None:
            columns.append(ColumnMotion(Column(layers, mass=mass), velocity, top - height, *span))
            polarisations.append(motions)
            impedances.append([medium.density * speed for medium, speed in zip(media, speeds, strict=True)])
    moved, stiff = np.array(polarisations), np.array(impedances)
    speeds = stiff / np.array([medium.density for medium in media])
    return LayeredWaves(top, tuple(joints), tuple(columns), moved, stiff, grain, height, speeds)


Undisturbed = GroundWaves | LayeredWaves | ObliqueLayers
"""The motion of the undisturbed ground."""


def undisturbed(case: DiskCase, ground: PackedMaterial, outside: Surroundings) -> Undisturbed | None:
    """The motion of the ground under the incident wave of a case, None without one; errors as of `ground_waves`.

    Damped uniform ground is one layer if the wave runs straight up.
    """
    table, layers = case.incident, [ground]
    if isinstance(ground, LayeredGround):
        layers = [zone.material for zone in reversed(ground.layers)]
    if table is None or (len(layers) == 1 and (table.angle != 0.0 or ground.mechanisms is None)):
        return ground_waves(case, ground, outside)
    found: LayeredWaves | ObliqueLayers | None
    wave, grain, media = case.wave[table.wave], ground.brick.mean_diameter, [homogeneous(each) for each in layers]
    if table.angle != 0.0:
        incident = incident_in(case, media[-1])
        early = min(float(incident.delays(outside.body.mesh.positions).min()), 0.0)
        span = wave.begin(), case.run.duration - early
        found = oblique_in_layers(media, case.layer_planes, outside.free_surface, incident, wave, span, grain)
        if found is None:
            raise CaseError([_beyond(case, media)])
    else:
        signals, height = (wave, None) if table.type == "sv" else (None, wave), reference_point(case)[1]
        relative = [None if each.mechanisms is None else each.mechanisms.relative_modulus for each in layers]
        span, ground_of = (wave.begin(), case.run.duration), (media, case.layer_planes, outside.free_surface)
        found = rising_in_layers(*ground_of, signals, height, span, grain, relative)
    must_not_be_there(case, found, outside)
    return found


def critical_in_layers(case: DiskCase, media: Sequence[Medium]) -> tuple[float, str]:
    """Smallest angle (degrees) of an incident wave at which a wave of a layer is evanescent, and the layer's name.

    media : of the layers, from the surface down.
    """
    assert case.incident is not None
    sign = float(np.copysign(1.0, case.incident.angle))
    angles = [critical_angle(media[-1], case.incident.type, sign, above) for above in media]
    least = int(np.argmin(angles))
    return sign * angles[least], case.layer_names[least]


def _beyond(case: DiskCase, media: Sequence[Medium]) -> str:
    """The message about an angle that is not below the critical one."""
    assert case.incident is not None
    critical, name = critical_in_layers(case, media)
    return (
        f"incident.angle: is {case.incident.angle:g}; from the critical angle of layer {name} on, {critical:.5g} "
        f"degrees, a wave no longer runs through it; must be {'below' if critical > 0.0 else 'above'} that"
    )


def _summed(
    signals: tuple[Incident | None, Incident | None], motion: np.ndarray
) -> Callable[[np.ndarray], np.ndarray] | None:
    """The velocity along a polarisation (2,) of signals along x and y; None without any."""
    both = zip(motion.tolist(), signals, strict=True)
    parts = [(part, signal) for part, signal in both if signal is not None and abs(part) > NO_PART]
    return (lambda t: np.asarray(sum(part * signal.velocity(t) for part, signal in parts))) if parts else None
