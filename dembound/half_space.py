"""The exact motion of the half-space that a case of Lamb's problem stands for, at the case's own monitors.

Written as a record like a run's, so that it is plotted and compared like one.
"""

from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from dembound import __version__
from dembound.boundaries import Symmetry
from dembound.case import Case
from dembound.case.load import Load
from dembound.errors import CaseError
from dembound.exact.lamb import surface_displacement
from dembound.results import replacing
from dembound.scene import Scene, build

ISOTROPY = 1e-6
"""Relative difference of C11 − C12 and 2 C66 up to which a medium counts as isotropic."""

SAMPLES = 2000
"""Times at which the exact motion is written down."""


@dataclass(frozen=True)
class LineLoad:
    """Vertical force history on the surface: where along x (m), and N per metre, downwards, per unit of the wave."""

    x: float
    force: float
    wave: str


def write_exact(case: Case, path: Path) -> None:
    """Write the exact histories of a case as a record; its monitors must lie on the surface.

    The load is a line on the surface. With a symmetry side it lies in that plane, and twice the case's force acts. A
    monitor is as far from it as the particle it records, taken to be on the surface.

    Raises CaseError where the case is not Lamb's problem: one vertical load that follows a wave, on the top, an
    isotropic medium, monitors on the top.
    """
    scene = build(case)
    load = _line_load(scene)
    tensor = scene.ground.material_tensor
    if abs(tensor[0, 0] - tensor[0, 1] - 2.0 * tensor[3, 3]) > ISOTROPY * tensor[0, 0]:
        raise CaseError(["material: makes an anisotropic medium, which has no such solution; see kratio and fric"])
    speeds = [float(np.sqrt(tensor[k, k] / scene.ground.density)) for k in (0, 3)]
    times = np.linspace(0.0, case.run.duration, SAMPLES)
    velocity = case.wave[load.wave].velocity
    with replacing(path) as part, h5py.File(part, "w") as file:
        file.attrs.update({"name": case.name, "case": case.text, "version": __version__, "complete": True})
        histories = file.create_group("histories", track_order=True)
        for monitor, node in zip(case.monitor, scene.monitors.values(), strict=True):
            place = scene.assembly.positions[node]
            _must_be_on_top(scene, node, f"monitor.{monitor.name}.position")
            along, down = surface_displacement(
                times, abs(place[0] - load.x), lambda t: load.force * velocity(t), scene.ground.density, *speeds
            )
            moved = np.column_stack([np.sign(place[0] - load.x) * along, -down, np.zeros(SAMPLES)])
            group = histories.create_group(monitor.name)
            group.attrs.update({"particle": node, "position": place, "wanted": monitor.position, "unit": "m"})
            _write(group, "time", times, "s")
            _write(group, "displacement", moved, "m, m, rad")
            _write(group, "velocity", np.gradient(moved, times, axis=0), "m/s, m/s, rad/s")


def _line_load(scene: Scene) -> LineLoad:
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
        if isinstance(case.boundary.get(side), Symmetry) and node in scene.edges[side].nodes:
            x, factor = plane, 2.0
    return LineLoad(x, -factor * load.force[1], load.wave)


def _must_be_on_top(scene: Scene, node: int, place: str) -> None:
    if "top" not in scene.edges or node not in scene.edges["top"].nodes:
        raise CaseError([f"{place}: must be on the top of the scene, where the solution is known"])


def _write(group: h5py.Group, name: str, values: np.ndarray, unit: str) -> None:
    group.create_dataset(name, data=values).attrs["unit"] = unit
