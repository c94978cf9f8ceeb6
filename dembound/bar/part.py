"""The part of a bar: its bonds as the method lays them, and changes them when springs are stretched far."""

import numpy as np

from dembound.bar.banded import ROUNDING
from dembound.bar.body import BarBody
from dembound.errors import RunError
from dembound.kernels import bar
from dembound.kernels.common import TRIGGERED
from dembound.kernels.tables import BarBonds
from dembound.motion.cracks import Cracks
from dembound.motion.part import Part
from dembound.motion.state import Arrays, State

SWING = 1e-6
"""Share by which a node with a prescribed velocity may swing beyond the bound of a stable step."""


class BarPart(Part):
    """A bar under its method.

    Attributes
    ----------
    bonds : springs and bonds as they are now.
    bond_updates : forces of springs and bonds computed so far.
    """

    name = "bar"

    def __init__(self, scene: BarBody, time_step: float) -> None:
        self.scene = scene
        self.nodes = slice(0, scene.count)
        self.law_name = scene.case.method.name
        self.bonds = scene.case.method.begin(scene.rod)
        self.bond_updates = 0
        self._step = time_step
        self._supported = np.unique(scene.supports.node)
        self._arrays = self._lay()
        self._unstable = not self._is_stable()
        self._reported = 0

    def _lay(self) -> BarBonds:
        """The bonds for the kernels."""
        bar = self.scene.case.bar
        return self.bonds.arrays(self._supported, bar.density, self._step, bar.drag_rate)

    def law(self) -> BarBonds:
        """The bonds as they are now."""
        return self._arrays

    def react(self, why: int, steps: int, state: State) -> None:
        """Let the method change the bonds where a spring has triggered it.

        Raises RunError where that makes the time step unstable.
        """
        self.bond_updates += steps * self.bonds.alive
        if why == TRIGGERED:
            u = state.u[0]
            self._change_bonds(u, u - self._step * state.v[0], state)

    def _change_bonds(self, u: np.ndarray, before: np.ndarray, state: State) -> None:
        """Let the method change the bonds at displacements u (n,), a step ago `before`, and book the energy added."""
        stored, alive = self._between(u, before), self.bonds.alive
        self.law_name = self.scene.case.method.on_trigger(self.bonds, u)
        self._arrays = self._lay()
        state.work[:, 4] += self._between(u, before) - stored
        if self.bonds.alive > alive and not self._is_stable():
            limit = self.scene.stable_step(self.bonds)
            raise RunError(
                f"the method's bonds at t = {state.step * self._step:g} s allow a time step of {limit:.6g} s only; "
                "take a smaller run.time_step or run.courant"
            )

    def _is_stable(self) -> bool:
        """Whether the time step is stable with the bonds as they are; it stays so while they only break."""
        return self.scene.is_stable(self.bonds, self._step * (1.0 - ROUNDING))

    def stored(self, displacement: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) in local springs and in peridynamic bonds."""
        return bar.stored(displacement[0], self._arrays)

    def _between(self, u: np.ndarray, before: np.ndarray) -> float:
        """Strain energy (J) half a step ago, ½ uᵀK u⁻: what central differences conserve."""
        return 0.25 * (sum(bar.stored(u + before, self._arrays)) - sum(bar.stored(u - before, self._arrays)))

    def blown_up(self, velocity: np.ndarray) -> int | None:
        """The node at which a run gains energy from nothing; None for a sound one. velocity (3, n) m/s.

        A stable step has ½ vᵀMv ≥ ½ (½Δt v)ᵀK(½Δt v) for any v, so velocities that break this swing beyond what the
        step can follow. Where bonds break first, what is left may be soft enough to look sound: then it counts whether
        the step was stable before they did.
        """
        v = velocity[0] / max(1.0, np.abs(velocity[0]).max())  # whose squares do not overflow
        kinetic = 0.5 * float(np.sum(self.scene.mass * v**2))
        swing = sum(bar.stored(0.5 * self._step * v, self._arrays))
        broken = self._unstable and len(self.bonds.breaks(0)[0]) > 0
        return int(np.argmax(np.abs(v))) if broken or swing > kinetic * (1.0 + SWING) else None

    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since this was last called; steps: those done by now."""
        step, pair = self.bonds.breaks(self._reported)
        self._reported = steps
        middle = self.scene.positions[pair].mean(axis=1)
        return Cracks(step, pair, middle, np.zeros(len(step), dtype=np.bool_))

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Stress, tension positive, and local damage of every node."""
        return {"stress": (self.stress(displacement), "Pa"), "damage": (self.bonds.damage(), "1")}

    def stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (n,) Pa along the bar at displacements (3, n), tension positive."""
        stress = np.empty(self.scene.count)
        bar.stresses(displacement[0], self._arrays, stress)
        return stress

    def memory(self) -> Arrays:
        """Springs, bonds and zones, the method in use, and what has been counted and reported."""
        return {
            "law": np.array(self.law_name),
            "bond_updates": np.array(self.bond_updates),
            "unstable": np.array(self._unstable),
            "reported": np.array(self._reported),
            **self.bonds.memory(),
        }

    def recall(self, memory: Arrays) -> None:
        """Take over what `memory` has returned in another run of the same case."""
        self.law_name = str(memory["law"])
        self.bond_updates, self._reported = int(memory["bond_updates"]), int(memory["reported"])
        self._unstable = bool(memory["unstable"])
        self.bonds.recall(memory)
        self._arrays = self._lay()
