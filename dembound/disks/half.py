"""One half of a symmetric scene, stepped in place of both: disks of the other half move as mirror images of its own.

The mirror line is the middle line along x or y. The image of (u_n, u_s, θ), with n across the line, is (−u_n, u_s, −θ);
in an antisymmetric motion all three have the other sign. Disks on the line are halves: they have half their mass, half
their contacts along the line and half of the forces from outside, and do not move in the components that their image
would move the other way. A contact of a disk with its own image acts as springs on its disk: the two move apart by
2u_n and their bond bends by 2θ, so that it pushes with −2k_n·u_n and turns with −2k_b·θ.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.boundaries.support import Edge, Supports
from dembound.disks.body import parts_of
from dembound.disks.contacts import plain_contacts
from dembound.disks.layout import lay_out
from dembound.disks.scene import DiskScene
from dembound.disks.smaller import DRIVES, LOADS, SmallerScene, supports_at
from dembound.disks.system import DiskSystem
from dembound.kernels.contacts import REFERENCE, strain_energy
from dembound.kernels.tables import Contacts
from dembound.packings.tiling import Assembly

ROUNDING = 1e-9
"""Distance over radius up to which a disk is at the place of another one's image."""


@dataclass(frozen=True, kw_only=True)
class HalfScene(SmallerScene):
    """The left or lower half of a scene, disks on the mirror line included; m of n disks.

    Attributes
    ----------
    axis : the axis across the mirror line.
    antisymmetric : whether images move the other way.
    image : (n,) bool, disks of the larger scene that are images of its own.
    fraction : (m,) part of a disk's cell inside this half.
    across : (q,) contacts of the larger scene between a disk and its image.
    """

    axis: int
    antisymmetric: bool
    image: np.ndarray
    fraction: np.ndarray
    across: np.ndarray

    def system(self, time_step: float) -> "HalfSystem":
        """Its body at rest as built, to be stepped by time_step (s)."""
        return HalfSystem(self, time_step)

    @property
    def saved(self) -> str:
        """The mirror line, and the number of disks that need not be stepped."""
        motion = "an antisymmetric" if self.antisymmetric else "a symmetric"
        disks = f"{self.count:,} of {self.of.count:,} disks"
        return f"symmetry: one half of {motion} scene about {_line(self.of, self.axis)} is stepped, {disks}"

    def differs(self, what: str) -> str:
        """In words, that something of the larger scene, in the plural, has no mirror images."""
        lacking = (
            " (antisymmetric ones need disks on this line)" if len(self.across) and what in (LOADS, DRIVES) else ""
        )
        return f"{_not_mirrored(self.of, self.axis, what)}{lacking}"

    @cached_property
    def cell_fraction(self) -> np.ndarray:
        """(m,) part of a disk's cell inside this half."""
        return self.fraction

    @cached_property
    def signs(self) -> np.ndarray:
        """(3,) factors of displacements, velocities and forces of images, by component."""
        return _signs(self.axis, self.antisymmetric)

    def of_all(self, name: str, values: np.ndarray) -> np.ndarray:
        """Values (m, …) of its disks as those of the disks (n, …) of the larger scene.

        name : "displacement", "velocity" or "stress", which change sign in images; all others do not.
        """
        wide = values[self.like]
        if name in ("displacement", "velocity"):
            wide[self.image] *= self.signs
        elif name == "stress":
            wide[self.image] *= (-1.0 if self.antisymmetric else 1.0) * np.array([1.0, 1.0, -1.0])
        return wide

    def observed(self, record: np.ndarray, times: np.ndarray) -> np.ndarray:
        """The motion of the monitors, some of which are images."""
        image = self.image[self.of.probes]
        return self.of.observed(record * np.where(image[:, None], np.tile(self.signs, 2), 1.0), times)

    def tracked_peaks(self, peaks: np.ndarray) -> np.ndarray:
        """Smallest and largest velocities (p, 3, 2); of an image the largest is the smallest with the other sign."""
        wide = super().tracked_peaks(peaks)
        turned = self.image[self.of.tracked][:, None] & (self.signs < 0.0)
        return np.where(turned[..., None], -wide[..., ::-1], wide)

    def elastic_stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (m, 3) Pa at displacements (3, m), computed on all disks, as half of the contacts are not its own."""
        wide = self.widened("displacement", displacement.T)
        return self.whole.elastic_stress(wide.T)[self.places_in_whole]

    @cached_property
    def _pairs_across(self) -> tuple[np.ndarray, np.ndarray, Contacts]:
        """Of the contacts across: disks (2q,) and signs (3, 2q) of all first and then all second ends; the contacts."""
        assembly = self.of.assembly
        ends, count = assembly.pairs[self.across].T.ravel(), len(self.across)
        pairs = np.arange(2 * count, dtype=np.int32).reshape(2, count).T
        alone = replace(assembly, pairs=pairs, contact_type=assembly.contact_type[self.across])
        contacts = plain_contacts(self.ground, alone, np.arange(2 * count))
        return self.like[ends], np.where(self.image[ends], self.signs[:, None], 1.0), contacts

    def energy_across(self, displacement: np.ndarray) -> tuple[float, float]:
        """Its half of the energy (J) in the contacts and bonds with images at displacements (3, m)."""
        contact, bond = 0.0, 0.0
        if isinstance(self.of, HalfScene):
            contact, bond = self.of.energy_across(self.of_all("displacement", displacement.T).T)
        if len(self.across) > 0:
            disks, signs, contacts = self._pairs_across
            own = strain_energy(signs * displacement[:, disks], contacts, REFERENCE)
            contact, bond = contact + own[0], bond + own[1]
        return 0.5 * contact, 0.5 * bond


class HalfSystem(DiskSystem):
    """The moving disks of one half; its energies include half of those in contacts with images."""

    scene: HalfScene

    def stored(self, u: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) at displacements (3, slots): in contacts and in bonds."""
        across = self.scene.energy_across(self.scene.layout.gather(u))
        pairs = zip(super().stored(u), across, strict=True)
        contact, bond = (own + across for own, across in pairs)
        return contact, bond

    def counted_outside(self, u: np.ndarray) -> float:
        """Energy (J) at displacements (3, slots) in contacts with images, which act as springs of the support table."""
        return sum(self.scene.energy_across(self.scene.layout.gather(u)))

    def stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (m, 3) xx, yy, xy in Pa of all disks at displacements (3, m), tension positive."""
        return self.scene.elastic_stress(displacement)


def halves(scene: DiskScene, axis: int) -> Iterator[HalfScene | str]:
    """The half of a scene across an axis for symmetric motion, and that for antisymmetric motion; or why there is none.

    The disks, the contacts across the line and those along it are mirror images of each other. Whether everything else
    is remains to be checked (reduction.py).
    """
    if (side := ("left", "bottom")[axis]) not in scene.edges:
        is_periodic = scene.case.side(side).is_periodic
        yield f"{'xy'[axis]} is periodic" if is_periodic else f"one of identical rows along {'yx'[axis]} is stepped"
        return
    mirrored = _mirrored(scene, axis)
    if mirrored is None:
        yield _not_mirrored(scene, axis, "disks")
        return
    own = np.arange(scene.count)
    beyond = (scene.positions[:, axis] > _middle(scene, axis)) & (mirrored != own)
    first, second = scene.assembly.pairs.T
    crossing = np.flatnonzero(beyond[first] != beyond[second])
    on_line = mirrored == own
    crossing = crossing[~(on_line[first] | on_line[second])[crossing]]  # those of disks on the line are images
    if (mirrored[first[crossing]] != second[crossing]).any():
        yield _not_mirrored(scene, axis, "contacts")
        return
    for antisymmetric in (False,) if len(crossing) else (False, True):
        yield _half(scene, axis, antisymmetric, mirrored, beyond, crossing)


def _half(
    scene: DiskScene, axis: int, antisymmetric: bool, mirrored: np.ndarray, beyond: np.ndarray, across: np.ndarray
) -> HalfScene | str:
    """One half, or why not; mirrored, beyond (n,): image of each disk, and those left out; across (q,) contacts."""
    place = np.flatnonzero(~beyond)
    number = np.cumsum(~beyond) - 1
    like = number[np.where(beyond, mirrored, np.arange(scene.count))]
    on_line = mirrored[place] == place
    assembly = _with_half_contacts(scene, axis, scene.assembly.only(~beyond), on_line)
    if assembly is None:
        return f"contacts along {_line(scene, axis)} are half contacts already"
    share = np.where(on_line, 0.5, 1.0)
    fraction = share * scene.cell_fraction[place]
    still = on_line & (_signs(axis, antisymmetric) < 0.0)[:, None]
    slots, rows = lay_out(assembly, scene.ground, parts_of(len(place), None), fraction)
    supports = supports_at(place, scene.supports, share)
    return HalfScene(
        case=scene.case,
        ground=scene.ground,
        assembly=assembly,
        rows=rows,
        edges=_edges(scene, number, beyond),
        supports=_with_mirror(supports, scene, still, *_springs(scene, axis, like, across)),
        monitors={name: int(like[node]) for name, node in scene.monitors.items()},
        slots=slots,
        of=scene,
        like=like,
        place=place,
        load=np.where(still, 0.0, share * scene.steady_load[:, place]),
        axis=axis,
        antisymmetric=antisymmetric,
        image=beyond,
        fraction=fraction,
        still=still,
        across=across,
    )


def _middle(scene: DiskScene, axis: int) -> float:
    """The coordinate (m) of the mirror line across an axis."""
    along = scene.positions[:, axis]
    return 0.5 * float(along.min() + along.max())


def _line(scene: DiskScene, axis: int) -> str:
    """The mirror line across an axis in words."""
    return f"{'xy'[axis]} = {_middle(scene, axis):g} m"


def _not_mirrored(scene: DiskScene, axis: int, what: str) -> str:
    """In words, that something in the plural has no mirror images across an axis."""
    return f"the {what} are not mirror-symmetric about {_line(scene, axis)}"


def _signs(axis: int, antisymmetric: bool) -> np.ndarray:
    """Factors (3,) of the motion of an image, by component."""
    signs = np.array([1.0, 1.0, -1.0])
    signs[axis] = -1.0
    return -signs if antisymmetric else signs


def _mirrored(scene: DiskScene, axis: int) -> np.ndarray | None:
    """The disk (n,) at the place of each one's image, itself on the line; None if one has none of the same radius."""
    from scipy.spatial import cKDTree

    images, radii = scene.positions.copy(), scene.assembly.radii
    images[:, axis] = 2.0 * _middle(scene, axis) - images[:, axis]
    distance, mirrored = cKDTree(scene.positions).query(images)
    far = distance > ROUNDING * radii
    unlike = np.abs(radii - radii[mirrored]) > ROUNDING * radii
    return None if (far | unlike).any() else mirrored


def _with_half_contacts(scene: DiskScene, axis: int, assembly: Assembly, on_line: np.ndarray) -> Assembly | None:
    """The assembly of a half with half contacts along the line; None if one of them is half a contact already."""
    whole = len(scene.ground.brick.pairs)
    along = on_line[assembly.pairs].all(axis=1)
    if (assembly.contact_type[along] >= whole).any():
        return None
    copies, size = [*assembly.copies], assembly.size.copy()
    copies[axis] = int(assembly.tile[:, axis].max()) + 1
    size[axis] = copies[axis] * scene.ground.brick.size[axis]
    kind = assembly.contact_type + along.astype(assembly.contact_type.dtype) * whole
    return replace(assembly, contact_type=kind, copies=(copies[0], copies[1]), size=size)


def _edges(scene: DiskScene, number: np.ndarray, beyond: np.ndarray) -> dict[str, Edge]:
    """The sides of a half, with the numbers (n,) of its disks; the mirror line is none."""
    edges = {}
    for side, edge in scene.edges.items():
        kept = ~beyond[edge.nodes]
        if kept.any():
            nodes = number[edge.nodes[kept]]
            shares = np.broadcast_to(edge.shares, kept.shape)[kept]
            edges[side] = Edge(side, nodes, edge.positions[kept], edge.diameters[kept], edge.length, shares)
    return edges


def _springs(
    scene: DiskScene, axis: int, like: np.ndarray, across: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The springs of contacts with images: disks (2q,) of the half, components and N/m or N·m/rad."""
    whole, stiffness = len(scene.ground.brick.pairs), scene.ground.stiffness
    kind = scene.assembly.contact_type[across]
    part = np.where(kind >= whole, 0.5, 1.0)
    node = like[scene.assembly.pairs[across, 0]]
    normal, bending = (2.0 * part * of[kind % whole] for of in (stiffness.normal, stiffness.bending))
    component = np.repeat([axis, 2], len(across))
    return np.tile(node, 2), component, np.concatenate([normal, bending])


def _with_mirror(
    table: Supports,
    scene: DiskScene,
    still: np.ndarray,
    node: np.ndarray,
    component: np.ndarray,
    stiffness: np.ndarray,
) -> Supports:
    """A support table with springs (q,), and with components (3, m) prescribed as zero, except those held anyway."""
    moves = scene.free[component] > 0.0
    sprung = 3 * node[moves] + component[moves]
    still_component, still_node = np.nonzero(still & (scene.free > 0.0)[:, None])
    fixed = 3 * still_node + still_component
    own = 3 * table.node + table.component
    key = np.union1d(own, np.concatenate([sprung, fixed]))
    line, is_fixed = np.searchsorted(key, own), np.isin(key, fixed)

    def column(values: np.ndarray) -> np.ndarray:
        """A column of the new table."""
        wide = np.zeros(len(key), values.dtype)
        wide[line] = values
        return wide

    prescribed = column(table.prescribed) | is_fixed
    springs = column(table.stiffness)
    np.add.at(springs, np.searchsorted(key, sprung), stiffness[moves])
    drive_row = line[table.drive_row]
    driven = ~is_fixed[drive_row]
    return replace(
        table,
        node=key // 3,
        component=key % 3,
        damping=np.where(prescribed, 0.0, column(table.damping)),
        follow=np.where(prescribed, 0.0, column(table.follow)),
        stiffness=np.where(prescribed, 0.0, springs),
        prescribed=prescribed,
        drive_row=drive_row[driven],
        drive=table.drive[driven],
        drive_signal=table.drive_signal[driven],
    )
