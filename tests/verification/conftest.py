"""The lab in which physical claims are tested: cases from a few words, and their motion at chosen places."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numba
import numpy as np
import pytest
import tomli_w

from dembound.bar.scene import BarScene, build_bar
from dembound.boundaries.support import SupportBuilder
from dembound.casefile import Case
from dembound.disks.contacts import layout
from dembound.disks.contacts.layout import contact_rows
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.confined import confined
from dembound.disks.scene import DiskScene, build, with_boundaries
from dembound.disks.stability import choose_step
from dembound.disks.stepping.scene_parts import Start
from dembound.disks.stepping.system import DiskSystem
from dembound.disks.surroundings.edges import find_edges
from dembound.kernels.elastic import contact_forces
from dembound.kinds import loads, with_changes
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.packings.brick import Brick
from dembound.packings.tiling import Assembly, tile

DENSITY = 2500.0
SPEED = 1000.0
RADIUS = 0.25
BRICK = (10.0, 10.0)
GROUND = (60.0, 60.0)
"""Width and height (m) of the ground round a box of disks."""
HOLE = {"name": "hole", "type": "circle", "centre": [30.0, 30.0], "radius": 4.0}
"""A hole in the middle of that ground."""


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
        load: Sequence[dict[str, Any]] = (),
        wall: Sequence[dict[str, Any]] = (),
        static: dict[str, Any] | None = None,
        duration: float = 1.0,
        **packing: Any,
    ) -> Case:
        """A case on `size` (m); random patterns are λ = 1.5 on a 10 x 10 m brick unless `packing` says otherwise.

        A material that names its moduli has no wave speed given.
        """
        if pattern != "A":
            packing = {"radius_ratio": 1.5, "brick": BRICK, "seed": 1} | packing
        if pattern == "C":
            packing = {"edge_radius": 0.26} | packing
        material = {"density": DENSITY} | (material or {})
        if not {"emod", "hz_shear"} & material.keys():
            material["p_wave_speed"] = SPEED
        tables = {
            "packing": {"pattern": pattern, "size": size, "radius": RADIUS} | packing,
            "material": material,
            "motion": {"held": held},
            "boundary": {
                side: {"type": table} if isinstance(table, str) else table for side, table in (boundary or {}).items()
            },
            "wave": {"pulse": wave} if wave else {},
            "load": [{"name": f"load{k}", **table} for k, table in enumerate(load)],
            **({"wall": [{"name": f"wall{k}", **table} for k, table in enumerate(wall)]} if wall else {}),
            **({"static": static} if static else {}),
            "run": {"duration": duration},
        }
        return loads(tomli_w.dumps(tables))

    def window(
        self,
        pattern: str,
        box: tuple[float, float, float, float],
        *,
        wave: str = "wave_s",
        hole: bool = False,
        changes: dict[str, Any] | None = None,
        **words: Any,
    ) -> Case:
        """A case of disks of 1 m in a box (left, bottom, right, top, m) of the ground, `GROUND`, in elements of 10 m.

        wave : key of the motion in which a pulse of 0.06 s, 35 m of S wave, comes from below; "": none comes. hole :
        whether there is `HOLE`.
        """
        left, bottom, right, top = box
        sides: dict[str, Any] = {side: {"type": "outside"} for side in ("left", "right", "bottom")}
        if wave:
            sides["bottom"][wave] = "pulse"
            words["wave"] = self.pulse(0.06)
        material = {"fric": 0.5} | words.pop("material", {})
        words = {"radius": 0.5, "held": (), "boundary": sides, "material": material} | words
        if pattern == "C":
            words |= {"edge_radius": 0.5}
        case = self.case(pattern, (right - left, top - bottom), **words)
        placed = {"ground.size": GROUND, "packing.origin": (left, bottom), "outside.element": 10.0}
        if top < GROUND[1]:
            placed["boundary.top"] = {"type": "outside"}
        return with_changes(case, placed | ({"hole": [HOLE]} if hole else {}) | (changes or {}))

    def scene(self, pattern: str, size: tuple[float, float], **words: Any) -> DiskScene:
        """The scene of `case`."""
        return build(self.case(pattern, size, **words))

    def bar(self, cells: int, method: dict[str, Any], spacing: float = 2.0 * RADIUS) -> BarScene:
        """A bar of so many spacings (m) of the same material, with free ends."""
        tables = {
            "bar": {"length": cells * spacing, "spacing": spacing, "density": DENSITY, "wave_speed": SPEED},
            "method": method,
            "run": {"duration": 1.0},
        }
        return build_bar(loads(tomli_w.dumps(tables)))

    def disks(
        self,
        positions: np.ndarray,
        radii: np.ndarray,
        pairs: Sequence[tuple[int, int]] = (),
        s_speed: float | None = None,
        **words: Any,
    ) -> DiskScene:
        """Disks at positions (n, 2) m, of radii (n,) m, of which `pairs` are bonded; the words are those of `case`.

        Each weighs ρ(2R)², as it would in a square lattice. s_speed : of S waves beyond the sides, m/s, for disks that
        are no packing and have none.
        """
        positions, radii = np.asarray(positions, dtype=float), np.asarray(radii, dtype=float)
        bonds = np.array(pairs, dtype=np.int64).reshape(-1, 2)
        box = np.array([np.sum((2.0 * radii) ** 2), 1.0])  # its area is what sets the mass
        case = self.case("A", (self.diameter, self.diameter), **words)
        nothing = np.zeros_like(bonds), np.zeros((len(radii), 2), bool), np.zeros(3)
        brick = Brick(box, positions, radii, bonds, *nothing, residual_ratio=0.0)
        ground = confined(make_packed_material(brick, case.material, case.motion.held), case)
        ground = replace(ground, given_speeds=(ground.given_speeds[0], s_speed))
        twins, types = np.arange(len(radii), dtype=np.int32), np.arange(len(bonds), dtype=np.int32)
        tiles = np.zeros((len(radii), 2), dtype=np.int32)
        assembly = Assembly(positions, radii, twins, tiles, bonds.astype(np.int32), types, (1, 1), box, box)
        edges = find_edges(assembly, (False, False))
        rows = (contact_rows(assembly, ground),)
        return with_boundaries(DiskScene(case, ground, assembly, rows, edges, SupportBuilder().table(), {}), case)

    def tiled(self, brick: Brick, copies: tuple[int, int], **words: Any) -> DiskScene:
        """Copies (along x, along y) of a brick made by hand; the words are those of `case`."""
        case = self.case("A", (self.diameter, self.diameter), **words)
        periodic = (case.side("left").is_periodic, case.side("bottom").is_periodic)
        ground = make_packed_material(brick, case.material, case.motion.held)
        assembly = tile(brick, copies, periodic)
        edges, rows = find_edges(assembly, periodic), (contact_rows(assembly, ground),)
        return with_boundaries(DiskScene(case, ground, assembly, rows, edges, SupportBuilder().table(), {}), case)

    def pulse(self, period: float) -> dict[str, Any]:
        """Z's cosine pulse, 0.5 m/s high."""
        return {"type": "cosine", "amplitude": 0.5, "period": period}

    def row(self, scene: DiskScene) -> np.ndarray:
        """Particles of a one-row scene, from left to right."""
        return np.argsort(scene.assembly.positions[:, 0])

    def run(self, scene: DiskScene, probes: np.ndarray, duration: float, step: float | None = None) -> History:
        """Motion of some particles from rest, at every step."""
        step = step or choose_step(scene)[0]
        record = Simulation(scene, step, probes).advance(int(np.ceil(duration / step)))
        return History(step * np.arange(len(record)), record[..., :3], record[..., 3:])

    def simulation(
        self,
        scene: DiskScene,
        start: Start | None = None,
        step: float | None = None,
        probes: Sequence[int] | np.ndarray = (),
        side_stride: int = 0,
    ) -> Simulation:
        """A simulation of a body as built, or from a settled start, by default at the step that its run would take."""
        step = step or choose_step(scene)[0]
        rest = {} if start is None else {"system": DiskSystem(scene, step, start), "datum": start.displacement}
        return Simulation(scene, step, probes, side_stride=side_stride, **rest)

    def advanced(self, simulation: Simulation, steps: int, threads: int) -> Simulation:
        """A run after so many more steps, computed by so many threads."""
        before = numba.get_num_threads()
        try:
            numba.set_num_threads(threads)
            simulation.advance(steps)
        finally:
            numba.set_num_threads(before)
        return simulation

    def ledger(self, simulation: Simulation, stride: int) -> Ledger:
        """The energy ledger of a simulation, with an entry every so many steps."""
        ledger = Ledger(simulation, stride)
        simulation.track(ledger)
        return ledger

    def inertia(self, scene: DiskScene) -> np.ndarray:
        """Masses and moments of inertia (3, n) of all nodes."""
        return np.stack([scene.mass, scene.mass, scene.inertia])

    def sections(self, scene: DiskScene, places: Sequence[float], duration: float) -> History:
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

    def forces(self, scene: DiskScene, displacement: np.ndarray) -> np.ndarray:
        """Contact forces and moments (3, n) of displacements and rotations (3, n)."""
        u = scene.layout.spread(displacement)
        force = np.zeros_like(u)
        for rows in scene.rows:
            contact_forces(u, rows, force)
        return scene.layout.gather(force).copy()


@pytest.fixture(scope="session")
def lab() -> Lab:
    return Lab()


class Rock:
    """Bars of L's rock, which the tests of peridynamics are about: 1 m long, 2620 kg/m³, 2740 m/s."""

    density, speed, strength, length = 2620.0, 2740.0, 10e6, 1.0

    def scene(
        self,
        method: dict[str, Any],
        *,
        spacing: float = 1e-3,
        load: dict[str, Any] | None = None,
        wave: dict[str, Any] | None = None,
        boundary: dict[str, Any] | None = None,
        **bar: Any,
    ) -> BarScene:
        """A bar under a load on its first node, whose time factor is the wave; `bar` has more keys of this table."""
        stiffness = {} if "youngs_modulus" in bar else {"wave_speed": self.speed}
        tables = {
            "bar": {"length": self.length, "spacing": spacing, "density": self.density} | stiffness | bar,
            "method": method,
            "boundary": boundary or {},
            "wave": {"pulse": wave} if wave else {},
            "load": [{"name": "hit", "wave": "pulse"} | load] if load else [],
            "run": {"duration": 1.0},
        }
        return build_bar(loads(tomli_w.dumps(tables)))

    def triangle(self, length: float, rise: float = 1.0 / 3.0) -> dict[str, Any]:
        """L's pulse of unit height, `length` s long, with its crest after a part of that."""
        return {"type": "triangle", "amplitude": 1.0, "rise": rise * length, "fall": (1.0 - rise) * length}

    def step(self, scene: BarScene, courant: float) -> float:
        """The time step (s) of a Courant number cΔt/Δx."""
        return courant * scene.rod.ranges[0].spacing / scene.case.bar.speed


@pytest.fixture(scope="session")
def rock() -> Rock:
    return Rock()


@pytest.fixture
def hold_in_order(monkeypatch: pytest.MonkeyPatch) -> Callable[[], None]:
    """Has disks held one by one, not in rows of copies.

    Kernels of rows for a stress and for strengths by layer in one, or for Hertz's law, would be compiled for a test or
    two alone; each has them in others: here, by eight pairs in laws/test_law.py, slow ones in test_limits_by_layer.py.
    """
    return lambda: monkeypatch.setattr(layout, "_plan", lambda part, levels: None)
