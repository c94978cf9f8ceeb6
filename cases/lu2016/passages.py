"""Lu & Wang (2016), section 3.2: error of the pulse each time it passes the middle of the bar, as Markdown.

    python cases/lu2016/passages.py RUN...

The runs are of unbreakable bars with one pulse from the left. An error is the difference between the stress and that of
d'Alembert's solution in the root mean square over a passage, L/c, in parts of that of the pulse.
"""

import sys
from pathlib import Path

from dembound.papers.figure import markdown
from dembound.papers.spalled import case_of, errors, history, name_of


def main() -> None:
    """Print the table."""
    rows = []
    for run in map(Path, sys.argv[1:]):
        case = case_of(run)
        found = errors(run)
        time = history(run, "middle")[0]
        courant = (time[1] - time[0]) * case.bar.speed / case.bar.spacing
        duration = case.wave[case.load[0].wave].duration()
        settings = name_of(case), f"{1e3 * case.bar.spacing:g}", f"{courant:.3f}", f"{1e3 * duration:.2f}"
        rows.append((*settings, *(f"{error:.2%}" if error > 1e-6 else f"{error:.0e}" for error in found)))
    passages = (f"passage {number}" for number in range(1, len(found) + 1))
    heads = ("method", "Δx (mm)", "cΔt/Δx", "t_0 (ms)", *passages)
    print(markdown(heads, rows))


if __name__ == "__main__":
    main()
