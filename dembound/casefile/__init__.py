"""The case: what a TOML file may say, and the one clear line for everything it may say wrongly."""

from dembound.casefile.model import Case
from dembound.casefile.writer import to_toml

__all__ = ["Case", "to_toml"]
