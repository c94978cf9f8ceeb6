"""The size of results is known before the run, and a disk that has less is warned of with both numbers."""

import pytest

from dembound import check
from dembound.motion.memory import in_words
from dembound.running import plan, planning, run_case
from dembound.running.planning import ALWAYS, results_bytes, space_warnings

LAW = {"material.law": "linearpbond", "material.elastic_start": False, "material.pb_ten": 1e9, "material.pb_coh": 1e9}
STATIC = {"static": {"stress": [-1e6, -1e6, 0.0], "ratio": 1e-2}}


def written(folder) -> dict[str, float]:
    """Bytes of the files of a run."""
    return {path.name: path.stat().st_size for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    ("changes", "output"),
    [
        (LAW, {"stress": True, "contacts": True, "peaks": True}),
        (LAW | STATIC, {"stress": True, "paraview": "vtkhdf"}),
    ],
)
def test_the_size_of_results_of_disks(bar, tmp_path, changes, output) -> None:
    large = {"packing.size": [30.0, 30.0], "reduce.rows": False, "run.duration": 2e-3}
    case = bar({**large, **changes, "output": {"snapshots": 9, "pictures": False, **output}})
    _require_equal(case, tmp_path)


def test_the_size_of_results_of_bars(spalling, tmp_path) -> None:
    fine = {"bar.spacing": 1e-4, "run.duration": 1e-5, "method": {"type": "peridynamics", "horizon": 6}}
    # with eight snapshots the chunks of the VTKHDF file, of up to a megabyte, are nearly full
    output = {"snapshots": 8, "pictures": False, "paraview": "both"}
    _require_equal(spalling({**fine, "output": output}), tmp_path)


def _require_equal(case, results) -> None:
    sizes = results_bytes(plan(case))
    found = written(run_case(case, results))
    # what changes with the size of the scene; a checkpoint is replaced by a new one beside it
    assert sum(sizes.values()) - ALWAYS == pytest.approx(sum(found.values()) + found["checkpoint.npz"], rel=0.15)


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
