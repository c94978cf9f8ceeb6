"""How well the supports of a side match the packing, from its homogenised stiffness, without running a wave."""

from typing import NamedTuple

import numpy as np

from dembound.boundaries import Motion
from dembound.boundaries.boundary import Boundary
from dembound.boundaries.support import Edge, SupportBuilder, Supports
from dembound.disks.scene import DiskScene
from dembound.disks.sides import media_of
from dembound.errors import CaseError


def homogenised_beta(scene: DiskScene, side: str, motion: Motion, part: int = 0) -> float:
    """β0 of a side, see `BoundaryMedium.matched`; nan where the motion is held. part : number in `media_of`."""
    edge, medium = media_of(scene, side)[part]
    return medium.matched(edge)[motion]


def factors_in(scene: DiskScene, side: str, part: int = 0) -> dict[Motion, float]:
    """The factors β of a side's dashpots as numbers; part : number in `media_of`."""
    return scene.case.side(side).factors_at(*media_of(scene, side)[part])


def supports_of(scene: DiskScene, side: str, part: int | None = None) -> Supports:
    """The support table of one side only; part : number in `media_of`, None for all."""
    builder, parts = SupportBuilder(held=scene.ground.held), media_of(scene, side)
    for edge, medium in parts if part is None else [parts[part]]:
        scene.case.side(side).support(edge, medium, scene.case.wave, builder)
    return builder.table()


def per_metre(scene: DiskScene, side: str, table: Boundary) -> dict[tuple[str, int, int], float]:
    """Support coefficients on the disks of a side of a type, per metre of it, with matched factors of its dashpots.

    By kind, component (0 x, 1 y, 2 rotation) and number of the signal (−1 for none): "dampers" N·s/m², "springs" N/m²,
    and "forces" of waves, N/m per unit of their signal. Prescribed motion is left out.
    """
    builder = SupportBuilder(held=scene.ground.held)
    for edge, medium in media_of(scene, side):
        matched = table.with_factors(dict.fromkeys(table.factors, "matched")).with_numbers(edge, medium)
        matched.support(edge, medium, scene.case.wave, builder)
    supports, length = builder.table(), _length(scene.edges[side])
    free = ~supports.prescribed
    found: dict[tuple[str, int, int], float] = {}
    for component in range(3):
        rows = free & (supports.component == component)
        for kind, values in (("dampers", supports.damping), ("springs", supports.stiffness)):
            if values[rows].any():
                found[kind, component, -1] = float(values[rows].sum()) / length
        drives = rows[supports.drive_row]
        for number in np.unique(supports.drive_signal[drives]).tolist():
            forces = supports.drive[drives & (supports.drive_signal == number)]
            found["forces", component, number] = float(forces.sum()) / length
    return found


def _length(edge: Edge) -> float:
    """Length (m) of a side for its disks; disks halved at its corners count as whole ones."""
    return edge.length * float(np.sum(edge.widths) / np.sum(edge.diameters))


def require_dashpots_alone(scene: DiskScene, side: str) -> None:
    """Raise CaseError for a side that has springs, or follows a free-field column, where only dashpots are allowed.

    Factors of dashpots are defined for plane waves that dashpots absorb; they would compensate for springs.
    """
    table = supports_of(scene, side)
    if table.stiffness.any() or table.follow.any():
        said = f'boundary.{side}.type: "{scene.case.side(side).type}" still has springs where dashpots are needed alone'
        why = "so no factor of dashpots can be found for it; a type with springs needs the method dashpots_alone()"
        raise CaseError([f"{said}, {why}"])


class Held(NamedTuple):
    """Supports of a side, per metre of it, along x and y: dashpots (2,) N·s/m² and springs (2,) N/m²."""

    damping: np.ndarray
    stiffness: np.ndarray

    @classmethod
    def of(cls, scene: DiskScene, side: str, part: int | None = None) -> "Held":
        """The sums over the particles of a side; disks halved at its corners count as whole ones.

        part : number in `media_of`, None for the whole side.
        """
        edge = scene.edges[side] if part is None else media_of(scene, side)[part][0]
        table = supports_of(scene, side, part)
        by_axis = [table.component == axis for axis in (0, 1)]
        both = table.damping, table.stiffness
        return cls(*(np.array([np.sum(values[own]) for own in by_axis]) / _length(edge) for values in both))
