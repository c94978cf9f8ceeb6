"""What can go wrong, and the exit code each kind of failure ends with.

Every error a user can cause is a `DemboundError`; the command line prints its message once and exits with
its code. Anything else is a bug and shows a traceback.

| code | meaning |
|---|---|
| 0 | done |
| 1 | a bug |
| 2 | bad input, nothing was written: the case file or the command's arguments |
| 3 | a run, calibration or view failed: motion grew without bound, β did not converge, no window opened |
| 4 | a packing could not be made |
| 5 | a file could not be read or written |
| 130 | stopped with Ctrl-C |
"""

from collections.abc import Iterable


class DemboundError(Exception):
    """A failure the user can act on.

    `exit_code` is what the process ends with, `source` the case or file it is about, where that is known.
    """

    exit_code = 3
    source = ""


class CaseError(DemboundError):
    """Bad input: every mistake found, one line each, as ``table.key: what is wrong, what is allowed``."""

    exit_code = 2

    def __init__(self, problems: Iterable[str], source: str = "") -> None:
        self.problems = list(problems)
        self.source = source
        super().__init__("\n".join(self.problems))


class RunError(DemboundError):
    """A run that could not go on: it says when and where."""

    exit_code = 3


class PackingError(DemboundError):
    """A packing that did not reach the stress, the force balance or the size asked for."""

    exit_code = 4
