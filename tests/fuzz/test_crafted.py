"""For any damaged or malicious file of results a command ends soon, in bounded memory, with its output or one line."""

import io
import json
import os
import random
import resource
import shutil
import subprocess
import sys
import threading
import time
import traceback
from collections import Counter
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest
import tomli_w
from crafted import copied, crafted
from small_cases import PUSHED, SPALLING

SECONDS, BYTES = 5.0, 500e6
"""Largest additional CPU time of a command compared with sound results, and memory compared with all imports."""

DISKS = PUSHED | {
    "packing": PUSHED["packing"] | {"size": [4.0, 1.0]},
    "monitor": [{"name": "gauge", "position": [2.4, 0.5]}],
    "run": {"duration": 0.003},
    "output": {"snapshots": 2, "pictures": False},
}
BAR = SPALLING | {"output": {"snapshots": 2, "pictures": False}}

READING: Sequence[tuple[str, ...]] = (
    ("plot", "{}"),
    ("plot", "{}", "--energy"),
    ("plot", "{}", "--field", "velocity"),
    ("plot", "{}", "--boundary", "right"),
    ("plot", "{}", "--quantity", "displacement"),
    ("report", "{}"),
    ("movie", "{}"),
    ("compare", "sound-{kind}", "{}"),
    ("compare", "{}", "sound-{kind}"),
    ("signals", "{}"),
    ("signals", "{}", "--show", "response"),
    ("signals", "{}", "--show", "section"),
    ("gauge", "{}", "--monitor", "gauge"),
    ("rerun", "{}", "-o", "again"),
    ("resume", "{}", "--until", "0.004"),
    ("estimate", "{}"),
)
CHART = ("chart", "bar.toml", "--vary", "run.courant=0.5,0.6", "--repeats", "1")
CHARTED: Sequence[tuple[str, ...]] = ((*CHART, "--resume"),)


def made(folder: Path) -> None:
    """Sound results of each kind, with which everything is compiled and imported."""
    for name, tables in (("bar", BAR), ("disks", DISKS)):
        (folder / f"{name}.toml").write_text(tomli_w.dumps(tables))
        assert ended(("run", f"{name}.toml", "-o", "made"))[0] == 0
        shutil.copytree(folder / "made" / name, folder / f"sound-{name}")
    assert ended(CHART)[0] == 0
    (folder / "results" / "bar_chart").rename(folder / "sound-chart")


def ended(words: Sequence[str]) -> tuple[int, str]:
    """Exit code and messages of a command, run in this process; an error of no message is re-raised."""
    from dembound.cli import app
    from dembound.errors import DemboundError

    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
        try:
            app(list(words), standalone_mode=False)
        except DemboundError as error:
            return error.exit_code, str(error)
        except OSError as error:
            return 5, f"{error.filename}: {error.strerror}"
        except SystemExit as end:
            return int(end.code or 0), ""
    return 0, ""


def worked(folder: Path, count: int, seed: int) -> None:
    """Craft results and read them; prints what was done, and how each command ended, in lines of JSON."""
    os.chdir(folder)
    made(folder)
    draw = random.Random(seed)
    for words in READING:  # import all that they need
        for kind in ("bar", "disks"):
            ended([word.format(f"sound-{kind}", kind=kind) for word in words])
    limit = int(most_memory() + 4 * BYTES)
    resource.setrlimit(resource.RLIMIT_AS, (limit + 2**36, limit + 2**36))
    resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
    for number in range(count):
        kind = draw.choice(("bar", "disks", "disks", "bar", "chart"))
        target = copied(Path(f"sound-{kind}"), Path("results/bar_chart" if kind == "chart" else "crafted"))
        what = crafted(target, draw)
        words = [w.format("crafted", kind=kind) for w in draw.choice(CHARTED if kind == "chart" else READING)]
        print(json.dumps({"number": number, "what": what, "words": words}), flush=True)
        began, before = time.process_time(), most_memory()
        try:
            code, said = ended(words)
        except BaseException as error:
            code, said = 1, f"{type(error).__name__}: {error}\n{traceback.format_exc()[-1500:]}"
        took, grown = time.process_time() - began, most_memory() - before
        if took > SECONDS:
            copied(Path(f"sound-{kind}"), target)
            began = time.process_time()
            ended(words)
            took -= time.process_time() - began
        print(json.dumps({"code": code, "said": said, "took": took, "grown": grown}), flush=True)


def most_memory() -> int:
    """The most bytes of memory that this process has had."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


COUNT, BATCH = 1000, 100
"""Structures in all, and in one process: VTK keeps memory, which would reach the limit after some hundreds."""


@pytest.mark.slow
def test_crafted_results_are_refused_in_a_line_or_used(tmp_path) -> None:
    environment = os.environ | {"MPLBACKEND": "Agg", "PYTHONPATH": str(Path(__file__).parents[1])}
    codes, bad, times, sizes = Counter(), [], [0.0], [0]
    for seed in range(COUNT, 2 * COUNT, BATCH):
        folder = tmp_path / f"{seed}"
        folder.mkdir()
        words = [sys.executable, __file__, str(folder), str(BATCH), str(seed)]
        what = None
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=environment) as process:
            for line in process.stdout:
                if not line.startswith("{"):
                    continue  # VTK prints there, too
                found = json.loads(line)
                if "what" in found:
                    what = found
                    timer = threading.Timer(40.0 * SECONDS, process.kill)  # on a machine that does much else
                    timer.start()
                    continue
                timer.cancel()
                codes[found["code"]] += 1
                times.append(found["took"])
                sizes.append(found["grown"])
                is_one_line = len(found["said"].splitlines()) <= 1 + found["code"] * (found["code"] in (2, 3))
                fits = times[-1] < SECONDS and sizes[-1] < BYTES
                if not (found["code"] in (0, 2, 3, 5) and is_one_line and fits):
                    bad.append((what, found))
        assert process.returncode == 0, what
    print(dict(codes), f"{max(times):.1f} s and {max(sizes) / 1e6:.0f} MB at most, {len(bad)} wrong")
    for before, after in bad:
        print(before, after["code"], after["took"], after["grown"], after["said"], sep="\n  ")
    assert not bad
    assert codes.total() == COUNT
    assert codes[5] > 0.15 * COUNT  # the others are numbers that change, and files that the command does not read


if __name__ == "__main__":
    worked(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))
