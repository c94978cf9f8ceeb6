"""Places between nodes: sums of their motion."""

import numpy as np

from dembound.motion.scene import Between


def test_displacement_and_velocity_are_the_same_sum_over_nodes_with_the_same_bits_for_any_number_of_steps() -> None:
    rng = np.random.default_rng(3)
    share, record = rng.normal(size=(25, 3, 3)), rng.normal(size=(40, 25, 6))
    record[:, :, [2, 5]] = np.nan  # rotations of nodes that have none do not count
    share[:, :, 2] = 0.0
    place, plain = Between(np.zeros(2), np.arange(25), share), np.nan_to_num(record)
    motions = np.stack([plain[..., :3], plain[..., 3:]], axis=1)  # displacements and velocities
    expected = np.einsum("kab,tmkb->tma", share, motions).reshape(40, 6)
    whole = place.motion(record)

    np.testing.assert_allclose(whole, expected, rtol=1e-11)
    for first, last in ((0, 1), (1, 8), (8, 40)):
        assert place.motion(record[first:last]).tobytes() == whole[first:last].tobytes()
