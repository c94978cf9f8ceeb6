"""Places between nodes: sums of their motion."""

import numpy as np

from dembound.motion.between import Between


def test_displacement_and_velocity_are_the_same_sum_over_nodes() -> None:
    rng = np.random.default_rng(3)
    share, record = rng.normal(size=(4, 3, 3)), rng.normal(size=(7, 4, 6))
    share[:, :, 2] = 0.0  # rotations do not count
    place = Between(np.zeros(2), np.arange(4), share)
    expected = [
        np.concatenate([sum(share[k] @ row[k, :3] for k in range(4)), sum(share[k] @ row[k, 3:] for k in range(4))])
        for row in record
    ]

    np.testing.assert_allclose(place.motion(record), expected, rtol=1e-12)
    record[:, :, [2, 5]] = np.nan  # of nodes that have none
    np.testing.assert_allclose(place.motion(record), expected, rtol=1e-12)


def test_the_sum_has_the_same_bits_for_any_number_of_steps() -> None:
    rng = np.random.default_rng(4)
    place = Between(np.zeros(2), np.arange(25), rng.normal(size=(25, 3, 3)))
    record = rng.normal(size=(40, 25, 6))
    whole = place.motion(record)

    for first, last in ((0, 1), (1, 8), (8, 40)):
        assert place.motion(record[first:last]).tobytes() == whole[first:last].tobytes()
