"""Roots of functions of one variable.

scipy finds them in fewer steps, but importing it takes longer than all steps here.
"""

from collections.abc import Callable


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """The root of a function that is positive at `low` and negative at `high`, to the last bit, by bisection."""
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if function(middle) > 0.0 else (low, middle)
    return high
