"""Checks that a change of the code keeps results of dembound: facts, runs, estimates, choices of two revisions.

    python benchmarks/golden.py write FILE [--sections check run estimate choice] [--names NAME...]
    python benchmarks/golden.py compare BEFORE AFTER

`check`: facts and warnings of all shipped cases. `run`: of each the digest of every array in its record, equal only to
the bit, and the norm of every history to ten digits, which are the same on other processors. `estimate`: errors by
cause of the scenes of `estimates.py` and `estimate_bars.py`. `choice`: the choices of `advise` for the scenes of
`error_bound.py`. `compare` prints a line for each difference, and ends with 1 if there is one.
"""

import argparse
import hashlib
import json
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from timing import ROOT, small_option

os.environ.setdefault("NUMBA_NUM_THREADS", "1")  # before numba is imported; results do not depend on it

Value = str | float | list[str]
Found = dict[str, Value]

OF_THE_MACHINE = ("memory", "disk", "estimated time")
"""Facts of `check` that another machine, or another moment, does not repeat."""

LONGEST = 300e6
"""Particle-steps of the longest run that is made; longer ones are cut short, with the same key on both sides."""

BOUNDS = (0.003, 0.01, 0.03, 0.1)


def shipped() -> Iterator[tuple[str, Any]]:
    """All shipped cases by name."""
    from dembound import shipped as cases
    from dembound.kinds import load

    for name in cases.names():
        yield name, load(cases.folder() / f"{name}.toml")


def facts_of(case: Any) -> Found:
    """Facts and warnings of `check`, without those of the machine."""
    from dembound.check import check

    facts, warnings = check(case)
    return {key: text for key, text in facts.items() if key not in OF_THE_MACHINE} | {"warnings": warnings}


def run_of(case: Any) -> Found:
    """Digests of the arrays of a run's record, and norms of its histories."""
    from dembound.kinds import with_changes
    from dembound.running import Progress, plan, run_case

    planned = plan(case)
    work = planned.steps * max(1, len(planned.stepped.mass))
    changes: dict[str, Any] = {"output.pictures": False}
    if work > LONGEST:
        changes["run.duration"] = float(f"{case.run.duration * LONGEST / work:.3g}")
    with tempfile.TemporaryDirectory() as folder:
        record = run_case(with_changes(case, changes), Path(folder), Progress()) / "run.h5"
        return {"duration": float(changes.get("run.duration", case.run.duration))} | digests(record)


def digests(record: Path) -> Found:
    """Name of every dataset -> digest of its bytes, with the norm of those that are histories."""
    import h5py

    found: Found = {}

    def visit(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset):
            values = np.asarray(item[()])
            numbers = values.dtype != object  # texts are in the case, too
            text = hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()[:16] if numbers else ""
            norm = f" {np.linalg.norm(values):.10g}" if name.startswith("histories/") else ""
            found[name] = text + norm

    with h5py.File(record) as file:
        file.visititems(visit)
    return found


def estimates() -> Iterator[tuple[str, Callable[[], Found]]]:
    """Errors by cause of the scenes of the benchmarks of estimates."""
    from estimate_scenes import scenes

    sys.path.insert(0, str(ROOT / "tests"))
    import estimated_bars
    from estimates import measured

    for scene in scenes():
        yield scene.name, lambda scene=scene: _rows(measured(scene)[0])
    for name in estimated_bars.SCENES:
        yield name, lambda name=name: _rows([vars(row) for row in estimated_bars.rows(name)])


def _rows(rows: list[dict[str, Any]]) -> Found:
    """Rows of a table as texts, without costs and CPU times."""
    texts = (
        ", ".join(f"{key} {_short(each)}" for key, each in row.items() if key not in ("cost", "stepping"))
        for row in rows
    )
    return {str(k): text for k, text in enumerate(texts)}


def _short(value: Any) -> str:
    """A number to six digits, anything else as it is."""
    return f"{value:.6g}" if isinstance(value, float | np.floating) else str(value)


def choices() -> Iterator[tuple[str, Callable[[], Found]]]:
    """The choice for each bound in the scenes of the benchmark of choices."""
    from error_bound_scenes import scenes

    from dembound.accuracy.estimate import advise
    from dembound.kinds import loads

    for name, tables in scenes():
        case = loads(tomli_w.dumps(tables), name=name.replace(" ", "_"))
        yield (
            name,
            lambda case=case: {
                f"{bound:g}": f"{'' if best.holds(bound) else 'none; '}{best.choice.name}, "
                f"{best.budget.worst().share.value:.6g}"
                for bound, best in advise(case, BOUNDS).best.items()
            },
        )


SECTIONS: dict[str, Callable[[], Iterator[tuple[str, Callable[[], Found]]]]] = {
    "check": lambda: ((name, lambda case=case: facts_of(case)) for name, case in shipped()),  # type: ignore[misc]
    "run": lambda: ((name, lambda case=case: run_of(case)) for name, case in shipped()),  # type: ignore[misc]
    "estimate": estimates,
    "choice": choices,
}


def written(sections: list[str], names: list[str], file: Path) -> None:
    """Write what is computed now, scene by scene; a scene that fails has the text of its error."""
    from dembound.errors import DemboundError

    found: dict[str, dict[str, Found]] = {}
    for section in sections:
        for name, compute in SECTIONS[section]():
            if names and not any(each in name for each in names):
                continue
            print(f"{section}: {name}", flush=True)
            try:
                found.setdefault(section, {})[name] = compute()
            except DemboundError as error:
                found.setdefault(section, {})[name] = {"error": str(error)}
            file.write_text(json.dumps(found, indent=1, sort_keys=True, ensure_ascii=False), encoding="utf-8")


def differences(before: Any, after: Any, place: str = "") -> Iterator[str]:
    """A line for each difference between two values, tables entry by entry."""
    if isinstance(before, dict) and isinstance(after, dict):
        for key in sorted(before.keys() | after.keys()):
            inner = f"{place} | {key}" if place else key
            if key not in before or key not in after:
                yield f"{inner}: only {'after' if key in after else 'before'}"
            else:
                yield from differences(before[key], after[key], inner)
    elif before != after:
        yield f"{place}:\n  - {before}\n  + {after}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(dest="verb", required=True)
    write = verbs.add_parser("write")
    write.add_argument("file", type=Path)
    write.add_argument("--sections", nargs="+", choices=SECTIONS, default=list(SECTIONS))
    write.add_argument("--names", nargs="+", default=[])
    small_option(write, names=["lu2016/table1_row1", "blast A outside", "ranges", "embedded 30 m along x cosine"])
    compare = verbs.add_parser("compare")
    compare.add_argument("before", type=Path)
    compare.add_argument("after", type=Path)
    options = parser.parse_args()
    if options.verb == "write":
        written(options.sections, options.names, options.file)
        return
    before, after = (json.loads(each.read_text(encoding="utf-8")) for each in (options.before, options.after))
    lines = list(differences(before, after))
    print("\n".join(lines) or "no difference")
    sys.exit(bool(lines))


if __name__ == "__main__":
    main()
