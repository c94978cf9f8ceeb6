"""Errors by what a static stage leaves out of balance.

Steady forces take up what is left, so that nothing moves without a wave. But a contact at the limit of friction, which
bears the force f less than at rest, slides when the wave has brought f. Its share in the wave's force is f/(ρ c v D),
as a contact bears ρ c v D under a wave of the velocity v, and so is the error: with f of the size of the mean
unbalanced force. Under the elastic law no contact is at a limit, and the error is none.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from dembound.accuracy.cause import MOTIONS, Cause, Causes
from dembound.accuracy.history import Motions
from dembound.disks.material.wave_front import slowest_speed
from dembound.disks.scene import DiskScene
from dembound.motion.cracks import MANY

REST = "rest"
"""Name of the cause."""

REST_FACTOR = 3.0
"""Factor of the errors."""


def causes_of_rest(scene: DiskScene, motions: Motions, static: Mapping[str, Any] | None) -> Causes:
    """The errors of a run by the end of its static stage, without one or under the elastic law none.

    motions : by monitor. static : of the summary, see `describe_static`.
    """
    if static is None or static["elastic"]:
        return Causes([])
    stages = [each for each in (static, static["before"], static["column"]) if each is not None]
    if (broken := sum(each["cracks"] for each in stages)) > MANY:
        words = f"{broken:,} bonds broke while the body settled, which ones is one draw of many"
        return Causes([Cause.unknown(REST, f"{words}: see what another static.ratio changes")])
    ground = scene.ground
    # under a wave of 1 m/s; a surface has less
    force = ground.density * slowest_speed(ground) * ground.brick.mean_diameter
    left = static["mean_residual"] / force
    parts: dict[str, dict[str, np.ndarray | float]] = {}
    for name, own in motions.items():
        velocity = float(np.abs(own.velocity[:, :2]).max(initial=0.0))
        parts[name] = dict.fromkeys(MOTIONS, left / velocity if velocity > 0.0 else np.nan)
    words = "by the unbalanced force left by the static stage, over the wave's in a contact"
    return Causes([Cause(REST, words, parts, factor=REST_FACTOR)])
