"""Table 1 of Lu & Wang (2016): place and time of spalls of the seven bars, with the printed values, as Markdown.

    python cases/lu2016/table1.py [RESULTS]      (default: results/lu2016)

The last two columns are the closed form's.
"""

import sys
from pathlib import Path

import numpy as np

from dembound.papers.figure import markdown
from dembound.papers.spalled import MEGA, MILLI, case_of, expected_spall, first_spall, in_millimetres

PRINTED = np.genfromtxt(Path(__file__).with_name("table1.csv"), delimiter=",", names=True, skip_header=1)
"""The seven rows of the paper."""

HEADS = (
    *("row", "m", "Δx (mm)", "p_m (MPa)", "t_0 (ms)", "x_F (mm)", "printed", "t_F (ms)", "printed"),
    *("closed form: x (mm)", "t (ms)"),
)


def main() -> None:
    """Print the table."""
    results = Path(sys.argv[1] if len(sys.argv) > 1 else "results/lu2016")
    rows = []
    for number, printed in enumerate(PRINTED, start=1):
        run = results / f"table1_row{number}"
        case, found = case_of(run), first_spall(run)
        x, t = expected_spall(case)
        load = case.load[0]
        settings = (
            case.method.largest_horizon,
            f"{case.bar.spacing / MILLI:g}",
            f"{load.pressure / MEGA:g}",
            f"{case.wave[load.wave].duration() / MILLI:.2f}",
        )
        place = in_millimetres(found["start"]), f"{printed['x_from_mm']:g}–{printed['x_to_mm']:g}"
        time = f"{found['time'] / MILLI:.4f}", f"{printed['t_F_ms']:.4f}"
        rows.append((number, *settings, *place, *time, f"{x / MILLI:.1f}", f"{t / MILLI:.4f}"))
    print(markdown(HEADS, rows))


if __name__ == "__main__":
    main()
