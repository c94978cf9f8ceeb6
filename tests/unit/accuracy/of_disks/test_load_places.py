"""Where loads start waves."""

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.accuracy.of_disks.load_places import middle_of_loads
from dembound.disks.scene import build


def test_places_are_seen_from_the_middle_of_the_loads_by_their_force() -> None:
    """Of 1 at (2.5, 1) and 3 at (6.5, 1): (5.5, 1); a pressure counts from the middle of its hole."""
    loads = [
        {"name": "a", "force": [1e5, 0.0], "region": [2.0, 0.5, 3.0, 1.5], "wave": "push"},
        {"name": "b", "force": [0.0, -3e5], "region": [6.0, 0.5, 7.0, 1.5], "wave": "push"},
    ]
    cave = {"name": "cave", "type": "rectangle", "corners": [4.0, 0.5, 6.0, 1.5]}
    blast = {"name": "c", "pressure": 1e5, "hole": "cave", "wave": "push"}
    free = {"boundary": {}}

    def middle(**changes: object) -> np.ndarray | None:
        return middle_of_loads(build(small(PUSHED, changes=changes)))  # type: ignore[arg-type]

    assert middle(load=loads, **free) == pytest.approx(np.array([5.5, 1.0]))
    assert middle(load=[blast], hole=[cave], **free) == pytest.approx(np.array([5.0, 1.0]))
    assert middle() is None  # driven


def test_loads_that_a_body_rests_under_start_no_waves() -> None:
    foot = {"name": "foot", "force": [0.0, -1e6], "region": [2.0, 0.5, 3.0, 1.5]}
    hit = {"name": "hit", "force": [1e5, 0.0], "region": [6.0, 0.5, 7.0, 1.5], "wave": "push"}
    at_rest = {"load": [foot, hit], "boundary": {}, "static": {"boundary": {"bottom": {"type": "fixed"}}}}
    assert middle_of_loads(build(small(PUSHED, changes=at_rest))) == pytest.approx(np.array([6.5, 1.0]))  # type: ignore[arg-type]
    sudden = {"load": [foot, hit], "boundary": {}}
    found = middle_of_loads(build(small(PUSHED, changes=sudden)))  # type: ignore[arg-type]
    assert found == pytest.approx(np.array([(10 * 2.5 + 6.5) / 11, 1.0]))
