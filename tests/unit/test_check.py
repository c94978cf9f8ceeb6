"""Checks of a case, without running it."""

from dembound.check import check
from dembound.errors import RunError
from dembound.kinds.disks.facts import disk_facts
from dembound.running import plan, warnings_before
from dembound.words import with_unit


def test_facts_are_those_of_the_run_and_of_the_scene(bar) -> None:
    case = bar({"run.time_step": 1e-4})
    facts, warnings = check(case)
    planned = plan(case)
    limit = planned.step_limit

    assert facts["steps"] == "100 for 0.01 s"
    assert facts["time step"] == f"100 µs, {1e-4 / limit:.3g} of the limit {with_unit(limit, 's')}"
    assert facts["reduced"] == "rows: 2 identical rows are stepped as one, 20 of 40 disks"
    assert facts["estimated time"] == "less than 1 s with 1 thread, without building, pictures"
    own = dict(disk_facts(planned.scene))
    assert {name: fact for name, fact in facts.items() if name in own} == own
    asked = check(bar({"reduce.settled": True}))[0]
    assert asked["not reduced"] == 'reduce.settled: not applied: material.law = "elastic" is used from the start'
    assert len(warnings) > 0
    assert warnings == warnings_before(planned)


def test_a_run_until_silence_is_announced_with_its_times(bar) -> None:
    silent = {"run.until": "silent", "run.time_step": 1e-4, "run.silent_level": 0.02, "run.silent_for": 0.005}
    steps = check(bar(silent))[0]["steps"]

    # a pulse of 0.01 s, and 4.75 m at 1000 m/s
    assert steps == "100 for 0.01 s, or until all monitors are below 2 % of their peaks for 5 ms, after 14.7 ms"


def test_the_estimate_of_what_may_break_is_a_range(bar) -> None:
    law = {"material.law": "linearpbond", "run.time_step": 1e-6, "run.duration": 10.0}
    bonds = {"material.pb_ten": 1e6}
    for changes, slowest in (
        ({}, "once contacts open or slide"),
        ({"material.elastic_start": False}, ""),
        (bonds, "all broken"),
        ({"material.elastic_start": False, **bonds}, "all broken"),
        ({"material.contact_share": 1.0, "material.fric": 0.5}, "all loose"),
    ):
        reported = check(bar({**law, **changes}))[0]["estimated time"]
        assert reported.endswith(f"{slowest} with 1 thread, without building, pictures")
        assert reported.startswith("about ")
        assert (" at the pace of the first steps, about " in reported) == bool(slowest)
    reported = check(bar({"static": {"stress": [-1e6, -2e6, 0.0]}}))[0]["estimated time"]
    assert ", without building, pictures; the static stage comes on top: " in reported


def test_a_case_whose_first_steps_blow_up_is_checked_without_an_estimate_of_time(bar, monkeypatch) -> None:
    def advance(self, steps: int) -> None:
        raise RunError("the motion grew without bound")

    monkeypatch.setattr("dembound.motion.simulation.Simulation.advance", advance)
    facts, warnings = check(bar())
    assert facts["estimated time"] == "unknown, as in the first steps the motion grew without bound"
    assert {"errors", "reduced"} <= set(facts)  # which follow
    assert warnings == warnings_before(plan(bar()))
