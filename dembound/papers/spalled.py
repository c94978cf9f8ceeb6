"""Runs of bars that break: what is read from their records, and how damage at the first spall is drawn."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from dembound.casefile.bar import BarCase
from dembound.casefile.model import as_kind
from dembound.errors import RunError
from dembound.exact import bar_stress, triangle_spall
from dembound.laws.peridynamic import CRACKED
from dembound.motion.simulation import Simulation
from dembound.plot.style import COLOURS, REFERENCE
from dembound.results.reader import open_record
from dembound.results.summary import read_summary
from dembound.running import plan
from dembound.running.recorded import recorded_case

MILLI, MEGA = 1e-3, 1e6

ROW = 1.25
"""Distance from one row of damage to the next; damage itself is 1 high."""


def first_spall(run: Path) -> dict[str, Any]:
    """The first spall of a run: `time` (s) and `start`, the range of its cracked nodes (m).

    Raises RunError if there is none.
    """
    found = read_summary(run)["spalls"]
    if not found:
        raise RunError(f"{run}: the bar did not break, so there is no spall to draw")
    return found[0]


def case_of(run: Path) -> BarCase:
    """The case that was run."""
    return as_kind(recorded_case(run / "run.h5"), BarCase, "must be of a bar", str(run))


def history(run: Path, monitor: str) -> tuple[np.ndarray, np.ndarray, float]:
    """Times (k,) s and stresses (k,) Pa at a monitor, and where it stands, m."""
    with open_record(run / "run.h5") as file:
        group = file[f"histories/{monitor}"]
        return group["time"][:], group["stress"][:], float(group.attrs["position"][0])


def stress_along(run: Path, time: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Places (n,) m and stresses (n,) Pa at the snapshot nearest to a time, and its own time, s."""
    with open_record(run / "run.h5") as file:
        nearest = min(file["snapshots"].values(), key=lambda group: abs(group.attrs["time"] - time))
        return file["particles/position"][:, 0], nearest["stress"][:], float(nearest.attrs["time"])


def damage_at_first_spall(run: Path) -> tuple[np.ndarray, np.ndarray]:
    """Places (n,) m and local damage (n,) in the step of the first spall, which no snapshot meets: it is run anew."""
    planned = plan(case_of(run))
    step = round(first_spall(run)["time"] / planned.time_step)
    simulation = Simulation(planned.scene, planned.time_step)
    simulation.run(step + 1)
    bar: Any = simulation.system.parts[0]
    return planned.scene.positions[:, 0], bar.bonds.damage(step)


def draw_damage(panel: Axes, runs: Sequence[tuple[str, Path]], limits: tuple[float, float]) -> None:
    """Damage of named runs, each at its first spall, in rows one below the other with the line that is a crack.

    Shown is the bar between the limits (m). Nodes of the spall and its time stand on the side where there is room.
    """
    for index, (_, run) in enumerate(runs):
        x, damage = damage_at_first_spall(run)
        base, colour = -ROW * index, COLOURS[index % len(COLOURS)]
        panel.fill_between(x, base, base + damage, color=colour, alpha=0.25, linewidth=0.0)
        panel.plot(x, base + damage, color=colour)
        panel.plot(x[damage > 0], base + damage[damage > 0], ".", color=colour)
        label = f"a crack, φ = {CRACKED:g}" if index == 0 else None
        panel.axhline(base + CRACKED, color=REFERENCE, linewidth=0.8, linestyle="--", zorder=1, label=label)
        spall = first_spall(run)
        words = f"{in_millimetres(spall['start'])} mm\n{spall['time'] / MILLI:.4f} ms"
        at, side = (0.99, "right") if np.mean(spall["start"]) < np.mean(limits) else (0.01, "left")
        beside: dict[str, Any] = {"ha": side, "va": "bottom", "fontsize": 7.5, "transform": panel.get_yaxis_transform()}
        panel.text(at, base + CRACKED + 0.04, words, **beside)
    panel.set_xlim(*limits)
    panel.set_yticks([-ROW * index for index in range(len(runs))], [name for name, _ in runs])
    panel.set_ylim(-ROW * (len(runs) - 1) - 0.3, 1.1)
    panel.set_xlabel("x (m)")


def exact_stress(case: BarCase, place: float, time: np.ndarray) -> np.ndarray:
    """Stress (k,) Pa of d'Alembert's solution at a place (m) and times (k,) s."""
    (load,) = case.load
    pulse = case.wave[load.wave].velocity
    return bar_stress(place, time, lambda t: load.pressure * pulse(t), case.bar.length, case.bar.speed)


def errors(run: Path, monitor: str = "middle") -> list[float]:
    """Errors of each whole passage of a run's pulse through the middle of an unbreakable bar.

    An error is the difference between the stress and d'Alembert's solution in the root mean square over a passage, L/c,
    in parts of that of the pulse.
    """
    case = case_of(run)
    time, stress, place = history(run, monitor)
    exact = exact_stress(case, place, time)
    wait = case.bar.length / case.bar.speed  # from one passage to the next
    begin = place / case.bar.speed + 0.5 * (case.wave[case.load[0].wave].duration() - wait)
    found = []
    for passage in range(int((time[-1] - begin) / wait)):
        inside = (time >= begin + passage * wait) & (time < begin + (passage + 1) * wait)
        error, pulse = (np.linalg.norm(values[inside]) for values in (stress - exact, exact))
        found.append(float(error / pulse))
    return found


def expected_spall(case: BarCase) -> tuple[float, float]:
    """Place (m) and time (s) of the first spall by the closed form."""
    (load,), bar = case.load, case.bar
    pulse: Any = case.wave[load.wave]
    strength = bar.modulus * bar.breaking_stretch
    return triangle_spall(bar.length, bar.speed, pulse.rise, pulse.fall, load.pressure, strength)


def name_of(case: BarCase) -> str:
    """The method as L calls it."""
    method, m = case.method, case.method.largest_horizon
    before = "PD1" if getattr(method, "before", "") == "peridynamics" else "FDM"
    return {
        "finite_difference": "FDM",
        "peridynamics": f"PD{m}",
        "switch": f"{before}–PD{m}",
        "patch": f"FDM with patches of PD{m}",
    }[method.type]


def in_millimetres(range_of: Sequence[float]) -> str:
    """A range in m as "906–909", or "906" where it is a single node."""
    return "–".join(f"{place / MILLI:.4g}" for place in sorted(set(range_of)))
