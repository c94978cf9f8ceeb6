"""Parts of histories, and which monitors count."""

import numpy as np

from dembound.formulas.history import History, loud

TIME = np.linspace(0.0, 1.0, 11)


def history(x: float, y: float) -> History:
    """A motion that grows with these speeds along x and y, and turns faster."""
    motion = np.outer(TIME, [x, y, 9.0])
    return History.of(np.zeros(2), TIME, motion, 2.0 * motion, 3.0 * TIME)


def test_parts_end_at_a_time_and_all_quantities_are_known_at_other_times() -> None:
    found = history(1.0, 2.0)
    assert found.until(0.5).time[-1] == TIME[5]
    assert found.before(0.5).time[-1] == TIME[4]
    assert len(found.before(0.5).values["stress"]) == 5
    assert found.until(1.0) is found
    found = history(1.0, 2.0).at(np.array([0.05, 0.95]))
    np.testing.assert_allclose(found.displacement[:, :2], [[0.05, 0.1], [0.95, 1.9]])
    np.testing.assert_allclose(found.values["stress"], [[0.15], [2.85]])


def test_monitors_below_a_hundredth_of_the_loudest_do_not_count() -> None:
    sizes = {"loud": -2.0, "just": 0.0201, "quiet": 0.0199}
    plain = {name: History(np.zeros(2), TIME, {"velocity": size * TIME[:, None]}) for name, size in sizes.items()}
    still = History(np.zeros(2), TIME, {})
    assert loud(plain | {"none": still}, "velocity") == ["loud", "just"]
