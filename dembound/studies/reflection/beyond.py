"""What the layers of a continuum beyond a side send back, by their formula (outside/layer.py)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dembound.boundaries import normal_axis
from dembound.disks.scene import DiskScene
from dembound.outside import choice
from dembound.outside.layer import Profile
from dembound.studies.reflection.meter import Kind, Reflections


def by_continuum(
    scene: DiskScene, side: str, frequencies: Sequence[float] | np.ndarray, angles: Sequence[float]
) -> tuple[int, Reflections]:
    """Number of nodes round a scene, and the reflections of the layer beyond a side.

    The elements reflect some of every wave in addition, `choice.layer_error`.
    """
    outside = scene.outside
    assert outside is not None
    body, axis = outside.body, normal_axis(side)
    slow, fast = body.medium.plane_waves((1.0 - axis, float(axis)))[0].tolist()
    profile = Profile(max(body.mesh.axes[axis].thickness), fast, body.mesh.inner, body.absorption)
    floor = choice.layer_error(outside.settings.order, outside.settings.layers) ** 2
    speeds: dict[Kind, float] = {"p": fast, "s": slow}
    same = {
        kind: np.array([[profile.expected_reflection(f, a, speed) ** 2 + floor for a in angles] for f in frequencies])
        for kind, speed in speeds.items()
    }
    nothing = {kind: np.zeros(values.shape) for kind, values in same.items()}
    return outside.count, Reflections(side, np.array(angles), np.array(frequencies), same, nothing)
