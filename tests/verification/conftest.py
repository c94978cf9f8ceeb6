"""The lab in which physical claims are tested: cases from a few words, and their motion at chosen places."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import tomli_w

from dembound.case import Case, loads
from dembound.kernels.elastic import contact_forces
from dembound.scene import Scene, build
from dembound.simulate import Simulation
from dembound.stability import choose_step

DENSITY = 2500.0
SPEED = 1000.0
RADIUS = 0.25
BRICK = (10.0, 10.0)


@dataclass(frozen=True)
class History:
    """Motion of p particles: times (k,) s; displacement and velocity (k, p, 3), SI."""

    times: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray

    def crossing(self, level: float, component: int = 0) -> np.ndarray:
        """First time (p,) at which each particle's velocity rises through `level`, between two samples."""
        velocity = self.velocity[:, :, component]
        after = np.argmax(velocity >= level, axis=0)
        column = np.arange(velocity.shape[1])
        low, high = velocity[after - 1, column], velocity[after, column]
        return self.times[after - 1] + (level - low) / (high - low) * np.diff(self.times)[after - 1]


class Lab:
    """Builds and runs scenes of Z's material: 2500 kg/m³, 1000 m/s, disks of mean diameter 0.5 m."""

    density, speed, diameter = DENSITY, SPEED, 2.0 * RADIUS

    def case(
        self,
        pattern: str,
        size: tuple[float, float],
        *,
        held: tuple[str, ...] = ("y",),
        material: dict[str, Any] | None = None,
        boundary: dict[str, Any] | None = None,
        wave: dict[str, Any] | None = None,
        duration: float = 1.0,
        **packing: Any,
    ) -> Case:
        """A case on `size` (m); random patterns are λ = 1.5 on a 10 x 10 m brick unless `packing` says otherwise."""
        if pattern != "A":
            packing = {"radius_ratio": 1.5, "brick": BRICK, "seed": 1} | packing
        if pattern == "C":
            packing = {"edge_radius": 0.26} | packing
        tables = {
            "packing": {"pattern": pattern, "size": size, "radius": RADIUS} | packing,
            "material": {"density": DENSITY, "p_wave_speed": SPEED} | (material or {}),
            "motion": {"held": held},
            "boundary": {
                side: {"type": table} if isinstance(table, str) else table for side, table in (boundary or {}).items()
            },
            "wave": {"pulse": wave} if wave else {},
            "run": {"duration": duration},
        }
        return loads(tomli_w.dumps(tables))

    def scene(self, pattern: str, size: tuple[float, float], **words: Any) -> Scene:
        """The scene of `case`."""
        return build(self.case(pattern, size, **words))

    def pulse(self, period: float) -> dict[str, Any]:
        """Z's cosine pulse, 0.5 m/s high."""
        return {"type": "cosine", "amplitude": 0.5, "period": period}

    def row(self, scene: Scene) -> np.ndarray:
        """Particles of a one-row scene, from left to right."""
        return np.argsort(scene.assembly.positions[:, 0])

    def run(self, scene: Scene, probes: np.ndarray, duration: float, step: float | None = None) -> History:
        """Motion of some particles from rest, at every step."""
        step = step or choose_step(scene)[0]
        simulation = Simulation(scene, step, probes)
        record = simulation.advance(int(np.ceil(duration / step)))
        return History(step * np.arange(len(record)), record[..., :3], record[..., 3:])

    def sections(self, scene: Scene, places: Sequence[float], duration: float) -> History:
        """Mean motion of the particles within 1 m of each place x (m): one column per place.

        Places a whole number of bricks apart have the same particles, so their histories differ by travel alone.
        """
        distance = np.abs(scene.assembly.positions[:, 0] - np.array(places)[:, None])
        sections = [np.flatnonzero(near) for near in distance < 1.0]
        history = self.run(scene, np.concatenate(sections), duration)
        ends = np.cumsum([len(section) for section in sections])[:-1]
        means = (
            np.stack([part.mean(axis=1) for part in np.split(motion, ends, axis=1)], axis=1)
            for motion in (history.displacement, history.velocity)
        )
        return History(history.times, *means)

    def forces(self, scene: Scene, displacement: np.ndarray) -> np.ndarray:
        """Contact forces and moments (3, n) of displacements and rotations (3, n)."""
        force = np.empty_like(displacement)
        contact_forces(displacement, *scene.contacts.arrays, force)
        return force


@pytest.fixture(scope="session")
def lab() -> Lab:
    return Lab()
