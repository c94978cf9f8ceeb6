"""One run of a choice: what its monitors record, and that it is made once."""

import numpy as np

from dembound.accuracy import runner
from dembound.accuracy.runner import Run, measure
from dembound.motion.kind import Finding
from dembound.running import Progress


def test_monitors_in_the_half_that_is_not_stepped_have_their_own_signs(bar) -> None:
    push = {"name": "push", "region": [4.5, 2.5, 5.5, 3.0], "force": [0.0, -1e6], "wave": "pulse"}
    places = [{"name": "left", "position": [2.25, 2.75]}, {"name": "right", "position": [7.75, 2.75]}]
    changes = {"packing.size": [10.0, 3.0], "motion.held": [], "boundary": {}, "load": [push], "monitor": places}
    half, whole = (
        measure(bar({**changes, "material.fric": 0.5, "reduce.symmetry": symmetry}), Progress())[0]
        for symmetry in (True, False)
    )

    assert half.count == whole.count // 2
    for name, gauge in whole.motions.items():
        largest = np.abs(gauge.velocity).max()
        assert np.abs(gauge.velocity[:, 0]).max() > 0.01 * largest
        np.testing.assert_allclose(half.motions[name].velocity, gauge.velocity, rtol=0.0, atol=1e-12 * largest)


def test_a_case_is_run_once_and_its_work_is_counted(bar, monkeypatch) -> None:
    made = []

    def run_of(case, progress, inside=None):
        made.append(case)
        return Run(work=7, findings={"break time": Finding(0.5, "s")}), 0.0, 0.0

    monkeypatch.setattr(runner, "measure", run_of)
    runs = runner.Runner()
    first = runs.run(bar())
    assert runs.run(bar()) is first
    assert runs.run(bar({"run.duration": 0.02})) is not first
    assert (len(made), runs.work) == (2, 14)
    assert (first.finding("break time"), first.finding("spall time")) == (0.5, np.inf)
