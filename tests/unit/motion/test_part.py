"""Bonds that broke, as lists: some of them, and several lists as one."""

import numpy as np

from dembound.motion.part import NO_CRACKS, Cracks, joined


def test_cracks_among_some_particles_are_numbered_as_these() -> None:
    pairs = np.array([(4, 7), (2, 4), (7, 9), (2, 9)])
    cracks = Cracks(np.arange(4), pairs, np.arange(8.0).reshape(4, 2), np.array([True, False, False, True]))
    left = cracks.among(np.array([2, 7, 9]))

    assert left.pair.tolist() == [[1, 2], [0, 2]]
    assert left.step.tolist() == [2, 3]
    assert left.position.tolist() == [[4.0, 5.0], [6.0, 7.0]]
    assert left.shear.tolist() == [False, True]


def test_lists_are_joined_in_the_order_of_their_steps() -> None:
    first, second = (
        Cracks(np.array(steps), np.full((2, 2), name), np.full((2, 2), float(name)), np.array([True, False]))
        for name, steps in ((1, [3, 7]), (2, [3, 5]))
    )
    both = joined([first, NO_CRACKS, second])

    # of one step in the order of the lists
    assert both.step.tolist() == [3, 3, 5, 7]
    assert both.pair.tolist() == [[1, 1], [2, 2], [2, 2], [1, 1]]
    assert both.position.tolist() == [[1.0, 1.0], [2.0, 2.0], [2.0, 2.0], [1.0, 1.0]]
    assert both.shear.tolist() == [True, True, False, False]
    assert len(joined([])) == 0
