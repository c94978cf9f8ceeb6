"""What kinds of sides return under a record: runs of a strip beside the numbers of `dembound boundary`.

    python absorption.py

Every kind is the upper side of strip_clc.toml, which sends components 90 (S) and up (P) of the record CLC upwards.
Three neighbouring disks separate upward and downward waves at all frequencies: v = A e^(−iqy) + B e^(iqy), with q from
the run with the least return. Writes absorption.png, and prints the table.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import dembound
from dembound.disks.reflection import Reflections, compare_types
from dembound.spectra import fourier_spectrum, smoothed

HERE = Path(__file__).parent
FREQUENCIES, COMPUTED = np.geomspace(0.1, 25.0, 49), np.geomspace(0.08, 31.0, 61)
LEAST = 1e-3
"""Least amplitude of the incident wave over its largest that is compared."""

KINDS = {
    "viscous": {"type": "viscous"},
    "viscous, half_mass": {"type": "viscous", "half_mass": True},
    "viscous, β = 0.9": {"type": "viscous", "beta_p": 0.9, "beta_s": 0.9},
    "viscoelastic, 20 m": {"type": "viscoelastic", "distance": 20.0},
    "viscoelastic, 200 m": {"type": "viscoelastic", "distance": 200.0},
    "outside": {"type": "outside"},
    "fixed": {"type": "fixed"},
}
LEAST_RETURN = "outside"
COLOURS = ("#0072B2", "#56B4E9", "#CC79A7", "#D55E00", "#E69F00", "#009E73", "#000000")
SHOWN = (0.1, 0.3, 1.0, 3.0, 10.0, 25.0)


def histories(case: dembound.Case, number: int, table: dict) -> np.ndarray:
    """Spectra (f, monitor, component) of the velocities of a run with this side; their frequencies are in [:, 0, 2]."""
    found = dembound.run(dembound.change(case, {"boundary.top": table}, name=f"absorption_{number}"), "results")
    columns = [
        found.histories[name]["velocity"][:, component] for name in ("lower", "middle", "upper") for component in (0, 1)
    ]
    step = float(np.diff(found.histories["lower"]["time"][:2])[0])
    spectra = [fourier_spectrum(column, step) for column in columns]
    frequency = spectra[0][0]
    used = (frequency > COMPUTED[0]) & (frequency < COMPUTED[-1])
    values = np.array([values[used] for _, values in spectra]).T.reshape(-1, 3, 2)
    return np.concatenate([values, np.repeat(frequency[used], 3).reshape(-1, 3, 1)], axis=2)


def phases(spectra: np.ndarray, component: int) -> np.ndarray:
    """Phase (f,) of the waves of the lattice from a monitor to the next.

    2 − 2 cos of it is aω² + bω⁴, by least squares of (U₁ + U₃)/U₂ = 2 cos.
    """
    lower, middle, upper = spectra[:, :, component].T
    square = (2.0 * np.pi * spectra[:, 0, 2].real) ** 2
    terms = np.stack([square, square**2]).T
    weights = np.abs(middle) / square  # of relative errors
    change = ((2.0 * middle - lower - upper) / middle).real
    found, *_ = np.linalg.lstsq(terms * weights[:, None], change * weights, rcond=None)
    return np.arccos(1.0 - 0.5 * (terms @ found))


def separated(spectra: np.ndarray, phase: np.ndarray, component: int) -> tuple[np.ndarray, np.ndarray]:
    """Energies (f,) of the upward and the downward wave."""
    lower, _, upper = spectra[:, :, component].T
    turn = np.exp(2j * phase)  # two spacings from lower to upper
    up = (upper - lower * turn) / (1.0 / turn - turn)
    return np.abs(up) ** 2, np.abs(lower - up) ** 2


def main() -> None:
    """Run all kinds, print the table and draw the picture."""
    case = dembound.load(HERE / "strip_clc.toml")
    runs = {name: histories(case, number, table) for number, (name, table) in enumerate(KINDS.items())}
    computed: dict[str, Reflections] = {}
    for name, table in KINDS.items():
        if name != "fixed":  # one disk is a brick: the last one must move
            (computed[name],) = compare_types(case, "top", [table], [0.0], COMPUTED.tolist())[0].values()
    figure = Figure(figsize=(11.0, 5.2), layout="constrained", dpi=130)
    panels = figure.subplots(1, 2, sharey=True)
    for panel, kind, component in zip(panels, "sp", (0, 1), strict=True):
        phase = phases(runs[LEAST_RETURN], component)
        print(f"{kind.upper()}: % of the amplitude at {SHOWN} Hz, run / computed; % of the energy, run / computed")
        for colour, (name, spectra) in zip(COLOURS, runs.items(), strict=True):
            every = spectra[:, 0, 2].real
            up, down = separated(spectra, phase, component)
            known = computed[name].total(kind)[:, 0] if name in computed else np.ones(len(COMPUTED))
            again = up * np.exp(np.interp(np.log(every), np.log(COMPUTED), np.log(known)))
            power, measured, expected = (smoothed(every, each, FREQUENCIES) for each in (up, down, again))
            incident = np.sqrt(power / power.max())
            has_energy = incident > LEAST
            of_run, of_both = (np.where(has_energy, np.sqrt(each / power), np.nan) for each in (measured, expected))
            panel.plot(COMPUTED, np.sqrt(known), color=colour, linewidth=1.2, label=name)
            panel.plot(FREQUENCIES, of_run, "o", color=colour, markersize=3.5)
            cells = [
                f"{100.0 * np.interp(f, FREQUENCIES, of_run):.3g} / {100.0 * np.interp(f, FREQUENCIES, of_both):.3g}"
                for f in SHOWN
            ]
            energies = f"{100.0 * down.sum() / up.sum():.3g} / {100.0 * again.sum() / up.sum():.3g}"
            difference = np.nanmax(np.abs(of_run - of_both))
            print(f"| {name} | {' | '.join(cells)} | {energies} | largest difference {100.0 * difference:.2g}")
        behind = panel.twinx()
        behind.fill_between(FREQUENCIES, incident, color="#E8E8E8", linewidth=0.0)
        behind.set(yscale="log", ylim=(1e-3, 1.5))
        if kind == "p":
            behind.set_ylabel("incident velocity amplitude / largest (–), grey")
        panel.set(xscale="log", yscale="log", xlim=(0.09, 28.0), ylim=(1e-5, 1.5), xlabel="frequency (Hz)")
        panel.set_title(f"{kind.upper()} waves along the normal: runs (points), computed (lines)", fontsize=10)
        panel.grid(color="#E0E0E0", linewidth=0.6)
        panel.set_zorder(behind.get_zorder() + 1)
        panel.patch.set_visible(False)
    panels[0].set_ylabel("returned / incident velocity amplitude (–)")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    figure.savefig("absorption.png")
    print("wrote absorption.png")


if __name__ == "__main__":
    main()
