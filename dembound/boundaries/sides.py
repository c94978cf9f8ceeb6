"""The four sides of a scene, the axis of their normals, and how waves move them."""

from typing import Literal

from dembound.table import Box

SIDES = ("left", "right", "bottom", "top")

Motion = Literal["p", "s"]
"""Kind of wave: P moves particles along the normal of the side it reaches, S across it."""

Factor = float | Literal["matched"]
"""Factor β of a side's dashpots as given: a number, or "matched" to absorb plane waves along the normal."""

OPPOSITE = {"left": "right", "right": "left", "bottom": "top", "top": "bottom"}
"""Side -> the side across the scene."""


def normal_axis(side: str) -> int:
    """Axis of a side's normal: 0 for left and right, 1 for bottom and top."""
    return 0 if side in ("left", "right") else 1


def is_far(side: str) -> bool:
    """Whether a side is at the far end of its axis: right or top."""
    return side in ("right", "top")


def plane_of(side: str, box: Box) -> float:
    """Position (m, along its normal) of a side of a box."""
    return box[normal_axis(side) + 2 * is_far(side)]


def axis_of_motion(side: str, motion: Motion) -> int:
    """Axis along which a wave moves the particles of a side at normal incidence."""
    return normal_axis(side) if motion == "p" else 1 - normal_axis(side)
