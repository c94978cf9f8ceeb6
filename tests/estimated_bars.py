"""Bars whose errors are estimated and known: scenes, their records, and exact motions beside them."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from small_cases import Tables, small

from dembound.accuracy.budget import Budget
from dembound.accuracy.of_bars.causes import causes_of_bar
from dembound.accuracy.runner import measure
from dembound.casefile.bar import BarCase
from dembound.formulas.cause import Causes
from dembound.formulas.history import History, Motions
from dembound.kinds import with_changes
from dembound.running import Progress

BAR: Tables = {
    "bar": {"length": 1.0, "spacing": 0.01, "density": 2620.0, "wave_speed": 2740.0},
    "method": {"type": "finite_difference"},
    "load": [{"name": "hit", "pressure": 1e6, "wave": "pulse"}],
    "wave": {"pulse": {"type": "triangle", "amplitude": 1.0, "rise": 6e-5, "fall": 12e-5}},
    "monitor": [{"name": "near", "position": 0.2}, {"name": "far", "position": 0.8}],
    "boundary": {},
    "run": {"duration": 1.1e-3, "courant": 0.9},
    "output": {"pictures": False},
}
"""A bar of 101 nodes in which a pulse of half its length runs three lengths."""

PD3 = {"type": "peridynamics", "horizon": 3}
PD3_CORRECTED = PD3 | {"corrected_ends": True}
PD8 = {"type": "peridynamics", "horizon": 8}
RICKER = {"wave.pulse": {"type": "ricker", "amplitude": 1.0, "frequency": 1.2e4}}
BURST = {"wave.pulse": {"type": "sine_burst", "amplitude": 1.0, "frequency": 8e3, "cycles": 5}}
VISCOUS, LAYER = {"type": "viscous"}, {"type": "matched_layer", "nodes": 16}
INPUT = {"type": "viscous_input", "wave_p": "pulse"}
LAYER_INPUT = {"type": "matched_layer", "nodes": 40, "wave_p": "pulse"}
GRIP = {"type": "velocity", "wave_p": "pulse"}
WALL = {"type": "fixed", "artificial": False}
RANGES = {
    "range": [
        {"name": "rock", "length": 0.6},
        {"name": "soft", "length": 0.4, "wave_speed": 1370.0, "spacing": 0.005, "density": 2000.0},
    ]
}

SCENES: Mapping[str, Mapping[str, Any]] = {
    "finite differences, ν = 0.5": {"run.courant": 0.5},
    "finite differences, ν = 0.9": {},
    "finite differences, ν = 1": {"run.courant": 1.0},
    "m = 1, soft ends": {"method": {"type": "peridynamics", "horizon": 1}},
    "m = 3, soft ends": {"method": PD3},
    "m = 3, corrected ends": {"method": PD3_CORRECTED, "run.courant": 1.1},
    "m = 8, soft ends": {"method": PD8, "run.courant": 3.0},
    "m = 8, corrected ends": {"method": PD8 | {"corrected_ends": True}},
    "m = 3, load on 3 nodes": {"method": PD3, "load.hit.nodes": 3},
    "switch": {"method": {"type": "switch", "horizon": 3}},
    "patch": {"method": {"type": "patch", "horizon": 3}, "run.courant": 0.5},
    "ricker": RICKER,
    "ricker, m = 3": RICKER | {"method": PD3_CORRECTED},
    "sine burst, ν = 0.5": BURST | {"run.courant": 0.5},
    "long bar": {"bar.length": 8.0, "run.duration": 3e-3, "monitor.far.position": 7.5},
    "short bar": {"bar.length": 0.2, "monitor.near.position": 0.05, "monitor.far.position": 0.2},
    "fine bar, m = 3": {"bar.spacing": 0.0025, "method": PD3},
    "rare samples": {"output.history_interval": 2e-5},
    "viscous end": {"boundary.right": VISCOUS},
    "viscous end, β = 0.7": {"boundary.right": VISCOUS | {"beta_p": 0.7}},
    "viscous end, β = 1.4, m = 3": {"boundary.right": VISCOUS | {"beta_p": 1.4}, "method": PD3_CORRECTED},
    "viscous soft end, m = 3": {"boundary.right": VISCOUS, "method": PD3},
    "viscous soft end, m = 8": {"boundary.right": VISCOUS, "method": PD8, "run.courant": 3.0},
    "viscous ends, loaded": {"boundary": {"left": VISCOUS, "right": VISCOUS}},
    "matched layer": {"boundary.right": LAYER},
    "matched layer, m = 3": {"boundary.right": LAYER, "method": PD3},
    "matched layer, m = 8": {"boundary.right": LAYER, "method": PD8},
    "wall": {"boundary.right": WALL, "method": PD3},
    "wall in place of rock": {"boundary.right": {"type": "fixed"}},
    "input": {"boundary.left": INPUT, "load": []},
    "input, β = 0.8, m = 3": {"boundary.left": INPUT | {"beta_p": 0.8}, "load": [], "method": PD3_CORRECTED},
    "input by a matched layer, m = 3": {"boundary.left": LAYER_INPUT, "load": [], "method": PD3},
    "grip": {"boundary": {"left": GRIP, "right": VISCOUS}, "load": []},
    "attenuation": {"bar.attenuation": 0.5},
    "attenuation, m = 3, viscous end": {"bar.attenuation": 0.5, "boundary.right": VISCOUS, "method": PD3},
    "ranges": {"bar": BAR["bar"] | RANGES, "method": PD3},
}
"""Name -> changes of `BAR`."""

FINER = 8
"""Number of spacings of the reference within one of the bar."""


def scene(name: str) -> BarCase:
    """One of `SCENES`."""
    case = small({**BAR}, name=name, changes=SCENES[name])
    assert isinstance(case, BarCase)
    return case


def recorded_of(case: BarCase) -> tuple[dict[str, History], float]:
    """The records of a run of a case, and its time step, s."""
    outcome, _, _ = measure(case, Progress())
    return {name: _recorded(outcome.motions, name) for name in outcome.motions}, outcome.time_step


def _recorded(gauges: Motions, name: str) -> History:
    gauge = gauges[name]
    values = {quantity: gauge.values[quantity][:, :2] for quantity in ("velocity", "displacement", "stress")}
    return History(gauge.place, gauge.time, values)


def exact(case: BarCase, recorded: History) -> dict[str, np.ndarray]:
    """Quantity -> exact values (k,) at a monitor.

    By d'Alembert; of bars with attenuation or ranges by finite differences on finer nodes at Courant number 1, with
    absorbing ends beyond all echoes. The stress of an end node is taken half a spacing inside.
    """
    if case.bar.attenuation > 0.0 or case.bar.range:
        return _finer(case, recorded)
    length, half = case.bar.length, 0.5 * case.bar.spacing
    place = float(recorded.place[0])
    return {
        "velocity": dalembert(case, place, recorded.time, "velocity"),
        "displacement": dalembert(case, place, recorded.time, "displacement"),
        "stress": dalembert(case, min(max(place, half), length - half), recorded.time, "stress"),
    }


def dalembert(case: BarCase, place: float, time: np.ndarray, quantity: str) -> np.ndarray:
    """Exact values (k,) at a place (m) of a uniform bar whose motion enters at the left end."""
    bar = case.bar
    impedance = bar.density * bar.speed
    left, right = (_reflected(case, side) for side in ("left", "right"))
    wave = case.wave["pulse"]
    history = wave.displacement if quantity == "displacement" else wave.velocity
    size = case.load[0].pressure * 0.5 * (1.0 + left) / impedance if case.load else 1.0
    total = np.zeros_like(time)
    for turn in range(int(time.max() * bar.speed / bar.length) + 1):
        way = turn * bar.length + (place if turn % 2 == 0 else bar.length - place)
        sign = -impedance * (-1.0) ** turn if quantity == "stress" else 1.0
        total += sign * size * right ** ((turn + 1) // 2) * left ** (turn // 2) * history(time - way / bar.speed)
    return total


def _reflected(case: BarCase, side: str) -> float:
    """Velocity of the reflected wave over that of the arriving wave at an end."""
    end = case.side(side)
    return 0.0 if end.is_artificial else -1.0 if 0 in end.prescribed(0) else 1.0


def true_errors(case: BarCase, recorded: History) -> dict[str, float]:
    """Quantity -> RMS error over RMS at a monitor, beside the exact motion."""
    true = exact(case, recorded)
    return {q: float(np.linalg.norm(v[:, 0] - true[q]) / np.linalg.norm(v[:, 0])) for q, v in recorded.values.items()}


def _finer(case: BarCase, recorded: History) -> dict[str, np.ndarray]:
    """Motion by finite differences on finer nodes; a right end that absorbs is farther away by half of all ways."""
    bar = case.bar
    changes: dict[str, Any] = {}
    if case.side("right").is_artificial:
        cells = int(0.5 * case.run.duration * bar.speed / bar.spacing) + 1
        changes |= {"bar.length": bar.length + cells * bar.spacing, "boundary": {}}
    changes |= {f"bar.range.{given.name}.spacing": given.spacing / FINER for given in bar.range if given.spacing}
    changes |= {"bar.spacing": bar.spacing / FINER, "method": {"type": "finite_difference"}}
    changes["run"] = {"duration": case.run.duration, "courant": 1.0}
    changes |= {f"load.{load.name}.nodes": 1 for load in case.load}
    changes["monitor"] = [{"name": "here", "position": float(recorded.place[0])}]
    finer, _ = recorded_of(with_changes(case, changes))
    return {
        quantity: np.interp(recorded.time, finer["here"].time, values[:, 0])
        for quantity, values in finer["here"].values.items()
    }


@dataclass(frozen=True)
class Row:
    """An error of a scene, estimated and true: RMS over the RMS of the record."""

    scene: str
    monitor: str
    quantity: str
    estimate: float
    truth: float

    @property
    def ratio(self) -> float:
        """Estimate over truth."""
        return self.estimate / self.truth if self.truth > 0.0 else np.inf


def estimated(case: BarCase) -> tuple[dict[str, History], Causes]:
    """The record of a case and the causes of its errors."""
    recorded, step = recorded_of(case)
    return recorded, causes_of_bar(case, recorded, step)


def rows(name: str) -> Iterator[Row]:
    """Total errors of a scene at all monitors."""
    case = scene(name)
    recorded, causes = estimated(case)
    found = Budget(recorded, causes)
    for monitor, each in recorded.items():
        true = exact(case, each)
        for quantity, values in each.values.items():
            error = np.linalg.norm(values[:, 0] - true[quantity]) / np.linalg.norm(values[:, 0])
            yield Row(name, monitor, quantity, found.total(monitor, quantity).value, float(error))
