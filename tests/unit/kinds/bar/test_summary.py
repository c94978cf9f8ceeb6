"""Entries of a bar's summary, and its results in words."""

import json
from pathlib import Path

import h5py
import numpy as np
import pytest

from dembound.bar.fracture import Spall, spalls
from dembound.gauge.peaks import first_fall
from dembound.kinds.bar import summary
from dembound.kinds.bar.summary import LATER_SPALLS, bar_outcome, part_of, summarise_bar
from dembound.motion.energy import Ledger
from dembound.motion.kind import Beginning, Plan
from dembound.motion.simulation import Simulation
from dembound.results.recorder import Recorder
from dembound.results.recording import Histories
from dembound.results.summary import summarise
from dembound.running import plan


@pytest.fixture
def run(spalling, tmp_path):
    """Runs the spalling bar with keys changed: its plan, simulation and record."""

    def make(**changes: object):
        planned = plan(spalling(changes))
        simulation = Simulation(planned.scene, planned.time_step, planned.scene.probes)
        path: Path = tmp_path / "run.h5"
        ledger = Ledger(simulation, planned.steps - 1)
        with Recorder(path, simulation, planned.step_limit, ledger=ledger) as recorder:
            simulation.track(Histories(recorder), ledger)
            simulation.run(planned.steps)
        return planned, simulation, path

    return make


def summary_of(planned: Plan, simulation: Simulation, path: Path) -> dict:
    """The summary of a run that took a second."""
    common = summarise(planned, simulation, path, {"step": 1.0})
    return common | planned.kind.summarise(planned.scene, simulation, Beginning(simulation.system), path)


def test_the_summary_of_a_bar_is_plain_json_with_the_spalls_of_its_bonds(run, monkeypatch) -> None:
    planned, simulation, path = run()
    found = json.loads(json.dumps(summary_of(planned, simulation, path), allow_nan=False))

    assert (found["name"], found["nodes"], found["steps"]) == ("spalling", 41, 60)
    assert found["method"] == {"type": "peridynamics", "horizon": 3, "corrected_ends": False}
    assert found["courant"] == pytest.approx(1.0, rel=1e-12)
    assert found["laws"] == [{"law": "peridynamics, m = 3", "from": 0.0}]
    # the books close to rounding: 60 steps of sums over 41 nodes
    assert found["energy"]["relative_error"] < 60 * 41 * np.finfo(float).eps

    bonds = part_of(simulation).bonds
    expected = spalls(bonds, planned.scene.positions[:, 0], planned.time_step)
    assert found["spalls"] == [spall.describe() for spall in expected]
    # tension comes once crest and tail, 0.4 m apart, have met at the far end
    assert expected[0].time > 1e-3
    assert found["cracks"] == {"tension": len(bonds.breaks(0)[0]), "shear": 0}
    for count in (0, 1, 2):  # those after the first are not to be relied on
        monkeypatch.setattr(summary, "spalls", lambda *_, n=count: n * [Spall(1e-3, (0.9, 0.9), (0.9, 0.9))])
        note = summarise_bar(planned.scene, simulation, path)["spalls_note"]
        assert note == (LATER_SPALLS if count > 1 else None)


@pytest.mark.parametrize("held", [{"type": "fixed"}, {"type": "velocity", "wave_p": "still"}], ids=["fixed", "moved"])
def test_a_bar_torn_off_the_end_that_holds_it_has_not_spalled(run, held: dict) -> None:
    # tension, which an end that is held doubles: the bar breaks there at the latest
    pull = {"name": "pull", "pressure": -6e6, "nodes": 3, "wave": "hit"}
    still = {"wave.still": {"type": "constant", "amplitude": 1e-9, "start": 0.0}} if "wave_p" in held else {}
    planned, simulation, path = run(**{"boundary.right": held, "load": [pull], **still})
    found = summary_of(planned, simulation, path)

    assert found["spalls"] == []
    assert list(found["breaks_at_ends"]) == ["right"]
    assert found["breaks_at_ends"]["right"]["start"][1] == 1.0
    # the front is there at 1 ms
    assert found["breaks_at_ends"]["right"]["time"] > 1e-3


def gauges(*places: float) -> dict:
    return {"monitor": [{"name": f"at-{place:g}", "position": place} for place in places]}


@pytest.mark.parametrize(("side", "free", "outwards"), [("left", 1.0, 1.0), ("right", 0.0, -1.0)])
def test_pull_back_is_that_of_a_free_end_beyond_a_spall(run, side: str, free: float, outwards: float) -> None:
    hit = {"name": "hit", "pressure": 12e6, "nodes": 3, "wave": "hit", "side": side}
    planned, simulation, path = run(**gauges(0.0, 0.5, 1.0), load=[hit], **{"run.duration": 2e-3})
    with h5py.File(path) as file:
        velocity = file[f"histories/at-{free:g}/velocity"][:, 0]

    # ½ρc of how far the velocity falls; the loaded end and the middle tell nothing of it
    found = summarise_bar(planned.scene, simulation, path)["pull_back_strength"]
    assert found == {f"at-{free:g}": 0.5 * 2500.0 * 1000.0 * first_fall(outwards * velocity)}


def outcome(spalls: list[dict], note: str | None = None, **more) -> list[str]:
    summary = {
        "laws": [{"law": "finite differences", "from": 0.0}],
        "spalls": spalls,
        "breaks_at_ends": {},
        "spalls_note": note,
        "bar": {"strength": 1e7},
        "energy": {"crack": 0.0, "supplied": 1.0, "relative_error": 0.0},
    }
    return bar_outcome(summary | more)


@pytest.mark.parametrize(("count", "lines", "last"), [(3, 3, "spall at"), (4, 4, "and 1 more"), (12, 4, "and 9 more")])
def test_of_many_spalls_the_first_are_reported(count: int, lines: int, last: str) -> None:
    facts = outcome([{"start": [0.1 * n, 0.1 * n], "time": 1e-3} for n in range(count)])
    assert facts[:3] == [f"spall at {place} m, 1 ms" for place in ("0", "0.1", "0.2")]
    assert len(facts) == lines
    assert facts[-1].startswith(last)


def test_a_bar_that_comes_off_an_end_that_holds_it_has_not_spalled() -> None:
    off = {"right": {"start": [1.99, 2.0], "end": [1.99, 2.0], "time": 7.41e-4}}
    ends = {"left": {"type": "free"}, "right": {"type": "fixed"}}
    assert outcome([], breaks_at_ends=off, boundaries=ends) == ["broke at the right end (fixed), 741 µs"]


@pytest.mark.parametrize(
    ("supplied", "said"), [(40.0, "5 % of the supplied energy"), (0.0, "energy though none came in")]
)
def test_energy_added_by_breaks_is_a_share_of_what_was_supplied_if_anything_was(supplied: float, said: str) -> None:
    (_, line) = outcome([], energy={"crack": -2.0, "supplied": supplied, "relative_error": 0.0})
    assert line == f"bonds broke within single steps, adding {said}, take a smaller bar.spacing or run.courant"
