"""Starting points: the commented case files that ``dembound new`` writes.

Each is one TOML file in this folder. Its name is that of the file, and it is listed with its title. No other
registration is needed.
"""

import tomllib
from importlib.resources import files

from dembound.errors import CaseError

DEFAULT = "long_bar"
"""The default starting point."""

ENDING = ".toml"


def names() -> list[str]:
    """Names of all starting points: the default first, then by name."""
    found = [file.name.removesuffix(ENDING) for file in files(__name__).iterdir() if file.name.endswith(ENDING)]
    return sorted(found, key=lambda name: (name != DEFAULT, name))


def titles() -> dict[str, str]:
    """Name of every starting point -> its title, in the order of `names`."""
    return {name: tomllib.loads(starting_point(name))["title"] for name in names()}


def starting_point(name: str = DEFAULT) -> str:
    """The TOML text of a starting point; raises CaseError for an unknown name."""
    known = names()
    if name not in known:
        from dembound.casefile.messages import choices, show  # here, as they import all tables of case files

        raise CaseError([f"--from: is {show(name)}, must be one of {choices(name, known)}"])
    return (files(__name__) / f"{name}{ENDING}").read_text(encoding="utf-8")
