"""One trial of the strength of a body: what ended it, and what counts as a failure."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from dembound.casefile.disks.static import RATIO
from dembound.disks.rest.settled import Settled
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.kind import Stages, StalledError
from dembound.motion.simulation import Simulation
from dembound.motion.state import Arrays
from dembound.motion.trackers import Every, Run

JUMP, TIMES, SHARE = 0.5, 2.0, 0.01
"""Mean diameters, and times the largest elastic displacement, beyond which a disk has left its place; share of the
disks above which these are a failure."""

LOOKS = 100
"""Steps between two looks at the displacements."""

REST, FALL, NO_REST, MOVES = "at rest", "few fall", "no rest", "moves"
"""What ended a trial: equilibrium, that of all but a few disks which fall, none, or the jump of displacements."""


@dataclass(frozen=True)
class Tried:
    """One state that was tried.

    Attributes
    ----------
    value : F, or horizontal acceleration in g, positive to the right. ended : `REST`, `FALL`, `NO_REST` or `MOVES`.
    moved : m, largest distance of a disk from its elastic place, nan if a stage before the last one failed; left :
    number of disks that have left theirs; has_jumped : whether these are too many. broken : bonds that broke since the
    body was built. steps : of the last stage.
    """

    value: float
    ended: str
    moved: float
    left: int
    has_jumped: bool
    broken: int
    steps: int

    @property
    def stands(self) -> bool:
        """Whether the body stands."""
        return self.ended in (REST, FALL)


class LeftError(StalledError):
    """Raised in a trial in which too many disks have left their places."""

    def __init__(self, run: Run) -> None:
        super().__init__("disks have left their places", run, np.zeros((0, 2)), run.system.take_cracks(run.state.step))


class Places(Stages):
    """Watches the last stage of a trial, and judges its end.

    scene : of the trial. elastic : (2, n) m, displacements of the body's disks in the elastic state.
    """

    def __init__(self, scene: DiskScene, elastic: np.ndarray) -> None:
        self._body, self._elastic = scene.parts["body"], elastic
        self._limit = max(JUMP * scene.ground.brick.mean_diameter, TIMES * float(np.hypot(*elastic).max()))
        self._before, self._last = 0, False

    def begin(self, name: str, simulation: Simulation) -> None:
        """Watch the body, but not its free-field column alone, nor the body before an excavation."""
        self._last = name == "body"
        if self._last:
            simulation.track(Watch(self))

    def finish(self, name: str, arrays: Arrays) -> None:
        """Count the bonds that broke before an excavation."""
        self._before += len(arrays["cracks/step"]) if name == "before" else 0

    def moved(self, displacement: np.ndarray) -> np.ndarray:
        """Distances (m,) m of the body's disks from their elastic places, at displacements (3, n)."""
        distances: np.ndarray = np.hypot(*(displacement[:2, self._body] - self._elastic))
        return distances

    def has_failed(self, displacement: np.ndarray) -> bool:
        """Whether too many disks have left their places at displacements (3, n)."""
        return bool(np.mean(self.moved(displacement) > self._limit) > SHARE)

    def stalled(self, value: float, broken: int, error: StalledError) -> Tried:
        """The end of a trial that failed; broken : bonds before it."""
        state, broken = error.run.state, broken + self._before + len(error.cracks)
        if not self._last:
            return Tried(value, NO_REST, np.nan, 0, False, broken, state.step)
        found = self._tried(value, NO_REST, state.displacement, broken, state.step)
        if isinstance(error, LeftError):
            return replace(found, ended=MOVES)
        rests = found.left > 0 and not found.has_jumped and self._ratio_of_others(error) <= RATIO
        return replace(found, ended=FALL) if rests else found

    def _ratio_of_others(self, error: StalledError) -> float:
        """Force ratio of the disks that have not left their places, as `StaticScene.force_ratio` is of all."""
        stays = self.moved(error.run.state.displacement) <= self._limit
        assert isinstance(error.run.system, DiskSystem)
        pair = np.concatenate([np.hypot(*each.arrays.force[:2]) for each in error.run.system.contacts.values()])
        unbalanced = np.hypot(*error.unbalanced[self._body].T)
        return float(unbalanced[stays].mean() / pair[pair > 0.0].mean()) if pair.any() else np.inf

    def settled(self, value: float, broken: int, settled: Settled) -> Tried:
        """The end of a trial that came to rest; broken : bonds before it."""
        displacement, broken = settled.start.displacement, broken + self._before + len(settled.cracks)
        ended = MOVES if self.has_failed(displacement) else REST
        return self._tried(value, ended, displacement, broken, settled.steps)

    def _tried(self, value: float, ended: str, displacement: np.ndarray, broken: int, steps: int) -> Tried:
        moved = self.moved(displacement)
        left = int(np.count_nonzero(moved > self._limit))
        return Tried(value, ended, float(moved.max()), left, left > SHARE * len(moved), broken, steps)


class Watch(Every):
    """Ends a trial in which too many disks have left their places."""

    name = "places"

    def __init__(self, places: Places) -> None:
        super().__init__(LOOKS)
        self._places = places

    def see(self, run: Run) -> None:
        """Raise `LeftError`."""
        if self._places.has_failed(run.state.displacement):
            raise LeftError(run)
