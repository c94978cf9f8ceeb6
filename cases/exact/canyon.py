"""Motion of a semicircular canyon's surface under P and SV waves from straight below, beside boundary elements.

    python cases/exact/canyon.py results/canyon_p results/canyon_sv     (half a minute; writes canyons.png)

Wong (1982, Bull. Seism. Soc. Am. 72, 1167-1183) and Kawase (1988, ibid. 78, 1415-1437) draw these amplitudes over x/a
at a frequency η = ωa/(πc_s), as shares of the incident wave, for ν = 1/3. Here they are computed for ν = 0, that of the
disks, and not taken from print: by indirect boundary elements with the full space's Green function, on the canyon and
on the surface beside it (Sánchez-Sesma & Campillo 1991, ibid. 81, 2234-2253).
"""

import sys
import tomllib
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.special import hankel1

import dembound
from dembound.plot.style import COLOURS, new_figure, outside_legend, save, styled

ETA = 1.0
"""Frequency ωa/(πc_s): the canyon is as wide as an S wave is long."""

RATIO = 2.0**0.5
"""c_p/c_s of the runs: the square lattice of equal stiffness ratios has ν = 0."""


def green(x: np.ndarray, rate: float, ratio: float) -> tuple[np.ndarray, np.ndarray]:
    """Displacement (…, 2, 2) at x (…, 2) from a unit line force along the last axis, and its gradient (…, k, 2, 2).

    Plane strain, e^{−iωt}, with μ = c_s = 1, ω = rate, ratio = c_p/c_s: G = A δ + B (2γγ − δ), γ = x/r, with
    A = (i/8)(H₀(k_p r)/ratio² + H₀(k_s r)) and B = (i/8)(H₂(k_s r) − H₂(k_p r)/ratio²).
    """
    r = np.hypot(x[..., 0], x[..., 1])
    waves = [(rate / ratio, 1.0 / ratio**2, -1.0), (rate, 1.0, 1.0)]
    h0, h1, h2 = ([hankel1(n, k * r) for k, _, _ in waves] for n in (0, 1, 2))
    a = 0.125j * sum(w * h for (_, w, _), h in zip(waves, h0, strict=True))
    b = 0.125j * sum(s * w * h for (_, w, s), h in zip(waves, h2, strict=True))
    da = -0.125j * sum(w * k * h for (k, w, _), h in zip(waves, h1, strict=True))
    db = 0.125j * sum(s * w * (k * h - 2.0 * g / r) for (k, w, s), h, g in zip(waves, h1, h2, strict=True))
    unit, one = x / r[..., None], np.eye(2)
    pair = unit[..., :, None] * unit[..., None, :]
    turn = (one - pair) / r[..., None, None]  # ∂_k γ_i
    shape = 2.0 * pair - one
    rise = da[..., None, None] * one, db[..., None, None] * shape
    slope = unit[..., :, None, None] * (rise[0] + rise[1])[..., None, :, :]
    slope = slope + 2.0 * b[..., None, None, None] * (
        turn[..., :, :, None] * unit[..., None, None, :] + turn[..., :, None, :] * unit[..., None, :, None]
    )
    return a[..., None, None] * one + b[..., None, None] * shape, slope


def stress(slope: np.ndarray, ratio: float) -> np.ndarray:
    """Stress (…, i, k, …) over μ of gradients ∂_k u_i given as (…, k, i, force)."""
    trace = np.trace(slope, axis1=-3, axis2=-2)[..., None, None, :] * np.eye(2)[:, :, None]
    return (ratio**2 - 2.0) * trace + slope + np.swapaxes(slope, -3, -2)


def free_field(y: np.ndarray, kind: str, rate: float, ratio: float) -> tuple[np.ndarray, np.ndarray]:
    """Displacement (n, 2), twice the cosine, and its gradient (n, k, i) of a wave from below at heights y ≤ 0."""
    k, axis = (rate / ratio, 1) if kind == "p" else (rate, 0)
    moved, slope = np.zeros((len(y), 2)), np.zeros((len(y), 2, 2))
    moved[:, axis], slope[:, 1, axis] = 2.0 * np.cos(k * y), -2.0 * k * np.sin(k * y)
    return moved, slope


def solved(kind: str, ratio: float, eta: float, size: float, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Middles (n, 2) of elements of a size from x = −reach to reach, in radii a, and their displacement (n, 2)."""
    rate, arc = np.pi * eta, round(np.pi / size)
    round_it = np.linspace(np.pi, 2.0 * np.pi, arc + 1)
    flat = 1.0 + size * np.arange(1, round((reach - 1.0) / size) + 1)
    x = np.concatenate([-flat[::-1], np.cos(round_it), flat])
    y = np.concatenate([0.0 * flat, np.sin(round_it), 0.0 * flat])
    ends = np.column_stack([x, y])
    middle, along = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends, axis=0)
    lengths = np.hypot(*along.T)
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / lengths[:, None]  # out of the ground
    nodes, weights = np.polynomial.legendre.leggauss(6)
    nodes, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    moves = pulls = np.zeros(())
    for place, weight in zip(nodes**2 / 2.0, weights * nodes, strict=True):  # dense round the middle, for ln r
        for side in (-place, place):
            moved, slope = green(middle[:, None] - (middle + side * along)[None], rate, ratio)
            shares = weight * lengths[None, :, None, None]
            moves = moves + shares * moved
            pulls = pulls + shares * np.einsum("mnikj,mk->mnij", stress(slope, ratio), normal)
    moved, slope = free_field(middle[:, 1], kind, rate, ratio)
    load = np.einsum("mikj,mk->mi", stress(slope[..., None], ratio), normal)
    flatten = (2 * len(middle), 2 * len(middle))
    matrix = 0.5 * np.eye(flatten[0]) + pulls.transpose(0, 2, 1, 3).reshape(flatten)
    force = np.linalg.solve(matrix, -load.ravel())
    return middle, moved + (moves.transpose(0, 2, 1, 3).reshape(flatten) @ force).reshape(-1, 2)


def amplitudes(kind: str, ratio: float, eta: float = ETA, size: float = 0.075, reach: float = 6.0) -> np.ndarray:
    """Rows x/a, |u_x|, |u_y| of the surface, over the incident wave's.

    kind : "p" or "sv". ratio : c_p/c_s. eta : ωa/(πc_s). size, reach : of the elements, in radii a. The mean with
    elements that go on for a quarter of a Rayleigh wave, whose ends return waves of the opposite sign.
    """
    more = round(0.46 / eta / size)
    middle, near = solved(kind, ratio, eta, size, reach)
    far = solved(kind, ratio, eta, size, reach + more * size)[1][more:-more]
    return np.column_stack([middle[:, 0], np.abs(0.5 * (near + far))]).T


def measured(results: dembound.Results, eta: float = ETA) -> np.ndarray:
    """Rows x/a, |u_x|, |u_y| at the monitors of a run of cases/gallery/canyon_p.toml or canyon_sv.toml.

    Amplitudes of the velocity at the frequency of eta, over half of that of the surface of level ground.
    """
    case = tomllib.loads(results.case)
    (centre, _), radius = case["hole"][0]["centre"], case["hole"][0]["radius"]
    frequency = 0.5 * eta * case["material"]["p_wave_speed"] / RATIO / radius
    places = {name: each["position"][0] for name, each in results.summary["monitors"].items()}

    def spectrum(name: str) -> np.ndarray:
        record = results.histories[name]
        return np.abs(np.exp(-2j * np.pi * frequency * record["time"]) @ record["velocity"][:, :2])

    level = 0.5 * np.hypot(*spectrum("surface_1.free_field"))
    names = [name for name in places if not name.endswith(".free_field")]
    return np.array([[(places[name] - centre) / radius, *(spectrum(name) / level)] for name in names]).T


@styled
def picture(pairs: dict[str, tuple[np.ndarray, np.ndarray]]) -> Figure:
    """Measured and computed amplitudes over x/a, by title of the run."""
    figure = new_figure(10.0, 4.2)
    panels = figure.subplots(1, len(pairs), squeeze=False)[0]
    for panel, (title, (found, expected)) in zip(panels, pairs.items(), strict=True):
        for axis, name in enumerate("xy", start=1):
            panel.plot(expected[0], expected[axis], color=COLOURS[axis - 1], label=f"{name}, boundary elements")
            panel.plot(found[0], found[axis], "o", markersize=3.5, color=COLOURS[axis - 1], label=f"{name}, disks")
        panel.set(xlim=(-2.1, 2.1), ylim=(0.0, 3.2), title=title, xlabel="x / radius (–)")
    figure.axes[0].set_ylabel("amplitude / incident wave's (–)")
    outside_legend(figure, (figure.axes[0],), columns=4)
    return figure


def main(folders: list[str]) -> None:
    """Print amplitudes at some places and the RMS difference of each run, and draw them all."""
    pairs = {}
    for folder in folders:
        results = dembound.Results(folder)
        found, expected = measured(results), amplitudes(Path(folder).name.removeprefix("canyon_"), RATIO)
        there = np.array([np.interp(found[0], expected[0], row) for row in expected[1:]])
        pairs[results.summary["title"]] = found, expected
        apart = np.sqrt(np.sum((found[1:] - there) ** 2) / np.sum(there**2))
        print(f"{results.name}: RMS of the difference {100.0 * apart:.1f} % of the amplitudes")
        for place in (0.0, 0.5, 1.1, 1.5, 2.0):
            nearest = int(np.argmin(np.abs(found[0] - place)))
            cells = (f"{row[nearest]:.2f} ({exact[nearest]:.2f})" for row, exact in zip(found[1:], there, strict=True))
            print(f"  x = {found[0][nearest]:.2f} a: x {next(cells)}, y {next(cells)}")
    save(picture(pairs), Path("canyons.png"))


if __name__ == "__main__":
    main(sys.argv[1:])
