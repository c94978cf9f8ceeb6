"""A slope of disks by a program of its own, in ground so wide and deep that nothing returns, beside `dembound run`.

    python benchmarks/slope_reference.py [--diameters 20 40 80] [--waves s p] [--apart 1 0.5] [--forms ricker]

The program is numpy alone: a square lattice of equal bonded disks, of which the formulas stand below, central
differences in time, and the exact wave of the endless lattice, present above a row of contacts and absent below it. It
shares with the run only the numbers of the case and the time step. The ground is 2 H high at the left, H at the right,
with a slope of 45° between them; H is the length of the wave, which is that of the crest frequency of a Ricker wavelet
or of the period of a cosine pulse. `dembound run` has sides "outside" so many H from crest and toe. Errors are those of
the velocity, RMS over RMS, in per cent, at five places of the surface.
"""

import argparse
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from timing import machine, show, small_option, write

P_SPEED, DENSITY = 1000.0, 2500.0
"""Of long P waves, m/s, and of the ground, kg/m³."""

SPEEDS = {"s": P_SPEED / np.sqrt(2.0), "p": P_SPEED}
"""Of long waves in the lattice, m/s."""

STIFFNESS, BENDING, MASS, INERTIA = np.array([1.0, 1.0 / 24.0, P_SPEED**-2, P_SPEED**-2 / 8.0]) * DENSITY * P_SPEED**2
"""Of disks of D = 1 m: ρc², normal and in shear; ½ρc²D²/12, as bonds bear half of it; ρD²; ½ρD²(D/2)²."""

SHARES = {"back": -0.4, "crest": 0.0, "face": 0.5, "toe": 1.0, "floor": 1.4}
"""Where places at the surface are, in heights of the slope to the right of its crest."""

PERIODS = {"ricker": 3.0, "cosine": 1.0}
"""How many periods a wave takes."""


class Scene(NamedTuple):
    """A slope of a height (m), its crest at x = 0 and y = 0 as far below its toe, under a wave from straight below."""

    kind: str
    form: str
    high: int
    apart: float

    @property
    def frequency(self) -> float:
        """Of a wave as long as the slope is high, Hz."""
        return float(SPEEDS[self.kind] / self.high)

    @property
    def duration(self) -> float:
        """Time in which the wave goes up and passes the slope, and goes on for two of its lengths, s."""
        return (PERIODS[self.form] + 4.0) / self.frequency

    def surface(self, x: np.ndarray) -> np.ndarray:
        """Heights (m) of the surface."""
        height: np.ndarray = 2.0 * self.high - np.clip(x, 0.0, self.high)
        return height

    def places(self) -> dict[str, tuple[float, float]]:
        """Centres (m) of the highest disks half a metre left of shares of the slope."""
        x = {name: round(share * self.high) - 0.5 for name, share in SHARES.items()}
        return {name: (at, float(np.floor(self.surface(np.array(at)) - 0.5)) + 0.5) for name, at in x.items()}

    def velocity(self, times: np.ndarray) -> np.ndarray:
        """Of the incident wave in the plane y = 0, m/s."""
        turns = self.frequency * times
        squared = np.square(np.pi * (turns - 1.5))
        pulse = np.where((turns > 0.0) & (turns < 1.0), 0.5 - 0.5 * np.cos(2.0 * np.pi * turns), 0.0)
        return {"ricker": (1.0 - 2.0 * squared) * np.exp(-squared), "cosine": pulse}[self.form]


def incident(scene: Scene, heights: Sequence[float], step: float, steps: int) -> np.ndarray:
    """Displacements and rotation (steps, k, 3) of the wave in the endless lattice at heights (m).

    With Ω = 2 sin(ωΔt/2)/Δt, c = cos q and D = 1, P waves have mΩ² = 2k(1 − c). In S waves displacement U and rotation
    Θ obey A U = −ik sin q Θ and B Θ = ik sin q U, with A = 2k(1 − c) − mΩ², B = ½k(3 + c) + 2k_b(1 − c) − IΩ². Thus
    AB = k²(1 − c²), a quadratic equation for c; that of the two solutions which is nearer 1 is the long wave.
    """
    count = 1 << int(np.ceil(np.log2(2 * steps)))
    omega, k, b = 2.0 * np.pi * np.fft.rfftfreq(count, step), STIFFNESS, BENDING
    raised = np.square(2.0 * np.sin(0.5 * omega * step) / step)
    if scene.kind == "p":
        c = 1.0 - MASS * raised / (2.0 * k)
        ratio = np.zeros_like(omega, dtype=complex)
    else:
        a, o = 2.0 * k - MASS * raised, 1.5 * k + 2.0 * b - INERTIA * raised
        two, one, none = k * k - 2.0 * k * (0.5 * k - 2.0 * b), a * (0.5 * k - 2.0 * b) - 2.0 * k * o, a * o - k * k
        c = (-one - np.sqrt(np.maximum(one**2 - 4.0 * two * none, 0.0))) / (2.0 * two)
        ratio = 1j * k * np.sqrt(np.clip(1.0 - c * c, 0.0, None)) / (o + (0.5 * k - 2.0 * b) * c)
    travels = np.abs(c) < 1.0
    spectrum = np.where(travels, np.fft.rfft(scene.velocity(step * np.arange(count))), 0.0)
    moved = np.divide(spectrum, 1j * omega, where=travels, out=np.zeros_like(spectrum))
    mean = scene.velocity(step * np.arange(count)).mean()
    found = np.zeros((steps, len(heights), 3))
    for number, height in enumerate(heights):
        at = moved * np.exp(-1j * height * np.arccos(np.clip(c, -1.0, 1.0)))
        motion = np.fft.irfft(at, count) + mean * step * np.arange(count)  # ω = 0 is the ramp of the displacement left
        found[:, number, 0 if scene.kind == "s" else 1] = (motion - motion[0])[:steps]
        turns = np.fft.irfft(at * ratio, count)
        found[:, number, 2] = (turns - turns[0])[:steps]
    return found


class Lattice:
    """Disks of 1 m below the surface of a scene; u: x, y and rotation (3, rows, columns), from far below upwards."""

    def __init__(self, scene: Scene, beside: int, below: int):
        """beside, below : ground from crest and toe to the ends, and from y = 0 down, m; an end repeats its column."""
        self.left, self.low = beside, below
        x = np.arange(-beside, scene.high + beside) + 0.5
        y = np.arange(-below, 2 * scene.high)[:, None] + 0.5
        there = y <= scene.surface(x) + 1e-9
        self.level, self.upright = there[:, 1:] & there[:, :-1], there[1:] & there[:-1]
        self.ends = np.zeros(there.shape)
        self.ends[:, [0, -1]] = there[:, [0, -1]]
        self.u, self.v, self.f = (np.zeros((3, *there.shape)) for _ in range(3))

    def at(self, place: tuple[float, float]) -> tuple[int, int]:
        """Row and column of the disk at a place, m."""
        return round(place[1] - 0.5) + self.low, round(place[0] - 0.5) + self.left

    def push(self, under: np.ndarray, over: np.ndarray) -> None:
        """Forces and moments f of the contacts, at first in a row, then in a column.

        A contact pulls by k times its stretch, and across, a quarter turn anticlockwise, by k times the shear
        s = u₂ − u₁ − ½D(θ₁ + θ₂); both disks have the moment ½D k s, and ± k_b(θ₂ − θ₁). `under` and `over` are the
        incident wave (3,) just below and above y = 0: disks above have the total motion, those below the scattered one.
        """
        (x, y, turn), (fx, fy, moment), k, b = self.u, self.f, STIFFNESS, BENDING
        self.f[:] = 0.0
        pull = k * self.level * np.diff(x)
        across = k * self.level * (np.diff(y) - 0.5 * (turn[:, 1:] + turn[:, :-1]))
        bent = b * self.level * np.diff(turn)
        for force, each in ((fx, pull), (fy, across)):
            force[:, :-1] += each
            force[:, 1:] -= each
        moment[:, :-1] += 0.5 * across + bent
        moment[:, 1:] += 0.5 * across - bent
        beyond = k * self.ends * turn  # contacts with equal disks beyond the ends: s = −Dθ
        moment -= 0.5 * beyond
        fy[:, 0] += beyond[:, 0]
        fy[:, -1] -= beyond[:, -1]

        pull = k * self.upright * np.diff(y, axis=0)
        across = k * self.upright * (-np.diff(x, axis=0) - 0.5 * (turn[1:] + turn[:-1]))
        bent = b * self.upright * np.diff(turn, axis=0)
        for force, each in ((fy, pull), (fx, -across)):
            force[:-1] += each
            force[1:] -= each
        moment[:-1] += 0.5 * across + bent
        moment[1:] += 0.5 * across - bent
        cut = self.low
        self.f[:, cut] += np.array(
            [k * (under[0] - 0.5 * under[2]), k * under[1], 0.5 * k * (under[0] - 0.5 * under[2]) + b * under[2]]
        )[:, None]
        self.f[:, cut - 1] += np.array(
            [-k * (over[0] + 0.5 * over[2]), -k * over[1], 0.5 * k * (over[0] + 0.5 * over[2]) - b * over[2]]
        )[:, None]

    def run(self, scene: Scene, step: float, steps: int) -> dict[str, np.ndarray]:
        """Velocities (steps, 2), m/s, at the times n Δt at the places: means of those half a step before and after."""
        waves = incident(scene, (-0.5, 0.5), step, steps)
        shares = step / np.array([MASS, MASS, INERTIA])[:, None, None]
        at = {name: self.at(place) for name, place in scene.places().items()}
        found = {name: np.zeros((steps, 2)) for name in at}
        for number, (under, over) in enumerate(waves):
            self.push(under, over)
            before = {name: self.v[:2, row, column].copy() for name, (row, column) in at.items()}
            self.v += shares * self.f
            for name, (row, column) in at.items():
                found[name][number] = 0.5 * (before[name] + self.v[:2, row, column])
            self.u += step * self.v
        return found


def ground_needed(scene: Scene) -> tuple[int, int]:
    """Ground (m) beside the slope and below y = 0 from whose ends nothing has returned to the slope at the end.

    Scattered waves begin when the wave, at 0 at first, has gone up by H; none is faster than P waves.
    """
    time = scene.duration - scene.high / SPEEDS[scene.kind]
    reach = int(np.ceil(0.5 * P_SPEED * time + 0.5 * scene.high))
    return reach, max(reach - scene.high, 2)


def run_of(scene: Scene, folder: Path) -> tuple[float, dict[str, np.ndarray], dict[str, np.ndarray], int]:
    """Time step (s), and times (s,) and velocities (s, 2) at the places by `dembound run`; disks and nodes."""
    import dembound

    high, apart = float(scene.high), scene.apart * scene.high
    case = dembound.case(
        "slope",
        ground={"surface": [[-apart, 2.0 * high], [0.0, 2.0 * high], [high, high], [high + apart, high]]},
        packing={"pattern": "A", "size": [high + 2.0 * apart, 2.0 * high], "origin": [-apart, 0.0], "radius": 0.5},
        material={"density": DENSITY, "p_wave_speed": P_SPEED, "fric": 0.5},
        boundary={side: {"type": "outside"} for side in ("left", "right")}
        | {"bottom": {"type": "outside", f"wave_{scene.kind}": "wave"}},
        wave={
            "wave": {"type": "ricker", "amplitude": 1.0, "frequency": scene.frequency}
            if scene.form == "ricker"
            else {"type": "cosine", "amplitude": 1.0, "period": 1.0 / scene.frequency}
        },
        monitor=[{"name": name, "position": list(place)} for name, place in scene.places().items()],
        run={"duration": scene.duration},
        output={"pictures": False},
    )
    found = dembound.run(case, folder)
    known = {name: found.histories[name] for name in SHARES}
    times = {name: np.array(history["time"]) for name, history in known.items()}
    motion = {name: np.array(history["velocity"])[:, :2] for name, history in known.items()}
    return float(found.attributes["time_step"]), times, motion, len(found.particles["radius"])


def errors(
    own: dict[str, np.ndarray], exact: dict[str, np.ndarray], times: dict[str, np.ndarray], step: float
) -> dict[str, float]:
    """Errors of velocities (k, 2) by place at times (k,) s, RMS over RMS; exact : (s, 2), at multiples of the step."""
    found = {}
    for name, each in exact.items():
        at = step * np.arange(len(each))
        other = np.stack([np.interp(times[name], at, each[:, c]) for c in (0, 1)], axis=1)
        found[name] = float(np.sqrt(((own[name] - other) ** 2).sum() / (other**2).sum()))
    return found


def rows(options: argparse.Namespace) -> Iterator[dict[str, Any]]:
    """Rows of the table."""
    for kind in options.waves:
        for form in options.forms:
            for high in options.diameters:
                known: dict[float, dict[str, np.ndarray]] = {}
                for apart in options.apart:
                    scene = Scene(kind, form, high, apart)
                    with tempfile.TemporaryDirectory() as folder:
                        step, times, own, disks = run_of(scene, Path(folder))
                    if step not in known:
                        steps = int(scene.duration / step) + 2
                        known[step] = Lattice(scene, *ground_needed(scene)).run(scene, step, steps)
                    row: dict[str, Any] = {"wave": kind, "form": form, "D": high, "apart": apart, "disks": disks}
                    row |= {name: 100.0 * each for name, each in errors(own, known[step], times, step).items()}
                    yield row | {"worst": max(row[name] for name in SHARES)}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--diameters", nargs="+", type=int, default=[20, 40, 80], help="disks in a wave")
    parser.add_argument("--waves", nargs="+", choices=list(SPEEDS), default=list(SPEEDS))
    parser.add_argument("--forms", nargs="+", choices=list(PERIODS), default=["ricker"])
    parser.add_argument("--apart", nargs="+", type=float, default=[1.0, 0.5], help="distance of the sides in heights")
    parser.add_argument("--json", type=Path, default=Path("results/benchmarks/slope_reference.json"))
    small_option(parser, diameters=[20], waves=["s"], apart=[1.0])
    options = parser.parse_args()
    found = list(rows(options))
    columns = {
        "wave": "{wave}",
        "form": "{form}",
        "D in a wave": "{D}",
        "sides at, H": "{apart:g}",
        "disks": "{disks:,}",
    }
    show("Errors, %", columns | {name: f"{{{name}:.3f}}" for name in (*SHARES, "worst")}, found)
    write(options.json, {"machine": machine(), "rows": found})
