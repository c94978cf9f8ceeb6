"""Runs of a batch share stages before the run, and a request to stop."""

import threading

import numpy as np
import pytest
from filelock import FileLock
from small_cases import PUSHED, small

from dembound.disks.rest import stage as static
from dembound.interrupts import Interrupts, Stopped
from dembound.results.results import Results
from dembound.running import Shared, run_case

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


def test_other_keys_have_another_folder(tmp_path) -> None:
    shared = Shared(tmp_path)
    assert shared.stages({"a": 1}) != shared.stages({"a": 2})
    assert shared.stages({"a": 1, "b": 2}) == shared.stages({"b": 2, "a": 1})
    assert shared.stages({}) is None
    assert Shared().stages({"a": 1}) is None
