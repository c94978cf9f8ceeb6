"""What a case would come to, without running it."""

import time
from typing import Any

import numpy as np

from dembound.case import Case
from dembound.run import Plan, describe_packing, describe_side, plan
from dembound.scene import Scene, boundary_medium
from dembound.simulate import Simulation
from dembound.threads import worthwhile_threads

FEWEST_PER_WAVELENGTH = 20.0
"""Below this many particles per wavelength the lattice's phase error (qa)²/24 exceeds 0.4 %."""

TRIAL_STEPS, TRIALS = 20, 3


def check(case: Case) -> tuple[dict[str, str], list[str]]:
    """Facts about the run a case describes, ready to print, and warnings. Runs a few steps to estimate the time."""
    planned = plan(case)
    scene, loose = planned.scene, planned.scene.assembly.loose
    threads = worthwhile_threads(scene.count)
    facts = {
        "particles": f"{scene.count:,}" + (f"; {loose} severed ones left out" if loose else ""),
        "contacts": f"{len(scene.assembly.pairs):,}",
        "time step": f"{planned.time_step:.4g} s, {planned.time_step / planned.step_limit:.3f} of the limit "
        f"{planned.step_limit:.6g} s",
        "steps": f"{planned.steps:,} for {case.run.duration:g} s",
        "memory": f"{scene.bytes / 1e6:.3g} MB",
        "estimated time": f"about {_estimate(planned):.2g} s with {threads} thread(s)",
    }
    facts |= _packing_facts(scene)
    for side in scene.edges:
        facts[f"{side} side"] = _side_fact(scene, side)
    for name, node in scene.monitors.items():
        x, y = scene.assembly.positions[node]
        facts[f"monitor {name}"] = f"particle {node} at ({x:.3f}, {y:.3f}) m"
    warnings = _tension_warnings(scene)
    for name, count in particles_per_wavelength(scene).items():
        facts[f"wave {name}"] = f"{count:.0f} particles per shortest wavelength"
        if count < FEWEST_PER_WAVELENGTH:
            warnings.append(
                f"wave.{name}: has {count:.1f} particles in its shortest wavelength, fewer than "
                f"{FEWEST_PER_WAVELENGTH:g}; the packing will disperse it"
            )
    return facts, warnings


def particles_per_wavelength(scene: Scene) -> dict[str, float]:
    """Shortest wavelength of every wave, at its highest frequency and the scene's slowest speed, in diameters."""
    speeds = [c for axis in (0, 1) for c in scene.ground.wave_speeds(axis) if np.isfinite(c)]
    spacing = scene.ground.brick.mean_diameter
    return {
        name: min(speeds) / wave.highest_frequency() / spacing if speeds else np.inf
        for name, wave in scene.case.wave.items()
    }


def _tension_warnings(scene: Scene) -> list[str]:
    """Waves whose stress ρcv exceeds the locked-in pressure: real contacts would open, the elastic law's do not."""
    pressure = _pressure(describe_packing(scene))
    medium = boundary_medium(scene.case, scene.ground, axis=0)
    stresses = {name: medium.density * medium.p_wave_speed * wave.peak() for name, wave in scene.case.wave.items()}
    return [
        f"wave.{name}: has a stress ρcv of {stress / 1e6:.3g} MPa, above the confining stress of "
        f"{pressure / 1e6:.3g} MPa; real contacts would open where it pulls, the elastic law keeps them closed"
        for name, stress in stresses.items()
        if 0.0 < pressure < stress  # a lattice packed without stress is told in the docs
    ]


def _pressure(packing: dict[str, Any]) -> float:
    """Locked-in isotropic pressure in Pa."""
    return 0.0 - 0.5 * (packing["stress"][0] + packing["stress"][1])


def _estimate(planned: Plan) -> float:
    """Seconds the run will take, from the quickest of a few short trials."""
    simulation = Simulation(planned.scene, planned.time_step, np.zeros(0, dtype=np.int64))
    simulation.advance(TRIAL_STEPS)  # compiles, and wakes the threads
    trials = []
    for _ in range(TRIALS):
        began = time.perf_counter()
        simulation.advance(TRIAL_STEPS)
        trials.append(time.perf_counter() - began)
    return min(trials) / TRIAL_STEPS * planned.steps


def _packing_facts(scene: Scene) -> dict[str, str]:
    packing = describe_packing(scene)
    speeds = [
        f"{name} = {packing[key]:.1f} m/s"
        for name, key in (("c_p", "p_wave_speed"), ("c_s", "s_wave_speed"))
        if packing[key] is not None
    ]
    stiffness = ", ".join(f"{name} {packing[name] / 1e9:.4f}" for name in ("C11", "C22", "C12", "C66"))
    return {
        "brick": f"{packing['disks_per_brick']:,} disk(s), solid fraction {packing['solid_fraction']:.4f}, "
        f"{packing['coordination']:.3f} contacts per disk",
        "brick equilibrium": f"residual force ratio {packing['residual_ratio']:.1e}, "
        f"confining stress {_pressure(packing) / 1e6:.3f} MPa",
        "homogenised stiffness": f"{stiffness} GPa",
        "wave speeds": ", ".join(speeds) or "no motion is free",
    }


def _side_fact(scene: Scene, side: str) -> str:
    facts = describe_side(scene, side)
    factors = "".join(f", {factor} = {facts[factor]:g}" for factor in ("beta_p", "beta_s") if factor in facts)
    return (
        f"{facts['type']}{factors}; {facts['particles']} particles, D = {facts['diameter_min']:.3f}…"
        f"{facts['diameter_max']:.3f} m, ΣD/H = {facts['cover']:.4f}"
    )
