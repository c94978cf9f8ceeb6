"""No error text of a library is shown, whatever value a key has."""

import re
from functools import reduce
from operator import getitem
from typing import Any

import pytest
import tomli_w
from small_cases import problems_of

from dembound.casefile.messages import allowed, counted, show

FULL: dict[str, Any] = {
    "title": "full",
    "packing": {"pattern": "A", "size": [10.0, 5.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1e3, "kratio": 1.0, "damp": 0.1, "law": "linearpbond"}
    | {"pb_ten": 1e6, "pb_coh": 2e6, "pb_fa": 30.0, "locked_in": 1e6, "geometry": "reference", "elastic_start": True},
    "motion": {"held": ["y"]},
    "boundary": {"left": {"type": "viscous_input", "wave_p": "w", "beta_p": 1.0}, "right": {"type": "fixed"}},
    "static": {"stress": [0.0, 0.0, 1.0], "ratio": 1e-4, "damp": 0.5, "max_steps": 10}
    | {"boundary": {"left": {"type": "fixed"}, "bottom": {"type": "roller"}}},
    "wave": {
        "w": {"type": "cosine", "amplitude": 1.0, "period": 1.0, "start": 0.0},
        "s": {"type": "sine_burst", "amplitude": 1.0, "frequency": 1.0, "cycles": 2, "taper": True},
    },
    "load": [
        {"name": "a", "force": [1.0, 0.0], "region": [0.0, 0.0, 1.0, 1.0], "wave": "w"},
        {"name": "b", "acceleration": [1.0, 0.0], "position": [0.0, 0.0]},
    ],
    "monitor": [{"name": "a", "position": [0.0, 0.0]}],
    "run": {"duration": 1.0, "time_step": 0.1, "safety": 0.5},
    "output": {"history_interval": 0.0, "energy_interval": 0.0, "snapshots": 1, "pictures": False},
}

# of every TOML kind one that is wrong nearly everywhere
WRONG: list[Any] = [-7, -7.5, 10**30, float("nan"), True, "", "wrong", [], [1], ["x", "x"], {}, {"a": 1}]


def keys(table: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Paths of all keys in nested tables, tables included."""
    inner = table.items() if isinstance(table, dict) else enumerate(table) if isinstance(table, list) else ()
    return [path, *(below for key, value in inner for below in keys(value, (*path, key)))]


def replaced(table: Any, path: tuple[Any, ...], value: Any) -> Any:
    """A copy with the value at the path replaced."""
    if not path:
        return value
    copy = dict(table) if isinstance(table, dict) else list(table)
    copy[path[0]] = replaced(table[path[0]], path[1:], value)
    return copy


def problems(data: dict[str, Any]) -> list[str]:
    return problems_of(tomli_w.dumps(data))


PATHS = keys(FULL)[1:]
ONE_OF_EACH = {(path[0], type(reduce(getitem, path, FULL))): path for path in PATHS}.values()
"""One path to a value of each type in a table; the others are a slow sweep."""


@pytest.mark.parametrize(
    "path",
    [path if path in ONE_OF_EACH else pytest.param(path, marks=pytest.mark.slow) for path in PATHS],
    ids=str,
)
def test_whatever_is_put_anywhere_is_answered_about_that_place(path: tuple[Any, ...]) -> None:
    refused = [found for value in WRONG if (found := problems(replaced(FULL, path, value)))]

    for found in refused:
        for line in found:
            assert re.match(r"[a-z_.0-9]+(\[\d+(, \w*)?\](\.\w+)?)?: \S", line)
            assert not re.search(r"pydantic|Input should|Field required|\bNone\b|value_error|https?:", line)
        # the table itself, or one that refers to its wave
        assert any(line.startswith(str(path[0])) or '"w"' in line for line in found)
    # a title may be any text and a time any positive number, but nothing takes half of the list
    assert len(refused) > len(WRONG) // 2


def test_values_are_shown_as_the_file_spells_them() -> None:
    assert [show(value) for value in (1.5, -2, True, 'a"ü', [1, "b"], {"a": 1}, float("nan"), 1e-5)] == [
        *("1.5", "-2", "true", '"a\\"ü"', '[1, "b"]', "a table", "nan", "1e-05")
    ]
    assert show("x" * 100) == '"' + "x" * 56 + "..."
    assert [counted(count, "disk") for count in (0, 1, 1200)] == ["0 disks", "1 disk", "1,200 disks"]
    assert allowed({"type": "string", "minLength": 1}) == "a text no shorter than 1"
