"""The largest RAM of whole runs, compared with the RAM that `dembound check` computes from the case.

    python benchmarks/memory.py [--cases elastic full ...] [--sizes 1e4 3e4 ...] [--json results/benchmarks/memory.json]

Every case is run for a few steps in a new process, with the command line, two snapshots, their files for ParaView and
pictures; each kind of case once before, so that it is packed and compiled. "before" is computed from the case, without
packing it, "after" from the scene built.

elastic  a bar of pattern B; full: with the history-dependent law from the start; switch: that may change to it
static   ground under gravity with the history-dependent law, after a static stage; statically elastic: with the other
free_field  two free-field columns beside a body with a hole that is excavated; stress: with stresses and peaks
few      two copies of a brick; one: a single one (up to 3e4); lattice: pattern A, of which one row is stepped
difference, peridynamics, patch   bars of nodes
"""

import argparse
import sys
import tempfile
from pathlib import Path
from typing import Any

from processes import whole
from timing import ROOT, in_one_line, machine, show, small_option, write

SIZES = (1e4, 3e4, 1e5, 3e5, 1e6)

DISKS = """
[packing]
pattern = "B"
bricks = [{across}, {up}]
radius = 0.25
radius_ratio = 1.5
brick = [10.0, 10.0]
seed = 1
[material]
density = 2500.0
p_wave_speed = 1000.0
match = "lattice"
{material}
[wave.pulse]
type = "cosine"
amplitude = 0.001
period = 0.5
[[monitor]]
name = "middle"
position = [5.0, 5.0]
[run]
duration = 0.01
[output]
snapshots = 2
"""
DRIVEN = '[boundary.left]\ntype = "velocity"\nwave_p = "pulse"\n[boundary.right]\ntype = "viscous"\n'
FULL = 'law = "linearpbond"\nfric = 0.5\npb_coh = 1e6\npb_ten = 1e6\npb_fa = 30.0\n'
GRAVITY = """
[static]
ratio = 0.9
[static.boundary.bottom]
type = "fixed"
[boundary.bottom]
type = "viscous_input"
wave_s = "pulse"
[[load]]
name = "gravity"
acceleration = [0.0, -1.0]
"""
FREE_FIELD = """
[static]
ratio = 0.9
[static.boundary.bottom]
type = "fixed"
[[load]]
name = "gravity"
acceleration = [0.0, -1.0]
[boundary.left]
type = "free_field"
[boundary.right]
type = "free_field"
[boundary.bottom]
type = "viscous_input"
wave_s = "pulse"
[[hole]]
name = "tunnel"
type = "circle"
stage = "after"
centre = [25.0, 25.0]
radius = 5.0
"""
BAR = """
[bar]
length = 10.0
spacing = {spacing}
density = 2300.0
wave_speed = 4000.0
strength = 8e6
[method]
{method}
[boundary.left]
type = "velocity"
wave_p = "pulse"
[wave.pulse]
type = "cosine"
amplitude = 0.5
period = 1e-4
[[monitor]]
name = "middle"
position = 5.0
[run]
duration = {duration}
[output]
snapshots = 2
"""

BRICK = 432
"""Disks of the brick of `DISKS`."""


def disks(material: str = "", sides: str = DRIVEN, **replaced: str) -> Any:
    """A function of the number of disks that writes a case of them, five bricks high; replaced : texts of the case."""

    def write_case(count: float) -> str:
        up = 5
        text = DISKS.format(across=max(round(count / BRICK / up), 5), up=up, material=material) + sides
        for old, new in replaced.items():
            assert old in text
            text = text.replace(old, new)
        return text

    return write_case


def large_bricks(across: int) -> Any:
    """Square bricks side by side."""

    def write_case(count: float) -> str:
        side = round((count / across / BRICK) ** 0.5 * 10.0, 1)
        text = DISKS.format(across=across, up=1, material="") + DRIVEN
        return text.replace("brick = [10.0, 10.0]", f"brick = [{side}, {side}]")

    return write_case


def lattice(count: float) -> str:
    """Squares of pattern A, periodic across."""
    text = DISKS.format(across=round(count / 200.0), up=200, material="") + DRIVEN
    text = "\n".join(line for line in text.splitlines() if line.split(" ")[0] not in ("radius_ratio", "brick", "seed"))
    return text.replace('"B"', '"A"') + '\n[boundary.bottom]\ntype = "periodic"\n[boundary.top]\ntype = "periodic"\n'


def bar(method: str) -> Any:
    """A bar of so many nodes under a method."""

    def write_case(count: float) -> str:
        return BAR.format(spacing=10.0 / count, method=method, duration=2e-3 / count * 3.0)

    return write_case


CASES = {
    "elastic": disks(),
    "full": disks(FULL + "elastic_start = false\n"),
    "switch": disks(FULL),
    "static": disks(FULL, GRAVITY),
    "statically elastic": disks("", GRAVITY),
    "free_field": disks(FULL, FREE_FIELD),
    "stress": disks(FULL, **{"snapshots = 2": "snapshots = 2\nstress = true\npeaks = true"}),
    "few": large_bricks(2),
    "one": large_bricks(1),
    "lattice": lattice,
    "difference": bar('type = "finite_difference"'),
    "peridynamics": bar('type = "peridynamics"\nhorizon = 3'),
    "patch": bar('type = "patch"\nhorizon = 3'),
}

MOST = {"few": 3e4, "one": 3e4}
"""Largest sizes of cases whose bricks take long to pack."""


def measured(name: str, count: float, folder: Path) -> dict[str, Any]:
    """One row of the table: RAM as computed, before and after the scene is built, and as measured."""
    from dembound.bar.body import run_bytes
    from dembound.casefile.bar import BarCase
    from dembound.disks.memory import expected_bytes
    from dembound.running import plan
    from dembound.schemas import load

    path = Path(folder, f"{name.replace(' ', '_')}_{count:.0f}.toml")
    path.write_text(CASES[name](count))
    case = load(path)
    before = run_bytes(case) if isinstance(case, BarCase) else expected_bytes(case)
    planned = plan(case)
    after = planned.stepped.largest_memory
    command = ["-m", "dembound", "run", path, "--output", folder]
    used = whole([sys.executable, *command], folder, {"PYTHONPATH": str(ROOT)}).memory
    return {
        "case": name,
        "count": planned.scene.count,
        "before": before / 1e6,
        "after": after / 1e6,
        "measured": used / 1e6,
        "error": 100.0 * (after / used - 1.0),
        "error_before": 100.0 * (before / used - 1.0),
    }


def main() -> None:
    """Print the table and write it as JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES))
    parser.add_argument("--sizes", nargs="+", type=float, default=list(SIZES))
    parser.add_argument("--json", type=Path, default=ROOT / "results/benchmarks/memory.json")
    small_option(parser, cases=["elastic", "difference"], sizes=[1e4])
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as place:
        for name in options.cases:
            measured(name, min(options.sizes), Path(place))  # packs and compiles
            for count in options.sizes:
                if count <= MOST.get(name, count):
                    rows.append(measured(name, count, Path(place)))
                    print(rows[-1], flush=True)
    columns = {
        "case": "{case}",
        "disks or nodes": "{count:,}",
        "computed, MB": "{after:.0f}",
        "measured, MB": "{measured:.0f}",
        "difference": "{error:+.0f} %",
        "from the case alone": "{error_before:+.0f} %",
    }
    print(in_one_line(machine()))
    show("Largest memory of a run", columns, rows)
    write(options.json, {"machine": machine(), "memory": rows})


if __name__ == "__main__":
    main()
