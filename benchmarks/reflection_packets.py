"""Wave packets reflected by sides in runs, compared with reflections that `dembound boundary` measures without a run.

    python benchmarks/reflection_packets.py [--only viscous] [--json FILE]

A packet of plane P or S waves runs at an angle through a strip of disks, periodic sideways, to its right side. The
strip is as high as one wave is long along the side, so that all waves of the packet have the same wave number k_y, and
wave numbers k_x with energies exp(−(k_x − k₀)²σ²): each is a plane wave with its own angle and frequency, which the
side reflects independently. Kinetic and strain energy of all disks are measured before and after; P and S waves are
distinguished by wave numbers and directions of motion. The last column is the meter's mean over the waves of the
packet.
"""

import argparse
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.sparse import diags
from scipy.sparse.linalg import eigsh
from timing import in_one_line, machine, show, small_option, write

from dembound import api
from dembound.casefile.disks import DiskCase
from dembound.casefile.model import as_kind
from dembound.disks.material.homogenise import Network
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.reflection import beyond
from dembound.disks.reflection.bricks import end_scene
from dembound.disks.reflection.meter import Kind, Meter, homogenised_wave
from dembound.disks.scene import DiskScene, build, ground_of
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

BRICK, DIAMETER, WAVE = 5.0, 0.5, 20.0
"""Side of bricks, mean diameter, and about the length of the waves, m."""

PATTERNS: dict[str, dict[str, Any]] = {
    "A": {},
    "B": {"radius_ratio": 1.5, "brick": [BRICK, BRICK]},
    "C": {"radius_ratio": 1.5, "brick": [BRICK, BRICK], "edge_radius": 0.26},
}

OUTSIDE: dict[str, Any] = {"outside": {"element": BRICK, "layers": 2, "reflection": 0.03}}
"""Elements as long as bricks, which are in no step with the disks, and layers that send back more than usual ones."""

SPREAD = 0.12
"""1/σ over k₀: waves of the packet that are half as fast across the side have exp(−17) of its energy."""

REACH = 4.5
"""Length of the packet before and behind its middle, in σ: the energy of its ends is exp(−20)."""

WAVES = 96
"""Plane waves that the packet is added up from, as far as 5/σ from k₀, so that the next packet is 60 σ away."""

MEANS = 12
"""Waves that means over the packet are taken from, by the rule of Gauss and Hermite."""

FEW = 100
"""Motions of a brick up to which all of its waves are computed at once."""

SHORTEST = 3.0
"""Largest k_x in which P and S waves are distinguished, over the length of the packet's wave vector."""


class Wave(NamedTuple):
    """A wave of a packing: k (2,) 1/m, ω rad/s, and the motion (3, n) of the disks of the brick at the origin."""

    vector: np.ndarray
    omega: float
    motion: np.ndarray


def plane_motion(ground: PackedMaterial, kind: Kind, vector: np.ndarray) -> tuple[np.ndarray, float]:
    """Polarisation (2,) and ω (rad/s) of a wave of the equivalent continuum with a wave vector (2,) 1/m.

    P waves move along the vector, S waves as it turned to the left.
    """
    wave = homogenised_wave(ground, kind, vector / np.hypot(*vector))
    assert wave is not None
    about = vector if kind == "p" else np.array([-vector[1], vector[0]])
    return wave.polarisation * np.sign(about @ wave.polarisation), float(np.hypot(*vector) / np.hypot(*wave.slowness))


def wave_of(ground: PackedMaterial, kind: Kind, vector: np.ndarray) -> Wave:
    """The wave of the packing with a wave vector (2,) 1/m that is most like a P or S wave of the continuum.

    By Bloch's theorem copies of a brick move alike but for their phases.
    """
    brick, (polarisation, omega) = ground.brick, plane_motion(ground, kind, vector)
    network = Network.of_brick(brick, ground.stiffness)
    ways = network.motion_matrix(np.exp(1j * (brick.images * brick.size) @ vector))
    root = np.sqrt(np.concatenate([ground.mass, ground.mass, ground.inertia]))
    ways = ways @ diags(1.0 / root)
    matrix = (ways.conj().T @ diags(network.springs) @ ways).tocsc()
    if len(root) < FEW:
        squares, shapes = np.linalg.eigh(matrix.toarray())
    else:
        squares, shapes = eigsh(matrix, 4, sigma=omega**2, v0=np.ones(len(root)))
    plane = np.zeros((3, len(brick.radii)), dtype=complex)
    plane[:2] = polarisation[:, None] * np.exp(1j * brick.positions @ vector)
    likeness = (plane.ravel() * root).conj() @ shapes
    best = int(np.argmax(np.abs(likeness)))
    motion = (shapes[:, best] / root * (likeness[best] / abs(likeness[best])).conj()).reshape(3, -1)
    return Wave(vector, math.sqrt(squares[best]), motion)


@dataclass(frozen=True)
class Packet:
    """A packet on its way to a side.

    pattern : of the packing. side : the table of the side. kind, angle : type of the waves, and the angle (degrees)
    from the normal of the wave with k₀.
    """

    pattern: str
    side: Mapping[str, Any]
    kind: Kind
    angle: float

    @property
    def height(self) -> float:
        """Height (m) of the strip, a whole number of bricks."""
        sine = math.sin(math.radians(self.angle))
        return BRICK * max(round(WAVE / (BRICK * sine)), 1) if sine else BRICK

    @property
    def along(self) -> float:
        """k_y, 1/m."""
        return 2.0 * math.pi / self.height if self.angle else 0.0

    @property
    def across(self) -> float:
        """k₀, 1/m."""
        return self.along / math.tan(math.radians(self.angle)) if self.angle else 2.0 * math.pi / WAVE

    @property
    def width(self) -> float:
        """σ, m."""
        return 1.0 / (SPREAD * self.across)

    def case(self, length: float) -> DiskCase:
        """The strip, at least so many metres long."""
        lateral = {"type": "periodic"}
        size = [BRICK * math.ceil(length / BRICK), self.height]
        case = api.case(
            packing={"pattern": self.pattern, "size": size, "radius": 0.5 * DIAMETER, **PATTERNS[self.pattern]},
            material={"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
            boundary={"bottom": lateral, "top": lateral, "right": dict(self.side)},
            run={"duration": 1.0},
            **OUTSIDE if self.side["type"] == "outside" else {},
        )
        return as_kind(case, DiskCase, "is no case of disks")

    def wave(self, ground: PackedMaterial, offset: float, time_step: float) -> Wave:
        """The wave with k_x = k₀ + offset/σ, with its frequency in time steps (s)."""
        wave = wave_of(ground, self.kind, np.array([self.across + offset / self.width, self.along]))
        return wave._replace(omega=2.0 / time_step * math.asin(0.5 * time_step * wave.omega))

    def speed(self, ground: PackedMaterial, kind: Kind) -> float:
        """Speed (m/s) across the side of the energy that comes as this packet and leaves as waves of a type, about."""
        _, omega = plane_motion(ground, self.kind, np.array([self.across, self.along]))
        speed = ground.wave_speeds(0)["ps".index(kind)]
        return speed * math.sqrt(max(1.0 - (speed * self.along / omega) ** 2, 0.0))

    def angle_of(self, ground: PackedMaterial, omega: float) -> float:
        """Angle (degrees) at which waves of the continuum with a frequency ω (rad/s) have k_y along the side."""

        def beyond(angle: float) -> float:
            direction = np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle))])
            return omega / plane_motion(ground, self.kind, direction)[1] * direction[1] - self.along

        return float(brentq(beyond, 0.0, 90.0)) if self.along else 0.0

    def motion(self, scene: DiskScene, middle: float, time_step: float) -> tuple[np.ndarray, np.ndarray]:
        """Displacement and velocity half a step (s) before, (3, n), of all disks, with the packet at x = middle (m)."""
        assembly, (u, v) = scene.assembly, np.zeros((2, 3, scene.count))
        disks = scene.disk_count
        corner = assembly.tile * scene.ground.brick.size
        for offset in np.linspace(-5.0, 5.0, WAVES):
            wave = self.wave(scene.ground, offset, time_step)
            phase = corner @ wave.vector - wave.vector[0] * middle
            moved = np.exp(-0.5 * offset**2 + 1j * phase) * wave.motion[:, assembly.brick_particle] / wave.omega
            u[:, :disks] += moved.real
            v[:, :disks] += (moved * (1.0 - np.exp(1j * wave.omega * time_step)) / time_step).real
        return u, v


class Energies(NamedTuple):
    """Reflected energies over that of the packet: as P and as S waves, and in total."""

    p: float
    s: float
    total: float


def energy(simulation: Simulation) -> float:
    """Kinetic and strain energy (J/m), without the strain of elements that absorb."""
    scene = simulation.scene
    inert = np.stack([scene.mass, scene.mass, scene.inertia])
    kinetic = 0.5 * float(np.sum(inert * simulation.state.velocity**2))
    return kinetic + sum(simulation.system.stored(simulation.state.u))


def share_of_p(packet: Packet, scene: DiskScene, velocity: np.ndarray) -> float:
    """Share of P waves in the energy of a motion (3, n) of waves with the packet's k_y."""
    x, y = scene.assembly.positions.T
    momentum = scene.mass[: len(x)] * velocity[:2, : len(x)] * np.exp(-1j * packet.along * y)
    step = 2.0 * math.pi / scene.size[0]
    most = int(SHORTEST * math.hypot(packet.across, packet.along) / step)
    found = {"p": 0.0, "s": 0.0}
    for number in range(-most, most + 1):
        if number == 0 and packet.along == 0.0:
            continue
        transformed = momentum @ np.exp(-1j * number * step * x)
        for kind in found:
            polarisation, _ = plane_motion(scene.ground, kind, np.array([number * step, packet.along]))
            found[kind] += abs(polarisation @ transformed) ** 2
    return found["p"] / (found["p"] + found["s"])


def in_a_run(packet: Packet) -> tuple[Energies, int, int]:
    """Reflected energies in a run; numbers of disks and steps."""
    ground = ground_of(packet.case(BRICK))
    came = packet.speed(ground, packet.kind)
    duration = 2.0 * REACH * packet.width / (came * (1.0 - 3.0 * SPREAD))  # until slower waves have left the side, too
    fastest = max(packet.speed(ground, kind) for kind in ("p", "s"))
    scene = build(packet.case(max(2.0 * REACH * packet.width, fastest * duration)))
    time_step, _ = choose_step(scene)
    simulation = Simulation(scene, time_step)
    middle = scene.size[0] - REACH * packet.width
    simulation.state.displacement, simulation.state.velocity = packet.motion(scene, middle, time_step)
    before = energy(simulation)
    simulation.run(round(duration / time_step))
    total = energy(simulation) / before
    of_p = share_of_p(packet, scene, simulation.state.velocity)
    return Energies(of_p * total, (1.0 - of_p) * total, total), scene.disk_count, simulation.state.step


def without_a_run(packet: Packet) -> Energies:
    """Reflected energies by the meter: means over the waves of the packet."""
    case = packet.case(2.0 * REACH * packet.width)
    scene = build(case)
    time_step, _ = choose_step(scene)
    if scene.outside is None:
        meter = Meter.of("right", time_step, end_scene(case, "right"))
    else:
        meter = beyond(scene, "right", time_step)
    points, weights = np.polynomial.hermite.hermgauss(MEANS)
    mean = np.zeros(2)
    for point, weight in zip(points, weights / weights.sum(), strict=True):
        _, omega, _ = packet.wave(scene.ground, point, time_step)
        angle = packet.angle_of(meter.ground, omega)
        (found,) = meter.measure([omega / (2.0 * math.pi)], [angle], [packet.kind])
        mean += weight * np.array([found.same[packet.kind][0, 0], found.converted[packet.kind][0, 0]])
    p, s = mean if packet.kind == "p" else mean[::-1]
    return Energies(float(p), float(s), float(mean.sum()))


VISCOUS, SOFT = ({"type": "viscous", "beta_p": beta, "beta_s": beta} for beta in (1.0, 0.5))
SPRINGS = VISCOUS | {"type": "viscoelastic", "distance": 5.0, "alpha_n": 1.0, "alpha_s": 0.5}

PACKETS = (
    *(Packet("A", VISCOUS, "p", angle) for angle in (30.0, 45.0, 60.0, 75.0)),
    *(Packet("A", VISCOUS, "s", angle) for angle in (30.0, 60.0)),
    Packet("A", VISCOUS | {"half_mass": True}, "s", 60.0),
    Packet("A", {"type": "free"}, "p", 30.0),
    *(Packet("B", VISCOUS, "p", angle) for angle in (0.0, 30.0, 60.0)),
    *(Packet("B", VISCOUS, "s", angle) for angle in (0.0, 30.0, 60.0)),
    Packet("B", SOFT, "p", 45.0),
    Packet("B", SPRINGS, "p", 45.0),
    Packet("B", SPRINGS, "s", 30.0),
    Packet("B", {"type": "free"}, "s", 30.0),
    Packet("B", {"type": "fixed"}, "s", 30.0),
    Packet("B", {"type": "roller"}, "p", 60.0),
    *(Packet("B", {"type": "outside"}, kind, angle) for kind in ("p", "s") for angle in (0.0, 30.0, 60.0)),
    Packet("C", VISCOUS, "p", 60.0),
    Packet("C", SOFT, "s", 30.0),
)


def row(packet: Packet) -> dict[str, Any]:
    """A line of the table."""
    (run, disks, steps), found = in_a_run(packet), without_a_run(packet)
    side = ", ".join(f"{value}" if key == "type" else f"{key} = {value}" for key, value in packet.side.items())
    same = {"pattern": packet.pattern, "side": side, "wave": f"{packet.kind.upper()}, {packet.angle:g}°"}
    return same | {"disks": disks, "steps": steps, "run": run._asdict(), "meter": found._asdict()}


def shown(line: Mapping[str, Any]) -> dict[str, Any]:
    """A line as it is printed."""
    each = {key: f"{line['run'][key]:.5%} / {line['meter'][key]:.5%}" for key in ("p", "s", "total")}
    off = line["meter"]["total"] - line["run"]["total"]
    return {**line, **each, "difference": f"{off:+.1e}, {off / line['run']['total']:+.1%}"}


def main() -> None:
    """Measure and print all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="only lines that contain this text, such as 'B, viscous'")
    parser.add_argument("--json", type=Path, default=Path("results/benchmarks/reflection_packets.json"))
    small_option(parser, only="A, free")
    chosen = parser.parse_args()
    facts = machine()
    print(in_one_line(facts))
    lines = [
        row(packet) for packet in PACKETS if chosen.only in f"{packet.pattern}, {packet.side['type']}, {packet.kind}"
    ]
    columns = ("pattern", "side", "wave", "disks", "steps", "p", "s", "total", "difference")
    show("energy sent back, run / meter", {name: f"{{{name}}}" for name in columns}, map(shown, lines))
    write(chosen.json, {"machine": facts, "packets": lines})


if __name__ == "__main__":
    main()
