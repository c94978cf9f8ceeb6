"""Measures oblique waves: ground without a tunnel against its exact motion, and a tunnel against a larger box.

    python measure.py [exact] [tunnel] [corners]

"exact": the largest deviation of any disk and of the continuum's nodes, in per cent of the disks' largest velocity.
"tunnel": RMS error of (v_x, v_y) at the tunnel and on the surface in the box of ``oblique.toml``, relative to a box of
twice the size in elements of half the size, in per cent of the RMS of the total motion. "corners": the same error in
the continuum, from the box to where its layers begin. All take some five minutes.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.kinds import load, with_changes
from dembound.motion.simulation import Simulation

Changes = dict[str, Any]

CASE = load(Path(__file__).parents[1] / "oblique.toml")
LOOKS = 60
"""Times at which all nodes are compared with the exact motion."""

ORTHOTROPIC = {"material.fric": 0.0}
RANDOM = {
    "packing.pattern": "B",
    "packing.radius_ratio": 1.5,
    "packing.brick": [25.0, 25.0],
    "packing.size": [75.0, 75.0],
    "packing.origin": [112.5, 125.0],
}
FRAMED = RANDOM | {"packing.pattern": "C", "packing.edge_radius": 0.5}
ANGLES = {f"SV {angle}°": {"incident.angle": float(angle)} for angle in (0, 15, 30, 40)}
P = {"P 30°": {"incident.type": "p"}}
GROUNDS: dict[str, Changes] = {
    **{f"A, isotropic, {name}": changes for name, changes in (ANGLES | P).items()},
    **{f"A, fric = 0, {name}": ORTHOTROPIC | changes for name, changes in ({"SV 30°": {}} | P).items()},
    **{f"B, seed {seed}, SV 30°": RANDOM | {"packing.seed": seed} for seed in (1, 2, 3)},
    "B, seed 1, P 30°": RANDOM | {"packing.seed": 1} | P["P 30°"],
    "C, seed 1, SV 30°": FRAMED | {"packing.seed": 1},
    "A, isotropic, SV 30°, 0.1 s": {"wave.pulse.period": 0.1},
    "A, isotropic, SV 30°, up to the surface": {"packing.origin": [120.0, 240.0], "boundary.top": {"type": "free"}},
    "B, seed 1, SV 30°, up to the surface": RANDOM
    | {"packing.seed": 1, "packing.origin": [112.5, 225.0], "boundary.top": {"type": "free"}},
}

WIDE = {"packing.size": [120.0, 120.0], "packing.origin": [90.0, 90.0], "outside.element": 15.0, "outside.margin": 4}
WIDE_RANDOM = {"packing.size": [175.0, 175.0], "packing.origin": [62.5, 75.0], "outside.element": 15.0}
TUNNELS: dict[str, tuple[Changes, Changes]] = {
    **{f"A, isotropic, {name}": (changes, WIDE) for name, changes in (ANGLES | P).items()},
    "A, isotropic, SV 30°, elements of 20 m": ({"outside.element": 20.0, "outside.margin": 2}, WIDE),
    **{f"A, fric = 0, {name}": (ORTHOTROPIC | each, WIDE) for name, each in ({"SV 30°": {}} | P).items()},
    "B, seed 1, SV 30°": (RANDOM | {"packing.seed": 1}, WIDE_RANDOM),
    "C, seed 1, SV 30°": (FRAMED | {"packing.seed": 1}, WIDE_RANDOM),
}


def case_of(changes: Changes) -> DiskCase:
    """The case with some changes."""
    case = with_changes(CASE, changes)
    assert isinstance(case, DiskCase)
    return case


def deviation(scene: DiskScene) -> tuple[float, float]:
    """Largest velocity of disks beyond the exact one, and of nodes, in per cent of the largest exact one of disks."""
    step, waves = choose_step(scene)[0], scene.ground_waves
    assert waves is not None
    simulation, steps = Simulation(scene, step), scene.case.run.duration / step
    disks = scene.disk_count
    corrector = np.moveaxis(scene.ground.continuum.corrector[:, scene.assembly.brick_particle], 1, 2)
    peak, beyond, grid = 0.0, 0.0, 0.0
    for look in range(1, LOOKS + 1):
        simulation.run(int(steps * look / LOOKS))
        velocity, now = simulation.state.velocity[:2], np.array([simulation.time - 0.5 * step])
        exact = waves.motion("velocity", now, scene.assembly.positions, corrector)[0, :, :2].T
        peak = max(peak, np.abs(exact).max())
        beyond = max(beyond, np.abs(velocity[:, :disks] - exact).max())
        grid = max(grid, np.abs(velocity[:, disks:]).max())
    return 100.0 * beyond / peak, 100.0 * grid / peak


def histories(case: DiskCase, step: float) -> tuple[dict[str, np.ndarray], DiskScene]:
    """Velocities (s, 2) at all monitors of a case, with this step, s."""
    scene = build(case)
    record = Simulation(scene, step, scene.probes).advance(int(case.run.duration / step))
    motion = scene.observed(record, step * np.arange(len(record)))
    return {name: motion[:, number, 3:5] for number, name in enumerate(scene.monitors)}, scene


def compare(changes: Changes, larger: Changes, places: dict[str, tuple[float, float]]) -> tuple[str, dict[str, float]]:
    """Size of a case, and its RMS deviation from a larger one at places (m), in per cent of the RMS of the motion."""
    monitors = (
        {"monitor": [{"name": name, "position": list(place)} for name, place in places.items()]} if places else {}
    )
    cases = [case_of(each | monitors) for each in (changes, changes | larger)]
    step = min(choose_step(build(case))[0] for case in cases)
    (own, scene), (reference, _) = (histories(case, step) for case in cases)
    assert scene.outside is not None
    size = f"{scene.disk_count:,} disks, {scene.outside.count:,} nodes of {scene.outside.settings.element:.3g} m"
    return size, {
        name: 100.0 * float(np.sqrt(np.mean((own[name] - expected) ** 2) / np.mean(expected**2)))
        for name, expected in reference.items()
        if not name.endswith(".free_field")
    }


def main() -> None:
    """Print what is asked for."""
    asked = sys.argv[1:] or ["exact", "tunnel", "corners"]
    for name, changes in GROUNDS.items() if "exact" in asked else ():
        scene = build(case_of({"hole": [], "monitor": []} | changes))
        print(f"{name}: disks {{:.3f}}, continuum {{:.3f}} %".format(*deviation(scene)), flush=True)
    for name, (changes, larger) in TUNNELS.items() if "tunnel" in asked else ():
        size, errors = compare(changes, larger, {})
        print(
            f"{name} ({size}):", ", ".join(f"{where} {error:.3f}" for where, error in errors.items()), "%", flush=True
        )
    if "corners" in asked:
        places = {f"corner_{way:g}": (119.5 - way, 119.5 - way) for way in (5.0, 10.0, 15.0, 20.0, 25.0, 29.0)}
        places |= {f"side_{way:g}": (119.5 - way, 149.5) for way in (10.0, 20.0, 29.0)}
        places |= {f"surface_{way:g}": (119.5 - way, 299.5) for way in (0.0, 10.0, 20.0, 29.0)}
        size, errors = compare({}, WIDE | {"outside.margin": 2}, places)
        print(f"towards the lower left corner ({size}):", {k: round(v, 3) for k, v in errors.items()})


if __name__ == "__main__":
    main()
