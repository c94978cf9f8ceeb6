"""The stages before a run, such as a static one, kept so that none has to be repeated."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dembound.motion.state import Arrays

if TYPE_CHECKING:
    from dembound.motion.simulation import Simulation


class Stages:
    """Receives the stages of a run. This class keeps nothing, so all stages are computed."""

    def finished(self, name: str) -> Arrays | None:
        """The arrays that `finish` has received for a stage, maybe in another run; None if it has to be computed."""
        return None

    def begin(self, name: str, simulation: Simulation) -> None:
        """Called before the first step of a stage; may set the simulation to a state reached before."""

    def finish(self, name: str, arrays: Arrays) -> None:
        """Receives the results of a completed stage."""
