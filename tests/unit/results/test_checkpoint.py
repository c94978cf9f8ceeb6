"""What a settled state that another run kept must have in common with the run that takes it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.results.checkpoint import Checkpoint, settled_state
from dembound.version import __version__

KEYS: dict[str, Any] = {"packing": {"seed": 1}, "outside": {"element": 5.0, "margin": None}, "outside_rows": [5.0, 5.0]}
"""Keys of a stage beside a continuum."""


def test_elements_that_follow_from_the_waves_are_named_in_one_line(tmp_path: Path) -> None:
    facts = {"version": __version__, "name": "rest", "keys": KEYS}
    Checkpoint(facts, {"displacement": np.zeros((3, 2))}).write(tmp_path / "rest.npz")
    assert list(settled_state(tmp_path, "rest", KEYS)) == ["displacement"]
    finer = KEYS | {"outside": {"element": 4.0, "margin": 2}, "outside_rows": [4.0, 4.0, 4.0]}
    for keys, lines in (
        (KEYS | {"packing": {"seed": 2}}, ["packing.seed: is 2 here, and 1 there"]),
        (finer, ["outside.margin: is 2 here, and not given there", "outside.element: elements, which settle too,"]),
    ):
        with pytest.raises(CaseError) as error:
            settled_state(tmp_path, "rest", keys)
        head, *found = error.value.problems
        assert head.endswith("has settled another body")
        assert [line[: len(start)] for line, start in zip(found, lines, strict=True)] == lines
    assert "they are of 4 m here, 5 m there" in found[-1]
