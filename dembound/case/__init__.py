"""The case: what a TOML file may say, and the one clear line for everything it may say wrongly."""

from dembound.case.model import Case
from dembound.case.writer import to_toml

__all__ = ["Case", "to_toml"]
