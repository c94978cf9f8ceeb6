"""The interface of a kind of body to runs, checks and reports; kinds.py names all kinds."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np

from dembound.casefile import Case
from dembound.casefile.schema import Schema
from dembound.errors import RunError
from dembound.motion.cracks import Cracks
from dembound.motion.part import System
from dembound.motion.scene import Scene
from dembound.motion.trackers import Run

if TYPE_CHECKING:
    import h5py
    import meshio
    from matplotlib.figure import Figure

C = TypeVar("C", bound=Case)
S = TypeVar("S", bound=Scene)

OnLook = Callable[[int, float], None]
"""Gets the steps of a static stage done so far, and its force ratio."""


@dataclass(frozen=True)
class Plan:
    """What a case comes to before its first step: the scene, the step and its limit (s), the number of steps."""

    kind: Kind[Any, Any]
    scene: Scene
    time_step: float
    step_limit: float
    steps: int


@dataclass(frozen=True)
class Stage:
    """A stage that came before the run, as a record keeps it.

    name : where in the record; facts : numbers by name; displacement (3, n) m and rad at its end, and the cracks it
    left, both of the nodes that are there in the run.
    """

    name: str
    facts: Mapping[str, Any]
    displacement: np.ndarray
    cracks: Cracks


@dataclass(frozen=True)
class Beginning:
    """Where a run begins: its parts and ties, the displacements (3, n) they are at rest at, and the stages before.

    summary : these stages in reports, as plain JSON values; None where there were none.
    """

    system: System
    datum: np.ndarray | None = None
    stages: tuple[Stage, ...] = ()
    summary: Mapping[str, Any] | None = field(default=None, repr=False)


class StalledError(RunError):
    """A stage before the run that does not come to rest.

    Attributes: run, the state it reached; unbalanced (n, 2), N, what each node's forces come to then; cracks,
    the bonds that broke on the way.
    """

    def __init__(self, message: str, run: Run, unbalanced: np.ndarray, cracks: Cracks) -> None:
        super().__init__(message)
        self.run = run
        self.unbalanced = unbalanced
        self.cracks = cracks


class Kind(ABC, Generic[C, S]):
    """A kind of body: how its cases become scenes, how these begin to move, and what is said of them.

    Attributes
    ----------
    name : what records call it; plural : what messages call several.
    schema : its case files.
    mesh_name : what its files for ParaView are called; view_script : a script that shows them.
    """

    name: str
    plural: str
    schema: Schema
    mesh_name: str
    view_script: str

    @abstractmethod
    def build(self, case: C) -> S:
        """The scene of a case.

        Raises CaseError and PackingError for what would stop a run later, before anything is written.
        """

    def is_planned_quickly(self, case: C) -> bool:
        """Whether planning a run of a case takes no long search for the stability limit; here where a step is given."""
        return case.run.time_step != "auto"

    @abstractmethod
    def choose_step(self, scene: S) -> tuple[float, float]:
        """Time step to run with and the stability limit (s); raises CaseError for a given step above the limit."""

    @abstractmethod
    def begin(self, scene: S, time_step: float, on_look: OnLook) -> Beginning:
        """Bring a scene to where its run begins.

        Raises StalledError when a stage before does not come to rest.
        """

    @abstractmethod
    def facts(self, scene: S, time_step: float) -> dict[str, str]:
        """What a case would come to with a time step (s), in words by name; `dembound check` prints it."""

    def not_estimated(self, case: C) -> str:
        """What a short trial of the first steps does not show of a run's time, in words."""
        return ""

    @abstractmethod
    def warnings_before(self, scene: S, time_step: float) -> list[str]:
        """What a run will do that was probably not meant, one line each."""

    @abstractmethod
    def warnings_after(self, scene: S, summary: Mapping[str, Any], record: Path) -> list[str]:
        """What a run has shown that was probably not meant, one line each."""

    @abstractmethod
    def summarise(self, scene: S, run: Run, beginning: Beginning, record: Path) -> dict[str, Any]:
        """What a summary has beside that of every run: plain JSON values, SI units."""

    @abstractmethod
    def outcome(self, summary: Mapping[str, Any]) -> list[str]:
        """What became of a run, in words, from its summary."""

    @abstractmethod
    def mesh(self, particles: h5py.Group, snapshot: h5py.Group, cracks: dict[str, np.ndarray]) -> meshio.Mesh:
        """One snapshot of a record for ParaView, and the cracks until then."""

    @abstractmethod
    def pictures(self, record: Path) -> Iterator[tuple[str, Figure]]:
        """The pictures of a run by name, beside those of its monitors' velocities."""

    @abstractmethod
    def field_picture(self, record: Path, field: str, snapshot: int | None) -> Figure:
        """A field of a record as a picture, of one snapshot or of what is best; raises CaseError where it has none."""
