"""The cheapest choice of what a case leaves open with which its run is as accurate as asked for."""

from dembound.studies.accuracy.choice import Choice
from dembound.studies.accuracy.choosing import choose

__all__ = ["Choice", "choose"]
