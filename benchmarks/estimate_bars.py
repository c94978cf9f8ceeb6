"""How close estimated errors of bars are to true ones, and what they cost.

    python benchmarks/estimate_bars.py [--scenes NAME ...] [--json FILE]

The scenes are those of tests/estimated_bars.py: methods, ends, pulses, lengths. An error is the RMS of the difference
from the exact motion over the RMS of the record; the exact one is d'Alembert's, for attenuation and ranges that of
finite differences on nodes eight times as fine. CPU times are those of a run without files, and of its estimate.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

from timing import ROOT, in_one_line, machine, show, small_option, timed, write

sys.path.insert(0, str(ROOT / "tests"))

from estimated_bars import SCENES, recorded_of, rows, scene

from dembound.accuracy.of_bars.causes import causes_of_bar

COLUMNS = {
    "scene": "{scene}",
    "monitor": "{monitor}",
    "quantity": "{quantity}",
    "estimate": "{estimate:.2e}",
    "truth": "{truth:.2e}",
    "ratio": "{ratio:.3f}",
}

COSTS = {"scene": "{scene}", "run: CPU ms": "{run:.0f}", "estimate: CPU ms": "{estimate:.0f}"}


def errors(name: str) -> list[dict[str, Any]]:
    """Rows of `COLUMNS` of a scene."""
    return [vars(row) | {"ratio": row.ratio} for row in rows(name)]


def costs(name: str) -> dict[str, Any]:
    """CPU time of a run without files, and of its estimate."""
    case = scene(name)
    recorded, step = recorded_of(case)
    run, estimate = timed(lambda: recorded_of(case)), timed(lambda: causes_of_bar(case, recorded, step))
    return {"scene": name, "run": 1e3 * run.cpu, "estimate": 1e3 * estimate.cpu}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES), metavar="NAME")
    parser.add_argument("--json", type=Path, default=ROOT / "results/benchmarks/estimate_bars.json")
    small_option(parser, scenes=["finite differences, ν = 0.5", "ranges"])
    options = parser.parse_args()
    facts = machine()
    print(in_one_line(facts))
    found = [row for name in options.scenes for row in errors(name)]
    show("Errors", COLUMNS, found)
    spent = [costs(name) for name in options.scenes]
    show("Costs", COSTS, spent)
    write(options.json, {"machine": facts, "errors": found, "costs": spent})


if __name__ == "__main__":
    main()
