"""A request to end is never lost, wherever in a command it arrives, and what is left goes on to the same bits."""

import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
import tomli_w
from recorded import contents
from small_cases import GRAINS, SPALLING

CASES = {
    "run": GRAINS
    | {
        "packing": GRAINS["packing"] | {"size": [16.0, 8.0]},
        "material": GRAINS["material"] | {"law": "linearpbond", "pb_ten": 4e5, "pb_coh": 8e5},
        "static": {"stress": [-2e5, -2e5, 0.0], "ratio": 1e-6},
        "run": {"duration": 0.6},
        "output": {"snapshots": 6},
    },
    "calibrate": GRAINS,
    "sweep": SPALLING,
    "chart": SPALLING,
}

COMMANDS = {
    "run": ("run", "run.toml"),
    "calibrate": ("calibrate", "calibrate.toml", "--all"),
    "sweep": ("sweep", "sweep.toml", "--vary", "run.courant=0.5,0.6,0.7", "-p", "2"),
    "chart": ("chart", "chart.toml", "--vary", "run.courant=0.5,0.6,0.7", "--repeats", "2"),
}

MOST = 60.0
"""Seconds from a signal to the end in which a machine that does much else compiles one kernel."""

STARTING = re.compile("init_import_site|<frozen site>|<frozen runpy>|<frozen importlib")
"""Pattern in the traceback of Ctrl-C while Python itself starts, before it comes to any line of a program."""

NOT_STARTED = "Could not import runpy module"
"""Said by Python, with exit code 1, where Ctrl-C comes while it imports what runs a module."""


@dataclass
class Found:
    """Outcome of the signals of a sweep.

    took : s from the signal to the end, with its command. outcomes : how often each way to end.
    """

    took: list[tuple[float, str]] = field(default_factory=list)
    outcomes: Counter[str] = field(default_factory=Counter)


def started(command: str, folder: Path, cold: Path | None = None) -> subprocess.Popen:
    environment = os.environ | {"MPLBACKEND": "Agg"} | ({"NUMBA_CACHE_DIR": str(cold)} if cold else {})
    return subprocess.Popen(
        [sys.executable, "-m", "dembound", *COMMANDS[command]],
        cwd=folder,
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=obey,
    )


def obey() -> None:
    """Ignore no signal, as may be ignored where tests are run."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)


CALIBRATED = "*_calibrated.toml"
"""The cases that ``calibrate`` writes beside its own."""


class Scene:
    """A folder with the cases, and what each command makes of them when nothing ends it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir()
        for name, tables in CASES.items():
            (folder / f"{name}.toml").write_text(tomli_w.dumps(tables))
        self.duration: dict[str, float] = {}
        for command in COMMANDS:
            for _ in range(2):
                shutil.rmtree(folder / "results", ignore_errors=True)
                began = time.monotonic()
                process = started(command, folder)
                _, said = process.communicate()
                assert process.returncode == 0, said
                self.duration[command] = time.monotonic() - began
                if self.duration[command] < 20.0:  # it has not compiled
                    break
            (folder / "results").rename(folder / f"whole-{command}")
            for file in folder.glob(CALIBRATED):
                file.rename(folder / f"whole-{command}" / file.name)

    def end(self, command: str, number: int, delay: float, found: Found, cold: Path | None, *, resumes: bool) -> bool:
        """Send a signal after a delay (s), and compare what is left; returns False if the command was over by then."""
        shutil.rmtree(self.folder / "results", ignore_errors=True)
        for file in self.folder.glob(CALIBRATED):
            file.unlink()
        process = started(command, self.folder, cold)
        try:
            process.wait(delay)
            return False
        except subprocess.TimeoutExpired:
            pass
        process.send_signal(number)
        sent = time.monotonic()
        _, said = process.communicate(timeout=600.0)
        took, code = time.monotonic() - sent, process.returncode
        said_first = f"{command} after {delay:.2f} s: {code}, {said}"
        if code == 0 and took < 0.02:  # it was just ending
            return False
        found.took.append((took, f"{command}{' cold' if cold else ''} {delay:.2f} s"))
        assert took < MOST, said_first
        if code == -number or NOT_STARTED in said:  # before its first line, or after its last one
            found.outcomes["by Python's start or end"] += 1
            assert "Traceback" not in said or STARTING.search(said), said_first
        else:
            found.outcomes["by its own code"] += 1
            assert code == 128 + number, said_first
            assert "stopped" in said, said_first
            assert "Traceback" not in said, said_first
            assert "Exception ignored" not in said, said_first
        if resumes:
            self.resume(command, said_first)
        return True

    def resume(self, command: str, said: str) -> None:
        """Do what a user would, and compare."""
        words = [*COMMANDS[command], *(["--resume"] if command == "chart" else [])]
        results = self.folder / "results"
        assert not list(results.rglob("*.part")), said
        if command == "run" and (results / "run.partial").exists():
            words = ["resume", "results/run.partial"]
        done = subprocess.run(
            [sys.executable, "-m", "dembound", *words], cwd=self.folder, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"{said}\n{done.stderr}"
        whole = self.folder / f"whole-{command}"
        for file in whole.glob(CALIBRATED):
            assert (self.folder / file.name).read_bytes() == file.read_bytes(), said
        for record in whole.rglob("*.h5"):
            found = contents(results / record.relative_to(whole), attributes=False)
            assert found == contents(record, attributes=False), f"{said}\n{record}"


# half of the signals are SIGTERM, half SIGINT; cold ones find no compiled code
@pytest.mark.slow
def test_a_signal_at_any_moment_ends_a_command(tmp_path) -> None:
    count, cold = 400, 40
    scene, draw, found = Scene(tmp_path / "scene"), random.Random(count), Found()
    while len(found.took) < count:
        trial = len(found.took)
        command, number = draw.choice(tuple(COMMANDS)), (signal.SIGTERM, signal.SIGINT)[trial % 2]
        is_cold = trial < cold
        most = 60.0 if is_cold else scene.duration[command]
        empty = tmp_path / "cold" if is_cold else None
        scene.end(command, number, draw.uniform(0.0, most), found, empty, resumes=trial % 4 == 0 and not is_cold)
        if is_cold:
            shutil.rmtree(tmp_path / "cold", ignore_errors=True)
    times = np.sort([took for took, _ in found.took])
    print(found.outcomes, f"s to the end: median {np.median(times):.2f}, most", sorted(found.took)[-8:])
    assert sum(found.outcomes.values()) == count
    assert found.outcomes["by its own code"] >= 0.5 * count
