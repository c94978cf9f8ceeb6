"""Monitors: the disks whose motion they record, or in a continuum the disks that would be there.

The packing goes on in the continuum beyond a body. The disk i that would be nearest to a monitor's place has the motion

    u_i = U(x_i) + χ_i : ∇U(x_i),    θ_i = χ^θ_i : ∇U(x_i)

with U the continuum's displacement and χ the correctors of the brick (material/homogenise.py); those of a lattice are
χ = 0 and θ = ½(∂U_y/∂x − ∂U_x/∂y). Beside a free-field column U is the scattered motion only, to which the motion of
the column's disk at the same place of the brick is added.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.ground import reach
from dembound.casefile.disks.load import FREE_FIELD
from dembound.casefile.messages import numbered
from dembound.continuum.interpolation import interpolation, slopes
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.packing_waves import INDEX
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.ground_waves import UnlikeWaves
from dembound.disks.surroundings.layered_waves import Undisturbed
from dembound.errors import CaseError
from dembound.holes.polygon import Polygon
from dembound.motion.scene import Between, Mean
from dembound.packings.brick import Brick
from dembound.packings.column import Seam, columns_end, nearest_in_column
from dembound.packings.tiling import Assembly, disks_around
from dembound.places import is_within, nearest

Monitors = tuple[dict[str, int], dict[str, Between]]
"""Name -> node, and name -> place of the monitors in a continuum."""

MOST_LINES = 10
"""Most monitors at places without motion that have a line each."""

DIGITS = 1e-9
"""Part of the last digit of a place by which a limit may be missed."""


def monitors_of(
    case: DiskCase,
    ground: PackedMaterial,
    assembly: Assembly,
    seams: Sequence[Seam],
    outside: Surroundings | None,
    waves: Undisturbed | None = None,
) -> Monitors:
    """The disk nearest to each monitor's position, of the body or in the continuum, and their twins.

    waves : motion of the ground without the body, for twins and for monitors in the continuum.

    Raises CaseError for positions in the absorbing layer, and below the ground if waves come from there.
    """
    if not case.monitor:
        return {}, {}
    first = columns_end(seams)
    of_body = first + nearest(assembly.positions[first:], np.array([m.position for m in case.monitor]))
    nodes = {m.name: int(node) for m, node in zip(case.monitor, of_body, strict=True)}
    twins: dict[str, int] = {}
    for name, node in nodes.items() if seams else ():
        number = int(len(seams) > 1 and assembly.positions[node, 0] > case.middle)
        twins[name] = int(seams[number].twin[node])
        if twins[name] == node:  # above the ground at that side
            surface = np.array([[assembly.positions[node, 0], seams[number].top]])
            twins[name] = int(nearest_in_column(assembly, surface, number)[0])
    between: dict[str, Between] = {}
    disks = {name: (assembly.positions[node], int(assembly.brick_particle[node])) for name, node in nodes.items()}
    if outside is not None:
        around = _Around(case, ground.brick, assembly, first, outside)
        around.check()
        for monitor in case.monitor:
            name = monitor.name
            beyond = None if monitor.points else around.disk_at(monitor.position, disks[name][0])
            if beyond is None:
                continue
            disks[name] = place, kind = beyond
            if seams:
                column = int(outside.is_right(place[None])[0]) if len(seams) > 1 else 0
                twins[name] = int(nearest_in_column(assembly, place[None], column)[0])
            between[name] = _in_continuum(outside, ground, place, kind, twins.get(name))
            nodes[name] = outside.first + int(nearest(outside.body.mesh.positions, place[None])[0])
    if waves is not None:
        for name, disk in disks.items():
            if name in between:
                between[name] = replace(between[name], known=_moving(waves, ground, *disk))
            beside = "right" if disk[0][0] > case.middle else "left"
            there = waves.in_ground(beside, disk[0][None])[0] if isinstance(waves, UnlikeWaves) else disk[0]
            on_twin = np.zeros(0, dtype=np.int64), np.zeros((0, 3, 3))  # without a column
            if name in twins:
                on_twin = np.array([twins[name]]), np.eye(3)[None]
            between[f"{name}{FREE_FIELD}"] = Between(there, *on_twin, _moving(waves, ground, *disk, beside=beside))
        twins = nodes | twins
    between |= _means(case, ground, assembly, first)
    return nodes | {f"{name}{FREE_FIELD}": node for name, node in twins.items()}, between


def _means(case: DiskCase, ground: PackedMaterial, assembly: Assembly, first: int) -> dict[str, Between]:
    """The monitors of means over polygons; first : number of the first disk of the body.

    Raises CaseError for a polygon without a disk.
    """
    found: dict[str, Between] = {}
    masses = ground.disk_masses(assembly)[0]
    for place, monitor in numbered("monitor", case.monitor):
        if monitor.points is None:
            continue
        shape = Polygon(type="polygon", name=monitor.name, points=monitor.points)
        disks = first + np.flatnonzero(shape.depth(assembly.positions[first:]) >= 0.0)
        if len(disks) == 0:
            raise CaseError([f"{place}.points: no particle of the body is centred in the polygon"])
        share = masses[disks] / masses[disks].sum()
        found[monitor.name] = Mean(share @ assembly.positions[disks], disks, share)
    return found


Moving = Callable[[np.ndarray], np.ndarray]
"""Displacement and velocity (s, 6) at times (s,) s."""


def _moving(
    waves: Undisturbed, ground: PackedMaterial, place: np.ndarray, kind: int, beside: str | None = None
) -> Moving:
    """The motion in the undisturbed ground of a disk of the brick, `kind`, at a place (2,) m.

    beside : the side whose ground it is, where it is not as high at both; None: that of the place.
    """
    corrector = np.moveaxis(ground.at(float(place[1]), float(place[0])).continuum.corrector[:, [kind]], 1, 2)

    def motion(times: np.ndarray) -> np.ndarray:
        moved = waves.motion
        if isinstance(waves, UnlikeWaves) and beside is not None:
            moved = partial(waves.beside, beside)
        return np.hstack([moved(of, times, place[None], corrector)[:, 0] for of in ("displacement", "velocity")])

    return motion


@dataclass(frozen=True)
class _Around:
    """The packing continued into the continuum round a body, whose first disk has the number `first`."""

    case: DiskCase
    brick: Brick
    assembly: Assembly
    first: int
    outside: Surroundings

    @property
    def _lowest(self) -> float:
        """Height (m) above which the continuum's motion is the total one, or there is a column to make it so."""
        is_total = self.first == 0 and not self.case.side("bottom").waves
        return -np.inf if is_total else self.case.box[1]

    def _allowed(self, places: np.ndarray) -> np.ndarray:
        """The places (k, 2) m, or the nearest ones where motion is recorded."""
        allowed = self.outside.allowed(places)
        allowed[:, 1] = np.maximum(allowed[:, 1], self._lowest)
        return allowed

    def check(self) -> None:
        """Raises CaseError for monitors at places where no motion is recorded."""
        monitors = self.case.monitor
        places = np.array([monitor.position for monitor in monitors])
        problems = []
        for number, (monitor, (x, y)) in enumerate(zip(monitors, self._allowed(places), strict=True), start=1):
            if (x, y) != monitor.position:
                below = monitor.position[1] < self._lowest
                where = "below the ground, where incident motion is not known" if below else "in the layer that absorbs"
                if monitor.position[1] > self.outside.height_at(np.array([monitor.position]))[0]:
                    where = "above the ground, which is lower beyond this side"
                x, y = self._rounded(monitor.position, np.array([x, y]))
                advice = f"the nearest place allowed is ({x:.10g}, {y:.10g}) m"
                problems.append(f"monitor[{number}, {monitor.name}].position: lies {where}; {advice}")
        if len(problems) > MOST_LINES:
            problems[MOST_LINES:] = [f"monitor: so do {len(problems) - MOST_LINES} more; limit a row by from and to"]
        if problems:
            raise CaseError(problems)

    def _rounded(self, position: tuple[float, float], allowed: np.ndarray) -> np.ndarray:
        """The nearest allowed place (2,) m for a position (m), in numbers of few digits, so slightly beyond the limit.

        They are multiples of a power of ten below a tenth of the elements.
        """
        element = float(self.outside.body.mesh.element_sizes.min())
        unit = 10.0 ** (np.floor(np.log10(element)) - 1)
        way = np.sign(np.subtract(allowed, position))
        return np.where(way == 0.0, allowed, way * np.ceil(way * allowed / unit - DIGITS) * unit + 0.0)  # no -0

    def disk_at(self, position: tuple[float, float], own: np.ndarray) -> tuple[np.ndarray, int] | None:
        """Place (2,) m, and number in the brick, of the disk in the continuum nearest to a position (m).

        None if `own` (2,) m, the nearest disk of the body, is nearer. No disks exist in layers and beyond free sides,
        nor, for places in the ground or on its rim, beyond where disks fill all of it.
        """
        case, brick, of = self.case, self.brick, self.assembly
        begin = of.positions[self.first] - brick.positions[of.brick_particle[self.first]]
        begin = begin - of.tile[self.first] * brick.size
        places = disks_around(brick, begin, position)[1].reshape(-1, 2)
        in_ground = is_within(case.box, position, case.packing.span)
        limits = case.box if in_ground else reach(case.ground, case.packing, case.boundary)
        refused = ~is_within(limits, places, case.packing.span)
        refused |= ~self.outside.is_beyond(places) | (self._allowed(places) != places).any(axis=1)
        there = np.flatnonzero(~refused)
        best = int(nearest(np.vstack([own, places[there]]), np.array([position]))[0])
        return None if best == 0 else (places[there[best - 1]], int(there[best - 1]) % len(brick.radii))


def _in_continuum(
    outside: Surroundings, ground: PackedMaterial, place: np.ndarray, kind: int, twin: int | None
) -> Between:
    """The motion of a disk of the brick, `kind`, at a place (2,) m of a continuum; twin : its twin's number."""
    mesh = outside.body.mesh
    at, slope = interpolation(mesh, place[None]), slopes(mesh, place[None])[:, 0]
    share, own = np.zeros((slope.shape[1], 3, 3)), ground.at(float(place[1]), float(place[0]))
    share[:, [0, 1], [0, 1]] = at.weight[0, :, None]
    for component in (0, 1):
        share[:, :, component] += (own.continuum.corrector[:, kind, INDEX[component]] @ slope).T
    node = outside.first + at.node[0]
    if twin is not None:
        node, share = np.append(node, twin), np.concatenate([share, np.eye(3)[None]])
    return Between(place, node, share)
