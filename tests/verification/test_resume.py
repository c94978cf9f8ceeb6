"""A run that is stopped at any step and resumed has the same record and summary, to the bit, as one that is not.

It goes on from its state alone: arrays by name, which all kinds of runs are cut and rebuilt from in memory, and a
checkpoint in a file, which is tried with a few of them.
"""

import json
import re
from functools import partial

import h5py
import numpy as np
import pytest
from recorded import contents
from small_cases import DROPPED, GRAINS, PULLED, small

from dembound.check import check
from dembound.errors import CaseError
from dembound.interrupts import Stopped
from dembound.kinds import kind_of
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.results.checkpoint import Checkpoints
from dembound.results.folder import Folder
from dembound.running import job, preflight, resume_case, run_case
from dembound.running.recorded import recorded_beginning, recorded_case

PACKING, MATERIAL, INPUT = GRAINS["packing"], GRAINS["material"], GRAINS["boundary"]["bottom"]
BRITTLE = MATERIAL | {"law": "linearpbond", "pb_ten": 3e5, "pb_coh": 6e5, "fric": 0.3}
LATTICE = {"pattern": "A", "size": [8.0, 4.0], "radius": 0.25}
FREE_FIELD = {side: {"type": "free_field"} for side in ("left", "right")}
SQUEEZED = {"stress": [-1e6, -1e6, 0.0], "ratio": 1e-3}
DISKS = GRAINS | {"output": GRAINS["output"] | {"peaks": True, "contacts": True}}
BAR = PULLED | {"boundary": {"right": {"type": "viscous", "beta_p": 0.2}}}
RANGES = {key: value for key, value in PULLED["bar"].items() if key != "length"} | {
    "range": [
        {"name": "pulled", "length": 0.7, "velocity": 1.0},
        {"name": "stiff", "length": 0.2, "spacing": 0.005, "wave_speed": 4000.0, "attenuation": 0.5},
        {"name": "struck", "length": 0.5, "interface": "contact", "gap": 0.0005},
    ]
}
CASES = {
    "damped": DISKS | {"material": MATERIAL | {"damp": 0.1}},
    "settled, elastic": DISKS | {"static": SQUEEZED},
    "rows and symmetry": DISKS
    | {
        "packing": {"pattern": "A", "size": [20.0, 6.0], "radius": 0.5},
        "motion": {"held": ["y"]},
        "boundary": {"left": {"type": "velocity", "wave_p": "pulse"}, "right": {"type": "viscous"}},
    },
    "law changes, bonds break": DISKS
    | {"material": BRITTLE, "motion": {"held": ["y"]}, "boundary": {"left": {"type": "velocity", "wave_p": "pulse"}}},
    "settled, updated": DISKS | {"material": BRITTLE, "static": SQUEEZED},
    "settled layers": DISKS
    | {
        "material": BRITTLE,
        "layer": [{"thickness": 1.7, "density": 2000.0, "p_wave_speed": 600.0}, {"name": "stiff"}],
        "static": {"boundary": {"bottom": {"type": "fixed"}}, "ratio": 1e-2},
        "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    },
    "free field that breaks": DISKS
    | {"packing": LATTICE, "material": BRITTLE, "boundary": FREE_FIELD | {"bottom": INPUT}},
    "ends in silence": DISKS | {"run": {"duration": 0.5, "until": "silent", "silent_level": 0.2}},
    "falls and comes to rest": DROPPED,
    "monitors and loads in a continuum": DISKS
    | {
        "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom")},
        "outside": {"element": 2.0, "margin": 2},
        "load": [{"name": "blow", "force": [1e3, -2e4], "region": [8.0, 3.0, 10.0, 4.0], "wave": "pulse"}],
        "monitor": [*GRAINS["monitor"], {"name": "beside", "position": [-1.0, 2.0]}],
    },
    "stress at rest beside a free field": DISKS
    | {"packing": LATTICE, "material": BRITTLE, "boundary": FREE_FIELD | {"bottom": INPUT}, "static": SQUEEZED},
    "settled box in the ground": DISKS
    | {
        "ground": {"size": [20.0, 20.0]},
        "packing": PACKING | {"origin": [6.0, 8.0]},
        "material": BRITTLE,
        "boundary": {
            **{side: {"type": "outside"} for side in ("left", "right", "top")},
            "bottom": {"type": "outside", "wave_s": "pulse"},
        },
        "outside": {"element": 4.0},
        "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
        "static": {"boundary": {"bottom": {"type": "fixed"}}, "ratio": 1e-2, "k0": 0.5},
        "layer": [
            {"thickness": 9.0, "density": 2000.0, "p_wave_speed": 600.0, "k0": 0.8, "fric": 0.2},
            {"name": "stiff"},
        ],
        "monitor": [{"name": "middle", "position": [10.0, 10.0]}, {"name": "beside", "position": [4.0, 10.0]}],
    },
    "damped by Q, settled beside a free field": DISKS
    | {
        "packing": LATTICE,
        "material": MATERIAL | {"quality_factor": 10.0},
        "boundary": FREE_FIELD | {"bottom": INPUT},
        "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
        "static": {"boundary": {"bottom": {"type": "fixed"}}, "ratio": 1e-2},
    },
    "Rayleigh damping": DISKS
    | {
        "material": MATERIAL | {"quality_factor": 10.0},
        "damping": {"type": "rayleigh"},
        "boundary": FREE_FIELD | {"bottom": INPUT},
    },
    "damped by Q, bonds break": DISKS
    | {
        "packing": LATTICE,
        "material": BRITTLE | {"quality_factor": 10.0, "contact_share": 0.5},
        "boundary": FREE_FIELD | {"bottom": INPUT},
        "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
        "static": {"boundary": {"bottom": {"type": "fixed"}}, "ratio": 1e-2},
    },
    "damped by Q in a continuum": DISKS
    | {
        "material": MATERIAL | {"quality_factor": 10.0},
        "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom")},
        "outside": {"element": 2.0, "margin": 2},
        "load": [{"name": "blow", "force": [1e3, -2e4], "region": [8.0, 3.0, 10.0, 4.0], "wave": "pulse"}],
        "monitor": [*GRAINS["monitor"], {"name": "beside", "position": [-1.0, 2.0]}],
    },
    "membranes, past the peak": DISKS
    | {
        "material": BRITTLE | {"damp": 0.7},
        "boundary": {"top": {"type": "velocity", "hold": ["normal"], "wave_p": "press"}, "bottom": {"type": "roller"}},
        "wave": {"press": {"type": "constant", "amplitude": -0.2, "rise": 0.005}},
        "load": [{"name": "cell", "pressure": 1e5, "sides": ["left", "right", "top"]}],
        "static": {"boundary": {"bottom": {"type": "roller"}}, "ratio": 1e-3},
        "run": {"duration": 1.0, "until": "peak"},
    },
    "on walls that move": DISKS
    | {
        "packing": LATTICE,
        "material": BRITTLE | {"dp_nratio": 0.2},
        "boundary": {},
        "wall": [
            {"name": "floor", "points": [[-9.0, 0.0], [9.0, 0.0], [20.0, -1.0]], "fric": 0.5, "dp_nratio": 0.2},
            {
                "name": "ram",
                "points": [[-0.05, 0.3], [-0.05, 9.0]],
                "wave_x": "pulse",
                "wave_y": "pulse",
                "until": 0.03,
            },
        ],
        "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
        "static": {"ratio": 1e-2},
    },
    "finite differences": BAR | {"method": {"type": "finite_difference"}},
    "switch": BAR | {"method": {"type": "switch", "horizon": 3}},
    "ranges": BAR | {"bar": RANGES},
    "matched layers": BAR
    | {
        "bar": PULLED["bar"] | {"attenuation": 0.5, "strength": 1e9},
        "boundary": {side: {"type": "matched_layer", "nodes": nodes} for side, nodes in (("left", 12), ("right", 8))},
        "method": {"type": "peridynamics", "horizon": 3},
    },
    "cracks that open": BAR
    | {"bar": PULLED["bar"] | {"fracture_energy": 1e4, "strength_per_decade": 1e6, "strength_rates": [0.1, 1e3]}},
}


class Stop(Checkpoints):
    """Stops a run, as a signal does, once it has come to a step: of the run, or of one stage before it."""

    at = 0
    stage: str | None = None
    is_on = False

    def observe(self, run, record) -> None:
        in_stage = getattr(run.system, "_settling", False)
        if Stop.is_on and in_stage == (Stop.stage is not None) and run.state.step >= Stop.at:
            Stop.is_on = False
            self.write(run)
            raise Stopped(2)


@pytest.fixture(autouse=True)
def stopping(monkeypatch) -> None:
    """Runs stop where `Stop` says, as soon as anything is due."""
    Stop.is_on = False
    monkeypatch.setattr(job, "Checkpoints", Stop)


def case_of(name: str, **changes):
    return small(CASES[name] | changes, name)


def stopped(case, folder, step: int, stage: str | None = None):
    """Run a case up to a step of the run, or of a static stage, and stop it there; returns the partial folder."""
    Stop.at, Stop.stage, Stop.is_on = step, stage, True
    with pytest.raises(Stopped):
        run_case(case, folder)
    return Folder(folder, case.name).partial


def summary(folder) -> dict:
    numbers = json.loads((folder / "summary.json").read_text())
    return {key: value for key, value in numbers.items() if key not in {"seconds", "wall_time", "resumed"}} | {
        "particle_steps_per_second": None
    }


@pytest.fixture(scope="module")
def settled(tmp_path_factory):
    """The results of a run that begins with a static stage."""
    return run_case(case_of("settled, updated"), tmp_path_factory.mktemp("settled"))


def test_a_settled_state_is_used_by_another_case(settled, tmp_path) -> None:
    softer = {"bottom": INPUT | {"beta_p": 0.8}, "right": {"type": "viscous"}}
    alone = run_case(case_of("settled, updated", boundary=softer), tmp_path / "alone")
    used = run_case(case_of("settled, updated", boundary=softer, static=SQUEEZED | {"from": str(settled)}), tmp_path)

    assert [name for name in differences(used, alone) if not name.startswith("@")] == []
    assert json.loads((used / "summary.json").read_text())["seconds"]["settle"] < 0.5
    assert not (used / "settled").exists()


def differences(one, other) -> list[str]:
    first, second = contents(one / "run.h5"), contents(other / "run.h5")
    return sorted(name for name in first.keys() | second.keys() if first.get(name) != second.get(name))


LATE = (
    "monitors and loads in a continuum",
    "settled box in the ground",
    "settled layers",
    "stress at rest beside a free field",
    "damped by Q, settled beside a free field",
    "Rayleigh damping",
)
"""Cases whose loops take long to compile, and keep no arrays that none of the others has."""

FILED = ("law changes, bonds break", "cracks that open")
"""Cases whose checkpoints in files are tried; the others with ``-m slow``."""

STEPS, CUTS = 240, (0, 1, 57, 58, 100, 161, 239)
"""Number of steps, and steps at which the run is cut: in between, before and after entries of the ledger, of which
there is one every 57 steps, and steps that follow."""

CHANGING = [name for name, tables in CASES.items() if tables.get("method", {}).get("type") in ("switch", "patch")]
CHANGING += ["law changes, bonds break", "free field that breaks"]
"""Cases in which a law or a method takes over from another one, and bonds break."""

BREAKING = (
    *CHANGING,
    "settled, updated",
    "settled layers",
    "stress at rest beside a free field",
    "finite differences",
    "damped by Q, bonds break",
    "membranes, past the peak",
)


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow) if n in LATE else n for n in CASES])
def test_a_run_cut_and_rebuilt_from_its_arrays_comes_to_the_same_bits(name) -> None:
    case = case_of(name)
    kind = kind_of(case)
    scene = kind.build(case)
    step, probes = kind.choose_step(scene)[0], list(scene.monitors.values())
    beginning = kind.begin(scene, step, lambda *_: None)
    whole = Simulation(scene, step, probes, system=beginning.system, datum=beginning.datum)
    whole.track(Ledger(whole, 57), *kind.trackers(whole))
    kept, records = {}, []
    for cut, end in zip(CUTS, (*CUTS[1:], STEPS), strict=True):
        kept[cut] = whole.state.arrays()
        records.append(whole.advance(end - cut))
    expected, record = whole.state.arrays(), np.concatenate(records)
    for cut, arrays in kept.items():
        again = Simulation(scene, step, probes)
        again.track(Ledger(again, 57), *kind.trackers(again))
        again.state.take(arrays)
        rest = again.advance(STEPS - cut)
        found = again.state.arrays()
        assert rest.tobytes() == record[cut:].tobytes(), f"cut at {cut}: the probes"
        assert found.keys() == expected.keys()
        different = [name for name, values in expected.items() if found[name].tobytes() != values.tobytes()]
        assert not different, f"cut at {cut}: {different}"

    cracks = sum(len(values) for name, values in expected.items() if name.endswith("crack_step"))  # of disks
    broken = sum(np.count_nonzero(values >= 0) for name, values in expected.items() if name.endswith("_broken"))
    if name not in LATE:
        assert len(whole.state.laws) == (2 if name in CHANGING else 1)
        assert (cracks + broken > 0) == (name in BREAKING)


def test_arrays_that_kernels_must_not_see_are_refused() -> None:
    """Types without constants are read beyond the end of an array, and a step before the present one never comes."""
    case = case_of("law changes, bonds break")
    kind = kind_of(case)
    scene = kind.build(case)
    step, probes = kind.choose_step(scene)[0], list(scene.monitors.values())
    simulation = Simulation(scene, step, probes, system=kind.begin(scene, step, lambda *_: None).system)
    simulation.track(Ledger(simulation, 57))
    simulation.advance(10)
    good = simulation.state.arrays()
    for name, value, said in (
        ("system/body/contact_type", 10**6, "types without constants"),
        ("system/body/constants", good["system/body/constants"][:, :-1], "of another law"),
        ("velocity", np.nan, "velocity is not finite"),
        ("ledger/due", 3, "ledger was due before step 10"),
        ("ledger/due", 10**6, "ledger is not due before step 1000000"),
        ("ledger/due", good["ledger/due"].astype(float), "ledger/due has 0 axes of float64"),
        ("ledger/most", good["ledger/most"][:1], "not enough values"),
        ("system/side_watch/turn", np.zeros(0), "turn has the shape"),
    ):
        bad = good[name].copy() if np.isscalar(value) else value
        if np.isscalar(value):
            bad[...] = value
        with pytest.raises(ValueError, match=said):
            simulation.state.take(good | {name: bad})


@pytest.fixture(
    scope="module", params=[name if name in FILED else pytest.param(name, marks=pytest.mark.slow) for name in CASES]
)
def whole(request, tmp_path_factory):
    """A case by its name in `CASES`, and the results of its run without a stop."""
    case = case_of(request.param)
    return request.param, case, run_case(case, tmp_path_factory.mktemp("whole"))


@pytest.mark.parametrize("cuts", [1, pytest.param(10, marks=pytest.mark.slow)])
def test_a_stopped_run_is_resumed_to_the_same_bits(whole, tmp_path, cuts) -> None:
    """Evenly spaced, and at changes of the law; and it can be stopped again."""
    _, case, folder = whole
    expected = summary(folder)
    switches = [round(law["from"] / expected["time_step"]) for law in expected["laws"]]
    for cut in sorted({*np.linspace(0, expected["steps"], cuts, endpoint=False).astype(int), *switches}):
        partial = stopped(case, tmp_path, int(cut))
        for step in (cut + 3, cut + 7):
            Stop.at, Stop.is_on = step, True
            with pytest.raises(Stopped):
                resume_case(partial)
        again = resume_case(partial)
        assert differences(again, folder) == [], f"stopped at step {cut}"
        assert summary(again) == expected
        assert len(json.loads((again / "summary.json").read_text())["resumed"]) == 3


def test_a_complete_run_is_continued_as_if_it_had_been_longer(whole, tmp_path) -> None:
    name, case, folder = whole
    if case.run.until != "duration":
        pytest.skip("ends before its duration; see the next test but one")
    part, snapshots = 0.6 * case.run.duration, 3
    changes = {"run": {"duration": part}, "output": CASES[name]["output"] | {"snapshots": snapshots}}
    first = run_case(case_of(name, **changes), tmp_path)
    steps = json.loads((first / "summary.json").read_text())["steps"]
    again = resume_case(first, until=case.run.duration)

    assert again == first
    # snapshots, and debris at these, are at other steps, as numbers of steps are rounded; nothing else may differ
    at_snapshots = ("snapshots/", "debris/")
    assert [each for each in differences(again, folder) if not each.startswith(at_snapshots) and "@" not in each] == []
    with h5py.File(again / "run.h5") as file:
        taken = [round(group.attrs["time"] / file.attrs["time_step"]) for group in file["snapshots"].values()]
        assert taken == [steps * k // snapshots for k in range(1, 7) if steps * k // snapshots <= file.attrs["steps"]]
        assert file.attrs["complete"]


def test_the_record_of_a_continued_run_is_run_again_to_the_same_bits(tmp_path) -> None:
    case = case_of("switch", output=BAR["output"] | {"snapshots": 3, "energy_interval": 0.0})
    first = resume_case(run_case(case, tmp_path / "one"), until=1.7 * case.run.duration)
    begun_for = recorded_beginning(first / "run.h5")
    assert begun_for == pytest.approx(case.run.duration, rel=1e-2)  # rounded up to whole steps

    again = run_case(recorded_case(first / "run.h5"), tmp_path / "two", begun_for=begun_for)
    assert differences(again, first) == []
    otherwise = run_case(recorded_case(first / "run.h5"), tmp_path / "three")
    assert {"energy/time", "snapshots/0004/velocity"} <= set(differences(otherwise, first))
    assert recorded_beginning(otherwise / "run.h5") is None


def test_a_run_that_ended_in_silence_is_continued_without_it(tmp_path) -> None:
    first = run_case(case_of("ends in silence"), tmp_path / "one")
    time = json.loads((first / "summary.json").read_text())["duration"]
    again = resume_case(first, until=1.5 * time)
    long = run_case(case_of("ends in silence", run={"duration": 1.5 * time}), tmp_path / "two")

    found, expected = contents(again / "run.h5"), contents(long / "run.h5")
    for name in ("histories/middle/velocity", "energy/error", "particles/peak_velocity"):
        assert found[name] == expected[name]


def test_a_static_stage_is_resumed_to_the_same_bits(settled, tmp_path) -> None:
    assert_a_stage_is_resumed(case_of("settled, updated"), "body", settled, tmp_path)


def test_the_static_stage_of_a_column_is_resumed_to_the_same_bits(tmp_path) -> None:
    changes = {
        "packing": LATTICE,
        "material": BRITTLE | {"geometry": "reference"},
        "boundary": FREE_FIELD | {"bottom": INPUT},
        "static": {"ratio": 1e-3, "boundary": {"bottom": {"type": "fixed"}}},
        "load": [{"name": "gravity", "acceleration": [0.0, -9.81]}],
    }
    case = case_of("settled, updated", **changes)
    assert_a_stage_is_resumed(case, "body.column", run_case(case, tmp_path / "whole"), tmp_path)


def assert_a_stage_is_resumed(case, stage: str, whole, folder) -> None:
    """Assert that a run stopped in a static stage comes to the results of the whole one."""
    partial = stopped(case, folder / "cut", 150, stage)
    assert not (partial / "run.h5").exists()
    again = resume_case(partial)
    assert differences(again, whole) == []
    assert summary(again) == summary(whole)


def test_the_settled_state_of_another_body_is_refused(settled, tmp_path) -> None:
    used = SQUEEZED | {"from": str(settled)}
    for changes, key in [
        ({"static": used | {"damp": 0.5}}, "static.damp: is 0.5 here, and 0.7 there"),
        ({"static": used, "material": BRITTLE | {"pb_ten": 4e5}}, "material.pb_ten: is 400000.0 here"),
        ({"static": used, "packing": PACKING | {"seed": 2}}, "packing.seed: is 2 here, and 0 there"),
        ({"static": SQUEEZED | {"from": str(tmp_path)}}, "has no settled state"),
    ]:
        case, messages = case_of("settled, updated", **changes), set()
        for find in (check, preflight, partial(run_case, results=tmp_path / "other")):
            with pytest.raises(CaseError, match=re.escape(key)) as refused:
                find(case)
            messages.add((refused.value.source, str(refused.value)))
        assert len(messages) == 1
        assert not (tmp_path / "other").exists()
