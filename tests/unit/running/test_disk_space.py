"""The size of results is known before the run, and a disk that has less is warned of with both numbers."""

import logging
from dataclasses import replace

import pytest

from dembound import check
from dembound.kinds import with_changes
from dembound.motion.memory import in_words
from dembound.running import Progress, job, plan, planning, resume_case, run_case, warnings_before
from dembound.running.planning import ALWAYS, results_bytes, space_warnings

LAW = {"material.law": "linearpbond", "material.elastic_start": False, "material.pb_ten": 1e9, "material.pb_coh": 1e9}
STATIC = {"static": {"stress": [-1e6, -1e6, 0.0], "ratio": 1e-2}}


def written(folder) -> dict[str, float]:
    """Bytes of the files of a run."""
    return {path.name: path.stat().st_size for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    ("changes", "output"),
    [
        ({}, {}),
        (LAW, {"stress": True, "contacts": True, "peaks": True}),
        (LAW, {"paraview": "none"}),
        (LAW | STATIC, {"stress": True, "paraview": "vtkhdf"}),
    ],
)
def test_the_size_of_results_of_disks(bar, tmp_path, changes, output) -> None:
    large = {"packing.size": [30.0, 30.0], "reduce.rows": False, "run.duration": 2e-3}
    case = bar({**large, **changes, "output": {"snapshots": 9, "pictures": False, **output}})
    _require_equal(case, tmp_path)


@pytest.mark.parametrize(("horizon", "paraview"), [(1, "vtu"), (6, "both")])
def test_the_size_of_results_of_bars(spalling, tmp_path, horizon, paraview) -> None:
    fine = {"bar.spacing": 1e-4, "run.duration": 1e-5, "method": {"type": "peridynamics", "horizon": horizon}}
    # with eight snapshots the chunks of the VTKHDF file, of up to a megabyte, are nearly full
    output = {"snapshots": 8, "pictures": False, "paraview": paraview}
    _require_equal(spalling({**fine, "output": output}), tmp_path)


def _require_equal(case, results) -> None:
    sizes = results_bytes(plan(case))
    found = written(run_case(case, results))
    # what changes with the size of the scene; a checkpoint is replaced by a new one beside it
    assert sum(sizes.values()) - ALWAYS == pytest.approx(sum(found.values()) + found["checkpoint.npz"], rel=0.15)


@pytest.mark.slow
def test_the_size_of_histories_and_energies(bar, tmp_path) -> None:
    case = bar({"run.duration": 2.0, "output": {"snapshots": 0, "pictures": False, "energy_interval": 1e-3}})
    sizes = results_bytes(plan(case))
    found = written(run_case(case, tmp_path))

    grown = sum(sizes[f"output.{name}_interval"] for name in ("history", "side", "energy"))
    assert grown == pytest.approx(found["run.h5"] + 2.0 * found["checkpoint.npz"], rel=0.15)
    wide = results_bytes(plan(bar({"run.duration": 2.0, "output.history_interval": 0.3, "run.checkpoint": 0.0})))
    assert wide["output.history_interval"] < 0.02 * sizes["output.history_interval"]
    assert wide["run.checkpoint"] == 0.0


def test_a_disk_with_less_space_is_warned_of_with_both_numbers(bar, tmp_path, monkeypatch) -> None:
    planned = plan(bar({"output.snapshots": 50}))
    need = in_words(sum(results_bytes(planned).values()))
    assert list(space_warnings(planned, tmp_path)) == []
    monkeypatch.setattr(planning, "disk_free", lambda path: 1e5)
    (warning,) = space_warnings(planned, tmp_path)

    assert warning.startswith(f"output.snapshots: the results take about {need}, ")
    assert warning.endswith("the disk has 100 kB free")
    facts, warnings = check.check(planned.scene.case)
    assert facts["disk"] == f"about {need} of results; the disk has 100 kB free"
    assert warning in warnings


class Heard(Progress):
    """Writes down warnings."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def warned(self, message: str) -> None:
        self.lines.append(message)


def test_a_run_warns_before_it_begins(bar, tmp_path, monkeypatch, caplog) -> None:
    heard = Heard()
    with monkeypatch.context() as patch:
        patch.setattr(planning, "disk_free", lambda path: 1e5)
        run_case(bar(), tmp_path, heard)
    assert "free" in heard.lines[0]
    monkeypatch.setattr(job, "LARGE", 1e5)
    with caplog.at_level(logging.INFO):
        run_case(bar(), tmp_path)
    assert [record.message for record in caplog.records if "of results; the disk has" in record.message]


def test_a_continued_run_warns_of_what_it_will_add(bar, tmp_path, monkeypatch) -> None:
    heard = Heard()
    case = bar({"output.snapshots": 9})
    folder, longer = run_case(case, tmp_path), 3.0 * case.run.duration
    # the plan of a run that is continued
    continued = replace(plan(with_changes(case, {"run.duration": longer})), regular_steps=plan(case).steps)
    first, whole = results_bytes(plan(case)), results_bytes(continued)
    for name in ("output.snapshots", "output.energy_interval"):  # steps, some 30 at first, are rounded up
        assert whole[name] == pytest.approx(3.0 * first[name], rel=1.0 / 30)

    partial = folder.rename(folder.with_name(f"{folder.name}.partial"))
    left = sum(whole.values()) - sum(written(partial).values())
    with monkeypatch.context() as small_disk:
        small_disk.setattr(planning, "disk_free", lambda path: left - 1e3)
        resume_case(partial, longer, heard)
    assert f"the results take about {in_words(left)} more, " in heard.lines[0]

    heard = Heard()
    monkeypatch.setattr(planning, "disk_free", lambda path: left + 1e3)  # the complete run is copied
    resume_case(folder, longer + case.run.duration, heard)
    assert "the results take about" in heard.lines[0]
    assert " more, " not in heard.lines[0]


def test_outputs_more_often_than_steps_are_mentioned(bar) -> None:
    often = {"run.time_step": 1e-4, "output": {"snapshots": 101, "history_interval": 9e-5, "energy_interval": 1e-6}}
    found = [line for line in warnings_before(plan(bar(often))) if line.startswith("output.")]

    assert found == [
        "output.snapshots: is 101, the run has 100 steps and as many snapshots",
        "output.history_interval: is 9e-05 s, below the time step, 0.0001 s; every step is kept",
        "output.energy_interval: is 1e-06 s, below the time step, 0.0001 s; every step is kept",
    ]
    each = {"run.time_step": 1e-4, "output": {"snapshots": 100, "history_interval": 1e-4, "energy_interval": 1e-4}}
    assert [line for line in warnings_before(plan(bar(each))) if line.startswith("output.")] == []
