"""Difference of the motion in the tunnel's model from that in a wider and deeper one, or in a continuum.

    python cases/zhou2018/tunnel_errors.py RUN REFERENCE [--monitors P1 P2]

Prints the RMS error along x, along y and of both over the reference's RMS along the same directions. RUN has free-field
sides. So has an extended model; then the scattered motions are compared, a monitor's less its twin's in the free-field
column, and its base is deeper, so that the wave comes later there: its histories are taken back by the delay with which
the twin's v_x, along which the incident wave moves, first passes a fifth of its peak. A continuum has no column; then
the total motions are compared.
"""

import argparse
from pathlib import Path

import h5py
import numpy as np

NOTHING = 1e-6
"""Velocity (m/s) of rounding, of which no share is given."""


def read(run: Path, monitor: str) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Times (k,) s, and the velocities (k, 2) m/s of a monitor and of its twin, if there is a column."""
    with h5py.File(run / "run.h5") as file:
        histories = file["histories"]
        body, twin = histories[monitor], histories.get(f"{monitor}.free_field")
        return body["time"][:], body["velocity"][:, :2], None if twin is None else twin["velocity"][:, :2]


def first_passage(time: np.ndarray, velocity: np.ndarray) -> float:
    """Time (s) at which |velocity| (k,) first passes a fifth of its peak, between two samples."""
    level = 0.2 * np.abs(velocity).max()
    after = int(np.argmax(np.abs(velocity) >= level))
    return float(np.interp(level, np.abs(velocity[after - 1 : after + 1]), time[after - 1 : after + 1]))


def at(times: np.ndarray, time: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Velocities (k, 2) at other times (j,), (j, 2)."""
    return np.stack([np.interp(times, time, component) for component in velocity.T], axis=1)


def share(error: np.ndarray, of: np.ndarray) -> str:
    """RMS of an error (k, c) over RMS of a motion, in words."""
    scale = np.sqrt(np.mean(of**2))
    return f"{np.sqrt(np.mean(error**2)) / scale:.2%}" if scale > NOTHING else "-"


def compare(run: Path, reference: Path, monitor: str) -> None:
    """Print the errors of one monitor, a line for each direction."""
    time, body, twin = read(run, monitor)
    later, wide, wide_twin = read(reference, monitor)
    if wide_twin is None:
        expected = at(time, later, wide)
        scattered, error = None, body - expected
    else:
        times = time + first_passage(later, wide_twin[:, 0]) - first_passage(time, twin[:, 0])
        expected, scattered = at(times, later, wide), at(times, later, wide - wide_twin)
        error = body - twin - scattered
    for words, columns in {"v_x": [0], "v_y": [1], "both": [0, 1]}.items():
        wrong, whole = error[:, columns], expected[:, columns]
        part = "" if scattered is None else f", {share(wrong, scattered[:, columns])} of the scattered"
        print(
            f"{run.name} beside {reference.name} {monitor} {words}: RMS error {share(wrong, whole)} of the total "
            f"motion{part}; largest {np.abs(wrong).max():.4f} m/s of {np.abs(whole).max():.4f}"
        )


def main() -> None:
    """Compare monitor by monitor."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("reference", type=Path)
    parser.add_argument("--monitors", nargs="+", default=["P1", "P2"])
    options = parser.parse_args()
    for monitor in options.monitors:
        compare(options.run, options.reference, monitor)


if __name__ == "__main__":
    main()
