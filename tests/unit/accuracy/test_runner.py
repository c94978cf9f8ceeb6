"""One run of a choice: what its monitors record, and that it is made once."""

import numpy as np

from dembound.accuracy import runner
from dembound.accuracy.runner import Run
from dembound.motion.kind import Finding


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
