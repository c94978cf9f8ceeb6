"""The case: what a TOML file may say, and the one clear line for everything it may say wrongly."""

from dembound.case.model import BarCase, Case, DiskCase
from dembound.case.reader import load, loads
from dembound.case.starter import BAR_STARTER, STARTER
from dembound.case.writer import to_toml, with_changes

__all__ = ["BAR_STARTER", "STARTER", "BarCase", "Case", "DiskCase", "load", "loads", "to_toml", "with_changes"]
