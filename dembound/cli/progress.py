"""Progress of a run on stderr: a bar on a terminal, else a line every ten seconds; and its warnings."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.progress import BarColumn, ProgressColumn, Task, TextColumn, TimeRemainingColumn
from rich.progress import Progress as RichProgress
from rich.text import Text

from dembound.cli.compiling import COMPILATION
from dembound.cli.console import INTERVAL, err
from dembound.motion.trackers import Run
from dembound.running import Progress


@contextmanager
def progress_of(name: str) -> Iterator[Progress]:
    """The progress of the case of that name."""
    if not err.is_terminal:
        yield Lines(name)
        return
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %  {task.fields[rate]}", markup=False),
        TimeRemainingColumn(),
        _Compiling(),
    )
    COMPILATION.beside_bar = True
    try:
        with RichProgress(*columns, console=err, transient=True) as bar:
            yield ProgressBar(bar, name)
    finally:
        COMPILATION.beside_bar = False


class _Compiling(ProgressColumn):
    """The note on compiling in a bar of progress."""

    def render(self, task: Task) -> Text:
        """The note of the process."""
        return Text(COMPILATION.note())


def print_warning(name: str, message: str) -> None:
    """Print a warning about the case of that name to stderr."""
    err.print(f"{name}: warning: {message}")


class Lines(Progress):
    """A run's progress as plain lines.

    Parameters
    ----------
    name : of the case.
    now : clock in s.
    """

    def __init__(self, name: str, now: Callable[[], float] = time.monotonic) -> None:
        self.name, self.now = name, now
        self.began = self.said = now()
        self.next = INTERVAL
        """Seconds of a static stage after which the next line is printed."""
        self.steps: int | None = None
        """Steps of the run at the last line; None before the first block."""
        self.compiled = 0.0
        """Seconds of compiling up to the last line, which a rate does not include."""

    def warned(self, message: str) -> None:
        """Print the warning at once, on a separate line."""
        print_warning(self.name, message)

    def settling(self, steps: int, ratio: float) -> None:
        """Print time, steps and force ratio of the static stage, after 10, 20, 40, … seconds."""
        if (took := self.now() - self.began) >= self.next:
            self.next *= 2.0
            err.print(f"{self.name}: static stage, {took:.0f} s, {steps:,} steps, unbalanced force ratio {ratio:.1e}")

    def running(self, run: Run, steps: int) -> None:
        """Print steps done and in all, simulated time, and particle-steps per second since the last line."""
        compiled = run.clock.seconds["compile"]
        if self.steps is None:
            self.said, self.steps, self.compiled = self.now(), run.state.step, compiled
        elif (since := self.now() - self.said) >= INTERVAL:
            stepping = since - (compiled - self.compiled)
            rate = (run.state.step - self.steps) * run.scene.count / stepping / 1e6
            self.said, self.steps, self.compiled = self.said + since, run.state.step, compiled
            err.print(
                f"{self.name}: {run.state.step:,} of {steps:,} steps, {run.time:.4g} s simulated, "
                f"{rate:.3g} M particle-steps/s"
            )


class ProgressBar(Progress):
    """A run's progress as a bar, with rate and time left."""

    def __init__(self, bar: RichProgress, name: str) -> None:
        self.bar, self.name = bar, name
        self.task = bar.add_task(name, total=None, rate="")

    def warned(self, message: str) -> None:
        """Print the warning on a separate line above the bar."""
        print_warning(self.name, message)

    def settling(self, steps: int, ratio: float) -> None:
        """The static stage, whose number of steps is not known in advance."""
        self.bar.update(self.task, description=f"{self.name}: static stage, {steps:,} steps, ratio {ratio:.1e}")

    def running(self, run: Run, steps: int) -> None:
        """The run itself."""
        speed = self.bar.tasks[0].speed
        rate = f"{speed * run.scene.count / 1e6:.0f} M particle-steps/s" if speed else ""
        self.bar.update(self.task, description=self.name, completed=run.state.step, total=steps, rate=rate)
