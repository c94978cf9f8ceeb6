"""Dependence of the cracks of docs/evidence/blast.md on the time step, the only difference between runs: its table.

python cases/blast/cracks.py results/blast_cracks      (half a minute of CPU time)
"""

import sys
from pathlib import Path

import numpy as np

from dembound.accuracy.repeat import Cracked, repeated
from dembound.running.recorded import recorded_case

STEPS = (0.99, 0.98, 0.97, 0.95, 0.9, 0.75, 0.5, 0.25)
"""Time steps over that of the run."""


def main() -> None:
    """Print each draw, and the differences between draws."""
    record = Path(sys.argv[1]) / "run.h5"
    own = Cracked.of(record)
    again = [repeated(recorded_case(record), record, own, step) for step in STEPS]
    for step, each in zip(STEPS, again, strict=True):
        changes = {f"{name} {quantity}": f"{x:.0%}" for name, of in each.changes.items() for quantity, x in of.items()}
        same, other = f"{each.common:.0%} in common", each.other
        print(f"step {step}: {len(other)} cracks, {same}, {other.energy:.4g} J/m, {other.radius:.4g} m, {changes}")
    draws = [own, *(each.other for each in again)]
    for name, values in {
        "cracks": [len(each) for each in draws],
        "energy (J/m)": [each.energy for each in draws],
        "radius (m)": [each.radius for each in draws],
    }.items():
        scatter = np.std(values, ddof=1) / np.mean(values)
        print(f"{name}: {min(values):.4g} to {max(values):.4g}, mean {np.mean(values):.4g}, deviation {scatter:.1%}")


if __name__ == "__main__":
    main()
