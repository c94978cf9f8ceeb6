"""A laboratory test from Python: what it returns, and a test that is stopped and continued."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from recorded import contents
from small_cases import PUSHED, small

import dembound
from dembound.errors import CaseError
from dembound.results.recording import LoadingCurve
from dembound.studies.laboratory import study
from dembound.studies.sweep import perform

STRENGTH = 5e5
LATTICE = {name: table for name, table in PUSHED.items() if name != "monitor"} | {
    "packing": {"pattern": "A", "size": [4.0, 8.0], "radius": 0.25},
    "material": {"density": 2500.0, "law": "linearpbond", "emod": 0.0, "pb_emod": 2e9, "pb_ten": STRENGTH},
}
"""Square cells that are pulled until one row of bonds tears."""


def test_a_stopped_test_is_continued_to_the_same_bits(tmp_path, monkeypatch) -> None:
    case, seen = small(LATTICE, "rock"), []
    whole = dembound.laboratory_test(case, "tension", tmp_path / "whole", seeds=1)

    def stop_midway(self, run, steps) -> None:
        report(self, run, steps)
        if run.time > 0.3 * whole.curves["seed=0"].time[-1]:
            seen.extend(perform.times_in(self._path.parent).values())
            self._path.with_name(self._path.name.replace("begun", "stop")).touch()

    report = perform.Begun.running
    with monkeypatch.context() as patch:
        patch.setattr(perform.Begun, "running", stop_midway)
        with pytest.raises(KeyboardInterrupt, match="rock: stopped; the same call continues what is left"):
            dembound.laboratory_test(case, "tension", tmp_path, seeds=1)
    partial = tmp_path / "rock_tension/members/seed=0.partial"
    assert (partial / "checkpoint.npz").is_file()
    again = dembound.laboratory_test(case, "tension", tmp_path, seeds=1)

    records = [found.record(found.done[0]) for found in (again, whole)]
    assert contents(records[0]) == contents(records[1])
    assert (again.folder / "test.csv").read_bytes() == (whole.folder / "test.csv").read_bytes()
    assert len(json.loads(records[0].with_name("summary.json").read_text())["resumed"]) == 1
    # its time and its checkpoint are of a run under way
    assert 0.0 < min(seen) <= whole.curves["seed=0"].time[-1]
    assert not perform.times_in(again.folder)
    assert {path.name for path in records[0].parent.iterdir()} == {"run.h5", "summary.json", "paraview"}

    strength = whole.statistic("strength")
    assert (strength.count, strength.mean) == (1, pytest.approx(STRENGTH, rel=0.01))
    assert whole.curves["seed=0"].strength == strength.mean
    assert list(whole.warnings) == []
    with pytest.raises(CaseError, match='quantity: is "strenght", must be one of strength'):
        whole.statistic("strenght")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"test": "ucx"}, "test: is ucx, must be one of ucs, tension, brazilian, biaxial"),
        ({"test": "biaxial", "pressures": [1e6, -1.0]}, "--pressures: is 1e.06,-1, must be different"),
        ({"rate": 0.0}, "--rate: is 0, must be more than 0"),
    ],
)
def test_what_a_test_cannot_be_made_of(words, message, tmp_path) -> None:
    with pytest.raises(CaseError, match=message):
        dembound.laboratory_test(small(LATTICE, "rock"), results=tmp_path, **{"test": "ucs", "seeds": 1} | words)
    assert not list(tmp_path.iterdir())


def test_what_makes_curves_doubtful() -> None:
    time, strain = np.linspace(0.0, 1.0, 101), np.linspace(0.0, 0.01, 101)
    rising = {"kind": "biaxial", "time": time, "pressure": 1e6, "strain": strain, "stress": 1e6 + 1e9 * strain}
    middle = {"gauge_time": time, "axial": strain, "lateral": strain}
    intact = LoadingCurve(**rising, **middle, crack_time=np.zeros(0), crack_shear=np.zeros(0))
    past = replace(intact, stress=np.where(strain < 0.008, rising["stress"], 1e6), crack_time=time[40:41])

    def warned(*curves: LoadingCurve, limit: float = 1.0) -> list[str]:
        sample = SimpleNamespace(warnings=(), test="biaxial", rate_limit=lambda strain: limit)
        named = {f"s{number}": curve for number, curve in enumerate(curves)}
        return list(study.Tested.warnings.fget(SimpleNamespace(sample=sample, envelopes={0: None}, curves=named)))

    assert warned(past) == []
    assert warned(replace(past, before=3)) == ["bonds broke under the pressure alone, before the test, in s0"]
    assert warned(*[intact] * 5) == ["no peak in s0, s1, s2 and 2 more: no bond broke"]
    (level,) = warned(replace(intact, crack_time=time[:1]))
    assert level == "no peak in s0: the stress was still rising or level at the end"
    assert [line[:36] for line in warned(past, limit=0.001)] == ["strain rate 0.01 1/s is above 0.001 "]
