"""The interface of a kind of body to runs, checks and reports; schemas.py lists the kinds. First echoes of sides."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, Protocol, TypeVar

import numpy as np

from dembound.boundaries import SIDES, normal_axis
from dembound.casefile.model import Case, Schema
from dembound.errors import RunError
from dembound.motion.endings import monitored
from dembound.motion.memory import Storage
from dembound.motion.part import Cracks, System
from dembound.motion.paths import Front, Source
from dembound.motion.scene import Scene
from dembound.motion.stability import Trial
from dembound.motion.state import Arrays
from dembound.motion.trackers import Run, Tracker
from dembound.table import Box
from dembound.words import CracksBy, Entries

if TYPE_CHECKING:
    import h5py
    import meshio
    from matplotlib.figure import Figure

    from dembound.motion.simulation import Simulation


class MovingPicture(Protocol):
    """A body at the snapshots of its record, all with the same axes and colours.

    Attributes
    ----------
    times : (k,) of the snapshots, s.
    width, height : of each frame in inches.
    words : description of the drawn field.
    """

    times: np.ndarray
    width: float
    height: float
    words: str

    def caption(self, index: int) -> str:
        """The time of a frame, and events until then, in words."""

    def frame(self, index: int, pixels: int) -> np.ndarray:
        """One frame as a picture (rows, pixels, 3) of red, green and blue from 0 to 255."""


class Slower(NamedTuple):
    """A pace slower than that of the first steps: when, in words, and ns of a step on one core at first and then."""

    words: str
    first: float
    then: float


class Stages:
    """Receives the stages of a run. This class keeps nothing, so all stages are computed."""

    def finished(self, name: str) -> Arrays | None:
        """The arrays that `finish` has received for a stage, maybe in another run; None if it has to be computed."""
        return None

    def begin(self, name: str, simulation: Simulation) -> None:
        """Called before the first step of a stage; may set the simulation to a state reached before."""

    def finish(self, name: str, arrays: Arrays) -> None:
        """Receives the results of a completed stage."""


C = TypeVar("C", bound=Case)
S = TypeVar("S", bound=Scene)

OnLook = Callable[[int, float, str], None]
"""Called with the number of steps of a static stage done so far, its force ratio, and its name."""


@dataclass(frozen=True)
class Reduction(Generic[S]):
    """The scene that is stepped in place of another one.

    scene : the smaller scene, or the same where no reduction applies.
    refused : the requested reductions that are impossible, each in a line with the reason.
    """

    scene: S
    refused: tuple[str, ...] = ()


@dataclass(frozen=True)
class Plan(Generic[S]):
    """A case before its first step: the scene, the time step and its limit (s), the number of steps.

    stepped : the scene whose motion is computed, the scene itself or a smaller one, and refused : see `Reduction`.
    regular_steps : number of steps of the run as it was begun, from which intervals of ledger and snapshots follow.
    """

    kind: Kind[Any, S]
    scene: S
    stepped: S
    time_step: float
    step_limit: float
    steps: int
    regular_steps: int
    refused: tuple[str, ...] = ()


class Finding(NamedTuple):
    """A number from a run, and its unit."""

    value: float
    unit: str


@dataclass(frozen=True)
class Stage:
    """A stage before the run, for the record.

    name : of its group in the record; facts : numbers by name; displacement (3, n) m and rad at its end, and its
    cracks, both for the nodes of the run.
    """

    name: str
    facts: Mapping[str, Any]
    displacement: np.ndarray
    cracks: Cracks


@dataclass(frozen=True)
class Beginning:
    """The state in which a run begins: parts and ties, their displacements (3, n) at rest, and the stages before.

    summary : these stages in reports, as plain JSON values; None if there were none.
    """

    system: System
    datum: np.ndarray | None = None
    stages: tuple[Stage, ...] = ()
    summary: Mapping[str, Any] | None = field(default=None, repr=False)


class StalledError(RunError):
    """Raised for a stage before the run that does not come to rest.

    Attributes: run, the state it reached; unbalanced (n, 2), N, sum of the forces on each node in this state; cracks,
    the bonds that broke in the stage.
    """

    def __init__(self, message: str, run: Run, unbalanced: np.ndarray, cracks: Cracks) -> None:
        super().__init__(message)
        self.run = run
        self.unbalanced = unbalanced
        self.cracks = cracks


class Kind(ABC, Generic[C, S]):
    """A kind of body: builds the scenes of its cases, their initial states, and reports.

    Attributes
    ----------
    name : in records; plural : in messages.
    schema : the tables of its case files.
    view_script : a script that shows its files in ParaView.
    work_unit : unit of the `work` of a run, in the plural.
    """

    name: str
    plural: str
    schema: Schema
    view_script: str
    work_unit: str

    @abstractmethod
    def build(self, case: C) -> S:
        """The scene of a case.

        Raises CaseError and PackingError for errors that would stop a run later, before anything is written.
        """

    def is_planned_quickly(self, case: C) -> bool:
        """Whether a run is planned without a long search for the stability limit; by default if a step is given."""
        return case.run.time_step != "auto"

    @abstractmethod
    def choose_step(self, scene: S) -> tuple[float, float]:
        """Time step to run with and the stability limit (s); raises CaseError for a given step above the limit."""

    def reduced(self, scene: S) -> Reduction[S]:
        """A smaller scene whose motion gives that of the scene; by default the scene itself."""
        return Reduction(scene)

    @abstractmethod
    def begin(self, scene: S, time_step: float, on_look: OnLook, stages: Stages | None = None) -> Beginning:
        """Bring a scene to the state in which its run begins; stages : keep its stages, by default nothing.

        Raises StalledError when a stage before does not come to rest.
        """

    def trackers(self, run: Run) -> list[Tracker]:
        """Additional trackers that the case of a run requires; by default none."""
        return []

    @abstractmethod
    def trials(self, case: C, *, full: bool = False) -> tuple[list[Trial], list[str]]:
        """The scenes in which the largest stable step of a case is measured, and their differences from it, in words.

        full : the whole scene, where it consists of copies of a part, instead of fewer of them. Raises the errors of
        building a scene.
        """

    @abstractmethod
    def sources(self, scene: S) -> list[Source]:
        """The sources of motion of a scene: places, times and speeds."""

    @abstractmethod
    def front(self, scene: S, time_step: float) -> Front:
        """The fastest waves of a scene that is stepped by time_step (s)."""

    def late(self, scene: S) -> float | None:
        """Time (s) by which all motion is later than waves through the planes of sides; by default 0.

        None where several waves are late by different times.
        """
        return 0.0

    @abstractmethod
    def storage(self, scene: S) -> Storage:
        """Bytes on disk of the results of a scene."""

    def require_ready(self, scene: S, stepped: S) -> None:
        """Raise the errors of what a run computes after its plan and before its first step; by default nothing.

        stepped : the scene whose motion is computed.
        """

    def stage_keys(self, scene: S) -> dict[str, Any]:
        """All inputs that determine the results of the stages before a run, as plain JSON values by key."""
        return {}

    def stage_names(self, scene: S) -> list[str]:
        """The names of the stages before a run, by default none."""
        return []

    def stages_from(self, case: C) -> Path | None:
        """The folder of results whose stages a case uses; by default none."""
        return None

    @abstractmethod
    def facts(self, scene: S, time_step: float) -> Entries:
        """Facts about a case with a time step (s); printed by `dembound check`."""

    def slower(self, scene: S) -> Slower | None:
        """The slowest pace that the steps of a run may come to; None if all take as long as the first ones."""
        return None

    def settles(self, case: C) -> bool:
        """Whether a static stage precedes the motion, of a number of steps that is not known in advance."""
        return False

    @abstractmethod
    def warnings_before(self, scene: S, time_step: float) -> list[str]:
        """Warnings that are known before the run, one line each."""

    @abstractmethod
    def warnings_after(self, scene: S, summary: Mapping[str, Any], record: Path) -> list[str]:
        """Warnings from the results of a run, one line each."""

    @abstractmethod
    def summarise(self, scene: S, run: Run, beginning: Beginning, record: Path) -> dict[str, Any]:
        """Additional entries of a summary for this kind of body: plain JSON values, SI units."""

    def derived(self, scene: S, file: h5py.File) -> dict[str, tuple[np.ndarray, str]]:
        """What follows from the snapshots and cracks of the open record of a run, by name: values and unit."""
        return {}

    @abstractmethod
    def work(self, run: Run) -> int:
        """The work of a run so far, in `work_unit`; the same in every run of a case."""

    def findings(self, scene: S, run: Run, inside: Box | None = None) -> dict[str, Finding]:
        """Numbers by name that are compared between runs in addition to histories; by default none.

        inside : part of the scene in which they are sought, by default all.
        """
        return {}

    @abstractmethod
    def outcome(self, summary: Mapping[str, Any]) -> list[str]:
        """The results of a run in words, from its summary."""

    @abstractmethod
    def meshes(self, particles: Arrays, snapshot: Arrays, cracks: Arrays) -> dict[str, meshio.Mesh]:
        """Meshes for ParaView of one snapshot of a record, with the cracks until then, by the names of their files.

        particles, snapshot, cracks : columns by name.
        """

    @abstractmethod
    def pictures(self, record: Path) -> Iterator[tuple[str, Figure]]:
        """The pictures of a run by name, besides the picture of its monitors' velocities."""

    @abstractmethod
    def field_picture(
        self, record: Path, field: str, snapshot: int | None, exaggerate: float | None, cracks: CracksBy = "kind"
    ) -> Figure:
        """A field of a record as a picture, of one snapshot or of suitable ones.

        exaggerate : as of `moving_picture`. cracks : colours of broken bonds. Raises CaseError if the field is missing.
        """

    @abstractmethod
    def moving_picture(self, record: Path, field: str | None, exaggerate: float | None) -> MovingPicture:
        """A field of a record at every snapshot, by default the field of a run's pictures.

        exaggerate : factor of the displacements of nodes; None for what suits. Raises CaseError without snapshots or
        the field.
        """


def echoes(planned: Plan) -> Entries:
    """The line for `dembound check` on the first echo of each artificial side without waves at a monitor, if any."""
    scene, lines = planned.scene, []
    names = [monitor.name for monitor in scene.case.monitor]
    if not names:
        return
    sources = planned.kind.sources(scene)
    speed, places = planned.kind.front(scene, planned.time_step).speed, monitored(scene)
    for side in SIDES:
        table, axis = scene.case.side(side), normal_axis(side)
        is_across = axis in planned.stepped.uniform_axes or scene.size[axis] == 0.0
        if is_across or not table.may_move or table.absorber:
            continue
        seen = [source for source in sources if source.is_local or not table.needs_column]  # of columns only local ones
        times = [source.start + source.distance_over(side, scene.plane(side), places) / speed for source in seen]
        first = np.min(times, axis=0, initial=np.inf) if times else np.full(len(places), np.inf)
        if first.min() < scene.case.run.duration:
            name = names[int(first.argmin())]
            lines.append(f"{side} ({table.type}) may reflect to {name} from {first.min():.3g} s on")
    if lines:
        yield "echoes", "; ".join(lines)
