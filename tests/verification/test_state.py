"""A run goes on from its state alone: cut anywhere and rebuilt from named arrays, it comes to the same bits."""

import numpy as np
import pytest
import tomli_w

from dembound.disks.rest import stage as static
from dembound.kinds import kind_of, loads
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

STEPS = 240
CUTS = (0, 1, 57, 58, 100, 161, 239)
"""In between, before and after entries of the ledger, of which there is one every 57 steps, and steps that follow."""

DISKS = {
    "packing": {"pattern": "B", "size": [8.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "boundary": {
        "bottom": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"},
        "right": {"type": "viscous"},
    },
    "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.01}},
    "monitor": [{"name": "middle", "position": [4.0, 2.0]}],
    "run": {"duration": 1.0},
    "output": {"peaks": True},
}
BRITTLE = {"law": "linearpbond", "pb_ten": 3e5, "pb_coh": 6e5, "fric": 0.3}
SQUEEZED = {"stress": [-1e6, -1e6, 0.0], "ratio": 1e-3}
FREE_FIELD = {side: {"type": "free_field"} for side in ("left", "right")}
SHAKEN_COLUMN = FREE_FIELD | {"bottom": {"type": "viscous_input", "wave_s": "pulse"}}
PULLED = {"left": {"type": "velocity", "wave_p": "pulse"}}

BAR = {
    "bar": {"length": 1.0, "spacing": 0.01, "density": 2500.0, "wave_speed": 1000.0, "strength": 8e6},
    "boundary": {"right": {"type": "viscous", "beta_p": 0.2}},
    "load": [{"name": "hit", "pressure": -15e6, "nodes": 3, "wave": "hit"}],
    "wave": {"hit": {"type": "triangle", "amplitude": 1.0, "rise": 2e-4, "fall": 2e-4}},
    "monitor": [{"name": "gauge", "position": 0.5}],
    "run": {"duration": 1.0},
}

CASES = {
    "elastic": DISKS,
    "damped": DISKS | {"material": DISKS["material"] | {"damp": 0.1}},
    "law changes, bonds break": DISKS
    | {"material": DISKS["material"] | BRITTLE, "boundary": PULLED, "motion": {"held": ["y"]}},
    "settled, updated": DISKS | {"material": DISKS["material"] | BRITTLE, "static": SQUEEZED},
    "settled, elastic": DISKS | {"static": SQUEEZED},
    "free field": DISKS | {"boundary": SHAKEN_COLUMN},
    "free field that breaks": DISKS | {"boundary": SHAKEN_COLUMN, "material": DISKS["material"] | BRITTLE},
    "peridynamics": BAR | {"method": {"type": "peridynamics", "horizon": 3}},
    "finite differences": BAR | {"method": {"type": "finite_difference"}},
    "switch": BAR | {"method": {"type": "switch", "horizon": 3}},
    "patch": BAR | {"method": {"type": "patch", "horizon": 3}},
    "attenuated": BAR
    | {"bar": BAR["bar"] | {"attenuation": 0.3}, "method": {"type": "patch", "horizon": 3, "reach": 2}},
}


CHANGING = ("law changes, bonds break", "free field that breaks", "switch", "patch", "attenuated")
"""Cases in which a law or a method takes over from another one."""

BREAKING = (*CHANGING, "settled, updated", "peridynamics", "finite differences")
"""Cases in which bonds break."""


def of_nothing(*_: object) -> None:
    """Nobody looks at the static stage."""


@pytest.fixture(scope="module", params=CASES)
def plan(request):
    """Scene, kind and time step of a case, and where its run begins; each made once."""
    case = loads(tomli_w.dumps(CASES[request.param]), name=request.param)
    kind = kind_of(case)
    scene = kind.build(case)
    step, _ = kind.choose_step(scene)
    return case, kind, scene, step


def begun(plan, *, settled: bool) -> Simulation:
    """A simulation, after its static stage or, to be told what it has come to, without one."""
    _, kind, scene, step = plan
    probes = list(scene.monitors.values())
    if settled:
        beginning = kind.begin(scene, step, of_nothing)
        simulation = Simulation(scene, step, probes, system=beginning.system, datum=beginning.datum)
    else:
        simulation = Simulation(scene, step, probes)
    simulation.track(Ledger(simulation, 57))
    return simulation


def test_a_run_cut_and_rebuilt_from_its_arrays_comes_to_the_same_bits(plan) -> None:
    whole = begun(plan, settled=True)
    kept, records = {}, []
    for cut, end in zip(CUTS, (*CUTS[1:], STEPS), strict=True):
        kept[cut] = whole.state.arrays()
        records.append(whole.advance(end - cut))
    expected = whole.state.arrays()
    record = np.concatenate(records)

    for cut, arrays in kept.items():
        again = begun(plan, settled=False)
        again.state.take(arrays)
        rest = again.advance(STEPS - cut)
        found = again.state.arrays()

        assert rest.tobytes() == record[cut:].tobytes(), f"cut at {cut}: the probes"
        assert found.keys() == expected.keys()
        different = [name for name, values in expected.items() if found[name].tobytes() != values.tobytes()]
        assert not different, f"cut at {cut}: {different}"


def test_the_cases_change_their_laws_and_break(plan) -> None:
    case, *_ = plan
    simulation = begun(plan, settled=True)
    simulation.advance(STEPS)
    arrays = simulation.state.arrays()
    cracks = [values for name, values in arrays.items() if name.endswith("crack_step")]  # of disks, not yet written
    broken = [values >= 0 for name, values in arrays.items() if name.endswith("_broken")]  # of bars

    assert len(simulation.state.owners["ledger"].entries) == 5
    assert len(simulation.state.laws) == (2 if case.name in CHANGING else 1)
    assert (sum(map(len, cracks)) + sum(map(np.count_nonzero, broken)) > 0) == (case.name in BREAKING)


class Rewound(Simulation):
    """Goes on from a state taken at step 250 after it has done 230 steps more, which must leave no trace."""

    def run(self, steps: int) -> None:
        super().run(250)
        kept = self.state.arrays()
        super().run(480)
        self.state.take(kept)
        assert self.state.step == 250
        super().run(steps)


@pytest.mark.parametrize("name", ["settled, updated", "settled, elastic"])
def test_a_static_stage_taken_back_settles_to_the_same_bits(name: str, monkeypatch) -> None:
    case = loads(tomli_w.dumps(CASES[name] | {"static": SQUEEZED | {"ratio": 1e-7}}), name=name)
    scene = kind_of(case).build(case)
    whole = static.settle(scene)
    monkeypatch.setattr(static, "Simulation", Rewound)
    again = static.settle(scene)

    assert whole.steps == again.steps > 480
    assert whole.start.displacement.tobytes() == again.start.displacement.tobytes()
    assert (whole.ratio, whole.stress.tobytes()) == (again.ratio, again.stress.tobytes())
