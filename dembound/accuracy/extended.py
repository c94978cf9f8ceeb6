"""A scene enlarged until nothing returns from its artificial sides: the reference for reflections of these sides.

Sides that stand in for the ground or rock beyond them (`Boundary.is_artificial`) move outwards by whole bricks, until
no wave can have been there and back at any monitor within the run. Loads, holes and monitors stay where they are. The
disks of the case keep their places, as all bricks are alike, and move like those of an endless scene. Driven sides,
mirror planes and periodic sides stay where they are, and free, fixed and roller sides that are not `artificial`.

An artificial side through which waves enter also stays: farther away it would send another wave, as packings disperse,
or the same wave too late. Its reflections are then in the reference as in the case, and the sentence says so.
"""

from dembound.accuracy.judges import judge_of
from dembound.accuracy.moved_sides import Extended
from dembound.casefile import Case

MOST = 8_000_000
"""Particles of the largest scene that is made unless another limit is given; its run takes some 2 GB."""


def extended(case: Case, most: int = MOST) -> Extended:
    """The scene of a case enlarged so that nothing returns from artificial sides to its monitors within run.duration.

    Without monitors nothing returns to any place of the scene. The time step remains that of the case. Bars are
    extended beyond ends that are neither loaded nor driven.

    most : largest number of particles or nodes.

    Raises CaseError where no artificial side can move, where a hole reaches beyond a side that has to, and where more
    than `most` particles are needed; also the errors of building the scene.
    """
    return judge_of(case).extended(case, most)
