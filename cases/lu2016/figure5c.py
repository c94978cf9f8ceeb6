"""Lu & Wang (2016), figure 5c: dispersion on a horizon of 20 mm that is cut into 1 to 4 spacings.

    python cases/lu2016/figure5c.py PICTURE

It prints how many spacings a wavelength needs. `dembound dispersion` shows all combinations of its options; here each
horizon goes with one spacing.
"""

import sys
from pathlib import Path

from records import MILLI, markdown

from dembound.exact.bar import Lattice, cells_per_wavelength
from dembound.plot.reflection import plot_dispersion
from dembound.plot.style import save

HORIZON, TIME_STEP, WAVE_SPEED = 0.02, 1e-6, 2763.0
"""m, s and m/s: as the other parts of the figure."""

HEADS = ("m", "Δx (mm)", "phase speed within 1 % from Δx per wavelength", "group speed")


def main() -> None:
    """Draw the picture."""
    lattices = [Lattice(m, HORIZON / m, TIME_STEP, WAVE_SPEED) for m in (1, 2, 3, 4)]
    title = "Lu & Wang (2016), fig. 5c: dispersion on a horizon of 20 mm, cut into 1 to 4 spacings"
    save(plot_dispersion(lattices), Path(sys.argv[1]), title)
    print(markdown(HEADS, [_row(lattice) for lattice in lattices]))


def _row(lattice: Lattice) -> tuple[str, ...]:
    """Spacing, and spacings per wavelength from which on both speeds are within 1 % of c."""
    needed = (cells_per_wavelength(lattice.horizon, lattice.courant, of=of) for of in ("phase", "group"))
    return f"{lattice.horizon}", f"{lattice.spacing / MILLI:.3g}", *(f"{cells:.1f}" for cells in needed)


if __name__ == "__main__":
    main()
