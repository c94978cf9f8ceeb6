"""The springs of closed joints as built, for the step limit of a scene."""

from collections.abc import Callable, Sequence

import numpy as np

from dembound.disks.faces.found import Faces, in_series

Filling = Callable[[np.ndarray, np.ndarray], None]


def filling_springs(faces: Sequence[Faces], positions: np.ndarray, slot: np.ndarray) -> Filling:
    """A function that adds the forces of closed joints at displacements u (3, slots) to force (3, slots).

    positions : (n, 2) m of the disks; slot : (n,) of each.
    """
    each = []
    for one in faces:
        disks, modes, lengths, (left, right) = springs_of(one, positions)
        stiffness = in_series(one.stiffness[:, left], one.stiffness[:, right]).ravel()
        each.append((slot[disks], modes, lengths * stiffness))

    def fill(u: np.ndarray, force: np.ndarray) -> None:
        for disks, modes, stiffness in each:
            pull = -stiffness * np.einsum("kec,cke->k", modes, u[:, disks])
            np.add.at(force.T, disks, modes * pull[:, None, None])

    return fill


def springs_of(faces: Faces, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Both disks (k, 2) of k springs, modes (k, 2, 3) that stretch them by 1 m or rad, length (k,) m of their overlap.

    The springs along the normal come before those along the line. And both faces (2, k/2) of each of these halves.
    """
    left, right = np.arange(faces.split), np.arange(faces.split, len(faces.disk))
    along = faces.along[left, None] + faces.along[None, right]
    along /= np.sqrt(np.sum(along**2, axis=-1, keepdims=True))
    begin = faces.ends[left, 0][:, None, None]
    ends = [np.sum((faces.ends[own] - begin) * along[:, :, None], axis=-1) for own in (left[:, None], right[None])]
    low = np.maximum(ends[0][..., 0], ends[1][..., 0])
    high = np.minimum(ends[0][..., 1], ends[1][..., 1])
    one, other = np.nonzero(high > low)
    length, t = (high - low)[one, other], along[one, other]
    middle = faces.ends[one, 0] + 0.5 * (low + high)[one, other][:, None] * t
    normal = np.stack([-t[:, 1], t[:, 0]], axis=1)
    both = np.stack([faces.disk[one], faces.disk[faces.split + other]], axis=1)
    modes = np.empty((2, len(one), 2, 3))
    for way, own in enumerate((normal, t)):
        for end, sign in enumerate((1.0, -1.0)):
            arm = middle - positions[both[:, end]]
            modes[way, :, end, :2] = sign * own
            modes[way, :, end, 2] = sign * (arm[:, 0] * own[:, 1] - arm[:, 1] * own[:, 0])
    faces_of_pairs = np.stack([one, faces.split + other])
    return np.tile(both, (2, 1)), modes.reshape(-1, 2, 3), np.tile(length, 2), faces_of_pairs
