"""Whatever a file of results is made to be, a command ends soon, in bounded memory, with its work done or one line."""

import multiprocessing
import os
import random
import resource
import shutil
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import pytest
import tomli_w
from crafted import copied, crafted
from small_cases import PUSHED, SPALLING

SECONDS, BYTES = 5.0, 500e6
"""CPU time and memory of a command beyond that of a process that has imported everything."""

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
    ("view", "{}", "-o", "view.png"),
    ("gauge", "{}", "--monitor", "gauge"),
    ("rerun", "{}", "-o", "again"),
    ("resume", "{}", "--until", "0.004"),
    ("estimate", "{}"),
)
CHARTED: Sequence[tuple[str, ...]] = (
    ("chart", "bar.toml", "--vary", "run.courant=0.5,0.6", "--resume", "--repeats", "1"),
)


def made(folder: Path) -> None:
    """Sound results of each kind, and of a chart, with which everything is compiled and imported."""
    for name, tables in (("bar", BAR), ("disks", DISKS)):
        (folder / f"{name}.toml").write_text(tomli_w.dumps(tables))
        assert ended(("run", f"{name}.toml", "-o", "made"))[0] == 0
        shutil.copytree(folder / "made" / name, folder / f"sound-{name}")
    assert ended(CHART)[0] == 0
    (folder / "results" / "bar_chart").rename(folder / "sound-chart")


def ended(words: Sequence[str]) -> tuple[int, str]:
    """Exit code and messages of a command, run in this process; an error of no message is re-raised."""
    import io
    from contextlib import redirect_stderr, redirect_stdout

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


def worked(folder: str, seed: int, count: int, results: "multiprocessing.Queue") -> None:
    """Craft results and read them; what a command needed and how it ended goes to the queue."""
    os.chdir(folder)
    os.environ["MPLBACKEND"] = "Agg"
    made(Path(folder))
    draw = random.Random(seed)
    for words in READING:  # import all that they need
        for kind in ("bar", "disks"):
            ended([word.format(f"sound-{kind}", kind=kind) for word in words])
    base = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    limit = base + 4 * BYTES
    resource.setrlimit(resource.RLIMIT_DATA, (int(limit), int(limit)))
    for number in range(count):
        kind = draw.choice(("bar", "disks", "disks", "bar", "chart"))
        target = copied(Path(f"sound-{kind}"), Path("results/bar_chart" if kind == "chart" else "crafted"))
        what = crafted(target, draw)
        words = [w.format("crafted", kind=kind) for w in draw.choice(CHARTED if kind == "chart" else READING)]
        results.put((number, what, words))
        began = time.process_time()
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        try:
            code, said = ended(words)
        except BaseException as error:
            code, said = 1, f"{type(error).__name__}: {error}"
        grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024
        results.put((number, code, said, time.process_time() - began, grown))
    results.put(None)


@pytest.mark.parametrize("count", [60, pytest.param(1000, marks=pytest.mark.slow)])
def test_crafted_results_are_refused_in_a_line_or_used(tmp_path, count) -> None:
    context = multiprocessing.get_context("spawn")
    results = context.Queue()
    process = context.Process(target=worked, args=(str(tmp_path), count, count, results))
    process.start()
    codes, bad, most_time, most_memory, what = Counter(), [], 0.0, 0, None
    while (found := received(results, process, what)) is not None:
        if len(found) == 3:
            what = found
            continue
        _, code, said, took, grown = found
        codes[code] += 1
        most_time, most_memory = max(most_time, took), max(most_memory, grown)
        if code not in (0, 2, 3, 5) or len(said.splitlines()) > 5 or took > SECONDS or grown > BYTES:
            bad.append((what, found))
    process.join()
    print(dict(codes), f"{most_time:.1f} s, {most_memory / 1e6:.0f} MB at most")
    for each in bad:
        print(each)
    assert not bad
    assert codes.total() == count


def received(results, process, what):
    """The next message of the worker; fails if that has died or needs much longer than it may."""
    import queue

    for _ in range(240):
        try:
            return results.get(timeout=0.5 if what else 2.0)
        except queue.Empty:
            if not process.is_alive():
                pytest.fail(f"the process has ended with {process.exitcode} at {what}")
    process.kill()
    pytest.fail(f"does not end: {what}")
