"""The speeds of every kind of ground and of whole commands in one table, beside LAMMPS, and the constants of `check`.

    python benchmarks/overview.py [--sections ground lammps commands] [--avx2] [--lammps-python PYTHON] [--json FILE]
    python benchmarks/overview.py --sections constants [--write]

Sections:

ground     million particle-steps per second of intact, damped, breaking and broken ground
lammps     bonded disks beside bpm/rotational and harmonic bonds (lammps_bar.py), loose ones beside gran/hooke/history
commands   CPU seconds of `dembound check` and `run`, with nothing compiled and later
constants  the nanoseconds of `dembound/disks/step_cost.py`, from which `check` and `advise` predict times; --write
           writes them there

One thread, CPU time, compiled first but for first commands. With --avx2 all is measured once more in a process whose
code uses AVX2 at most. Without LAMMPS its rows are left out. The scenes that break are those of broken_scenes.py.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from functools import cache, partial
from pathlib import Path
from typing import Any

import lammps_bar
import numba
import numpy as np
from broken_scenes import SCENES, Scene
from continuum_rate import measure, measure_ties, meshes
from processes import WorkerError, whole
from stepping import DAMPED, bar, prepare, set_in_motion, steps_for
from timing import ROOT, in_one_line, instruction_sets, machine, median_time, show, small_option, timed, write

from dembound.motion.simulation import Simulation

ELASTIC, FULL = "elastic", "linearpbond, reference"
ALONE = bar("B", 1, 1).replace("brick = [10.0, 10.0]", "brick = [30.0, 30.0]")
"""A brick without copies, whose disks are stepped one by one."""
DASHPOTS = 'law = "linearpbond"\nfric = 0.5\ndp_nratio = 0.2\ndp_sratio = 0.2\n'
DASHED = bar("B", 20, 5).replace("[run]", f"{DASHPOTS}[run]")

INTACT = {
    "intact, elastic": (bar("B", 20, 5), ELASTIC),
    "intact, elastic, no copies": (ALONE, ELASTIC),
    "intact, elastic, damped": (bar("B", 20, 5), DAMPED),
    "intact, linearpbond": (bar("B", 20, 5), FULL),
    "intact, linearpbond, no copies": (ALONE, FULL),
    "intact, linearpbond, dashpots": (DASHED, FULL),
}
"""Name -> text of the case and its law, see `stepping.LAWS`."""

COMMANDS = {
    "--help": ["--help"],
    **{
        f"{what} {name}": [what, name]
        for what, name in (
            ("check", "quickstart"), ("run", "quickstart"), ("check", "gallery/blast_cracks"),
            ("run", "gallery/blast_cracks"), ("run", "lu2016/table1_row1"), ("run", "zhou2018/tunnel"),
            ("run", "zhou2018/tunnel_a"), ("run", "zhou2018/tunnel_window"), ("run", "gravity"),
        )
    },
    "run quickstart, linearpbond": ["run", "quickstart", "--set", "material.law=linearpbond"],
}  # fmt: skip

COSTS = ROOT / "dembound" / "disks" / "step_cost.py"


def intact(name: str, seconds: float, repeats: int) -> float:
    """Nanoseconds of a step of a particle of ground that keeps its bonds, in small motion."""
    case, law = INTACT[name]
    simulation = prepare(case, law)
    set_in_motion(simulation)
    steps = steps_for(simulation, seconds)
    return 1e9 * median_time(lambda: simulation.advance(steps), repeats) / steps / simulation.scene.count


def broken(scene: Scene, small: bool) -> tuple[float, Simulation]:
    """The same of a scene that breaks: the mean of its second half, with all lists of pairs, and its last state."""
    simulation, steps = scene.simulation(small)
    simulation.advance(steps // 2)
    took = timed(lambda: simulation.advance(steps - steps // 2)).cpu
    return 1e9 * took / (steps - steps // 2) / simulation.scene.count, simulation


@cache
def all_ground(small: bool, seconds: float, repeats: int) -> dict[str, float]:
    """Nanoseconds of a step of a particle of every kind of ground; measured once for all sections."""
    found = {name: intact(name, seconds, repeats) for name in INTACT}
    return found | {name: broken(scene, small)[0] for name, scene in SCENES.items()}


def ground(options: argparse.Namespace) -> list[dict[str, Any]]:
    found = all_ground(options.small, options.seconds, options.repeats)
    return [{"name": name, "value": 1e3 / each, "unit": "M/s"} for name, each in found.items()]


def lammps(options: argparse.Namespace) -> list[dict[str, Any]]:
    """Rates of the bars of `lammps_bar`, and of a column of loose disks after its collapse."""
    try:
        with lammps_bar.lammps_worker(options) as worker, tempfile.TemporaryDirectory() as folder:
            worker.ask("version")
            rows = [row for name in options.bars for row in lammps_bar.measure(name, Path(folder), options)]
            found = [{"name": f"{row['bar']}, {row['law']}", "value": row["rate"], "unit": "M/s"} for row in rows]
            name, scene = next((name, scene) for name, scene in SCENES.items() if scene.is_loose)
            own, simulation = broken(scene, options.small)
            body = Path(folder) / "loose.npz"
            lammps_bar.write_loose(simulation, body)
            worker.ask("open", body=str(body), style="granular", held=False)
            worker.ask("block", steps=20)
            steps = max(20, round(20 * options.seconds / worker.ask("block", steps=20)[0]))
            taken = [worker.ask("block", steps=steps)[0] / steps for _ in range(options.rounds)]
            rate = 1e-6 * simulation.scene.count / float(np.median(taken))
            found.append({"name": f"{name}, dembound", "value": 1e3 / own, "unit": "M/s"})
            return [*found, {"name": f"{name}, gran/hooke/history", "value": rate, "unit": "M/s"}]
    except (WorkerError, OSError) as error:
        print(f"LAMMPS is missing ({error}): no rows of it; see lammps_bar.py")
        return []


def commands(options: argparse.Namespace) -> list[dict[str, Any]]:
    """CPU seconds of whole commands in new processes; the first of each is on an empty cache of compiled code."""
    rows = []
    for name, arguments in list(COMMANDS.items())[: 1 if options.small else None]:
        called = [f"{ROOT / 'cases' / each}.toml" if (ROOT / "cases" / f"{each}.toml").exists() else each
                  for each in arguments]  # fmt: skip
        with tempfile.TemporaryDirectory() as folder:
            environment = {"PYTHONPATH": str(ROOT), "NUMBA_CACHE_DIR": str(Path(folder) / "compiled")}
            run = partial(whole, [sys.executable, "-m", "dembound", *called], Path(folder), environment)
            first, later = run(), [run() for _ in range(max(1, options.repeats // 2))]
        rows.append({"name": f"dembound {name}", "value": float(np.median([each.cpu for each in later])), "unit": "s"})
        rows.append({"name": f"dembound {name}, first", "value": first.cpu, "unit": "s"})
        memory = max(each.memory for each in later) / 1e6
        rows.append({"name": f"dembound {name}, memory", "value": memory, "unit": "MB"})
    return rows


def constants(options: argparse.Namespace) -> list[dict[str, Any]]:
    """The constants of `step_cost`, measured, in their order; printed, and written with --write."""
    cost = all_ground(options.small, options.seconds, options.repeats)
    side = 8 if options.small else 32
    elastic, *absorbing = (measure(name, mesh, options.repeats)["nanoseconds"] for name, mesh in meshes(4, side))
    tie = measure_ties("B", 4, options.repeats)["nanoseconds"]
    rows = cost["intact, elastic"], cost["intact, linearpbond"]
    alone = cost["intact, elastic, no copies"], cost["intact, linearpbond, no copies"]
    lines = {
        "ELASTIC_NODE, ABSORBING_NODE, TIE": (elastic, float(np.mean(absorbing)), tie),
        "BROKEN": max(cost[name] for name in SCENES),
        "DISK": {(True, False): rows[0], (False, False): alone[0], (True, True): rows[1], (False, True): alone[1]},
        "DASHPOTS": max(0.0, cost["intact, linearpbond, dashpots"] - rows[1]),
        "DAMPED": max(0.0, cost["intact, elastic, damped"] - rows[0]),
    }
    text = COSTS.read_text(encoding="utf-8")
    for name, value in lines.items():
        line = f"{name} = {_digits(value)}"
        print(line)
        text, found = re.subn(rf"^{name} = .*$", lambda _, line=line: line, text, flags=re.MULTILINE)
        assert found == 1, f"{COSTS} has no line of {name}"
    if options.write:
        COSTS.write_text(text, encoding="utf-8")
        print(f"written: {COSTS}")
    return []


def _digits(value: Any) -> str:
    """A constant, a tuple or a table of them with two digits."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {_digits(each)}" for key, each in value.items()) + "}"
    if isinstance(value, tuple):
        return ", ".join(map(_digits, value))
    return repr(float(f"{value:.2g}"))


SECTIONS: dict[str, Callable[[argparse.Namespace], list[dict[str, Any]]]] = {
    "ground": ground,
    "lammps": lammps,
    "commands": commands,
    "constants": constants,
}


def without_avx512() -> dict[str, str]:
    """The environment in which numba compiles for the processor here, but with AVX2 at most."""
    from llvmlite import binding

    allowed = binding.get_host_cpu_features()
    wide = re.compile("avx512|avx10|amx|evex")
    features = ",".join(f"{'+' if on and not wide.match(name) else '-'}{name}" for name, on in allowed.items())
    return os.environ | {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": features}


def with_avx2(options: argparse.Namespace) -> dict[str, float]:
    """The values of all rows, measured in another process with AVX2 at most; empty where it fails."""
    with tempfile.TemporaryDirectory() as folder:
        found = Path(folder) / "avx2.json"
        asked = [each for each in sys.argv[1:] if each not in ("--avx2", "--write")]
        called = [sys.executable, __file__, *asked, "--json", str(found)]
        subprocess.run(called, env=without_avx512(), stdout=sys.stderr, check=True)
        return {row["name"]: row["value"] for row in json.loads(found.read_text())["rows"]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sections", nargs="+", choices=SECTIONS, default=list(SECTIONS)[:3], metavar="SECTION")
    parser.add_argument("--bars", nargs="+", choices=lammps_bar.BARS, default=["A40k", "B40k"], metavar="BAR")
    parser.add_argument("--lammps-python", default=sys.executable, help="a Python that can import lammps")
    parser.add_argument("--avx2", action="store_true", help="measure again with AVX2 at most, in a second column")
    parser.add_argument("--write", action="store_true", help="write the constants into dembound/disks/step_cost.py")
    parser.add_argument("--repeats", type=int, default=7, help="blocks of each measurement; half as many commands")
    parser.add_argument("--rounds", type=int, default=5, help="turns of blocks beside LAMMPS")
    parser.add_argument("--seconds", type=float, default=0.3, help="CPU seconds of a block")
    parser.add_argument("--json", type=Path, default=Path("results/benchmarks/overview.json"))
    small_option(parser, sections=list(SECTIONS), bars=["A40k"], repeats=1, rounds=1, seconds=0.05)
    options = parser.parse_args()
    options.held = False
    numba.set_num_threads(1)
    facts = machine()
    print(in_one_line(facts))
    rows = [row for name in options.sections for row in SECTIONS[name](options)]
    columns = {"measured": "{name}", "unit": "{unit}", ", ".join(instruction_sets()): "{value:.3g}"}
    if options.avx2:
        other = with_avx2(options)
        rows = [row | {"avx2": other.get(row["name"], float("nan"))} for row in rows]
        columns["AVX2 at most"] = "{avx2:.3g}"
    if rows:
        show("Speeds, one thread: M/s are million particle-steps, s CPU seconds", columns, rows)
    write(options.json, {"machine": facts, "rows": rows})


if __name__ == "__main__":
    main()
