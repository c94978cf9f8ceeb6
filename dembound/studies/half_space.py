"""The exact motion of the half-space of a case of Lamb's problem, at the case's monitors.

It is written as a record with the layout of a run, so that it can be plotted and compared in the same way.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import Load
from dembound.casefile.types import LAWS
from dembound.disks.scene import DiskScene, build
from dembound.errors import CaseError
from dembound.exact.lamb import surface_displacement
from dembound.motion.silence import monitored
from dembound.results.committed import new_file
from dembound.results.datasets import describe, write
from dembound.results.new_record import header_of_monitor
from dembound.version import __version__

ISOTROPY = 1e-6
"""Relative difference of C11 − C12 and 2 C66 up to which a medium is treated as isotropic."""

CORNER = 0.25
"""Least distance between the load and a side that does not mirror it, over the distance from load to monitor."""

SAMPLES = 2000
"""Number of times at which the exact motion is written."""

JUMP = 0.01
"""Jump over the largest load above which a load is refused at once.

The quadrature does not converge with such a jump, which takes a minute to detect; with a jump of a tenth of it, as at
the end of a measured record, it converges.
"""

CONTINUOUS = "the solution needs a continuous load"

ON_TOP = "must be on the top of the scene, where the solution is computed"


@dataclass(frozen=True)
class LineLoad:
    """Vertical force history on the surface: position along x (m), and N per metre, downwards, per unit of the wave."""

    x: float
    force: float
    wave: str


def write_exact(case: DiskCase, path: Path) -> None:
    """Write the exact histories of a case as a record; its monitors must lie on the surface.

    The load is a line on the surface. With a symmetry side it lies in that plane, and twice the case's force acts. The
    distance of a monitor is that of its particle, assumed to be on the surface.

    The folder of `path` is created if it does not exist.

    Raises CaseError if the case is not Lamb's problem: one vertical load that follows a continuous wave, on a free top,
    away from sides that do not mirror it, an isotropic and linear medium, monitors on the top and not under the load.
    """
    scene = build(case)
    times, motions = surface_motions(scene)
    path.parent.mkdir(parents=True, exist_ok=True)
    with new_file(path) as file:
        facts = {"name": case.name, "case": case.text, "version": __version__, "size": scene.size, "complete": True}
        describe(file, facts)
        histories = file.create_group("histories", track_order=True)
        for monitor in case.monitor:
            moved, group = motions[monitor.name], histories.create_group(monitor.name)
            describe(group, header_of_monitor(scene, monitor.name))
            write(group, "time", times, "s")
            write(group, "displacement", moved, "m, m, rad")
            write(group, "velocity", np.gradient(moved, times, axis=0), "m/s, m/s, rad/s")


def surface_motions(scene: DiskScene, samples: int = SAMPLES) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Exact times (k,) s and displacements (k, 3) m of a scene's monitors by name; errors as `write_exact`."""
    case = scene.case
    load, speeds = _line_load(scene), _wave_speeds(scene)
    if problems := [*_yielding(case), *_ends_of_the_surface(scene, load)]:
        raise CaseError(problems)
    times = np.linspace(0.0, case.run.duration, samples)
    return times, {monitor.name: _motion(scene, load, speeds, monitor.name, times) for monitor in case.monitor}


def _wave_speeds(scene: DiskScene) -> tuple[float, float]:
    """c_p and c_s in m/s of the half-space."""
    tensor = scene.ground.material_tensor
    if abs(tensor[0, 0] - tensor[0, 1] - 2.0 * tensor[3, 3]) > ISOTROPY * tensor[0, 0]:
        raise CaseError(["material: makes an anisotropic medium, which has no such solution; see kratio and fric"])
    p_speed, s_speed = (float(np.sqrt(tensor[k, k] / scene.ground.density)) for k in (0, 3))
    return p_speed, s_speed


def _motion(scene: DiskScene, load: LineLoad, speeds: tuple[float, float], name: str, times: np.ndarray) -> np.ndarray:
    """Displacements (k, 3) of a monitor's particle at times (k,) s."""
    place = scene.monitored[name]
    if name not in scene.between:
        _must_be_on_top(scene, scene.monitors[name], f"monitor.{name}.position")
    elif place[1] < scene.case.size[1] - scene.ground.brick.mean_diameter:
        raise CaseError([f"monitor.{name}.position: {ON_TOP}"])
    away = float(place[0]) - load.x
    if away == 0.0:
        raise CaseError([f"monitor.{name}.position: lies under the load, where the solution is infinite"])
    velocity = scene.case.wave[load.wave].velocity
    when, step = _largest_jump(velocity, times[-1] - abs(away) / speeds[0])
    if step > JUMP:
        raise CaseError([f"wave.{load.wave}: has a jump at {when:.3g} s; {CONTINUOUS}"])
    try:
        along, down = surface_displacement(
            times, abs(away), lambda t: load.force * velocity(t), scene.ground.density, *speeds
        )
    except RuntimeError:
        raise CaseError([f"wave.{load.wave}: is so rough that the solution does not converge; {CONTINUOUS}"]) from None
    return np.column_stack([np.sign(away) * along, -down, np.zeros(len(times))])


def _largest_jump(velocity: Callable[[np.ndarray], np.ndarray], end: float) -> tuple[float, float]:
    """Time (s) of the largest jump of a wave after t = 0 and before `end` (s), and its size over the largest velocity.

    Every interval between samples is halved repeatedly, and the half with the larger change is kept. The change of a
    continuous wave decreases with the width, that of a jump does not. Two opposite jumps between two samples are not
    detected.
    """
    # from just after t = 0, where a load may jump; 30 halvings reduce an interval to 1e-9 of its width
    times = max(end, 0.0) * np.linspace(1e-9, 1.0, SAMPLES)
    low, high = times[:-1], times[1:]
    largest = np.abs(velocity(times)).max()
    for _ in range(30):
        middle = 0.5 * (low + high)
        before, after = (np.abs(velocity(middle) - velocity(edge)) for edge in (low, high))
        low, high = np.where(before > after, low, middle), np.where(before > after, middle, high)
    steps = np.abs(velocity(high) - velocity(low))
    k = int(steps.argmax())
    return float(high[k]), float(steps[k] / largest) if largest > 0.0 else 0.0


def _line_load(scene: DiskScene) -> LineLoad:
    """The load of Lamb's problem."""
    case = scene.case
    driven: list[Load] = [load for load in case.load if load.wave is not None]
    if len(driven) != 1 or driven[0].force is None or driven[0].position is None or driven[0].force[0] != 0.0:
        raise CaseError(["load: Lamb's problem has one vertical force on one place, following a wave"])
    load = driven[0]
    assert load.position is not None and load.force is not None and load.wave is not None  # noqa: PT018
    node = int(np.argmin(np.hypot(*(scene.assembly.positions - load.position).T)))
    _must_be_on_top(scene, node, f"load.{load.name}.position")
    x, factor = float(scene.assembly.positions[node, 0]), 1.0
    for side, plane in (("left", 0.0), ("right", float(scene.assembly.size[0]))):
        if case.side(side).is_mirror and node in scene.edges[side].nodes:
            x, factor = plane, 2.0
    return LineLoad(x, -factor * load.force[1], load.wave)


def _yielding(case: DiskCase) -> Iterator[str]:
    """Properties of the case that differ from a linear half-space with a free surface."""
    if LAWS[case.material.law].has_history:
        name = case.material.law
        yield f'material.law: is "{name}", must have no history, as "elastic"; the solution is that of a linear solid'
    top = case.side("top")
    if not top.is_free:
        yield f'boundary.top.type: is "{top.type}", must be "free", the surface of the half-space'


def _ends_of_the_surface(scene: DiskScene, load: LineLoad) -> Iterator[str]:
    """Sides so near that the body is a quarter space with the load at its corner; a mirror side is at distance zero."""
    reach = np.abs(monitored(scene)[:, 0] - load.x).max(initial=0.0)
    for side, plane in (("left", 0.0), ("right", float(scene.assembly.size[0]))):
        away = abs(plane - load.x)
        if side in scene.edges and not scene.case.side(side).is_outside and 0.0 < away < CORNER * reach:
            yield (
                f"load: is {away:.3g} m from the {side} side and {reach:.3g} m from a monitor, which makes a quarter "
                f"space; the side must mirror the load (symmetry) or be at least {CORNER * reach:.3g} m away"
            )


def _must_be_on_top(scene: DiskScene, node: int, place: str) -> None:
    if "top" not in scene.edges or node not in scene.edges["top"].nodes:
        raise CaseError([f"{place}: {ON_TOP}"])
