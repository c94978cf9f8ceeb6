"""The memory of a machine is read as its system reports it, within the limits of containers."""

import os
import signal
import threading
import time
from pathlib import Path

import pytest

from dembound.interrupts import TOGETHER, Interrupts, Stopped, caught, look, put_off
from dembound.machine import Memory, memory_here

GIB = 2.0**30


@pytest.fixture
def root(tmp_path):
    """Writes the files of a Linux machine of 8 GiB, 6 GiB of them free, and others given by name."""

    def make(**files: str) -> Path:
        known = {"proc/meminfo": "MemTotal: 8388608 kB\nMemFree: 9 kB\nMemAvailable: 6291456 kB\nHugePages_Total: 0\n"}
        for name, text in {**known, **files}.items():
            path = tmp_path / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return tmp_path

    return make


def group(folder: str, limit: float, usage: float, dropped: float) -> dict[str, str]:
    """The files of a control group of version 2."""
    at = f"sys/fs/cgroup/{folder}"
    numbers = f"anon 7\ninactive_file {dropped:.0f}\n"
    return {f"{at}memory.max": f"{limit:.0f}", f"{at}memory.current": f"{usage:.0f}", f"{at}memory.stat": numbers}


def test_a_machine_without_limits(root) -> None:
    assert memory_here(root()) == Memory(8.0 * GIB, 6.0 * GIB)
    files = {"proc/self/cgroup": "0::/\n", "sys/fs/cgroup/memory.max": "max\n", "sys/fs/cgroup/memory.current": "5\n"}
    assert memory_here(root(**files)) == Memory(8.0 * GIB, 6.0 * GIB)
    here = memory_here()
    assert here is None or 0.0 < here.free <= here.total


def test_the_group_of_a_process_or_one_around_it_limits_its_memory(root) -> None:
    files = {"proc/self/cgroup": "0::/job/step\n", **group("job/step/", 9.0 * GIB, GIB, 0.0)}
    files |= group("job/", 4.0 * GIB, 2.0 * GIB, 0.5 * GIB)

    # pages of files that nobody uses are dropped when others need them: 4 − 2 + 0.5
    assert memory_here(root(**files)) == Memory(4.0 * GIB, 2.5 * GIB)


@pytest.fixture(autouse=True)
def _python_handlers():
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # tests may be run where it is ignored
    yield
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    signal.signal(signal.SIGINT, before)


def send(number: int = signal.SIGINT) -> None:
    os.kill(os.getpid(), number)
    time.sleep(0.0)  # the handler is called between two instructions


def test_nothing_is_raised_before_it_is_looked_for() -> None:
    def work() -> None:
        with Interrupts():
            look()
            send(signal.SIGTERM)
            assert caught() == signal.SIGTERM
            with put_off():
                look()
            look()
            pytest.fail("must not be reached")

    with pytest.raises(Stopped) as stop:
        work()
    assert stop.value.exit_code == 143
    look()


def test_a_second_signal_acts_at_once_unless_it_is_the_same_request() -> None:
    done = []

    def work() -> None:
        with Interrupts():
            timer = threading.Timer(0.3 * TOGETHER, os.kill, (os.getpid(), signal.SIGINT))
            timer.start()
            send()  # returns after TOGETHER, within which the second one comes
            timer.join()
            done.append(caught())
            send()
            done.append("must not be reached")

    with pytest.raises(KeyboardInterrupt) as stop:
        work()
    assert type(stop.value) is KeyboardInterrupt
    assert done == [signal.SIGINT]


def test_a_file_is_a_request_in_its_thread_alone(tmp_path) -> None:
    seen = []

    def worker() -> None:
        with Interrupts(tmp_path / "stop"):
            look()
            (tmp_path / "stop").touch()
            seen.append(caught())

    thread = threading.Thread(target=worker)
    with Interrupts():
        thread.start()
        thread.join()
        look()
    assert seen == [signal.SIGTERM]
