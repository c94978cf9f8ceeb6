"""The halves of a symmetric scene: which of its disks, contacts and forces one half has, see half.py."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from dembound.boundaries.support import Edge, Supports
from dembound.disks.body import parts_of
from dembound.disks.contacts.layout import lay_out
from dembound.disks.reduced.half import HalfScene
from dembound.disks.reduced.mirror import disks_at_images, middle, mirror_line, not_mirrored, signs_of_images
from dembound.disks.reduced.smaller import supports_at
from dembound.disks.scene import DiskScene
from dembound.packings.tiling import Assembly


def halves(scene: DiskScene, axis: int) -> Iterator[HalfScene | str]:
    """The half of a scene across an axis for symmetric motion, and that for antisymmetric motion; or why there is none.

    The disks, the contacts across the line and those along it are mirror images of each other. Whether everything else
    is remains to be checked (reduction.py).
    """
    if (side := ("left", "bottom")[axis]) not in scene.edges:
        is_periodic = scene.case.side(side).is_periodic
        yield f"{'xy'[axis]} is periodic" if is_periodic else f"one of identical rows along {'yx'[axis]} is stepped"
        return
    mirrored = disks_at_images(scene, axis)
    if mirrored is None:
        yield not_mirrored(scene, axis, "disks")
        return
    own = np.arange(scene.count)
    beyond = (scene.positions[:, axis] > middle(scene, axis)) & (mirrored != own)
    first, second = scene.assembly.pairs.T
    crossing = np.flatnonzero(beyond[first] != beyond[second])
    on_line = mirrored == own
    crossing = crossing[~(on_line[first] | on_line[second])[crossing]]  # those of disks on the line are images
    if (mirrored[first[crossing]] != second[crossing]).any():
        yield not_mirrored(scene, axis, "contacts")
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
        return f"contacts along {mirror_line(scene, axis)} are half contacts already"
    share = np.where(on_line, 0.5, 1.0)
    fraction = share * scene.cell_fraction[place]
    still = on_line & (signs_of_images(axis, antisymmetric) < 0.0)[:, None]
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
