"""The motion of undisturbed layers under a plane wave at an angle: in each layer that of four plane waves.

Their histories follow from the P and SV waves of all layers (exact/oblique.py).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import block_diag

from dembound.boundaries.support import Incident
from dembound.continuum.medium import NO_WAVE, ElasticPlaneWave, Medium, traction_of, waves_with
from dembound.disks.surroundings.ground_waves import GroundWaves, NearPlaces, layer_at
from dembound.exact.oblique import Bed, History, ObliqueMotion


@dataclass(frozen=True, eq=False)
class ObliqueLayers:
    """The motion of layered ground under a wave at an angle, of which `GroundWaves` is that of uniform ground.

    Attributes
    ----------
    layers : the waves of each layer, from the surface down; the fastest one that runs up comes first, in the lowest
    layer the incident one. joints : heights (m) of the planes between layers, from the uppermost down.
    """

    layers: tuple[GroundWaves, ...]
    joints: tuple[float, ...]

    @property
    def across(self) -> float:
        """Time (s) of the slowest wave through a mean diameter of the disks."""
        return max(layer.grain * float(np.hypot(*wave.slowness)) for layer in self.layers for wave in layer.waves)

    def arrives(self, places: np.ndarray) -> float:
        """Time (s) from the incident wave at its reference to that at the first of places (k, 2) m."""
        return min(self.layers[layer].arrives(places[own]) for layer, own in self.parts(places[:, 1]))

    def parts(self, heights: np.ndarray) -> Iterator[tuple[int, np.ndarray]]:
        """Layers with any of the heights (k,) m, and the numbers (m,) of these."""
        layers = layer_at(heights, self.joints, self.layers[0].grain)
        for layer in np.unique(layers).tolist():
            yield layer, np.flatnonzero(layers == layer)

    def near(self, places: np.ndarray) -> NearObliqueLayers:
        """The waves near places (k, 2) m only."""
        parts = self.parts(places[:, 1])
        return NearObliqueLayers(self, {layer: self.layers[layer].near(places[own]) for layer, own in parts})

    def motion(self, of: str, times: np.ndarray, places: np.ndarray, corrector: np.ndarray | None = None) -> np.ndarray:
        """Motion (k, d, 3) of disks at places (d, 2) m with correctors (3, 4, d), by default none, at times (k,) s.

        of : "displacement" (m and rad) or "velocity" (m/s and rad/s).
        """
        moved = np.zeros((len(times), len(places), 3))
        for layer, own in self.parts(places[:, 1]):
            values = None if corrector is None else corrector[:, :, own]
            moved[:, own] = self.layers[layer].motion(of, times, places[own], values)
        return moved

    def within(self, low: float, high: float) -> Iterator[tuple[float, float, GroundWaves]]:
        """The waves between two heights (m), by layer with its own two; equal heights are in one layer."""
        ends = np.clip([np.inf, *self.joints, -np.inf], low, high).tolist()
        (own,) = layer_at(np.array([low]), self.joints, self.layers[0].grain).tolist()
        for number, (layer, top, bottom) in enumerate(zip(self.layers, ends[:-1], ends[1:], strict=True)):
            if top > bottom or (low == high and number == own):
                yield bottom, top, layer


@dataclass(frozen=True, eq=False)
class NearObliqueLayers:
    """The motion of layered ground near some places, as a sum of amplitudes: those of each layer (`NearPlaces`).

    Attributes
    ----------
    ground : the motion. layers : by number.
    """

    ground: ObliqueLayers
    layers: dict[int, NearPlaces]

    @property
    def count(self) -> int:
        """Number of amplitudes."""
        return sum(near.count for near in self.layers.values())

    def amplitudes(self, times: np.ndarray, behind: float) -> np.ndarray:
        """Displacements (k, count) m at times (k,) s, as of `NearPlaces`."""
        return np.hstack([near.amplitudes(times, behind) for near in self.layers.values()])

    def velocities(self, behind: float) -> np.ndarray:
        """Matrix (count, count) 1/s from the amplitudes to the velocities, `behind` (s) earlier."""
        return np.asarray(block_diag(*(near.velocities(behind) for near in self.layers.values())))

    def strained(self, places: np.ndarray, values: np.ndarray, heights: np.ndarray | None = None) -> np.ndarray:
        """Values (3, 4, d) per unit gradient at places (d, 2) m, per unit of amplitudes: (3, d, count).

        heights : (d,) m in the layers whose gradients these are, by default the places', which may be across a joint.
        """
        return self._joined("strained", places, values, places[:, 1] if heights is None else heights)

    def motion(self, places: np.ndarray, corrector: np.ndarray) -> np.ndarray:
        """Motion (3, d, count) of disks at places (d, 2) m with correctors (3, 4, d), per unit of amplitudes."""
        return self._joined("motion", places, corrector, places[:, 1])

    def _joined(self, of: str, places: np.ndarray, values: np.ndarray, heights: np.ndarray) -> np.ndarray:
        """Each layer's part (3, d, count) at places (d, 2) m with values (3, 4, d) and heights (d,) m in the layers."""
        found = np.zeros((3, len(places), self.count))
        for layer, own in self.ground.parts(heights):
            found[:, own, self._columns[layer]] = getattr(self.layers[layer], of)(places[own], values[:, :, own])
        return found

    @property
    def _columns(self) -> dict[int, slice]:
        """The amplitudes of each layer."""
        ends = np.cumsum([0, *(near.count for near in self.layers.values())]).tolist()
        return {layer: slice(*each) for layer, each in zip(self.layers, pairwise(ends), strict=True)}


def bed_of(medium: Medium, waves: Sequence[ElasticPlaneWave], thickness: float) -> Bed:
    """A layer of a medium with its four plane waves of unit amplitude; thickness : m."""
    motion = np.array([wave.motion for wave in waves]).T
    traction = np.array([traction_of(medium, *wave.slowness) @ wave.motion for wave in waves]).T
    return Bed(thickness, np.array([wave.slowness[1] for wave in waves]), motion, traction)


def oblique_in_layers(
    media: Sequence[Medium],
    joints: Sequence[float],
    surface: tuple[float, float] | None,
    incident: ElasticPlaneWave,
    signal: Incident,
    span: tuple[float, float],
    grain: float,
) -> ObliqueLayers | None:
    """The motion of layers under a wave at an angle, from the surface down; None if waves of a layer are evanescent.

    media, joints : of the layers, and heights (m) between them. surface : height (m) and mass (kg/m²) of the free
    surface; None: the uppermost layer goes on above. incident : wave of the lowest layer, continued if its reference is
    above, with a history. span : times (s) before which the history is zero, and until which it is asked for. grain :
    mean diameter, m.
    """
    top, mass = surface or (joints[0], None)
    ends, sx = [top, *joints], incident.slowness[0]
    found = [waves_with(medium, sx) for medium in media]
    each = [[*up[::-1], *down[::-1]] for up, down in filter(None, found)]
    if len(each) < len(media):
        return None
    thick = [*(-np.diff(ends)).tolist(), 0.0]
    beds = [bed_of(*own) for own in zip(media, each, thick, strict=True)]
    rising = np.linalg.solve(beds[-1].motion[:, :2], incident.motion)
    begin = incident.delay + incident.slowness[1] * ends[-1]  # at x = 0, where the wave enters the layers
    moving = ObliqueMotion(beds, rising, mass, signal.velocity, *span)
    layers = []
    for number, (medium, waves) in enumerate(zip(media, each, strict=True)):
        own: list[tuple[ElasticPlaneWave, Incident]] = []
        if number == len(media) - 1:
            own.append((incident, signal))
        for wave in range(4) if not own else (2, 3):
            if moving.largest(number)[wave] > NO_WAVE:
                plane = number + (wave < 2)
                late = begin + moving.ends[plane] - waves[wave].slowness[1] * ends[plane]
                own.append((waves[wave].shifted(late), History(moving, number, wave)))
        layers.append(GroundWaves(medium, tuple(wave for wave, _ in own), tuple(signal for _, signal in own), grain))
    return ObliqueLayers(tuple(layers), tuple(joints))
