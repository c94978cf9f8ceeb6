"""Lu & Wang (2016), figure 5c: dispersion on a horizon of 20 mm that is cut into 1 to 4 spacings.

    python cases/lu2016/figure5c.py PICTURE

`dembound dispersion` shows all combinations of its options; here each horizon goes with one spacing.
"""

import sys
from pathlib import Path

from dembound.exact.dispersion import Lattice
from dembound.plot.dispersion import plot_dispersion
from dembound.plot.style import save

HORIZON, TIME_STEP, WAVE_SPEED = 0.02, 1e-6, 2763.0
"""m, s and m/s: as the other parts of the figure."""


def main() -> None:
    """Draw the picture."""
    lattices = [Lattice(m, HORIZON / m, TIME_STEP, WAVE_SPEED) for m in (1, 2, 3, 4)]
    save(plot_dispersion(lattices), Path(sys.argv[1]))


if __name__ == "__main__":
    main()
