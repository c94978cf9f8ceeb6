"""What runs, checks and reports ask of bars."""

import h5py
import numpy as np
import pytest

from dembound.bar.kind import Bars
from dembound.errors import CaseError
from dembound.running import preflight


def test_a_bar_begins_at_rest_as_built(spalling) -> None:
    scene = Bars().build(spalling())
    step, limit = Bars().choose_step(scene)
    beginning = Bars().begin(scene, step, lambda steps, ratio: pytest.fail("nothing settles"))

    assert 0.0 < step <= limit
    assert beginning.datum is None
    assert beginning.stages == ()
    assert beginning.summary is None
    (part,) = beginning.system.parts
    assert part.bonds.alive > 0
    assert not any(beginning.system.stored(np.zeros((3, scene.count))))


def test_what_would_stop_a_run_is_found_before_it(spalling) -> None:
    with pytest.raises(CaseError, match=r"run\.courant"):
        preflight(spalling({"run.courant": 2.0}))
    preflight(spalling())


def test_a_short_trial_shows_a_whole_run(spalling) -> None:
    assert Bars().not_estimated(spalling()) == []


def test_stress_is_drawn_where_there_are_monitors(spalled_run, tmp_path) -> None:
    unwatched = tmp_path / "run.h5"
    unwatched.write_bytes(spalled_run.read_bytes())
    with h5py.File(unwatched, "r+") as file:
        del file["histories/gauge"]

    assert [name for name, _ in Bars().pictures(spalled_run)] == ["scene", "histories_stress"]
    assert [name for name, _ in Bars().pictures(unwatched)] == ["scene"]


def test_a_field_is_drawn_that_a_bar_has(spalled_run) -> None:
    assert len(Bars().field_picture(spalled_run, "damage", None).axes) > 0
    with pytest.raises(CaseError):
        Bars().field_picture(spalled_run, "stress_xx", None)
