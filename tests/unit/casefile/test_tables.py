"""Keys that are varied: lists and ranges."""

import pytest
from pydantic import ValidationError

from dembound.casefile.tables import Chart, Sweep, range_of


def test_ranges_include_both_ends_and_other_values_are_none() -> None:
    ranges = {"1:4": [1, 2, 3, 4], "7:7": [7], "-2:2:2": [-2, 0, 2], "0:10:4": [0, 4, 8]}
    assert {text: range_of(text) for text in ranges} == ranges
    for value in ("1", "1:", "1:2:3:4", "1.5:2", "a:b", 3, [1, 2], True):
        assert range_of(value) is None
    for text in ("4:1", "1:4:0", "1:1000000"):
        with pytest.raises(ValueError, match=text):
            range_of(text)


@pytest.mark.parametrize("table", [Chart, Sweep])
def test_lists_are_found_by_dotted_key(table) -> None:
    found = table(vary={"packing": {"seed": "1:3", "radius": [0.25]}, "run.safety": [0.5, 0.9]})
    assert found.vary == {"packing.seed": [1, 2, 3], "packing.radius": [0.25], "run.safety": [0.5, 0.9]}


@pytest.mark.parametrize("values", [0.5, [], "many", "3:1"])
def test_what_is_no_list_is_refused(values) -> None:
    with pytest.raises(ValidationError, match=r"must have a list of values|range without a number"):
        Sweep(vary={"run.safety": values})
