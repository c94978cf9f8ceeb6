"""The exact plane wave through a block of disks, which charts compare their choices with."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from dembound.accuracy.history import History, Motions, along
from dembound.accuracy.of_disks.waves import is_square_lattice
from dembound.accuracy.reference import Exact
from dembound.boundaries import OPPOSITE, Motion, axis_of_motion, normal_axis
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.scene import build, ground_of


@dataclass(frozen=True)
class ExactPlaneWave(Exact[DiskCase]):
    """A plane wave that enters at one side of a block of disks and leaves at the opposite one.

    It enters through the plane of the side, at once, and runs with the homogenised speed of the packing of each choice;
    on the opposite side it leaves without reflection, whatever side a choice has there.
    """

    side: str
    motion: Motion
    sentence: str = "exact plane wave at the homogenised speed, leaving without reflection"

    @classmethod
    def of(cls, case: DiskCase) -> ExactPlaneWave | None:
        """The solution of a case; None if it is another problem."""
        other = case.is_damped or len(case.layer) > 1
        if other or case.hole or case.load or case.static or len(case.driving) != 1:
            return None
        ((side, waves),) = case.driving.items()
        far = case.side(OPPOSITE[side])
        if case.side(side).is_interface or far.is_interface:
            return None
        if len(waves) != 1 or not far.factors or far.waves or not LAWS[case.material.law].is_linear:
            return None
        ((motion, _),) = waves.items()
        return cls(side, motion) if all(_keeps_plane(case, side, motion)) else None

    def motions(self, case: DiskCase, recorded: Motions) -> dict[str, History]:
        """The wave at the monitors' particles, at the same times."""
        scene, axis = build(case), normal_axis(self.side)
        speed = scene.ground.wave_speeds(axis)[0 if self.motion == "p" else 1]
        start = scene.plane(self.side)
        wave, column = case.wave[case.driving[self.side][self.motion]], axis_of_motion(self.side, self.motion)
        found = {}
        for name, history in recorded.items():
            late = history.time - abs(float(history.place[axis]) - start) / speed
            moved, moving = (along(motion(late), column) for motion in (wave.displacement, wave.velocity))
            found[name] = History.of(history.place, history.time, moved, moving)
        return found


def _keeps_plane(case: DiskCase, side: str, motion: Motion) -> Iterator[bool]:
    """For each of the two sides along which a plane wave runs, whether the wave stays plane.

    Along free sides it does so on a square lattice only. Free edges of random packings are softer, even with rows of
    equal disks along them: they slow the wave in a strip 20 disks high by up to 2 %.
    """
    across = 1 - normal_axis(side)
    held = motion == "p" and "xy"[across] in case.motion.held
    for lateral in ("bottom", "top") if across == 1 else ("left", "right"):
        is_even = held and case.side(lateral).is_free and case.packing.is_lattice
        yield case.side(lateral).is_periodic or (is_even and is_square_lattice(ground_of(case)))
