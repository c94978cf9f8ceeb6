"""How far the scattered motion in the tunnel's model is from that in a wider and deeper one.

    python cases/zhou2018/tunnel_errors.py RUN EXTENDED [--monitors P1 P2] [--component x]

Both are runs with free-field sides. The scattered motion is a monitor's less its twin's in the free-field column. The
extended model's base is deeper, so the wave comes later there: its histories are taken back by the delay with which the
twin's velocity first passes a fifth of its peak.
"""

import argparse
from pathlib import Path

import h5py
import numpy as np


def read(run: Path, monitor: str, column: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (k,) s, and the velocities (k,) m/s of a monitor and its twin."""
    with h5py.File(run / "run.h5") as file:
        body, twin = (file[f"histories/{name}"] for name in (monitor, f"{monitor}.free_field"))
        return body["time"][:], body["velocity"][:, column], twin["velocity"][:, column]


def first_passage(time: np.ndarray, velocity: np.ndarray) -> float:
    """Time (s) at which |velocity| first passes a fifth of its peak, between two samples."""
    level = 0.2 * np.abs(velocity).max()
    after = int(np.argmax(np.abs(velocity) >= level))
    return float(np.interp(level, np.abs(velocity[after - 1 : after + 1]), time[after - 1 : after + 1]))


def rms(values: np.ndarray) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))


def main() -> None:
    """Print one line per monitor."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("extended", type=Path)
    parser.add_argument("--monitors", nargs="+", default=["P1", "P2"])
    parser.add_argument("--component", choices=["x", "y"], default="x")
    options = parser.parse_args()
    column = "xy".index(options.component)
    for monitor in options.monitors:
        time, body, twin = read(options.run, monitor, column)
        later, wide_body, wide_twin = read(options.extended, monitor, column)
        delay = first_passage(later, wide_twin) - first_passage(time, twin)
        expected = np.interp(time + delay, later, wide_body)
        scattered = np.interp(time + delay, later, wide_body - wide_twin)
        error = body - twin - scattered
        print(
            f"{options.run.name} {monitor} v_{options.component}: RMS error {rms(error) / rms(expected):.2%} of the "
            f"total motion, {rms(error) / rms(scattered):.1%} of the scattered; largest "
            f"{np.abs(error).max():.4f} m/s of {np.abs(expected).max():.4f} and {np.abs(scattered).max():.4f}"
        )


if __name__ == "__main__":
    main()
