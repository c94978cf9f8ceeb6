"""The errors dembound raises, and the exit code of each kind of failure.

Every error a user can cause is a `DemboundError`; the command line prints its message once and exits with its code. Any
other exception is a bug and prints a traceback.

| code | meaning |
|---|---|
| 0 | done |
| 1 | a bug |
| 2 | bad input, nothing was written: the case file or the command's arguments |
| 3 | a run, calibration, view or choice failed: motion grew, β did not converge, no window, no error so small |
| 4 | a packing could not be made |
| 5 | a file could not be read or written |
| 130 | stopped with Ctrl-C, 143 by SIGTERM, 129 by SIGHUP |
"""

import re
from collections.abc import Iterable

CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]")
"""Characters that no name or title may have: control characters, line separators, and bytes that are not text."""


def visible(text: str) -> str:
    r"""A text in one line, with its control characters as escapes such as ``\x1b``, so that none reaches a terminal."""
    return CONTROL.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


class DemboundError(Exception):
    """A failure the user can correct.

    `exit_code` is the exit code of the process, `source` the case or file concerned, where there is one.
    """

    exit_code = 3
    source = ""


class CaseError(DemboundError):
    """Bad input: every mistake found, one line each, as ``table.key: what is wrong, what is allowed``."""

    exit_code = 2

    def __init__(self, problems: Iterable[str], source: str = "") -> None:
        self.problems = [visible(problem) for problem in problems]
        self.source = source
        super().__init__("\n".join(self.problems))


class NameMissingError(CaseError, KeyError):
    """A name that results do not have; the message has those they have. Also a KeyError, as of any mapping."""

    __str__ = Exception.__str__  # without the quotes of a KeyError


class RecordError(CaseError):
    """A record of results that cannot be read, is damaged, or lacks what every record has."""

    exit_code = 5


class RunError(DemboundError):
    """A run that had to stop; the message gives time and place."""

    exit_code = 3


class NotAccurateError(DemboundError):
    """No choice whose error is as small as asked for; the message has the best one."""

    exit_code = 3


class PackingError(DemboundError):
    """A packing that did not reach the stress, the force balance or the size asked for."""

    exit_code = 4


class UnusableTypeWarning(UserWarning):
    """A type of tables that another package registers, but that cannot be used."""
