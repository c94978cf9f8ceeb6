"""Bars as a kind of body, for runs, checks and reports."""

import h5py
import pytest

from dembound.errors import CaseError
from dembound.kinds.bar.kind import Bars
from dembound.running import preflight


def test_what_would_stop_a_run_is_found_before_it(spalling) -> None:
    with pytest.raises(CaseError, match=r"run\.courant"):
        preflight(spalling({"run.courant": 2.0}))
    preflight(spalling())


def test_what_a_bar_has_is_drawn(spalled_run, tmp_path) -> None:
    assert len(Bars().field_picture(spalled_run, "damage", None).axes) > 0
    with pytest.raises(CaseError):
        Bars().field_picture(spalled_run, "stress_xx", None)
    unwatched = tmp_path / "run.h5"
    unwatched.write_bytes(spalled_run.read_bytes())
    with h5py.File(unwatched, "r+") as file:
        del file["histories/gauge"]

    assert [name for name, _ in Bars().pictures(spalled_run)] == ["scene", "histories_stress"]
    assert [name for name, _ in Bars().pictures(unwatched)] == ["scene"]
