"""What a side on rock returns beyond the reflection of the rock itself, along its normal.

The rock begins at the plane of the side; of the disks there the mass begins at a depth m, and the stiffness, on which
the dashpots act, at s (disks/entry.py). For long waves of the wave number k that is an impedance too many of
i k (s α² − m) at the plane, over that of the ground, with α of the rock. The reflection (1 − α)/(1 + α) then has an
error of 2 i k (s α² − m)/(1 + α)², a multiple of the acceleration. Shifts of the entry time are no error.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from dembound.accuracy.cause import MOTIONS
from dembound.accuracy.history import History
from dembound.accuracy.of_disks.waves import crossing_time
from dembound.boundaries import Motion, axis_of_motion, normal_axis
from dembound.disks.entry import side_ends
from dembound.disks.matching import factors_in, homogenised_beta
from dembound.disks.scene import DiskScene
from dembound.disks.side_media import ground_at


def errors_on_rock(
    scene: DiskScene, side: str, own: History, back: Mapping[Motion, float]
) -> dict[str, np.ndarray | float]:
    """Errors (k, 2) of a recorded motion by a side on rock, by quantity.

    back : by kind of wave, the reflection of the opposite side, from which the motion comes back to the rock; 0 where
    nothing does, but for waves that only leave: there the recorded motion itself arrives.
    """
    axis, errors = normal_axis(side), {quantity: np.zeros_like(own.values[quantity]) for quantity in MOTIONS}
    driven, ground = scene.case.side(side).waves, ground_at(scene, side)
    for motion, (mass, stiffness) in side_ends(scene, side).items():
        speed, column = ground.wave_speeds(axis)[0 if motion == "p" else 1], axis_of_motion(side, motion)
        alpha = factors_in(scene, side)[motion] / homogenised_beta(scene, side, motion)
        if not math.isfinite(speed):
            continue
        trip = 2.0 * crossing_time(scene, axis, motion) if driven else 0.0
        returned = back[motion] if driven else 1.0
        lag = -2.0 * (stiffness * alpha**2 - mass) / (speed * (1.0 + alpha) ** 2)
        velocity = own.values["velocity"][:, column]
        rates = {"velocity": np.gradient(velocity, own.time), "displacement": velocity}
        for quantity, rate in rates.items():
            error = returned * lag * np.interp(own.time - trip, own.time, rate, left=0.0)
            again, late = (1.0 - alpha) / (1.0 + alpha) * returned, trip
            while driven and abs(again) > REPEATED and late < own.time[-1] - own.time[0]:
                errors[quantity][:, column] += again * np.interp(own.time - late, own.time, error, left=0.0)
                again, late = again * (1.0 - alpha) / (1.0 + alpha) * returned, late + trip
            errors[quantity][:, column] += error
    return dict(errors)


REPEATED = 1e-3
"""Share of an error that comes back from the rock once more, below which it no longer counts."""
