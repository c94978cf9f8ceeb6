"""Reflection of plane waves by a side with a continuum beyond it, against the angle of incidence.

Exact for the discrete equations. Lattice, ties and continuum repeat themselves along the side with the height h of an
element, so of a wave e^(i(k_y y − ωt)) only the nodes of one row of elements (element_row.py) and the disks beside it
are unknown. Disks before the last column have the waves of the lattice with wave numbers k_y + 2πm/h along the side,
as many as there are disks in h; only one of them comes in.
"""

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np
from element_row import ROWS, Row, layer_profile
from oblique import column_matrices, couplings, lattice, waves
from scenes import DENSITY, RADIUS, SPEED

from dembound import api
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step

Couplings = list[tuple[int, int, np.ndarray]]

DIAMETER = 2.0 * RADIUS

FREQUENCY = 14.0
"""Hz, at which an S wave is 101 diameters long."""

NODES = 17.0
"""Nodes of elements per wavelength of the S wave."""


@dataclass(frozen=True, eq=False)
class Side:
    """The continuum on the right side of a square lattice of 1000 m/s with ν = 0, three elements high.

    Attributes
    ----------
    scene : disks and continuum. step : Δt, s.
    """

    scene: DiskScene
    step: float

    @classmethod
    def of(cls, nodes: float = NODES, layers: int = 3, reflection: float = 1e-4, **keys: Any) -> "Side":
        """A side with `nodes` nodes in the S wave, elements rounded down to whole diameters; keys : of [outside]."""
        order = keys.get("order", 4)
        size = DIAMETER * int(order * SPEED * 0.5**0.5 / FREQUENCY / nodes / DIAMETER)
        case = api.case(
            packing={"pattern": "A", "size": [size, ROWS * size], "radius": RADIUS},
            material={"density": DENSITY, "p_wave_speed": SPEED, "fric": 0.5},
            boundary={"right": {"type": "outside"}},
            outside={"element": size, "margin": 1, "layers": layers, "reflection": reflection} | keys,
            run={"duration": 1.0},
        )
        scene = build(case)
        return cls(scene, choose_step(scene)[0])

    @property
    def speeds(self) -> tuple[float, float]:
        """Speeds of P and S waves, m/s."""
        p_speed, s_speed = self.scene.ground.wave_speeds(0)
        return float(p_speed), float(s_speed)

    def formula(self, motion: str, angle: float, frequency: float = FREQUENCY) -> float:
        """The reflection to expect of waves that keep their kind, in a continuum that is not discrete."""
        assert self.scene.outside is not None
        profile = layer_profile(self.scene.outside.body)
        return profile.expected_reflection(frequency, angle, self.speeds["ps".index(motion)])


@cache
def _free_lattice() -> tuple[np.ndarray, Couplings, Couplings]:
    """Mass, mass and inertia of a disk, and couplings inside and at the free right side of a lattice."""
    scene = lattice({"type": "free"})
    inertia = np.array([scene.mass[0], scene.mass[0], scene.inertia[0]])
    return inertia, couplings(scene, 2), couplings(scene, 4)


@dataclass(frozen=True, eq=False)
class Harmonic:
    """The lattice's six waves of one wave number along the side.

    Attributes
    ----------
    factor, shape, flow : (6,), (3, 6), (6,) of `oblique.waves`. left : (3, 6) forces of the waves on disks of a free
    side, with those of inertia.
    """

    factor: np.ndarray
    shape: np.ndarray
    flow: np.ndarray
    left: np.ndarray

    @classmethod
    def of(cls, frequency: float, along: float) -> "Harmonic":
        """The waves for a frequency (rad/s) of accelerations and a wave number (1/m)."""
        inertia, inside, at_the_side = _free_lattice()
        factor, shape, flow = waves(column_matrices(inside, along), inertia, frequency)
        edge = column_matrices(at_the_side, along)
        own = edge[0] + frequency**2 * np.diag(inertia)
        return cls(factor, shape, flow, edge[-1] @ (shape / factor) + own @ shape)

    @cached_property
    def runs(self) -> np.ndarray:
        """(6,) bool, the waves that carry energy."""
        return np.abs(np.abs(self.factor) - 1.0) < 1e-8

    @property
    def leaving(self) -> np.ndarray:
        """The three waves that go away from the side or decay away from it."""
        return np.flatnonzero(np.where(self.runs, self.flow < 0.0, np.abs(self.factor) > 1.0))

    def kinds(self, waves: np.ndarray) -> dict[str, int]:
        """P and S waves among some waves, the faster first; only S if P decays."""
        running = waves[self.runs[waves]]
        order = running[np.argsort(np.abs(np.angle(self.factor[running])))]
        return dict(zip(("p", "s") if len(order) == 2 else ("s",), order.tolist(), strict=True))

    @property
    def incoming(self) -> dict[str, int]:
        """P and S waves towards the side."""
        return self.kinds(np.flatnonzero(self.runs & (self.flow > 0.0)))


def reflection(side: Side, motion: str, angle: float, frequency: float = FREQUENCY) -> dict[str, float]:
    """Reflected amplitudes "p", "s" and energy of a plane wave, as parts of the incident one.

    motion : "p" or "s"; angle : degrees from the normal; frequency : Hz.
    """
    turned, speed = 2.0 * np.pi * frequency, side.speeds["ps".index(motion)]
    accelerated = 2.0 / side.step * float(np.sin(0.5 * turned * side.step))
    row = Row(side.scene, side.step, turned, accelerated / speed * float(np.sin(np.radians(angle))))
    count = row.disks.shape[1]
    turns = row.along * DIAMETER + 2.0 * np.pi * np.arange(count) / count
    harmonics = [Harmonic.of(accelerated, turn / DIAMETER) for turn in turns]
    amplitude = _leaving(row, np.exp(1j * np.outer(np.arange(count), turns)), harmonics, motion)
    first, back = harmonics[0], harmonics[0].kinds(harmonics[0].leaving)
    wave, sizes = first.incoming[motion], np.linalg.norm(first.shape[:2], axis=0)
    energy = sum(abs(amplitude[k]) ** 2 * -first.flow[k] / first.flow[wave] for k in back.values())
    sent = {kind: float(abs(amplitude[k]) * sizes[k] / sizes[wave]) for kind, k in back.items()}
    return {"p": 0.0, "s": 0.0} | sent | {"energy": float(energy)}


def _leaving(row: Row, phases: np.ndarray, harmonics: list[Harmonic], motion: str) -> np.ndarray:
    """Amplitudes (6,) of the waves of the first harmonic that go away, for an incident one of amplitude 1.

    phases : (n, n) of each disk in each harmonic.
    """

    def of_disks(values: list[np.ndarray]) -> np.ndarray:
        """(3n, k) of all disks, from those (3, k') of each harmonic."""
        return np.hstack([np.kron(phases[:, [m]], each) for m, each in enumerate(values)])

    first = harmonics[0]
    wave = [first.incoming[motion]]
    shapes, left = (
        of_disks([getattr(each, name)[:, each.leaving] for each in harmonics]) for name in ("shape", "left")
    )
    came, pushed = (np.kron(phases[:, [0]], values[:, wave]) for values in (first.shape, first.left))
    by_disks, by_nodes, on_nodes_by_disks, on_nodes = row.ties()
    moving = row.moving
    grid = (row.grid() + on_nodes)[np.ix_(moving, moving)]
    whole = np.block([[left + by_disks @ shapes, by_nodes[:, moving]], [(on_nodes_by_disks @ shapes)[moving], grid]])
    given = np.vstack([pushed + by_disks @ came, (on_nodes_by_disks @ came)[moving]])
    amplitude = np.zeros(6, dtype=complex)
    amplitude[first.leaving] = np.linalg.solve(whole, -given)[:3, 0]
    return amplitude


def branches(turn: float) -> np.ndarray:
    """Frequencies (3,) of the lattice's waves along x over c_p/D, ascending, of a phase `turn` from disk to disk.

    The last one is that of rotations.
    """
    inertia, inside, _ = _free_lattice()
    stiffness = -sum(block * np.exp(1j * turn * across) for across, _, block in inside)
    squares = np.linalg.eigvals(stiffness / inertia[:, None]).real
    return np.sqrt(np.maximum(np.sort(squares), 0.0)) * DIAMETER / SPEED
