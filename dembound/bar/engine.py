"""How a bar is stepped: its bonds as the method laid them, and the method's answers when they are stretched far."""

import numpy as np

from dembound.bar.banded import ROUNDING
from dembound.bar.scene import BarScene
from dembound.contacts import Cracks
from dembound.engine import Engine
from dembound.errors import RunError
from dembound.kernels import bar
from dembound.kernels.tables import BarBonds, Body, Log, Supports

SWING = 1e-6
"""Share by which a node with a prescribed velocity may swing beyond the bound of a stable step."""


class BarEngine(Engine):
    """Moves a bar, and lets its method answer.

    Attributes
    ----------
    bonds : springs and bonds as they are now.
    bond_updates : forces of springs and bonds computed so far.
    """

    def __init__(self, scene: BarScene, time_step: float) -> None:
        self.scene = scene
        self.name = scene.case.method.name
        self.bonds = scene.case.method.begin(scene.rod)
        self.bond_updates = 0
        self._step = time_step
        rate = scene.case.bar.drag_rate
        part = 0.5 * rate * time_step
        self._keep = (1.0 - part) / (1.0 + part)
        self._drag = rate * scene.mass if rate > 0.0 else np.zeros(0)
        self._supported = np.unique(scene.supports.node)
        self._arrays = self._lay()
        self._unstable = not self._is_stable()
        self._told = 0

    def _lay(self) -> BarBonds:
        """The bonds for the kernels."""
        mass = self.scene.case.bar.density * self.scene.rod.section * self.scene.rod.spacing
        return self.bonds.arrays(self._supported, self._step / mass)

    def advance(
        self, u: np.ndarray, spare: np.ndarray, v: np.ndarray, number: int, body: Body, supports: Supports, log: Log
    ) -> int:
        """Advance by the steps of supports.drive, or until the method has to answer; returns the steps done.

        Raises RunError where its answer makes the time step unstable.
        """
        arrays = self._arrays
        done, why = bar.advance(u, spare, v, number, arrays, body, self._keep, self._drag, supports, log)
        self.bond_updates += int(done) * self.bonds.alive
        if why == bar.ASKED:
            self._answer(u[0], u[0] - self._step * v[0], number + int(done), log)
        return int(done)

    def _answer(self, u: np.ndarray, before: np.ndarray, step: int, log: Log) -> None:
        """Let the method answer at displacements u (n,), those a step ago being `before`, and enter what that did."""
        stored, alive = self._between(u, before), self.bonds.alive
        self.name = self.scene.case.method.answer(self.bonds, u)
        self._arrays = self._lay()
        log.work[:, 4] += self._between(u, before) - stored
        if self.bonds.alive > alive and not self._is_stable():
            limit = self.scene.stable_step(self.bonds)
            raise RunError(
                f"the method's bonds at t = {step * self._step:g} s allow a time step of {limit:.6g} s only; "
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
        step, pair = self.bonds.breaks(self._told)
        self._told = steps
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
