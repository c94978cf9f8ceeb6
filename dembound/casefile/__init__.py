"""The case file: its tables, and one clear line for every mistake in them."""

from dembound.casefile.edit import to_toml
from dembound.casefile.model import Case

__all__ = ["Case", "to_toml"]
