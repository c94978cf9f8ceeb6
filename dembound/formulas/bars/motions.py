"""The motion of a linear bar at its monitors: as it is stepped, without its ends, in exact time, and exact.

All are sums over complex frequencies (`Window`) of what loads and waves do at each (chain.py, rods.py).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from dembound.bar.layers import ENDS, EndLayer
from dembound.bar.scene import BarScene, build_bar, end_supports
from dembound.boundaries.matched_layer import MatchedLayer
from dembound.boundaries.support import Signal
from dembound.casefile.bar import BarCase
from dembound.formulas.bars.chain import Chain, Frequencies, Response, observed_near
from dembound.formulas.bars.rods import Rods, Window, needed
from dembound.formulas.history import History, Motions
from dembound.methods.rod import Range

FINER = 8
"""Samples in a step of the waves of the exact motion, which need not arrive at whole steps."""

BATCH, LARGE_BATCH = 256, 2**15
"""Numbers of frequencies that are computed together: of nodes, and of rods."""

EVANESCENT_NODES = 20
"""Nodes between a push and a monitor beyond which waves that do not run have no effect."""

ABOVE = 1.1
"""Largest frequency that counts then, over that of the shortest wave; above, motion decays within a few spacings."""

AT_PLACE = 1e-9
"""Distance of a node from the place of its monitor that is none, over the length of the bar."""


def places_of(case: BarCase) -> dict[str, float]:
    """Monitor -> its place in the case, m."""
    return {monitor.name: monitor.position for monitor in case.monitor}


@dataclass(frozen=True)
class BarMotions:
    """The motions of a case at its monitors; times : of the records, by monitor."""

    case: BarCase
    scene: BarScene
    window: Window
    times: Mapping[str, np.ndarray]

    @property
    def absorbing(self) -> list[str]:
        """The ends that stand in for more of the bar."""
        return [side for side in ENDS if self.case.side(side).is_artificial]

    @property
    def nodes(self) -> dict[str, int]:
        """Monitor -> number of its node."""
        return {name: self.scene.monitors[name] for name in self.times}

    @property
    def places(self) -> dict[str, float]:
        """Monitor -> its place in the case, m."""
        given = places_of(self.case)
        return {name: given[name] for name in self.times}

    @property
    def beside_places(self) -> bool:
        """Whether the node of a monitor is not at its place."""
        rod = self.scene.rod
        reach = AT_PLACE * rod.ranges[-1].end
        return any(abs(rod.positions[self.nodes[name]] - place) > reach for name, place in self.places.items())

    @property
    def dashpots(self) -> list[tuple[float, Range]]:
        """For each absorbing end its dashpot (N·s/m; nan if the end is of another type) and the range there."""
        found = []
        for side in self.absorbing:
            rows = end_supports(self.case, side)
            alone = not (side in self.scene.layers or rows.stiffness.any() or rows.prescribed.any())
            found.append((float(rows.damping.sum()) if alone else math.nan, self.scene.rod.end(side)))
        return found

    @property
    def loaded_at_ends(self) -> BarMotions:
        """A bar like this one with all loads on its last nodes alone."""
        loads = tuple(load.model_copy(update={"nodes": 1}) for load in self.case.load)
        case = replace(self.case, load=loads)
        return replace(self, case=case, scene=build_bar(case))

    def own(self) -> Motions:
        """The motion of the bar as it is stepped, with its own ends."""
        return self._in_nodes(self.scene, self.scene.layers, self.window.step, [])

    def endless(self, step: float) -> Motions:
        """The motion of a bar that goes on beyond ends that absorb; step : Δt, s, 0 for exact time."""
        if not self.absorbing:
            return self._in_nodes(self.scene, self.scene.layers, step, [])
        least = max(4, 2 * self.case.method.horizon_beyond)
        layered = {side: MatchedLayer(type="matched_layer", nodes=least) for side in self.absorbing}
        scene = build_bar(replace(self.case, boundary={**self.case.boundary, **layered}))
        window = self.window.samples * self.window.step
        layers = {side: layer.endless(window) for side, layer in scene.layers.items()}
        return self._in_nodes(scene, layers, step, [side for side in self.absorbing if self.case.side(side).waves])

    def _in_nodes(
        self, scene: BarScene, layers: Mapping[str, EndLayer], step: float, entering: Iterable[str]
    ) -> Motions:
        """The motion of a chain of nodes; entering : ends at which the wave enters an endless bar."""
        chain, clock = Chain(scene, layers, self.window.step), Frequencies.of(self.window.s, step)
        forces = self._forces(scene, chain, clock)
        ends = {"left": 0, "right": scene.count - 1}
        waves = {side: self.window.transform(self._wave(side)) / clock.mean for side in entering}
        pushed = [*forces, *(ends[side] for side in waves)]
        response = Response(chain, [*observed_near(chain, list(self.nodes.values())), *pushed])
        count = min(needed([*forces.values(), *waves.values()]), self._running(clock, pushed, chain.wide))
        found: dict[str, list[np.ndarray]] = {name: [] for name in self.nodes}
        for start in range(0, count, BATCH):
            chosen = slice(start, min(start + BATCH, count))
            now, push = clock.part(chosen), {node: values[chosen] for node, values in forces.items()}
            for side, wave in waves.items():
                push[ends[side]] = push.get(ends[side], 0.0) + wave[chosen] / chain.mobility(side, now)
            moved = response.velocities(now, push)
            for name, node in self.nodes.items():
                velocity = response.at(moved, chain.first + node)
                stress = _stress(scene, response, moved, now, node)
                found[name].append(np.stack([velocity * now.mean, velocity / now.change, stress]))
        return {name: self._history(self.window, np.concatenate(each, axis=1), name) for name, each in found.items()}

    def _forces(self, scene: BarScene, chain: Chain, clock: Frequencies) -> dict[int, np.ndarray]:
        """Node -> transform (f,) N of its force, or of the force on its dashpot where a velocity is prescribed."""
        supports, forces = scene.supports, dict[int, np.ndarray]()
        for row, drive, number in zip(supports.drive_row, supports.drive, supports.drive_signal, strict=True):
            node, rigid = int(supports.node[row]), bool(supports.prescribed[row])
            ahead = 0.5 * clock.step if rigid else 0.0  # velocities are those of half steps
            transform = drive * self.window.transform(supports.signals[number], ahead) * np.exp(-ahead * clock.s)
            forces[node] = forces.get(node, 0.0) + transform * (chain.rigid * clock.mean if rigid else 1.0)
        return forces

    def _running(self, clock: Frequencies, pushed: Iterable[int], wide: int) -> int:
        """How many frequencies, from the lowest, count: above that of the shortest wave no wave propagates.

        Higher frequencies only move nodes near forces; with monitors there all frequencies count.
        """
        near = max(EVANESCENT_NODES, 4 * wide)
        if any(abs(node - push) <= near for node in self.nodes.values() for push in pushed):
            return len(clock.s)
        highest = 2.0 / self.scene.step_limit()
        return max(1, int(np.count_nonzero(np.abs(clock.change) <= ABOVE * highest)))

    def exact(self, places: Mapping[str, float] | None = None) -> Motions:
        """The motion of rods without nodes and steps at places (m, by monitor); None: at the nodes of the monitors."""
        finer = self.window.finer(FINER)
        pushed: dict[str, np.ndarray] = {}
        for load in self.case.load:
            inwards = 1.0 if load.side == "left" else -1.0
            force = inwards * load.pressure * self.scene.rod.end(load.side).section
            transform = force * finer.transform(self.case.wave[load.wave].velocity)
            pushed[load.side] = pushed.get(load.side, 0.0) + transform
        waves = {side: finer.transform(self._wave(side)) for side in ENDS if self.case.side(side).waves}
        count = needed([*pushed.values(), *waves.values()])
        nodes = {name: float(self.scene.positions[node, 0]) for name, node in self.nodes.items()}
        place = np.array([(places or nodes)[name] for name in nodes])
        left, right = (self.scene.rod.end(side) for side in ENDS)
        plane = np.clip(place, 0.5 * left.spacing, right.end - 0.5 * right.spacing)
        found = []
        for start in range(0, count, LARGE_BATCH):
            chosen = slice(start, min(start + LARGE_BATCH, count))
            rods = Rods(self.case, self.scene.rod, np.concatenate([place, plane]), finer.s[chosen])
            here = ({side: values[chosen] for side, values in each.items()} for each in (pushed, waves))
            velocity, stress = rods.motion(*here)
            velocity, stress = velocity[:, : len(place)], stress[:, len(place) :]
            found.append(np.stack([velocity, velocity / rods.s[:, None], stress]))
        motion = np.concatenate(found, axis=1)
        return {name: self._history(finer, motion[:, :, k], name) for k, name in enumerate(self.nodes)}

    def _wave(self, side: str) -> Signal:
        """Velocity history, positive along the bar, of the wave that enters at an end."""
        return self.case.wave[self.case.side(side).waves["p"]].velocity

    def _history(self, window: Window, transforms: np.ndarray, name: str) -> History:
        """Velocity, displacement and stress at the times of a record, from their transforms (3, f); 0 afterwards."""
        from scipy.interpolate import CubicSpline

        grid, time = window.time, self.times[name]
        found = {}
        for quantity, values in zip(("velocity", "displacement", "stress"), transforms, strict=True):
            own = window.history(values)
            if not np.array_equal(time, grid):
                own = np.where(time <= grid[-1] + 0.5 * window.step, CubicSpline(grid, own)(time), 0.0)
            found[quantity] = own[:, None]
        return History(self.scene.positions[self.nodes[name], :2], time, found)


def _stress(scene: BarScene, response: Response, moved: np.ndarray, clock: Frequencies, node: int) -> np.ndarray:
    """Stress (f,) Pa at a node, as `kernels.bar.node_stress` computes it."""
    planes = [plane for plane in (node - 1, node) if 0 <= plane < scene.count - 1]
    tension = sum(response.tension(moved, clock, response.chain.first + plane) for plane in planes)
    return np.asarray(tension / scene.rod.sections[planes].sum())
