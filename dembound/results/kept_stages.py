"""The stages before a run in files, so that resumed runs and other runs of a batch need not repeat them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dembound.errors import CaseError
from dembound.files import make_folder, require_plain
from dembound.motion.stages import Stages
from dembound.motion.state import Arrays
from dembound.results.checkpoint import FILE as CHECKPOINT
from dembound.results.checkpoint import Checkpoint, Checkpoints, differences
from dembound.results.json_files import checked
from dembound.results.reader import understood
from dembound.version import __version__

if TYPE_CHECKING:
    from dembound.motion.simulation import Simulation

FOLDER = "settled"
"""Name of the folder of stages within that of a run."""


def settled_state(folder: Path, name: str, keys: Mapping[str, Any]) -> Arrays:
    """The arrays of a stage that a run has kept in a folder; name : of the stage, keys : that determine its result.

    Raises CaseError if it is not there or depends on other keys, RecordError if it is damaged, or a link.
    """
    path = folder / f"{name}.npz"
    require_plain(path)
    if not path.is_file():
        raise CaseError([f"static.from: {folder} has no settled state ({name}.npz)"])
    kept = Checkpoint.read(path)
    if different := differences(keys, checked(_Kept, kept.facts, path).keys):
        raise CaseError([f"static.from: {folder} has settled another body", *different])
    return kept.arrays


@dataclass
class _Kept:
    """The facts of a stage."""

    keys: dict[str, Any]


class KeptStages(Stages):
    """Stages that are kept in the folder of a run, or taken from that of another one.

    Parameters
    ----------
    folder : of the stages, created with the first one; None: none are kept.
    keys : the keys of the case on which they depend.
    checkpoints : makes the tracker that writes checkpoints of a stage, given its name.
    source : folder of another run whose stages are used; None: the stages of this run.
    unfinished : name of a stage that a checkpoint was written in, and a function that returns its arrays; or None.
    """

    def __init__(
        self,
        folder: Path | None,
        keys: Mapping[str, Any],
        checkpoints: Callable[[str], Checkpoints],
        source: Path | None = None,
        unfinished: tuple[str, Callable[[], Arrays]] | None = None,
    ) -> None:
        self._folder, self._keys, self._checkpoints = folder, keys, checkpoints
        self._source = folder if source is None else source / FOLDER
        self._required = source is not None
        self._unfinished = unfinished

    def finished(self, name: str) -> Arrays | None:
        """The arrays of a stage; None if it has not been kept.

        Raises CaseError as `settled_state` if it is to be taken from another run.
        """
        if self._source is None or not (self._required or (self._source / f"{name}.npz").is_file()):
            return None
        return settled_state(self._source, name, self._keys)

    def begin(self, name: str, simulation: Simulation) -> None:
        """Write checkpoints of the stage, and continue it from its checkpoint."""
        self._begun = simulation, self._checkpoints(name)
        simulation.track(self._begun[1])
        if self._unfinished is not None and self._unfinished[0] == name:
            with understood(Path(CHECKPOINT)):
                simulation.state.take(self._unfinished[1]())
            self._unfinished = None

    def finish(self, name: str, arrays: Arrays) -> None:
        """Keep the stage and its checkpoint, with which a run can be resumed before its first step."""
        if self._folder is not None:
            make_folder(self._folder)
            facts = {"version": __version__, "keys": self._keys}
            Checkpoint(facts, arrays).write(self._folder / f"{name}.npz")
            simulation, checkpoints = self._begun
            checkpoints.write(simulation, durable=False)
