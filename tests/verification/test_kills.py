"""A run that is killed again and again loses at most the time of a checkpoint interval each, and ends with its bits."""

import random
import subprocess
import sys
import time

import pytest
import tomli_w
from recorded import contents
from small_cases import GRAINS

from dembound.results.reader import open_record

INTERVAL = 0.3
"""Seconds between two checkpoints."""

MARGIN = 2.0
"""Seconds of a block of steps and of writing a checkpoint, on a busy machine."""

CASE = {
    **GRAINS,
    "packing": GRAINS["packing"] | {"size": [20.0, 10.0], "brick": [5.0, 5.0]},
    "material": GRAINS["material"] | {"law": "linearpbond", "pb_ten": 4e5, "pb_coh": 8e5},
    "static": {"stress": [-2e5, -2e5, 0.0]},
    "output": {"pictures": False, "snapshots": 4, "energy_interval": 1e-3},
}


def started(*words: str) -> subprocess.Popen:
    command = [sys.executable, "-m", "dembound", *words]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


# durations: each process steps for up to three intervals before it is killed, and none may have reached the end
@pytest.mark.slow
@pytest.mark.parametrize(("kills", "duration"), [(3, 2.4), (50, 16.0)])
def test_a_run_that_is_killed_goes_on(tmp_path, kills, duration) -> None:
    for name in ("killed", "whole"):
        tables = CASE | {"run": {"duration": duration, "checkpoint": INTERVAL}}
        (tmp_path / f"{name}.toml").write_text(tomli_w.dumps(tables))
    whole = started("run", str(tmp_path / "whole.toml"), "-o", str(tmp_path))
    assert whole.wait() == 0
    with open_record(tmp_path / "whole" / "run.h5") as file:
        steps = int(file.attrs["steps"])
    draw = random.Random(kills)
    partial, checkpoint = tmp_path / "killed.partial", tmp_path / "killed.partial" / "checkpoint.npz"
    run = started("run", str(tmp_path / "killed.toml"), "-o", str(tmp_path))
    done, lost = 0, []
    while done < kills and run.poll() is None:
        # the first checkpoint of each process, so that each gets further, and a random time after it
        before = checkpoint.stat().st_mtime_ns if checkpoint.exists() else 0
        while run.poll() is None and not (checkpoint.exists() and checkpoint.stat().st_mtime_ns > before):
            time.sleep(0.01)
        time.sleep(draw.uniform(0.0, 2.0 * INTERVAL))
        if run.poll() is not None:
            break
        run.kill()
        run.wait()
        done += 1
        lost.append(time.time() - checkpoint.stat().st_mtime)
        if (partial / "run.h5").exists():
            with open_record(partial / "run.h5") as file:
                # a kill while the files for ParaView are written finds all steps
                assert not file.attrs["complete"] or file.attrs["steps"] == steps
        run = started("resume", str(partial))
    assert run.wait() == 0, run.stderr.read()
    assert done == kills
    assert max(lost) < INTERVAL + MARGIN
    killed, whole = (contents(tmp_path / name / "run.h5", attributes=False) for name in ("killed", "whole"))
    assert killed == whole
