"""The differences between two cases, in words."""

from dembound.results.checkpoint import differences


def test_differences_name_both_values_and_what_is_not_given() -> None:
    here = {"run": {"duration": 1.0}, "boundary": {"left": {"type": "free_field"}}, "static": {"stress": None}}
    there = {"run": {"duration": 2.0}, "boundary": {}, "static": {"stress": [1.0, 0.0, 0.0]}}

    assert differences(here, here) == []
    assert differences(here, there) == [
        "run.duration: is 1.0 here, and 2.0 there",
        'boundary.left: is {"type": "free_field"} here, and not given there',
        "static.stress: is not given here, and [1.0, 0.0, 0.0] there",
    ]
