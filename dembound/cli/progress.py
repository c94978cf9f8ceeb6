"""Progress of a run, estimate or advice on stderr: a bar on a terminal, else a line every ten seconds; and warnings.

The table of advice is printed as it becomes known.
"""

import math
import textwrap
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext

from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as RichProgress

from dembound.accuracy.proposal import Proposal, Watch
from dembound.accuracy.table import WIDTH, in_one_line, lines_of
from dembound.cli.console import INTERVAL, ending_with, err, print_lines
from dembound.formulas.cause import Cause
from dembound.formulas.history import Motions
from dembound.motion.trackers import Run
from dembound.running import Progress
from dembound.words import percent, with_unit

PACE = 60.0
"""Seconds up to now whose pace gives the time left: ground that breaks is stepped ever more slowly."""


class Shown(Progress):
    """Progress that is shown under a name, which may change."""

    def begin(self, name: str) -> None:
        """Something else begins, of this name."""

    def aside(self) -> AbstractContextManager[None]:
        """Inside, other things may be printed to the terminal."""
        return nullcontext()


@contextmanager
def progress_of(name: str) -> Iterator[Shown]:
    """The progress of the case of that name."""
    if not err.is_terminal:
        yield Lines(name)
        return
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %  {task.fields[rate]}", markup=False),
        TimeRemainingColumn(),
    )
    with RichProgress(*columns, console=err, transient=True, speed_estimate_period=PACE) as bar:
        yield ProgressBar(bar, name)


class Watching(Watch):
    """Shows what is computed for an estimate or for advice, and prints what is known meanwhile.

    Parameters
    ----------
    name : of the case; shown : its progress.

    Attributes
    ----------
    missing : what is not known yet, in words.
    """

    def __init__(self, name: str, shown: Shown) -> None:
        self.name, self.shown, self.missing = name, shown, "all errors"

    def begins(self, what: str) -> None:
        """Show what begins, after the part of the whole that it belongs to."""
        super().begins(what)
        self.shown.begin(": ".join(filter(None, (self.name, self.part, what))))

    @contextmanager
    def run(self, what: str) -> Iterator[Progress]:
        """Show the steps of a companion."""
        self.begins(what)
        yield self.shown

    def says(self, words: str) -> None:
        """Print it in one line."""
        err.print(f"{self.name}: {words}")

    def knows(self, causes: Sequence[Cause], motions: Motions, missing: str) -> None:
        """Print the causes in one line, once, which remains if the rest is interrupted."""
        before, self.missing = self.missing, missing
        if missing != before and (known := in_one_line(causes, motions)):
            err.print(f"{self.name}: largest errors by formula: {known}; still to be found: {missing}")


@contextmanager
def watched(name: str, made: Callable[[str, Shown], Watching] = Watching) -> Iterator[Watching]:
    """The watch of an estimate or of advice about the case of that name; a request to end says what is missing.

    made : makes it from the name and its progress.
    """
    with progress_of(name) as shown:
        watching = made(name, shown)
        with ending_with(lambda: f"{name}: stopped; missing: {watching.missing}"):
            yield watching


def print_warning(name: str, message: str) -> None:
    """Print a warning about the case of that name to stderr."""
    err.print(f"{name}: warning: {message}")


class Lines(Shown):
    """A run's progress as plain lines.

    Parameters
    ----------
    name : of the case.
    now : clock in s.
    """

    def __init__(self, name: str, now: Callable[[], float] = time.monotonic) -> None:
        self.name, self.now = name, now
        self.began = self.begun = now()
        self.next = INTERVAL
        """Seconds of a static stage after which the next line is printed."""
        self.lines: deque[tuple[float, int, float]] = deque(maxlen=round(PACE / INTERVAL))
        """Of the last lines, and the first block: time, steps, and seconds of compiling, which no rate includes."""
        self.stage = ""
        """The static stage of the last line."""

    def begin(self, name: str) -> None:
        """Print the name of what begins, unless a line was printed a short time ago."""
        self.name, self.stage, self.began, self.next = name, "", self.now(), INTERVAL
        self.lines.clear()
        if self.began - self.begun >= INTERVAL:
            self.begun = self.began
            err.print(name)

    def warned(self, message: str) -> None:
        """Print the warning at once, on a separate line."""
        print_warning(self.name, message)

    def settling(self, steps: int, ratio: float, stage: str) -> None:
        """Print time, steps and force ratio of a static stage, 10, 20, 40, … seconds after its begin."""
        if self.stage not in ("", stage):
            self.began, self.next = self.now(), INTERVAL
        self.stage = stage
        if (took := self.now() - self.began) >= self.next:
            self.next *= 2.0
            err.print(f"{self.name}: {stage}, {took:.0f} s, {steps:,} steps, unbalanced force ratio {ratio:.1e}")

    def running(self, run: Run, steps: int) -> None:
        """Print steps done and in all, simulated time; from the last minute particle-steps per second and time left."""
        now = self.now(), run.state.step, run.clock.seconds["compile"]
        if not self.lines:
            self.lines.append(now)
        elif now[0] - self.lines[-1][0] >= INTERVAL:
            since, done, compiling = (b - a for a, b in zip(self.lines[0], now, strict=True))
            self.lines.append(now)
            rate = done * run.scene.count / (since - compiling) / 1e6
            left = (steps - run.state.step) * run.scene.count / (1e6 * rate) if rate > 0.0 else math.inf
            self.begun = now[0]
            err.print(
                f"{self.name}: {run.state.step:,} of {steps:,} steps, {run.time:.4g} s simulated, "
                f"{rate:.3g} M particle-steps/s, about {with_unit(left, 's', 2)} left"
            )


class ProgressBar(Shown):
    """A run's progress as a bar, with rate and time left."""

    def __init__(self, bar: RichProgress, name: str) -> None:
        self.bar, self.name = bar, name
        self.task = bar.add_task(name, total=None, rate="")

    def warned(self, message: str) -> None:
        """Print the warning on a separate line above the bar."""
        print_warning(self.name, message)

    def begin(self, name: str) -> None:
        """A new bar, for what begins."""
        self.bar.remove_task(self.task)
        self.name, self.task = name, self.bar.add_task(name, total=None, rate="")

    @contextmanager
    def aside(self) -> Iterator[None]:
        """Inside, there is no bar."""
        self.bar.stop()
        yield
        self.bar.start()

    def settling(self, steps: int, ratio: float, stage: str) -> None:
        """A static stage, whose number of steps is not known in advance."""
        self.bar.update(self.task, description=f"{self.name}: {stage}, {steps:,} steps, ratio {ratio:.1e}")

    def running(self, run: Run, steps: int) -> None:
        """The run itself."""
        speed = self.bar.tasks[0].speed
        rate = f"{speed * run.scene.count / 1e6:.0f} M particle-steps/s" if speed else ""
        self.bar.update(self.task, description=self.name, completed=run.state.step, total=steps, rate=rate)


class Table(Watching):
    """Shows what is computed, and prints errors of a case and the cheapest choice by bound, once known."""

    def __init__(self, bounds: Sequence[float], name: str, shown: Shown) -> None:
        super().__init__(name, shown)
        self._left, self._before = sorted(bounds, reverse=True), ""

    def given(self, proposal: Proposal) -> None:
        """Print the errors of the case, and the head of the table of choices."""
        self._print(
            f"{self.name}: its steps take about {with_unit(proposal.cost, 's', 2)}",
            *lines_of(proposal.budget),
            "",
            "   requested  predicted  at most      time   what changes",
        )

    def best(self, bound: float, best: Proposal) -> None:
        """Print the choice for a bound."""
        share = best.budget.worst().share
        numbers = f"{share.expected:>9} {share.most:>8}  {with_unit(best.cost, 's', 2):>8}   "
        words = best.choice.name if best.choice.changes else "nothing"
        if not best.holds(bound):
            words = f"no choice holds it, least error: {words if best.choice.changes else 'the case as it is'}"
        self._before, words = words, "the same" if words == self._before != "nothing" else words
        first = f"{percent(bound, 3):>12}  {numbers}"
        self._left.remove(bound)
        self._print(*textwrap.wrap(words, WIDTH, initial_indent=first, subsequent_indent=" " * 8))

    def _print(self, *lines: str) -> None:
        """Print lines of at most 80 characters."""
        left = ", ".join(percent(each, 3) for each in self._left)
        self.missing = f"the cheapest choices within {left}" if left else "nothing"
        with self.shown.aside():
            print_lines(*lines)
