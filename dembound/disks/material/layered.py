"""Ground of horizontal layers: one packing whose masses and springs change with height.

A contact between two layers has their springs in series, k = 2k₁k₂/(k₁ + k₂). For long waves the mass then changes at
one height and the stiffness at others, for P and for S waves, up to half a diameter from the joint. A strip of bricks
across the joint gives these heights; disks within five diameters get masses and springs that move all three to it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np

from dembound.disks.material.joints import compliances, corrected
from dembound.disks.material.packed_material import PackedMaterial
from dembound.errors import CaseError
from dembound.laws import Stiffness
from dembound.packings.brick import Brick
from dembound.packings.tiling import Assembly, tile
from dembound.pairwise import STRAIN

REACH = 5.0
"""Diameters on either side of a joint in which masses and springs move its effective heights to it."""

ON_JOINT = 1e-6
"""Diameters below a joint from which a disk counts as above it: rounding of the heights of rows."""

STRIP = 8.0
"""Diameters, at least, of each third of the strip on either side of a joint, see `entry.APART`."""

ROUNDS = 3
"""Times that masses and springs beside a joint are corrected; each leaves about a tenth of the error."""

SAME = 1e-9
"""Relative difference of densities or moduli of two layers that counts as none."""

FAINT = 1e-12
"""Springs against single motions over those of the contacts, see `Network.relaxed`."""


class Zone(NamedTuple):
    """Disks of one material: heights low and high (m), number of their layer from the top, and the material."""

    low: float
    high: float
    layer: int
    material: PackedMaterial


class Joint(NamedTuple):
    """The effective heights (m) of a joint less the height asked for, before they are corrected.

    mass : where the density changes; p, s : where the stiffness changes for P and S waves; nan where it does not.
    """

    height: float
    mass: float
    p: float
    s: float


@dataclass(frozen=True)
class LayeredGround(PackedMaterial):
    """A brick in several layers. Its own density, moduli and tensors are those of the layer of the slowest waves.

    Attributes
    ----------
    zones : from the bottom up, without gaps; the lowest and the highest have no end.
    layers : the layers as asked for, from the bottom up, without corrections.
    joints : between the layers, from the bottom up.
    """

    zones: tuple[Zone, ...] = ()
    layers: tuple[Zone, ...] = ()
    joints: tuple[Joint, ...] = ()

    def at(self, height: float, x: float | None = None) -> PackedMaterial:
        """The material of the layer at a height (m), without corrections; above it on a joint."""
        return self.layers[int(_number(self.layers, self._rounding, np.array(height)))].material

    @property
    def materials(self) -> tuple[PackedMaterial, ...]:
        """The materials of its layers, from the surface down, without corrections."""
        return tuple(zone.material for zone in reversed(self.layers))

    def _with(self, **damping: Any) -> Self:
        """The ground with other damping in all layers, see `PackedMaterial`."""
        zones, layers = (
            tuple(zone._replace(material=zone.material._with(**damping)) for zone in some)
            for some in (self.zones, self.layers)
        )
        return super()._with(zones=zones, layers=layers, **damping)

    def zone_of(self, places: np.ndarray) -> np.ndarray:
        """Number of the zone, from the bottom, of disks at places (n, 2) m."""
        return _number(self.zones, self._rounding, places[:, 1])

    @property
    def zone_materials(self) -> tuple[PackedMaterial, ...]:
        """The material of each zone, from the bottom."""
        return tuple(zone.material for zone in self.zones)

    def layer_of(self, places: np.ndarray) -> np.ndarray:
        """Number of the layer, from the top, of disks at places (n, 2) m."""
        return np.array([zone.layer for zone in self.zones])[self.zone_of(places)]

    def disk_masses(self, assembly: Assembly) -> tuple[np.ndarray, np.ndarray]:
        """Masses (n,) kg and moments of inertia (n,) kg·m² of an assembly's disks."""
        zone, disk = self.zone_of(assembly.positions), assembly.brick_particle
        mass, inertia = (
            np.stack([getattr(each, name) for each in self.zone_materials]) for name in ("mass", "inertia")
        )
        return mass[zone, disk], inertia[zone, disk]

    @property
    def pairings(self) -> tuple[tuple[int, int], ...]:
        """The zones of the first and second disk of contacts, in the order of the variants of the brick's contacts."""
        last = len(self.zones) - 1
        return tuple((a, b) for a in range(last + 1) for b in (a - 1, a, a + 1) if 0 <= b <= last)

    def pairing_of(self, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        """Number (b,) in `pairings` of contacts between disks at places first and second (b, 2) m."""
        a, b = self.zone_of(first), self.zone_of(second)
        require_thick((np.abs(a - b) <= 1).all())
        return 3 * a + b - a

    def stiffness_of(self, pairing: tuple[int, int]) -> Stiffness:
        """Constants of the brick's contacts between two zones: contacts in series, and bonds in series."""
        one = self.zones[pairing[0]].material.springs
        if pairing[0] == pairing[1]:
            return one
        radii = self.brick.radii[self.brick.pairs].T
        constants = self.pair_constants((radii[0], radii[1]), self.brick.vectors, pairing, gaps_close=False)
        contacts, bonds = self.law.stiffnesses(constants)
        normal, shear, bending = contacts + bonds
        return Stiffness(normal, shear, bending, one.arm_i, one.arm_j)

    def pair_constants(
        self,
        radii: tuple[np.ndarray, np.ndarray],
        vectors: np.ndarray,
        zones: tuple[np.ndarray | int, np.ndarray | int] = (0, 0),
        *,
        bonded: bool | None = None,
        gaps_close: bool = True,
        locked_in: float = 0.0,
    ) -> np.ndarray:
        """Constants (b, c + 3) of pairs, see `PackedMaterial.pair_constants`."""
        found, stiff = np.empty((len(vectors), self.law.width + STRAIN)), self.law.stiff
        stresses = [number for number, each in enumerate(self.law.columns) if each.in_half == 2.0]
        ends = np.stack([np.broadcast_to(zone, len(vectors)) for zone in zones], axis=1)
        for pair in np.unique(ends, axis=0):
            chosen = (ends == pair).all(axis=1)
            own: dict[str, Any] = {"radii": (radii[0][chosen], radii[1][chosen]), "vectors": vectors[chosen]}
            own |= {"bonded": bonded, "gaps_close": gaps_close, "locked_in": locked_in}
            one, other = (self.zones[zone].material.pair_constants(**own) for zone in pair.tolist())
            found[chosen] = one
            if pair[0] != pair[1]:
                found[np.ix_(chosen, stiff)] = _in_series(one[:, stiff], other[:, stiff])
                found[np.ix_(chosen, stresses)] = np.maximum(one[:, stresses], other[:, stresses])
        return found

    @cached_property
    def _rounding(self) -> float:
        return ON_JOINT * self.brick.mean_diameter


def require_thick(joins_neighbours: bool | np.bool_) -> None:
    """Raise CaseError unless contacts join disks of neighbouring zones only."""
    if not joins_neighbours:
        raise CaseError(["layer: a layer is too thin for this packing: contacts reach across it"])


def materials_in(ground: PackedMaterial) -> list[PackedMaterial]:
    """The materials of the layers of a ground as asked for, from the bottom up; of a uniform one itself."""
    return [zone.material for zone in ground.layers] if isinstance(ground, LayeredGround) else [ground]


def layered(layers: Sequence[PackedMaterial], joints: Sequence[float], origin: float) -> LayeredGround:
    """The ground of layers of one brick.

    layers : from the bottom up, one more than joints : heights (m) between them, ascending. origin : height (m) of the
    lower edge of a brick.
    """
    damped, layers = layers, [replace(each, mechanisms=None) for each in layers]  # joints are found without damping
    ends = [-np.inf, *joints, np.inf]
    plain = [Zone(*each) for each in zip(ends[:-1], ends[1:], range(len(layers) - 1, -1, -1), layers, strict=True)]
    zones, found = [plain[0]], []
    for under, above, height in zip(plain[:-1], plain[1:], joints, strict=True):
        reach = min(REACH * layers[0].brick.mean_diameter, *(0.5 * (each.high - each.low) for each in (under, above)))
        joint, nearby = _settled(under, above, height, origin, reach)
        below = zones.pop()
        zones += [below._replace(high=height - reach), *nearby, above._replace(low=height + reach)]
        found.append(joint)
    zones, plain = (
        [each._replace(material=replace(each.material, mechanisms=damped[-1 - each.layer].mechanisms)) for each in some]
        for some in ([zone for zone in zones if zone.high > zone.low], plain)
    )
    slowest = min(damped, key=lambda each: float(np.nanmin([each.wave_speeds(axis) for axis in (0, 1)])))
    own = {each.name: getattr(slowest, each.name) for each in fields(PackedMaterial) if each.init}
    return LayeredGround(**own, zones=tuple(zones), layers=tuple(plain), joints=tuple(found))


def _number(zones: Sequence[Zone], rounding: float, heights: np.ndarray) -> np.ndarray:
    """Number of the zone of disks at heights (m)."""
    return np.searchsorted([zone.low for zone in zones[1:]], heights + rounding, side="right")


def _in_series(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Twice the stiffness of two springs in series, each of which is half of a contact; 0 where either is 0."""
    return np.divide(2.0 * one * other, one + other, out=np.zeros_like(one), where=one + other > 0.0)


def _settled(below: Zone, above: Zone, height: float, origin: float, reach: float) -> tuple[Joint, tuple[Zone, Zone]]:
    """A joint of two layers as it is without corrections, and the zones within reach (m) of it that correct it."""
    strip = _strip(below.material.brick, height, origin)
    below, above = below._replace(low=-np.inf), above._replace(high=np.inf)
    first = left = _heights(strip, (below, above), height)
    moved = np.zeros(3)
    for _ in range(ROUNDS):
        moved = moved + np.nan_to_num(left)
        lower, upper = (corrected(moved, below.material, above.material, reach, number) for number in (0, 1))
        nearby = Zone(height - reach, height, below.layer, lower), Zone(height, height + reach, above.layer, upper)
        zones = below._replace(high=height - reach), *nearby, above._replace(low=height + reach)
        left = _heights(strip, zones, height)
    return Joint(height, *first.tolist()), nearby


def _strip(brick: Brick, height: float, origin: float) -> Assembly:
    """A strip of bricks, periodic sideways, three thirds below and above the brick that a height (m) is in.

    origin : height (m) of the lower edge of a brick.
    """
    deep = float(brick.size[1])
    third = int(np.ceil(STRIP * brick.mean_diameter / deep))
    begins = height - (height - origin) % deep - 3 * third * deep
    return tile(brick, (1, 6 * third + 1), (True, False), (0.0, begins))


def _heights(strip: Assembly, zones: Sequence[Zone], height: float) -> np.ndarray:
    """Heights (3,) m where mass, and stiffness for P and S waves, change in a strip, less that of its joint.

    The strip has the mass of two uniform layers that meet at h_m. Pulled along x or y, it lengthens like two uniform
    layers that meet at h_c: by (h_c − y₁)/M₁ + (y₂ − h_c)/M₂ per unit of traction between the mass centres y₁, y₂ of
    bricks away from its ends and from the joint. nan where the two layers do not differ.
    """
    below, above = zones[0].material, zones[-1].material
    own = {each.name: getattr(below, each.name) for each in fields(PackedMaterial) if each.init}
    ground = LayeredGround(**own, zones=tuple(zones))
    up, row, third = strip.positions[:, 1], strip.tile[:, 1], strip.copies[1] // 6
    wide, high = strip.size.tolist()
    mass, _ = ground.disk_masses(strip)
    found = np.full(3, np.nan)
    if not np.isclose(below.density, above.density, rtol=SAME, atol=0.0):
        more = mass.sum() / wide - above.density * high
        found[0] = more / (below.density - above.density) + float(strip.origin[1] + below.brick.mass_offset[1])
    ends = [(row >= third) & (row < 2 * third), (row > 4 * third) & (row <= 5 * third)]
    moved = _pulled(ground, strip, row < third, row > 5 * third)
    for place, component in ((1, 1), (2, 0)):
        soft = [compliances(each)[component] for each in (below, above)]
        if component in below.held or np.isclose(soft[0], soft[1], rtol=SAME, atol=0.0):
            continue
        both = up, moved[component, :, component]
        y, u = ([float(np.average(values[part], weights=mass[part])) for part in ends] for values in both)
        found[place] = ((u[1] - u[0]) * wide + y[0] * soft[0] - y[1] * soft[1]) / (soft[0] - soft[1])
    return found - height


def _pulled(ground: LayeredGround, strip: Assembly, held: np.ndarray, pulled: np.ndarray) -> np.ndarray:
    """Motions (3, n, 2) of a strip's disks, some held and some pulled along x and along y by 1 N in all."""
    from scipy.sparse import diags
    from scipy.sparse.linalg import splu

    from dembound.disks.material.homogenise import Network

    count, ends = len(strip.radii), strip.positions[strip.pairs]
    kinds = ground.pairing_of(ends[:, 0], ends[:, 1])
    each = [ground.stiffness_of(pairing) for pairing in ground.pairings]
    columns = (np.stack([getattr(one, field.name) for one in each]) for field in fields(Stiffness))
    stiffness = Stiffness(*(column[kinds, strip.contact_type] for column in columns))
    network = Network(count, strip.pairs, ground.brick.vectors[strip.contact_type], stiffness)
    free = np.ones((3, count), dtype=bool)
    free[:2, held] = False
    free[list(ground.held)] = False
    ways = network.motion_matrix()[:, free.ravel()]
    matrix = (ways.T @ diags(network.springs) @ ways).tocsc()
    matrix += FAINT * diags(matrix.diagonal(), format="csc")
    mass, _ = ground.disk_masses(strip)
    force = np.zeros((3, count, 2))
    for component in (0, 1):
        force[component, pulled, component] = mass[pulled] / mass[pulled].sum()
    moved = np.zeros_like(force)
    moved[free] = splu(matrix).solve(force[free])
    return moved
