"""Real processes, of this machine and of a Dask cluster: one is killed in the middle, and no member is lost."""

import atexit
import json
import multiprocessing
import os
import signal
import time
from contextlib import contextmanager

import pytest

from dembound.studies.sweep.perform import MEMBERS
from dembound.studies.sweep.study import Options, sweep
from dembound.studies.sweep.workers import processes
from dembound.version import __version__

kills = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="Windows has no SIGKILL")


@contextmanager
def here():
    """Two processes of this machine, and the numbers of those that are alive."""
    yield {"processes": 2}, lambda: [process.pid for process in multiprocessing.active_children()]


@contextmanager
def elsewhere():
    """A Dask cluster of two processes."""
    distributed = pytest.importorskip("distributed", reason="Dask is not installed (dembound[cluster])")
    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None}
    with distributed.LocalCluster(**options, silence_logs="ERROR") as made:
        yield {"scheduler": made.scheduler_address}, lambda: [each.process.pid for each in made.workers.values()]


@kills
@pytest.mark.slow
@pytest.mark.parametrize("workers", [here, elsewhere])
def test_no_member_is_lost_with_a_worker_that_is_killed(rods, tmp_path, workers) -> None:
    members = rods(1e6, 2e6, 3e6, **{"run.duration": 0.02})
    folder, killed, standings = tmp_path / "rod_sweep", [], []
    with workers() as (options, numbers):

        def kill_one(standing) -> None:
            standings.append(standing)
            if not killed and list(folder.glob(f"{MEMBERS}/*.partial/run.h5")):
                killed.append(numbers()[0])
                os.kill(killed[0], signal.SIGKILL)

        outcomes = sweep(members, Options(**options), folder, kill_one)
    assert killed
    assert [outcome.failure for outcome in outcomes] == [""] * 3
    for member, outcome in zip(members, outcomes, strict=True):
        summary = json.loads((folder / MEMBERS / member.name / "summary.json").read_text())
        assert (summary["version"], summary["threads"]) == (__version__, 1)
        assert outcome.values["energy.kinetic"] == summary["energy"]["kinetic"]
    # linear until it breaks: the energy is that of the square of the pressure
    energies = [outcome.values["energy.supplied"] for outcome in outcomes]
    assert energies == pytest.approx([energies[0], 4.0 * energies[0], 9.0 * energies[0]], rel=1e-9)
    assert standings[-1]._replace(kept=0) == (3, 3, 0, 0, 0)
    assert sweep(members, Options(processes=1), folder, standings.append) == outcomes


@kills
def test_the_end_of_processes_is_not_waited_for_and_others_are_left_alone(tmp_path) -> None:
    own = multiprocessing.get_context("spawn").Process(target=time.sleep, args=(600.0,), daemon=True)
    own.start()
    try:
        with processes(1, tmp_path / "stop") as workers:
            (process,) = workers._waiting
            process.pool.submit(atexit.register, time.sleep, 600.0).result()
            began = time.monotonic()
        assert time.monotonic() - began < 300.0
        assert own.is_alive()
    finally:
        own.kill()
