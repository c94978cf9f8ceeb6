"""Numbers beyond the range of computation cause one line before anything is built."""

import math

import pytest
import tomli_w
from small_cases import PUSHED, SPALLING, SURROUNDED, Tables, problems_of, small

from dembound.casefile.disks.layer import MOST_ELEMENTS
from dembound.errors import CaseError
from dembound.kinds import with_changes
from dembound.machine import Memory
from dembound.motion import memory
from dembound.running import plan
from dembound.waves.wave import LATEST


def problems(tables: Tables) -> list[str]:
    return problems_of(tomli_w.dumps(tables))


def test_a_count_beyond_all_need_is_one_line() -> None:
    many = 2**31
    for tables, line in (
        (SURROUNDED | {"outside": {"layers": many}}, f"outside.layers: is {many}, must be at most {MOST_ELEMENTS}"),
        (PUSHED | {"output": {"snapshots": many}}, f"output.snapshots: is {many}, must be at most 10000"),
        (SPALLING | {"load": [SPALLING["load"][0] | {"nodes": many}]}, f"load[1, hit].nodes: is {many}, must be at"),
    ):
        (found,) = problems(tables)
        assert found.startswith(line)


def test_elements_for_which_there_is_no_memory_are_refused_before_they_are_made(monkeypatch) -> None:
    monkeypatch.setattr(memory, "memory_here", lambda: Memory(8e9, 8e9))
    case = small(SURROUNDED | {"outside": {"element": 3.0, "order": 3, "margin": 1000, "layers": 1000}})
    # (4 + 2·2000)(2 + 2000) elements of nine nodes
    with pytest.raises(CaseError, match=r"outside: 72 disks and 7.2\de\+07 nodes of the continuum .* of memory"):
        plan(case)


@pytest.mark.parametrize("value", [math.inf, math.nan])
def test_a_number_that_is_not_finite_is_refused_in_the_values_of_other_keys(value: float) -> None:
    choice = {"choice": [{"name": "c", "set": {"packing.size": [10.0, 0.0]}}]}
    for tables, place in (
        ({"chart": choice}, "chart.choice[1, c].set: packing.size"),
        ({"chart": {"vary": {"run.safety": [0.5, 0.0]}}}, "chart.vary: run.safety"),
        ({"sweep": {"vary": {"run.safety": [0.5, 0.0]}}}, "sweep.vary: run.safety"),
    ):
        text = tomli_w.dumps(PUSHED | tables).replace("0.0,\n]", f"{value},\n]")
        assert problems_of(text) == [f"{place} is {value:g}, must be finite"]
    for key in ("run.duration", "packing.radius", "material.density", "wave.push.period", "chart.repeats"):
        with pytest.raises(CaseError):
            with_changes(small(PUSHED), {key: value})


def test_a_wave_that_rounding_would_change_is_refused() -> None:
    for share, late in ((0.99, False), (1.01, True)):
        start = share * LATEST * 0.01  # its period
        found = problems(PUSHED | {"wave": PUSHED["wave"] | {"push": PUSHED["wave"]["push"] | {"start": start}}})
        assert [line.partition(", must be at most")[0] for line in found] == late * [f"wave.push.start: is {start:g}"]


def test_names_and_titles_do_not_reorder_text() -> None:
    for hidden in ("\u202e", "\u200b"):
        (found,) = problems(PUSHED | {"title": f"a{hidden}b"})
        assert found.startswith("title: is ")
        assert hidden not in found
        (found,) = problems(PUSHED | {"monitor": [{"name": f"a{hidden}b", "position": [1.0, 1.0]}]})
        assert hidden not in found
    assert problems(PUSHED | {"title": "Grundgebirge, 岩石, скала, صخر, σ = ρc²"}) == []
