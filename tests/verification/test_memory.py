"""The memory that `dembound check` prints is the largest of the run, within 15 %.

It is the sum of the program's, which is measured, and of arrays, which are counted; of the medium scenes here the
arrays are a third to a half. `benchmarks/memory.py` measures up to a million disks and nodes.
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import tomli_w

import dembound
from dembound.kinds import load
from dembound.running import plan

ROOT = Path(__file__).parents[2]
TOLERANCE = 0.15

PULSE = {"pulse": {"type": "cosine", "amplitude": 0.001, "period": 0.5}}
LEFT = {"left": {"type": "velocity", "wave_p": "pulse"}}
LAW = {"law": "linearpbond", "fric": 0.5, "elastic_start": False}


def disks(*size: float, law: dict[str, Any] | None = None, **tables: Any) -> dict[str, Any]:
    """A lattice of disks of 1 m."""
    return {
        "packing": {"pattern": "A", "size": size, "radius": 0.5},
        "material": {"density": 2500.0, "p_wave_speed": 1000.0} | (law or {}),
        "boundary": LEFT,
        "wave": PULSE,
        "run": {"duration": 0.005},
        "output": {"snapshots": 1},
    } | tables


CONTINUUM = {
    "outside": {"element": 1.0, "margin": 600, "layers": 100},
    "boundary": LEFT | {"right": {"type": "outside"}},
}
CASES = {
    "small": disks(100.0, 100.0),
    "medium": disks(500.0, 400.0),
    "medium, with pairs": disks(400.0, 400.0, law=LAW),
    "medium, with arms of bonds": disks(400.0, 400.0, law={"law": "linearpbond", "fric": 0.5, "quality_factor": 20.0}),
    "continuum": disks(40.0, 20.0, law={"fric": 0.5}, **CONTINUUM),
    "bar": {
        "bar": {"length": 1.0, "spacing": 5e-6, "density": 2500.0, "wave_speed": 4000.0},
        "method": {"type": "peridynamics", "horizon": 3},
        "boundary": LEFT,
        "wave": PULSE,
        "run": {"duration": 5e-9},
        "output": {"snapshots": 1},
    },
}


def measured(case: Path) -> float:
    """Largest memory (bytes) of `dembound run`; a process that compiled first may need more, so it is run again then.

    It is started by a small script, as a process begins with the memory of the one that starts it.
    """
    start = [sys.executable, ROOT / "benchmarks/processes.py", sys.executable, "-m", "dembound", "run", case]
    ended = subprocess.run(start, cwd=case.parent, capture_output=True, text=True, check=True)
    _, _, memory, status = json.loads(ended.stdout)
    assert status == 0, ended.stderr
    return memory


@pytest.mark.skipif(sys.platform != "linux", reason="the memory of the program is that on Linux")
@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_computed_memory_is_that_of_the_run(name, tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(Path(dembound.__file__).parents[1]))
    case = tmp_path / "case.toml"
    case.write_text(tomli_w.dumps(CASES[name]))
    computed = plan(load(case)).stepped.largest_memory
    found = measured(case)
    if found > computed * (1.0 + TOLERANCE):
        found = measured(case)
    assert computed == pytest.approx(found, rel=TOLERANCE)
