"""The order of a sweep, with workers that only note what they are given."""

from collections import deque
from concurrent.futures import Future
from contextlib import contextmanager

import pytest

from dembound.studies.sweep import study
from dembound.studies.sweep.perform import Outcome, outcome_in
from dembound.studies.sweep.study import Options, sweep
from dembound.studies.sweep.workers import Workers


class LostError(Exception):
    """The process of a task has ended."""


class Noting(Workers):
    """Two workers that answer by `answers` for a member's name; by default it is done at once.

    An answer is an outcome's values, an error, or a function of task and future, which stay under way.
    """

    lost = (LostError,)
    tries = 2

    def __init__(self, answers):
        self.answers = {name: deque(each) for name, each in answers.items()}
        self.submitted, self.killed = [], False

    def has_room(self, under_way):
        return under_way < 2

    def submit(self, task):
        self.submitted.append(task.name)
        future = Future()
        answer = self.answers[task.name].popleft() if self.answers.get(task.name) else {"x": 1.0}
        answer = answer(task, future) if callable(answer) else answer
        if isinstance(answer, BaseException):
            future.set_exception(answer)
        elif answer is not None:
            given = answer if "failure" in answer else {"values": answer}
            outcome = Outcome(task.name, folder=task.name, **given)
            outcome.write(task.folder, task.key)
            future.set_result(outcome)
        return future

    def kill(self):
        self.killed = True


@pytest.fixture
def swept(monkeypatch, tmp_path):
    """Sweeps members with noting workers; returns the outcomes and the workers."""

    def run(members, report=lambda standing: None, anew=False, **answers):
        workers = Noting(answers)

        @contextmanager
        def given(count, stop):
            yield workers

        monkeypatch.setattr(study, "processes", given)
        return sweep(members, Options(anew=anew), tmp_path / "a_sweep", report), workers

    return run


def names(members):
    return [member.name for member in members]


def test_only_what_is_missing_or_failed_is_done(rods, swept) -> None:
    members = rods(1e6, 2e6, 3e6)
    outcomes, workers = swept(members, **{members[1].name: [{"failure": "stalled"}]})
    assert workers.submitted == names(members)
    assert [outcome.failure for outcome in outcomes] == ["", "stalled", ""]
    outcomes, workers = swept(members)
    assert workers.submitted == [members[1].name]
    assert [outcome.failure for outcome in outcomes] == [""] * 3
    more = rods(1e6, 2.5e6, 3e6)
    assert swept(more)[1].submitted == [more[1].name]
    changed = rods(4e6, 5e6, **{"bar.density": 2600.0})
    assert swept(changed)[1].submitted == names(changed)
    assert swept(members)[1].submitted == []
    assert swept(members, anew=True)[1].submitted == names(members)
    same = rods(1e6, **{"bar.density": 2600.0})
    assert names(same) == names(members)[:1]
    swept(same)  # whose run is in the folder of the first member
    assert swept(members)[1].submitted == names(members)[:1]


def test_others_wait_until_the_first_is_stepped(rods, swept) -> None:
    members, under_way, first = rods(1e6, 2e6, 3e6), [], []

    def report(standing):
        under_way.append(standing.under_way)
        if len(under_way) == 2:
            task, _ = first
            task.begun.touch()
        elif len(under_way) == 4:
            _, future = first
            future.set_result(Outcome(members[0].name))

    def left_under_way(task, future):
        first.extend([task, future])

    _, workers = swept(members, report, **{members[0].name: [left_under_way]})
    assert under_way[:3] == [1, 1, 2]  # alone, until it is stepped
    assert workers.submitted == names(members)


def test_a_lost_member_is_repeated_once_then_failed_and_the_others_go_on(rods, swept, tmp_path) -> None:
    members = rods(1e6, 2e6, 3e6)
    answers = {members[0].name: [LostError(), {"x": 5.0}], members[1].name: [LostError(), LostError()]}
    outcomes, workers = swept(members, **answers)
    assert outcomes[0].values == {"x": 5.0}
    assert outcomes[1].failure == "its process was killed, as where memory is short (LostError)"
    assert outcomes[2].values == {"x": 1.0}
    assert sorted(workers.submitted) == sorted([*names(members), members[0].name, members[1].name])
    assert outcome_in(tmp_path / "a_sweep", members[1].key).failure == outcomes[1].failure
    # other errors of a cluster fail the member, which is repeated in the next sweep
    (other,) = rods(4e6)
    outcomes, _ = swept([other], **{other.name: [ModuleNotFoundError("No module named 'dembound'")]})
    assert outcomes[0].failure == "ModuleNotFoundError: No module named 'dembound'"
    assert outcome_in(tmp_path / "a_sweep", other.key) is None


def test_a_signal_asks_all_to_stop_and_leaves_what_is_done(rods, swept, tmp_path) -> None:
    members, folder, seen = rods(1e6, 2e6, 3e6), tmp_path / "a_sweep", []

    def report(standing):
        if standing.done == 1:
            raise KeyboardInterrupt

    def under_way(task, future):
        seen.append(task)

    with pytest.raises(KeyboardInterrupt):
        swept(members, report, **{members[1].name: [under_way]})
    assert not seen[0].stop.exists()  # nobody is left who has to see it
    assert outcome_in(folder, members[0].key).failure == ""
    assert not list(folder.glob("begun-*"))
    assert swept(members)[1].submitted == [members[1].name]
