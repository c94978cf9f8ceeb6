"""The stiffness of faces with which a joint as a whole has the one asked for, in the packing that it is in.

Faces are in series with the rock between the centres of the disks on both sides, in place of the contacts there. How
much that yields depends on the packing. It is measured in the disks beside the joint under the stress of a long plane
wave. Without the joint they move as those of the periodic packing, u₀; the forces f at their rim that belong to this
move them by u with it. With unit stress the compliance of the joint is (f·u − f·u₀)/length.
"""

from dataclasses import replace

import numpy as np

from dembound.disks.faces.found import Faces
from dembound.disks.faces.springs import springs_of
from dembound.disks.material.homogenise import Network
from dembound.disks.material.packed_material import NO_STIFFNESS, PackedMaterial
from dembound.packings.tiling import Assembly

DEPTH = 4.0
"""Distance from the joint up to which disks are measured, over the mean diameter: twice that changes it by 0.5 %."""

SHORTEST = 10.0
"""Length of the straight pieces of a joint that are measured, over the mean diameter."""

ROUNDS = 3
"""Measurements by which the faces are corrected; a fourth would change the joint's stiffness by less than 1e-3."""

STIFFEST = 0.75
"""Largest stiffness of corrected faces over that of the contacts that they replace: the time step stays within 2 %."""

FAINT = 1e-10
"""Springs against every single motion, over those of the contacts: the forces are in balance, but for rounding."""


def with_rock(faces: Faces, ground: PackedMaterial, assembly: Assembly) -> Faces:
    """Faces with the compliance of the rock as measured, in an assembly that has the contacts which they replace.

    They keep that of these contacts in layered ground, in ground without shear stiffness, and without a straight piece
    of ten diameters.
    """
    tensor, diameter = ground.material_tensor, ground.brick.mean_diameter
    if ground.is_layered or tensor[3, 3] <= NO_STIFFNESS * tensor[0, 0] or not faces.removed.all():
        return faces
    height = np.sum(faces.ends[:, 0] * faces.along[:, ::-1] * [-1.0, 1.0], axis=1)
    lines = np.column_stack([faces.along, (height / diameter).round(6)])
    strips = [_Strip(faces, (lines == line).all(axis=1), ground, assembly) for line in np.unique(lines, axis=0)]
    strips = [each for each in strips if each.width.min() >= SHORTEST * diameter]
    if not strips:
        return faces
    width = np.sum([each.width for each in strips], axis=0)
    asked, stiffest = faces.asked, np.maximum(STIFFEST * faces.removed[:, 0], faces.stiffness[:, 0])
    found = np.sum([each.work(faces.stiffness[:, 0]) for each in strips], axis=0) / width
    for _ in range(ROUNDS):
        rock = np.maximum(1.0 / faces.stiffness[:, 0] - found, 1.0 / stiffest - 1.0 / asked)
        faces = replace(faces, rock=np.repeat(rock[:, None], len(faces.disk), axis=1))
        found = np.sum([each.work(faces.stiffness[:, 0]) for each in strips], axis=0) / width
    return replace(faces, whole=1.0 / found)


class _Strip:
    """The disks beside a straight piece of a joint under unit stress; ``width`` (2,) m of the piece, see `work`."""

    def __init__(self, faces: Faces, piece: np.ndarray, ground: PackedMaterial, assembly: Assembly) -> None:
        from scipy.sparse import coo_matrix, diags

        own = replace(
            faces,
            split=int(piece[: faces.split].sum()),
            **{name: getattr(faces, name)[piece] for name in ("disk", "ends", "along")},
        )
        along, count, types = own.along[0], len(assembly.radii), len(ground.brick.pairs)
        normal = np.array([-along[1], along[0]])
        place, height = assembly.positions @ along, (assembly.positions - own.ends[0, 0]) @ normal
        ends = own.ends @ along
        near = (np.abs(height) <= DEPTH * ground.brick.mean_diameter) & (place >= ends.min()) & (place <= ends.max())
        kept = near[assembly.pairs].all(axis=1)
        kind, half = assembly.contact_type[kept] % types, assembly.contact_type[kept] // types % 2 == 1
        stiffness = ground.springs.of(kind).times(np.where(half, 0.5, 1.0))
        network = Network(count, assembly.pairs[kept], ground.brick.vectors[kind], stiffness)
        ways, crosses = network.motion_matrix(), faces.side[network.pairs].prod(axis=1) < 0
        # gradients a ⊗ n of motion along the normal n, with unit stress across and along it, see GRADIENTS
        planes = np.array([[normal[0], 0.0], [0.0, normal[1]], [normal[1], 0.0], [0.0, normal[0]]])
        stress = np.column_stack([normal, along])
        gradients = planes @ np.linalg.solve(planes.T @ ground.material_tensor @ planes, stress)
        moved = ground.continuum.corrector[:, assembly.brick_particle] @ gradients
        moved[:2] += np.stack([assembly.positions @ gradients[[0, 2]], assembly.positions @ gradients[[3, 1]]])
        moved = moved.reshape(3 * count, 2)
        force = ways.T @ (network.springs[:, None] * (ways @ moved))
        left = np.tile((height > 0.0), 2)
        self.width = np.sum(np.repeat(stress, count, axis=0)[left] * force[: 2 * count][left], axis=0)
        free = np.zeros((3, count), dtype=np.bool_)
        free[:, near] = True
        free[[each for each in ground.held if each == 2]] = False
        self._without = np.sum(force * moved, axis=0)
        chosen = np.flatnonzero(free)
        self._force, ways = force[chosen], ways[:, chosen]
        self._springs = ways.T @ diags(network.springs * ~np.tile(crosses, 3)) @ ways
        disks, modes, lengths, _ = springs_of(own, assembly.positions)
        rows = np.repeat(np.arange(len(lengths)), 6)
        columns = (disks[:, :, None] + count * np.arange(3)).ravel()
        self._ways = coo_matrix((modes.ravel(), (rows, columns)), shape=(len(lengths), 3 * count)).tocsc()[:, chosen]
        self._lengths = lengths.reshape(2, -1)

    def work(self, stiffness: np.ndarray) -> np.ndarray:
        """Work (2,) m²/Pa of unit normal and unit shear stress on the joint, with faces of a stiffness (2,) Pa/m."""
        from scipy.sparse import diags
        from scipy.sparse.linalg import splu

        springs = diags((self._lengths * stiffness[:, None]).ravel())
        matrix = (self._springs + self._ways.T @ springs @ self._ways).tocsc()
        matrix += FAINT * diags(matrix.diagonal(), format="csc")
        solver = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        found: np.ndarray = np.sum(self._force * solver.solve(self._force), axis=0) - self._without
        return found
