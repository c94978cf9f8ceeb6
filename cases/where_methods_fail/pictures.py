"""The pictures of where methods fail: oblique waves, short waves in packings, springs, lagged dampers, ends of bars."""

import numpy as np
from ends import dashpot_echo, harmonic_echo
from grains import coda, pulse_along_bar
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter
from oblique import ANGLES, dashpot_formula, reflection
from sides import lagged_limit, on_springs

from dembound.plot.style import COLOURS, REFERENCE, new_figure, outside_legend, point_style, styled

PER_WAVELENGTH = 200.0
"""Disks in a wavelength of the oblique waves."""


@styled
def oblique_waves() -> Figure:
    """Reflected amplitudes and energy against the angle of incidence, for P and S waves."""
    figure = new_figure(10.0, 4.2)
    panels = figure.subplots(1, 3, sharex=True)
    side = {"type": "viscous", "half_mass": True}
    for panel, motion in zip(panels, ("p", "s"), strict=False):
        measured = [reflection(side, motion, angle, PER_WAVELENGTH) for angle in ANGLES]
        formula = [dashpot_formula(motion, angle) for angle in ANGLES]
        for index, kind in enumerate(("p", "s")):
            colour = COLOURS[index]
            panel.plot(
                ANGLES, [each[kind] for each in formula], color=colour, label=f"reflected {kind.upper()}, formula"
            )
            points = [each[kind] for each in measured]
            panel.plot(ANGLES, points, "o", color=colour, label=f"reflected {kind.upper()}, lattice")
        panel.set_title(f"incident {motion.upper()} wave")
        panel.set_ylabel("amplitude / that of the incident wave (–)")
        energy = [each["energy"] for each in measured]
        panels[2].plot(ANGLES, energy, "s-", color=COLOURS[2 + (motion == "s")], label=f"incident {motion.upper()}")
    panels[2].set_title("reflected energy")
    panels[2].set_ylabel("energy / that of the incident wave (–)")
    for panel in panels:
        panel.set_xlabel("angle from the normal (degrees)")
        panel.set_ylim(0.0, 1.0)
    figure.suptitle("Plane waves on a viscous side with β = 1, isotropic square lattice (ν = 0)", fontsize=11)
    outside_legend(figure, panels, columns=3)
    return figure


@styled
def short_waves() -> Figure:
    """Delay and loss of peak of a pulse in patterns A, B and C, and coda against the wavelength."""
    figure = new_figure(10.0, 4.2)
    delay, loss, behind = figure.subplots(1, 3)
    counts = np.array([10.0, 14.0, 20.0, 28.0, 40.0, 56.0, 80.0])
    for index, pattern in enumerate("ABC"):
        found = np.array([pulse_along_bar(pattern, count) for count in counts])
        for panel, values in ((delay, found[:, 0]), (loss, found[:, 1])):
            panel.plot(counts, 100.0 * np.abs(values), label=f"pattern {pattern}", **point_style(index))
    for panel, what in ((delay, "delay over 60 m (% of the travel time)"), (loss, "loss of the peak over 60 m (%)")):
        panel.set_xscale("log")
        panel.set_xticks(counts[::2], [f"{count:g}" for count in counts[::2]])
        panel.xaxis.set_minor_formatter(NullFormatter())
        panel.set_yscale("log")
        panel.set_xlabel("mean diameters in the wavelength (–)")
        panel.set_ylabel(what)
        panel.axvline(20.0, color=REFERENCE, linewidth=1.0, zorder=1)
    lengths = np.array([12.0, 14.0, 16.0, 18.0, 20.0, 22.0, 24.0, 28.0, 34.0, 40.0])
    for index, brick in enumerate((10.0, 5.0)):
        sent_back = [100.0 * coda(length, brick) for length in lengths]
        behind.plot(lengths, sent_back, label=f"pattern B, bricks of {brick:g} m", **point_style(3 + index))
    behind.set_yscale("log")
    behind.set_xlabel("wavelength (m)")
    behind.set_ylabel("motion behind a burst (% of its peak)")
    figure.suptitle("Short waves: disks of 0.5 m; a warning is issued below 20 diameters (grey)", fontsize=11)
    outside_legend(figure, (delay, behind), columns=5)
    return figure


@styled
def springs_and_dampers() -> Figure:
    """Reflection of long waves by springs, and the stable step with dashpots on the velocity half a step earlier."""
    figure = new_figure(8.5, 4.0)
    left, right = figure.subplots(1, 2)
    ratios = np.geomspace(0.3, 300.0, 25)
    found = np.array([on_springs(ratio) for ratio in ratios])
    left.plot(ratios, found[:, 1], color=COLOURS[0], label="formula")
    left.plot(ratios, found[:, 0], "o", color=COLOURS[1], label="lattice")
    left.set_xscale("log")
    left.set_xlabel("wavelength / distance L of the source (–)")
    left.set_ylabel("reflected P wave / incident one (–)")
    left.set_title("springs reflect long waves (α_n = 1, G = ρc_p²/2)")
    left.legend()
    factors = np.array([0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0])
    cases = (("lagged, half end mass", 0.5, False), ("lagged, whole end mass", 1.0, False), ("centred", 0.5, True))
    for index, (name, mass, centred) in enumerate(cases):
        limits = [lagged_limit(beta, mass, centred=centred) for beta in factors]
        right.plot(factors, limits, label=name, **point_style(index))
    right.set_xlabel("boundary factor β (–)")
    right.set_ylabel("largest stable step / that without dashpots (–)")
    right.set_ylim(0.0, 1.1)
    right.set_title("dashpots at the ends of a chain")
    right.legend()
    return figure


@styled
def bar_ends() -> Figure:
    """Reflection of matched layers and a dashpot, against the wavelength and against the number of nodes."""
    figure = new_figure(9.5, 4.4)
    left, right = figure.subplots(1, 2, sharey=True)
    cells = np.geomspace(5.0, 2000.0, 40)
    left.plot(cells, [dashpot_echo(each) for each in cells], color=REFERENCE, label="dashpot, finite differences")
    counts = np.array([8, 12, 16, 20, 30, 40, 60, 80, 120, 160])
    for index, horizon in enumerate((1, 3, 8)):
        name = f"peridynamics, m = {horizon}" if horizon > 1 else "finite differences"
        for nodes, line in ((40, "-"), (80, "--")):
            echoes = [harmonic_echo(horizon, nodes, each) for each in cells]
            left.plot(cells, echoes, line, color=COLOURS[index], label=f"{name}, {nodes} nodes")
        enough = counts[counts >= 2 * horizon]
        most = [max(harmonic_echo(horizon, int(nodes), each) for each in (20.0, 50.0, 200.0)) for nodes in enough]
        right.plot(enough, most, label=f"{name}, largest at 20, 50, 200 Δx", **point_style(index))
    left.set_xlabel("wavelength c/f over Δx (–)")
    left.set_ylabel("returned / arriving amplitude (–)")
    right.set_xlabel("nodes in the layer (–)")
    for panel in (left, right):
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_ylim(1e-10, 1.0)
    right.set_xticks(counts[::3], [f"{count}" for count in counts[::3]])
    right.xaxis.set_minor_formatter(NullFormatter())
    figure.suptitle("Matched layers beyond an end of a bar, 0.9 of the stability limit", fontsize=11)
    outside_legend(figure, (left, right), columns=2)
    return figure


PICTURES = {
    "oblique_waves": oblique_waves,
    "short_waves": short_waves,
    "springs_and_dampers": springs_and_dampers,
    "bar_ends": bar_ends,
}
"""Name of the file -> drawing."""
