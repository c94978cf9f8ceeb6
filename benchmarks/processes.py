"""Whole processes: their time and RAM, and workers that answer requests and keep their compiled code.

    python benchmarks/processes.py COMMAND ...     # runs a command, prints its CPU and wall time and largest RAM

The largest RAM of a new process includes that of the process that starts it, so commands are started by this small
script, which imports no packages.
"""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple


class Usage(NamedTuple):
    """CPU and wall seconds of a process, its largest RAM in bytes, and its exit status."""

    cpu: float
    wall: float
    memory: int
    status: int


class WorkerError(Exception):
    """A worker could not do what was asked; the message is the last line of its error."""


def whole(command: Sequence[str | Path], folder: Path, environment: Mapping[str, str] = {}) -> Usage:
    """Run a command in a folder, with a changed environment, and measure it; raises WorkerError if it fails."""
    ended = subprocess.run(
        [sys.executable, __file__, *map(str, command)],
        cwd=folder,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
    )
    if ended.returncode != 0:
        raise WorkerError((ended.stderr.strip().splitlines() or ["no message"])[-1])
    usage = Usage(*json.loads(ended.stdout))
    if usage.status != 0:
        raise WorkerError(f"{' '.join(map(str, command))}: exit status {usage.status}; {ended.stderr.strip()[-300:]}")
    return usage


class Worker:
    """A process that answers requests, one JSON line each, until it is closed."""

    def __init__(self, script: Path, python: str = sys.executable, environment: Mapping[str, str] = {}) -> None:
        self._process = subprocess.Popen(
            [python, str(script)],
            env={**os.environ, **environment},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def __enter__(self) -> "Worker":
        return self

    def __exit__(self, *_: object) -> None:
        self._process.communicate()

    def ask(self, name: str, **keys: Any) -> Any:
        """The answer to a request; raises WorkerError if the worker could not do it."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        try:
            self._process.stdin.write(json.dumps([name, keys]) + "\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            raise WorkerError("the process has ended") from None
        line = self._process.stdout.readline()
        if not line:
            raise WorkerError(f"the process has ended with exit status {self._process.wait()}")
        done, answer = json.loads(line)
        if not done:
            raise WorkerError(answer)
        return answer


def serve(requests: Mapping[str, Callable[..., Any]]) -> None:
    """Answer the requests of `Worker.ask` by functions until the input ends; all other output goes to stderr."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    for line in sys.stdin:
        name, keys = json.loads(line)
        try:
            answer = [True, requests[name](**keys)]
        except Exception as error:
            answer = [False, f"{type(error).__name__}: {error}"]
        answers.write(json.dumps(answer) + "\n")
        answers.flush()


def _measure(command: Sequence[str]) -> Usage:
    """Run a command without its output."""
    began = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    taken = time.perf_counter() - began
    unit = 1 if sys.platform == "darwin" else 1024
    return Usage(used.ru_utime + used.ru_stime, taken, used.ru_maxrss * unit, os.waitstatus_to_exitcode(status))


if __name__ == "__main__":
    print(json.dumps(_measure(sys.argv[1:])))
