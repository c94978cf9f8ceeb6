"""Whose results a run replaces, what is known of it before it runs, and what runs of a batch share."""

import threading
from dataclasses import replace

import numpy as np
import pytest
from filelock import FileLock
from small_cases import PUSHED, SPALLING, small

import dembound
from dembound import check
from dembound.casefile import Case
from dembound.disks.rest import stage as static
from dembound.errors import CaseError
from dembound.interrupts import Interrupts, Stopped
from dembound.motion.endings import monitored
from dembound.motion.memory import in_words
from dembound.motion.paths import first_arrivals
from dembound.results.results import Results
from dembound.running import Shared, plan, planning, run_case, warnings_before
from dembound.running.planning import ALWAYS, results_bytes, space_warnings
from dembound.running.recorded import recorded_case

SHORT = {"run.duration": 1e-4, "output": {"pictures": False}}


def of_file(name: str, tables: dict = SPALLING) -> Case:
    """A short case as from the file <name>.toml."""
    return replace(small(tables, changes=SHORT), name=name, origin=name)


def test_results_of_another_case_are_not_replaced(tmp_path) -> None:
    folder = run_case(of_file("a"), tmp_path)
    before = (folder / "run.h5").read_bytes()
    other = replace(of_file("b"), name="a")
    for case, said in (
        (other, "has results of case a, which this run of case b would replace"),
        (of_file("a", PUSHED), "has results of a case of bar, which this run of a case of disks would replace"),
    ):
        with pytest.raises(CaseError, match=said):
            run_case(case, tmp_path)
    assert (folder / "run.h5").read_bytes() == before
    folder.rename(tmp_path / "a.partial")  # as if it had been interrupted
    with pytest.raises(CaseError, match=r"a\.partial: has results of case a"):
        run_case(other, tmp_path)


def test_the_same_case_is_run_again_under_its_names_also_changed_and_from_its_record(tmp_path) -> None:
    named = replace(of_file("b"), name="a")
    run_case(named, tmp_path)
    run_case(dembound.change(named, {"run.duration": 2e-4, "load.hit.pressure": 1e6}), tmp_path)
    run_case(recorded_case(tmp_path / "a" / "run.h5"), tmp_path)
    again = dembound.change(of_file("b"), {}, name="a")
    run_case(again, tmp_path)
    assert recorded_case(tmp_path / "a" / "run.h5").origin == "b"


SETTLED = {
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "static": {"boundary": {"bottom": {"type": "fixed"}}},
    "output": {"pictures": False, "snapshots": 0},
}


def test_a_stage_is_computed_once_for_all_that_need_it(tmp_path, monkeypatch) -> None:
    cases = [small(PUSHED, name, SETTLED | {"wave.push.amplitude": size}) for name, size in (("a", 0.1), ("b", 0.2))]
    alone = [Results(run_case(case, tmp_path / "alone")) for case in cases]
    shared = Shared(tmp_path / "settled")
    first = run_case(cases[0], tmp_path / "together", shared=shared)
    monkeypatch.setattr(static, "UntilAtRest", None)
    second = run_case(cases[1], tmp_path / "together", shared=shared)
    for folder, own in zip((first, second), alone, strict=True):
        found = Results(folder).histories["back"]["velocity"]
        assert np.array_equal(found, own.histories["back"]["velocity"])
        assert not (folder / "settled").exists()


def test_a_stage_is_shared_by_all_records_and_factors(tmp_path) -> None:
    """Of ground that breaks, beside a free field and beside a continuum, whose elements are given here."""
    for name, frequency in (("a.txt", 5.0), ("b.txt", 15.0)):
        time = 0.01 * np.arange(101)
        np.savetxt(tmp_path / name, np.column_stack([time, np.sin(np.pi * time) ** 2 * np.sin(frequency * time)]))
    weak = {"material.law": "linearpbond", "material.pb_ten": 1e6, "material.pb_coh": 1e6, "material.fric": 0.5}
    for side in ("free_field", "outside"):
        below = {"type": "outside" if side == "outside" else "viscous_input", "wave_s": "h"}
        sides = {"boundary": {"left": {"type": side}, "right": {"type": side}, "bottom": below}}
        tables = {"wave": {"h": {"type": "file", "path": "a.txt"}}, "monitor": [], "packing.size": [15.0, 10.0]}
        tables |= {"outside": {"element": 5.0}} if side == "outside" else {}
        case = dembound.change(replace(small(PUSHED), folder=tmp_path), SETTLED | weak | sides | tables)
        shared = Shared(tmp_path / "settled")
        found = set()
        for other in ({}, {"wave.h.scale": 3.0}, {"wave.h.path": "b.txt"}):
            planned = plan(dembound.change(case, other))
            found.add(shared.stages(planned.kind.stage_keys(planned.stepped)))
        assert len(found) == 1
        stronger = plan(dembound.change(case, {"material.pb_ten": 2e6}))
        assert shared.stages(stronger.kind.stage_keys(stronger.stepped)) not in found


def test_others_wait_for_a_stage_unless_they_are_to_stop(tmp_path) -> None:
    shared = Shared(tmp_path / "settled")
    keys = {"packing": {"radius": 0.5}}
    lock = FileLock(shared.stages(keys).with_suffix(".lock"))
    (tmp_path / "settled").mkdir()
    lock.acquire()
    timer = threading.Timer(0.2, (tmp_path / "stop").touch)
    timer.start()
    with pytest.raises(Stopped), Interrupts(tmp_path / "stop"), shared.settling(keys):
        pass
    lock.release()
    with shared.settling(keys):
        assert shared.stages(keys).parent == tmp_path / "settled"


LAW = {"material.law": "linearpbond", "material.elastic_start": False, "material.pb_ten": 1e9, "material.pb_coh": 1e9}
STATIC = {"static": {"stress": [-1e6, -1e6, 0.0], "ratio": 1e-2}}


def written(folder) -> dict[str, float]:
    """Bytes of the files of a run."""
    return {path.name: path.stat().st_size for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    ("changes", "output"),
    [(LAW, {"stress": True, "contacts": True, "peaks": True}), (LAW | STATIC, {"stress": True, "paraview": "vtkhdf"})],
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


def test_what_is_missed_in_results_is_warned_of(bar) -> None:
    def warned(changes: dict, words: str) -> list[str]:
        return [line.split(":")[0] for line in warnings_before(plan(bar(changes))) if words in line]

    # disks are 0.5 m wide; one is centred at (5.25, 0.25) m
    for x, names in ((5.2, ["monitor.b"]), (5.8, [])):
        two = [{"name": "a", "position": [5.25, 0.25]}, {"name": "b", "position": [x, 0.3]}]
        assert warned({"monitor": two}, "records the same") == names
    for snapshots, names in ((0, ["output.stress and output.contacts"]), (1, [])):
        output = {"stress": True, "contacts": True, "snapshots": snapshots}
        assert warned({"output": output}, "output.stress and output.contacts: is about snapshots") == names


def test_monitors_that_no_wave_reaches_are_named_before_the_run(bar) -> None:
    """The monitor of the farther end: its way over the speed of the fastest waves, of which the run is a share."""
    planned = plan(bar())
    sources, front = planned.kind.sources(planned.scene), planned.kind.front(planned.scene, planned.time_step)
    first = first_arrivals(sources, front, monitored(planned.scene))
    farthest = planned.scene.case.monitor[int(first.argmax())].name
    for share, late in ((0.9, True), (1.1, False)):
        lines = warnings_before(plan(bar({"run.duration": share * float(first.max())})))
        found = [line for line in lines if "the first wave reaches it" in line]
        assert [farthest in line and f"reaches it at {first.max():.4g} s" in line for line in found] == late * [True]
