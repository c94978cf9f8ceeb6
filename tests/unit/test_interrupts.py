"""Requests to end are noted, and obeyed at calls of `look`; none is lost."""

import os
import signal
import threading
import time
from importlib.machinery import ExtensionFileLoader

import pytest

from dembound.interrupts import TOGETHER, Interrupts, Stopped, caught, end_while_loading, look, put_off


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


def test_requests_to_an_outer_statement_are_seen_within() -> None:
    def work(number: int) -> None:
        with Interrupts(), Interrupts() as inner:
            send(number)
            assert inner.caught == number
            look()
            pytest.fail("must not be reached")

    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        before = signal.signal(number, signal.default_int_handler)  # tests may be run where hangups are ignored
        with pytest.raises(Stopped) as stop:
            work(number)
        assert stop.value.exit_code == 128 + number
        signal.signal(number, before)


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


def test_signals_end_a_process_at_once_while_it_loads_a_library(monkeypatch) -> None:
    inside = []

    def load(loader: object, spec: object) -> None:
        inside.append(signal.getsignal(signal.SIGTERM))

    monkeypatch.setattr(ExtensionFileLoader, "create_module", load)
    end_while_loading()
    with Interrupts():
        noting = signal.getsignal(signal.SIGTERM)
        ExtensionFileLoader("library", "library.so").create_module(None)
        assert signal.getsignal(signal.SIGTERM) == noting
    assert inside == [signal.SIG_DFL]
