"""The four sides of a scene, and the axis of their normals."""

SIDES = ("left", "right", "bottom", "top")

OPPOSITE = {"left": "right", "right": "left", "bottom": "top", "top": "bottom"}
"""Side -> the side across the scene."""


def normal_axis(side: str) -> int:
    """Axis of a side's normal: 0 for left and right, 1 for bottom and top."""
    return 0 if side in ("left", "right") else 1
