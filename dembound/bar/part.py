"""The part of a bar: its bonds, which the method creates, and changes when springs reach a given stretch."""

import numpy as np

from dembound.bar.banded import ROUNDING
from dembound.bar.body import BarBody
from dembound.errors import RunError
from dembound.kernels import bar
from dembound.kernels.common import TRIGGERED
from dembound.kernels.tables import BarBonds
from dembound.methods.bonds import Bonds
from dembound.motion.part import Cracks, Part
from dembound.motion.state import Arrays, State

SWING = 1e-6
"""Share by which the motion of a node with a prescribed velocity may exceed the bound of a stable step."""


class BarPart(Part):
    """A bar under its method.

    Parameters
    ----------
    scene : the bar; time_step : Δt in s.
    first : bonds to begin with; by default the first bonds of the method.
    through : of the scene's layers, see kernels.tables.BarLayers.

    Attributes
    ----------
    bonds : springs and bonds as they are now.
    bond_updates : forces of springs and bonds computed so far.
    """

    name = "bar"
    is_summarised = True

    def __init__(
        self, scene: BarBody, time_step: float, first: Bonds | None = None, through: np.ndarray | None = None
    ) -> None:
        self.scene = scene
        self.nodes = slice(0, scene.count)
        self.law_name = scene.case.method.name
        self.bonds = scene.case.method.begin(scene.rod) if first is None else first
        self.bond_updates = 0
        self._step, self._through = time_step, through
        self._supported = np.unique(scene.supports.node)
        self._arrays = self._lay()
        self._unstable = not self._is_stable()
        self._reported = 0

    def _lay(self) -> BarBonds:
        """The bonds for the kernels."""
        return self.bonds.arrays(self._supported, self._step, self._through)

    def law(self) -> BarBonds:
        """The bonds as they are now."""
        return self._arrays

    def react(self, why: int, steps: int, state: State) -> None:
        """Let the method change the bonds at a spring that has reached its limit.

        Raises RunError if the time step is unstable with the new bonds.
        """
        self.bond_updates += steps * self.bonds.alive
        self._refuse_breaks_at_layers()
        if why == TRIGGERED:
            u = state.u[0]
            self._change_bonds(u, u - self._step * state.v[0], state)

    def _refuse_breaks_at_layers(self) -> None:
        """Raise RunError if a bond broke at a node whose bonds reach into a layer, as these never break."""
        if not (self.scene.layers and np.isfinite(self.scene.rod.elongation).any()):
            return
        step, pair = self.bonds.begun()
        for side, layer in self.scene.layers.items():
            for k in np.flatnonzero(np.isin(pair, layer.inner).any(axis=1))[:1]:
                raise RunError(
                    f"the bar broke at t = {step[k] * self._step:g} s within {len(layer.inner) * layer.spacing:g} m of "
                    f"its {side} end, where bonds reach into the matched layer, which never break; make the bar longer"
                )

    def _change_bonds(self, u: np.ndarray, before: np.ndarray, state: State) -> None:
        """Let the method change the bonds, and add the energy difference to the ledger.

        u : (n,) m, displacements now; before : one step earlier.
        """
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
        """Whether the time step is stable with the present bonds; it remains so while bonds only break."""
        return self.scene.is_stable(self.bonds, self._step * (1.0 - ROUNDING))

    def stored(self, u: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) in local springs and in peridynamic bonds."""
        return bar.stored(u[0], self._arrays)

    def _between(self, u: np.ndarray, before: np.ndarray) -> float:
        """Strain energy (J) half a step earlier, ½ uᵀK u⁻, which central differences conserve."""
        return 0.25 * (sum(bar.stored(u + before, self._arrays)) - sum(bar.stored(u - before, self._arrays)))

    def blown_up(self, velocity: np.ndarray) -> int | None:
        """The node at which a run is unstable and gains energy; None for a stable run. velocity (3, n) m/s.

        A stable step has ½ vᵀMv ≥ ½ (½Δt v)ᵀK(½Δt v) for any v, so velocities that violate this belong to an
        instability. If bonds break first, the remaining bar may be so soft that the condition holds; then the step is
        judged by the bonds before they broke.
        """
        v = velocity[0] / max(1.0, np.abs(velocity[0]).max())  # scaled so that squares do not overflow
        kinetic = 0.5 * float(np.sum(self.scene.mass * v**2))
        swing = sum(bar.stored(0.5 * self._step * v, self._arrays))
        broken = self._unstable and len(self.bonds.breaks(0)[0]) > 0
        return int(np.argmax(np.abs(v))) if broken or swing > kinetic * (1.0 + SWING) else None

    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since this was last called; steps: number of steps done."""
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

    def saved_arrays(self) -> Arrays:
        """Springs, bonds and zones, the method in use, and the counters."""
        return {
            "law": np.array(self.law_name),
            "bond_updates": np.array(self.bond_updates),
            "unstable": np.array(self._unstable),
            "reported": np.array(self._reported),
            **self.bonds.saved_arrays(),
        }

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        self.law_name = str(saved["law"])
        self.bond_updates, self._reported = int(saved["bond_updates"]), int(saved["reported"])
        self._unstable = bool(saved["unstable"])
        self.bonds.restore(saved)
        self._arrays = self._lay()
