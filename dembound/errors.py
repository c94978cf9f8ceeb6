"""The errors dembound raises, and the exit code of each kind of failure.

Every error a user can cause is a `DemboundError`; the command line prints its message once and exits with its code. Any
other exception is a bug and prints a traceback.

| code | meaning |
|---|---|
| 0 | done |
| 1 | a bug |
| 2 | bad input, nothing was written: the case file or the command's arguments |
| 3 | a run, calibration or choice failed: motion grew, memory ran out, β did not converge, no window or choice |
| 4 | a packing could not be made |
| 5 | a file could not be read or written |
| 130 | stopped with Ctrl-C, 143 by SIGTERM, 129 by SIGHUP |
"""

import re
from collections.abc import Iterable

_HIDDEN = (
    r"\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"  # what changes the direction of text
    r"\u200b\u2060-\u2065\u206a-\u206f\ufeff\ufff9-\ufffb\U000e0000-\U000e007f"  # what cannot be seen
)

HIDDEN = re.compile(f"[{_HIDDEN}]")
"""Characters that reorder a text or are invisible, so that it looks like another one."""

CONTROL = re.compile(rf"[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff{_HIDDEN}]")
"""Characters that names and titles must not have: those in `HIDDEN`, control characters, ends of lines, bytes that are
not text.
"""


def escaped(found: re.Match[str]) -> str:
    r"""A matched character as an escape such as ``\x1b``."""
    return found[0].encode("unicode_escape").decode()


def visible(text: str) -> str:
    r"""A text in one line, with what `CONTROL` finds as escapes such as ``\x1b``, so that none reaches a terminal."""
    return CONTROL.sub(escaped, text)


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
    """A name that results do not have; the message lists the existing names. Also a KeyError, as of any mapping."""

    __str__ = Exception.__str__  # without the quotes of a KeyError


class NumberMissingError(CaseError, IndexError):
    """A number outside the range of results, which the message gives. Also an IndexError, as of any list."""


class RecordError(CaseError):
    """A record of results that cannot be read, is damaged, or is incomplete."""

    exit_code = 5


class RunError(DemboundError):
    """A run that had to stop; the message gives time and place."""

    exit_code = 3


class NotAccurateError(DemboundError):
    """No choice keeps the requested error bound; the message has the best one."""

    exit_code = 3


class PackingError(DemboundError):
    """A packing that did not reach the requested stress, force balance or size."""

    exit_code = 4


class CaseWarning(UserWarning):
    """A warning about a probable mistake in a case, or about its results."""


class UnusableTypeWarning(UserWarning):
    """A type of tables that another package registers, but that cannot be used."""
