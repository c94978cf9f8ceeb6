"""A scene gets as many threads as it is worth, and no more than are allowed."""

import numba

from dembound.motion.memory import PARTICLES_PER_THREAD, thread_count_for, threads_for


def test_small_scenes_get_one_thread_and_the_allowance_comes_back(monkeypatch) -> None:
    asked = []
    monkeypatch.setattr(numba, "get_num_threads", lambda: 4)
    monkeypatch.setattr(numba, "set_num_threads", asked.append)
    with threads_for(3 * PARTICLES_PER_THREAD - 1):
        assert asked == [2]

    assert asked == [2, 4]
    assert [thread_count_for(n * PARTICLES_PER_THREAD) for n in (0, 1, 3, 9)] == [1, 1, 3, 4]
