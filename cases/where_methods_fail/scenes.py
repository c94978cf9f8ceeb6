"""Small scenes of disks and bars for the measurements, from a few words."""

from typing import Any

import numpy as np

from dembound import api
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

DENSITY, SPEED, RADIUS = 2500.0, 1000.0, 0.25
"""Disks, kg/m³, m/s and m: Z's long bars."""

ROCK_DENSITY, ROCK_SPEED, STRENGTH = 2620.0, 2740.0, 10e6
"""Bars, kg/m³, m/s and Pa: L's rock."""

PERIODIC = {"bottom": {"type": "periodic"}, "top": {"type": "periodic"}}


def disks(pattern: str, size: tuple[float, float], held: tuple[str, ...] = (), **tables: Any) -> DiskScene:
    """The scene of a case of disks of pattern A, B or C; other tables as in a case file, sides under `boundary`."""
    packing: dict[str, Any] = {"pattern": pattern, "size": size, "radius": RADIUS}
    if pattern != "A":
        packing |= {"radius_ratio": 1.5, "brick": (10.0, 10.0), "seed": 1}
    if pattern == "C":
        packing |= {"edge_radius": 0.26}
    packing |= tables.pop("packing", {})
    material = {"density": DENSITY} | tables.pop("material", {})
    if "emod" not in material:
        material["p_wave_speed"] = SPEED
    tables = {"run": {"duration": 1.0}, "motion": {"held": held}} | tables
    return build(api.case(packing=packing, material=material, **tables))


def bar(method: dict[str, Any], spacing: float = 1e-3, **tables: Any) -> api.Case:
    """The case of a rock bar of 1 m; other tables as in a case file, keys of [bar] under `bar`."""
    rock = {"length": 1.0, "spacing": spacing, "density": ROCK_DENSITY, "wave_speed": ROCK_SPEED}
    return api.case(bar=rock | tables.pop("bar", {}), method=method, **({"run": {"duration": 1e-3}} | tables))


def triangle(length: float, **keys: float) -> dict[str, Any]:
    """L's pulse of unit height, `length` s long, with its crest after a third of it."""
    return {"type": "triangle", "amplitude": 1.0, "rise": length / 3.0, "fall": 2.0 * length / 3.0} | keys


def section(scene: DiskScene, place: float, duration: float, component: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Times (k,) s and mean velocity (k,) m/s of the disks within 1 m of a place (m)."""
    near = np.flatnonzero(np.abs(scene.positions[:, 0] - place) < 1.0)
    step = choose_step(scene)[0]
    record = Simulation(scene, step, near).advance(int(duration / step))
    return step * np.arange(len(record)), record[:, :, 3 + component].mean(axis=1)
