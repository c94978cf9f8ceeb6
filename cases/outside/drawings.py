"""The pictures of what sides with a continuum beyond them send back, and of loads that stay."""

import numpy as np
from angles import DIAMETER, FREQUENCY, Side, reflection
from lasting import SPEED, exact_settlement, half_space, inner, rule, settlement
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter
from oblique import reflection as of_dashpots

from dembound.plot.style import COLOURS, REFERENCE, decade, new_figure, outside_legend, point_style, styled

ANGLES = np.arange(0.0, 86.0, 2.5)
"""Degrees from the normal."""

DASHPOTS = {"type": "viscous", "half_mass": True}


@styled
def angles() -> Figure:
    """Reflected amplitudes against the angle of incidence, of a continuum and of dashpots, for P and S waves."""
    side = Side.of()
    figure = new_figure(10.0, 4.8)
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    for panel, motion in zip(panels, "ps", strict=True):
        per_wavelength = side.speeds["ps".index(motion)] / FREQUENCY / DIAMETER
        beyond = [reflection(side, motion, angle) for angle in ANGLES]
        dashpots = [of_dashpots(DASHPOTS, motion, angle, per_wavelength) for angle in ANGLES]
        for index, kind in enumerate("ps"):
            name = f"reflected {kind.upper()}"
            for found, what, marker in ((beyond, "continuum", "o"), (dashpots, "dashpots, β = 1", "x")):
                values = np.array([each[kind] for each in found])
                points = np.where(values > 1e-6, values, np.nan)  # what vanishes by symmetry is rounding
                panel.plot(ANGLES, points, marker=marker, color=COLOURS[index], linewidth=0.8, label=f"{name}, {what}")
        formula = [side.formula(motion, angle) for angle in ANGLES]
        panel.plot(ANGLES, formula, color=REFERENCE, linewidth=2.0, zorder=1, label="the layers' formula")
        panel.set_yscale("log")
        panel.set_ylim(1e-5, 1.5)
        panel.yaxis.set_major_formatter(FuncFormatter(decade))
        panel.set_title(f"incident {motion.upper()} wave")
        panel.set_xlabel("angle from the normal (degrees)")
        panel.set_ylabel("amplitude / that of the incident wave (–)")
    figure.suptitle(
        "Plane waves on a side of disks, S waves of 101 diameters, 17 nodes of elements in each", fontsize=11
    )
    outside_legend(figure, panels, columns=3)
    return figure


SETTLED = {
    "viscous": "viscous sides",
    "viscoelastic": "viscoelastic sides",
    "outside": "continuum, margin of one element",
}
"""Types of sides -> labels."""

CHOICES: dict[str, dict[str, float]] = {
    "three layers, R0 = 10⁻⁴": {},
    "the same, margin of 3": {"margin": 3},
    "the same, margin of 8": {"margin": 8},
    "two layers": {"layers": 2},
    "three layers, R0 = 10⁻⁶": {"reflection": 1e-6},
}
"""Labels -> keys of [outside]."""


@styled
def lasting() -> Figure:
    """Settlement beside a load that stays, against time; and its missing part, against c_p t/L."""
    figure = new_figure(10.0, 4.8)
    left, right = figure.subplots(1, 2)
    times = np.geomspace(0.3, 20.0, 60)
    for index, (side, name) in enumerate(SETTLED.items()):
        left.plot(times, 1e3 * settlement(half_space(side), times), color=COLOURS[index], label=name)
    expected = 1e3 * exact_settlement(half_space(), times)
    left.plot(times, expected, "--", color=REFERENCE, linewidth=2.5, label="exact half-space", zorder=1)
    left.set_xlabel("time (s)")
    left.set_ylabel("displacement 20 disks beside the load (mm)")
    later = np.geomspace(1.0, 80.0, 14)
    for index, (name, keys) in enumerate(CHOICES.items()):
        case = half_space(duration=later[-1], **keys)
        missing = 1.0 - settlement(case, later) / exact_settlement(case, later)
        shown = np.where(missing > 1e-4, missing, np.nan)
        right.plot(SPEED * later / inner(case), 100.0 * shown, label=name, **point_style(index))
    reach = np.array([70.0, 200.0])
    right.plot(reach, 100.0 * rule(reach), color=REFERENCE, linewidth=2.5, zorder=1, label="6·10⁻⁷ (c_p t/L)²")
    right.set_xlabel("c_p t/L, L the larger side within the layers (–)")
    right.set_ylabel("missing part of the displacement (%)")
    right.set_ylim(1e-2, 30.0)
    for panel in (left, right):
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.legend()
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(NullFormatter())
    figure.suptitle("A force that stays on a half-space: c_p = 300 m/s, a body of 51 × 20 disks", fontsize=11)
    return figure


PICTURES = {"outside_angles": angles, "outside_lasting": lasting}
"""Name of the file -> drawing."""
