"""The case file: its tables, and one clear line for every mistake in them."""

from dembound.casefile.model import Case
from dembound.casefile.writer import to_toml

__all__ = ["Case", "to_toml"]
