"""Cracks with a fracture energy: traction by opening, and the places of spalls by spacing.

    python cases/cracks/pictures.py FOLDER

The first picture pulls a bar as long as EG_f/σ_t² apart and draws the traction of its crack beside the law. The second
breaks L's bar under a pulse of 26 MPa at several spacings; a table of its spalls is printed, as Markdown. A minute.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from dembound.api import case
from dembound.bar.fracture import opened_planes, spalls
from dembound.kinds import load, with_changes
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.running import plan

ROCK: dict[str, Any] = {"density": 2620.0, "wave_speed": 2740.0, "strength": 10e6}
MODULUS = 2620.0 * 2740.0**2
ENERGY = 200.0
"""Fracture energy, J/m²."""

OPEN = 2.0 * ENERGY / 10e6
LENGTH = MODULUS * ENERGY / 10e6**2
HORIZON = 8e-3
"""Horizon of peridynamics, m, at every spacing."""

PULL = 0.02
"""Speed of the pulled end, m/s."""

MILLI, MICRO, MEGA = 1e-3, 1e-6, 1e6

SPACINGS = (2e-3, 1e-3, 0.5e-3, 0.25e-3)
"""Spacings of the nodes, m."""


def pulled(method: dict[str, Any], cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Opening (m) and traction (Pa) of the crack in a bar whose right end is pulled slowly."""
    scene = plan(
        case(
            bar=ROCK | {"length": LENGTH, "spacing": LENGTH / cells, "fracture_energy": ENERGY},
            method=method,
            boundary={"left": {"type": "fixed"}, "right": {"type": "velocity", "wave_p": "pull"}},
            wave={"pull": {"type": "constant", "amplitude": PULL}},
            run={"duration": 1.05 * OPEN / PULL, "courant": 0.9},
        )
    )
    simulation = Simulation(scene.scene, scene.time_step)
    part = simulation.system.parts[0]
    taken = []
    while simulation.state.step < scene.steps:
        simulation.run(min(scene.steps, simulation.state.step + cells))
        taken.append((simulation.state.u[0].copy(), part.stress(simulation.state.u)))
    (plane,) = np.flatnonzero(opened_planes(part.bonds)[1] >= 0)
    elongation = np.array([u[plane + 1] - u[plane] for u, _ in taken])
    traction = np.array([0.5 * (stress[plane] + stress[plane + 1]) for _, stress in taken])
    return elongation - traction / MODULUS * LENGTH / cells, traction


def draw_traction() -> Figure:
    """Traction by opening of finite differences and of peridynamics, beside the law."""
    figure = Figure(figsize=(6.0, 3.8), layout="constrained")
    axes = figure.subplots()
    axes.plot([0.0, OPEN / MICRO], [10.0, 0.0], "k-", lw=1, label="law")
    methods = {
        "finite differences": {"type": "finite_difference"},
        "peridynamics, m = 3": {"type": "peridynamics", "horizon": 3, "corrected_ends": True},
    }
    for (name, method), mark in zip(methods.items(), "o^", strict=True):
        opening, traction = pulled(method, 41)
        shown = slice(None, None, max(1, len(opening) // 60))
        axes.plot(opening[shown] / MICRO, traction[shown] / MEGA, mark, ms=4, mfc="none", label=name)
    axes.set(xlabel="opening w (µm)", ylabel="traction (MPa)")
    axes.legend()
    axes.grid(alpha=0.3)
    return figure


def broken(method: str, spacing: float, energy: float | None) -> tuple[list[float], list[float], float]:
    """Places (m) and times (s) of the cracks in L's bar under a pulse of 26 MPa, and the energy (J/m²) they take.

    With a fracture energy they are spalls, without one all springs that broke.
    """
    base = load(Path(__file__).with_name("pieces.toml"))
    (hit,) = base.load
    horizon = 1 if method == "finite_difference" else round(HORIZON / spacing)
    bar = base.bar.model_dump(exclude_none=True) | {"spacing": spacing}
    if energy is None:
        del bar["fracture_energy"]
    of_method = {"type": method} | ({"horizon": horizon} if method != "finite_difference" else {})
    changes = {"bar": bar, "method": of_method, "load": [hit.model_dump() | {"nodes": horizon}]}
    made = with_changes(base, changes)
    planned = plan(made)
    simulation = Simulation(planned.scene, planned.time_step)
    ledger = Ledger(simulation, planned.steps - 1)
    simulation.track(ledger)
    simulation.run(planned.steps)
    bonds = simulation.system.parts[0].bonds
    taken = ledger.entries[-1].crack
    if energy is None:
        steps, pairs = bonds.breaks(0)
        return (spacing * (pairs[:, 0] + 0.5)).tolist(), (planned.time_step * steps).tolist(), taken
    found = sorted(spalls(bonds, planned.scene.positions[:, 0], planned.time_step), key=lambda spall: spall.end)
    return [0.5 * sum(spall.end) for spall in found], [spall.time for spall in found], taken


CHOICES: dict[str, tuple[str, float | None]] = {
    "finite differences, at once": ("finite_difference", None),
    "finite differences, 200 J/m²": ("finite_difference", ENERGY),
    "patches, δ = 8 mm, 200 J/m²": ("patch", ENERGY),
    "peridynamics, δ = 8 mm, 200 J/m²": ("peridynamics", ENERGY),
}
"""Method and fracture energy (J/m²; None: bonds break at once)."""


def draw_pieces() -> Figure:
    """Places of spalls by spacing, for every choice; prints them."""
    figure = Figure(figsize=(10.0, 3.6), layout="constrained")
    panels = figure.subplots(1, len(CHOICES), sharey=True, sharex=True)
    print(
        "| | Δx (mm) | cracks | places (mm) | open at (µs) | energy of all cracks (J/m²) |\n|---|---|---|---|---|---|"
    )
    for axes, (name, (method, energy)) in zip(panels, CHOICES.items(), strict=True):
        for spacing in SPACINGS:
            places, times, taken = broken(method, spacing, energy)
            axes.plot(np.array(places) / MILLI, np.full(len(places), spacing / MILLI), "|", ms=18, mew=1.2)
            few = len(places) <= 9
            where = " ".join(f"{place / MILLI:.1f}" for place in places) if few else "–"
            when = " ".join(f"{time / MICRO:.1f}" for time in times) if few else "–"
            print(f"| {name} | {spacing / MILLI:g} | {len(places)} | {where} | {when} | {taken:.0f} |")
        axes.set_title(name.replace(", ", "\n"), fontsize="small")
        axes.set(xlabel="place (mm)", yscale="log", ylim=(0.18, 2.8), xlim=(840.0, 985.0))
        axes.set_yticks([spacing / MILLI for spacing in SPACINGS], [f"{spacing / MILLI:g}" for spacing in SPACINGS])
        axes.minorticks_off()
    panels[0].set_ylabel("Δx (mm)")
    return figure


def main() -> None:
    """Draw both pictures into the folder."""
    folder = Path(sys.argv[1])
    draw_traction().savefig(folder / "cracks_traction.png", dpi=110)
    draw_pieces().savefig(folder / "cracks_pieces.png", dpi=110)


if __name__ == "__main__":
    main()
