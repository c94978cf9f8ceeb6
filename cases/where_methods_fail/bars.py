"""Measured thresholds of methods for bars of nodes."""

from typing import Any

import numpy as np
from scenes import ROCK_DENSITY, ROCK_SPEED, STRENGTH, bar, triangle

from dembound.bar.fracture import spalls
from dembound.bar.scene import BarPart, BarScene, build_bar
from dembound.bar.stability import carrying_lattices, choose_step
from dembound.errors import RunError
from dembound.exact.bar import cells_per_wavelength
from dembound.gauge.estimates import pull_back_strength
from dembound.kinds import kind_of
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Rod
from dembound.motion.part import System
from dembound.motion.simulation import Simulation
from dembound.studies.dispersion import measure
from dembound.studies.stability import short_run

METHODS: dict[str, dict[str, Any]] = {
    "finite_difference": {"type": "finite_difference"},
    "peridynamics": {"type": "peridynamics", "horizon": 3},
    "switch": {"type": "switch", "horizon": 3},
    "patch": {"type": "patch", "horizon": 3},
}


def cells_for_one_per_cent(horizon: int) -> tuple[float, float]:
    """Spacings in a wavelength for 1 % of speed at 0.9 of the limit; and the error a simulation has there."""
    method = {"type": "peridynamics", "horizon": horizon}
    case = bar(method, run={"duration": 1e-3, "safety": 0.9})
    scene = build_bar(case)
    lattice = carrying_lattices(scene, choose_step(scene)[0])[0]
    cells = cells_per_wavelength(horizon, lattice.courant)
    wavenumber = np.array([2.0 * np.pi / (cells * lattice.spacing)])
    speed = float(measure(lattice, wavenumber)[0] / wavenumber[0])
    return cells, abs(speed / ROCK_SPEED - 1.0)


def smeared(horizon: int, length: float = 20e-6) -> float:
    """Loss of peak velocity of a cosine pulse (s) over half the bar, 1 mm spacing."""
    pulse = {"type": "cosine", "amplitude": 1.0, "period": length}
    load = [{"name": "blow", "pressure": 1e6, "wave": "pulse", "nodes": horizon}]
    scene = build_bar(bar({"type": "peridynamics", "horizon": horizon}, load=load, wave={"pulse": pulse}))
    step = choose_step(scene)[0]
    velocity = Simulation(scene, step, [200, 700]).advance(int(0.95 / ROCK_SPEED / step))[:, :, 3]
    return float(1.0 - velocity[:, 1].max() / velocity[:, 0].max())


def seam_echo(cells: float, horizon: int = 3, complement: bool = True) -> float:
    """Reflected part of a burst at the border of a zone of peridynamics, for `cells` spacings per wavelength.

    complement : whether local springs carry the rest of the stress that the zone's bonds do not, as in the method
    `patch`.
    """
    count, seam, gauge, courant = 1600, 900, 450, 0.5
    spacing = 1.0 / count
    frequency = np.arcsin(courant * np.sin(np.pi / cells)) / (np.pi * courant * spacing / ROCK_SPEED)
    burst = {"type": "sine_burst", "amplitude": 1.0, "frequency": frequency, "cycles": 6}
    load = [{"name": "blow", "pressure": 1e6, "wave": "pulse"}]
    scene = build_bar(bar({"type": "patch", "horizon": horizon}, spacing, load=load, wave={"pulse": burst}))
    bonds = scene.case.method.begin(scene.rod) if complement else Bonds(scene.rod, horizon, complement=False)
    bonds.add_zone(seam, count + 1)
    step = courant * spacing / ROCK_SPEED
    system = System([BarPart(scene, step, bonds)], [], np.zeros((3, scene.count)))
    velocity = Simulation(scene, step, [gauge], system=system).advance(int((2 * seam + gauge) / courant))[:, 0, 3]
    wave = velocity * np.exp(-2j * np.pi * frequency * step * np.arange(len(velocity)))
    split = int(seam / courant)
    return float(abs(wave[split:].sum() / wave[:split].sum()))


def pieces(method: str, spacing: float = 1e-3) -> list[float]:
    """Places (m) at which a bar under a pulse of 3.4 strengths spalls within 0.6 ms, in the order of their times."""
    load = [{"name": "blow", "pressure": 3.4 * STRENGTH, "wave": "pulse", "nodes": 3}]
    case = bar(METHODS[method], spacing, bar={"strength": STRENGTH}, load=load, wave={"pulse": triangle(0.12e-3)})
    scene = build_bar(case)
    simulation = Simulation(scene, choose_step(scene)[0])
    simulation.run(int(0.6e-3 / simulation.time_step))
    part = simulation.system.parts[0]
    found = spalls(part.bonds, scene.positions[:, 0], simulation.time_step)
    return [0.5 * (spall.start[0] + spall.start[1]) for spall in sorted(found, key=lambda spall: spall.time)]


def energy_of_a_spall(energy: float, horizon: float = 8e-3, spacing: float = 0.5e-3) -> tuple[float, float]:
    """Horizon over EG_f/σ_t², and energy of fully open bonds over G_f for each spall, under 2.6 strengths.

    energy : G_f, J/m²; horizon : mΔx, m.
    """
    lengths = round(horizon / spacing)
    load = [{"name": "blow", "pressure": 2.6 * STRENGTH, "wave": "pulse", "nodes": lengths}]
    rock = {"strength": STRENGTH, "fracture_energy": energy}
    method = {"type": "peridynamics", "horizon": lengths}
    scene = build_bar(bar(method, spacing, bar=rock, load=load, wave={"pulse": triangle(0.12e-3)}))
    simulation = Simulation(scene, 0.9 * spacing / ROCK_SPEED)
    simulation.run(int(0.6e-3 / simulation.time_step))
    bonds = simulation.system.parts[0].bonds
    found = spalls(bonds, scene.positions[:, 0], simulation.time_step)
    opening = bonds.opening
    taken = 0.5 * opening["whole"] * opening["limit"] * opening["apart"]
    share = float(taken[opening.left == 0.0].sum()) / energy / len(found)
    return horizon / scene.case.bar.characteristic_length, share


def apparent_strength(period: float, energy: float = 100.0, strength: float = 6.34e6) -> float:
    """Pull-back strength over strength of a concrete bar with one strength (Pa), under a pulse of 20 MPa.

    period : its length, s; energy : G_f, J/m².
    """
    length, density, speed, cells = max(1.0, round(1.2 * 3800.0 * period, 2)), 2400.0, 3800.0, 2400
    concrete = {"length": length, "spacing": length / cells, "density": density, "wave_speed": speed}
    pulse = {"type": "cosine", "amplitude": 1.0, "period": period}
    load = [{"name": "blow", "pressure": 20e6, "wave": "pulse"}]
    concrete |= {"strength": strength, "fracture_energy": energy}
    scene = build_bar(bar(METHODS["finite_difference"], bar=concrete, load=load, wave={"pulse": pulse}))
    step = 0.9 * length / cells / speed
    steps = int((2.2 * length / speed + period) / step)
    velocity = Simulation(scene, step, [cells]).advance(steps)[:, 0, 3]
    return pull_back_strength(step * np.arange(steps), velocity, density, speed, length) / strength


def tearing_load(horizon: int, nodes: int = 1, spacing: float = 5e-3) -> float:
    """Pressure over strength at which a load on so many nodes tears its own end, to 1 %."""

    def tears(strengths: float) -> bool:
        load = [{"name": "blow", "pressure": strengths * STRENGTH, "wave": "pulse", "nodes": nodes}]
        method = {"type": "peridynamics", "horizon": horizon}
        case = bar(method, spacing, bar={"strength": STRENGTH}, load=load, wave={"pulse": triangle(0.12e-3)})
        simulation = Simulation(build_bar(case), 1e-6)
        simulation.run(int(1.0 / ROCK_SPEED / 1e-6))
        cracks = simulation.system.take_cracks(simulation.state.step)
        return bool(np.any(cracks.position[:, 0] < 0.1))

    low, high = 0.1, 100.0
    while high / low > 1.01:
        middle = np.sqrt(low * high)
        low, high = (low, middle) if tears(middle) else (middle, high)
    return float(np.sqrt(low * high))


def odd_even_swing(late: float, courant: float = 1.0) -> float:
    """Largest pressure of a spring behind the front of a sudden load that starts `late` steps late, over the load."""
    spacing = 5e-3
    step = courant * spacing / ROCK_SPEED
    wave = {"type": "constant", "amplitude": 1.0, "start": late * step}
    load = [{"name": "blow", "pressure": 1e6, "wave": "pulse"}]
    scene = build_bar(bar(METHODS["finite_difference"], spacing, load=load, wave={"pulse": wave}))
    u = Simulation(scene, step, [20, 21]).advance(int(150 / courant))[:, :, 0]
    return float((u[:, 0] - u[:, 1]).max() * ROCK_DENSITY * ROCK_SPEED**2 / spacing / 1e6)


def above_the_limit(share: float = 1.001) -> int:
    """Steps in which noise at a share of the limit grows to 1e4 times its energy."""
    case = bar(METHODS["finite_difference"], 5e-3)
    course = short_run(kind_of(case).trials(case)[0][0], share * build_bar(case).step_limit())
    return course.steps[-1]


def stops(share: float, strength: float | None) -> bool:
    """Whether a run at a share of the stability limit is stopped, of a bar that breaks at this strength (Pa)."""
    more = {} if strength is None else {"bar": {"strength": strength}}
    load = [{"name": "blow", "pressure": 12e6, "wave": "pulse"}]
    scene: BarScene = build_bar(
        bar(METHODS["finite_difference"], 5e-3, load=load, wave={"pulse": triangle(0.12e-3)}, **more)
    )
    simulation = Simulation(scene, share * scene.step_limit())
    try:
        simulation.run(2000)
    except RunError:
        return True
    return False


def soft_end(corrected: bool) -> float:
    """Reflected part of a pulse of 60 mm at a viscous end of a peridynamic bar, 1 mm spacing, m = 3."""
    boundary = {"left": {"type": "viscous_input", "wave_p": "pulse"}, "right": {"type": "viscous"}}
    pulse = {"type": "cosine", "amplitude": 1.0, "period": 60e-3 / ROCK_SPEED}
    method = {"type": "peridynamics", "horizon": 3, "corrected_ends": corrected}
    scene = build_bar(bar(method, boundary=boundary, wave={"pulse": pulse}))
    step = choose_step(scene)[0]
    velocity = Simulation(scene, step, [500]).advance(int(1.9 / ROCK_SPEED / step))[:, 0, 3]
    late = int(1.0 / ROCK_SPEED / step)
    return float(np.abs(velocity[late:]).max() / velocity[:late].max())


def families_by_distance(horizon: int, nodes: int = 60, spacing: float = 1e-3) -> float:
    """Part of the outermost pairs of a bar that comparing rounded distances with mΔx loses."""
    places = spacing * np.arange(nodes)
    found = np.sum(np.abs(places[:, None] - places) <= horizon * spacing) - nodes
    whole = 2 * sum(nodes - p for p in range(1, horizon + 1))
    return float((whole - found) / (2 * (nodes - horizon)))


def too_stiff(horizon: int) -> float:
    """E_eff/E of a bar without the half volume of the outermost neighbours, from its bonds."""
    rod = Rod.uniform(60, spacing=0.01, section=1.0, modulus=20e9)
    bonds = Bonds(rod, horizon)
    bonds.add_zone(0, 60)
    bonds.bond[-1] *= 2.0
    lengths = np.arange(1, horizon + 1)
    return float((bonds.bond[:, 30] * lengths**2).sum() / rod.springs[30])
