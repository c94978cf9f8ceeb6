"""Compares the speed of two revisions, which take turns on the same machine.

    python benchmarks/compare_revisions.py [OLD] [NEW] [--cases quickstart ...] [--json FILE]

OLD and NEW are revisions of git. NEW is by default the working tree, OLD `main`, or the commit before where `main` is
the present commit. Each revision is checked out in a temporary folder and has one process that steps, so that its code
is compiled once; blocks of steps are timed in turns, by CPU time, and so are whole commands in new processes. Revisions
read the cases of OLD, as later ones understand earlier cases. For every pair of turns the ratio of times NEW / OLD is
taken; medians are quoted with the first and third quartile. Changes of more than 5 % are marked if the middle half of
the ratios is beyond 1 on the same side. Revisions before the packages were named as now are compared by commands alone.

Exit codes: 0 compared; 1 an unknown revision, or nothing could be compared.
"""

import argparse
import contextlib
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from processes import Worker, WorkerError, whole
from stepping import DAMPED, LAWS
from timing import ROOT, in_one_line, machine, quartiles, show, small_option, write

MARKED = 0.05
"""Relative change that is marked."""

STEPPED = {
    "quickstart": tuple(law for law in LAWS if law != DAMPED),
    "zhou2018/long_bar_b": ("elastic",),
    "zhou2018/long_bar_a": ("elastic",),
    "zhou2018/tunnel_a": ("elastic",),
    "zhou2018/tunnel_b": ("elastic",),
    "lu2016/table1_row1": (),
}
"""Case -> laws under which it is stepped in blocks; other cases are only run whole."""

COLUMNS = {
    "measured": "{measured}",
    "old": "{old:.4g}",
    "new": "{new:.4g}",
    "unit": "{unit}",
    "new / old": "{ratio:.3f}",
    "middle half": "{low:.3f}–{high:.3f}",
    "": "{mark}",
}


class Tree:
    """A revision, in a folder of its own, with a process that steps."""

    def __init__(self, name: str, folder: Path) -> None:
        self.name, self.folder = name, folder
        self.environment = {"PYTHONPATH": str(folder)}

    def worker(self) -> Worker:
        """A new process with the code of this revision."""
        return Worker(Path(__file__).parent / "stepping.py", environment=self.environment)

    def command(self, *arguments: str | Path) -> float:
        """CPU seconds of a whole command, without its results."""
        with tempfile.TemporaryDirectory() as folder:
            return whole([sys.executable, "-m", "dembound", *arguments], Path(folder), self.environment).cpu


def verdict(old: list[float], new: list[float]) -> dict[str, Any]:
    """The ratio of times taken in turns, its quartiles, and the mark of a change: "faster", "slower" or nothing."""
    low, ratio, high = quartiles([after / before for before, after in zip(old, new, strict=True)])
    mark = ""
    if ratio < 1.0 - MARKED and high < 1.0:
        mark = "faster"
    elif ratio > 1.0 + MARKED and low > 1.0:
        mark = "slower"
    return {"ratio": ratio, "low": low, "high": high, "mark": mark}


def in_turns(work: list[Callable[[], float]], rounds: int) -> list[list[float]]:
    """Results of each of the functions, called in turns, every second round in reverse order."""
    results: list[list[float]] = [[] for _ in work]
    for number in range(rounds):
        for k in range(len(work))[:: 1 if number % 2 == 0 else -1]:
            results[k].append(work[k]())
    return results


def compared(name: str, unit: str, work: list[Callable[[], float]], rounds: int) -> dict[str, Any]:
    """A row of `COLUMNS` from two functions that return times, the old one first."""
    old, new = in_turns(work, rounds)
    middles = {"old": quartiles(old)[1], "new": quartiles(new)[1]}
    return {"measured": name, "unit": unit, **middles, **verdict(old, new), "old_each": old, "new_each": new}


def steps(workers: list[Worker], case: Path, law: str, options: argparse.Namespace) -> dict[str, Any]:
    """Blocks of steps of a case in turns; nanoseconds of the CPU per particle-step."""
    counts = [worker.ask("open", case=str(case), law=law, threads=options.threads)["count"] for worker in workers]
    number = min(worker.ask("steps_for", seconds=options.seconds) for worker in workers)

    def block_of(worker: Worker, count: int) -> Callable[[], float]:
        return lambda: worker.ask("block", steps=number)[0] * 1e9 / (number * count)

    work = [block_of(worker, count) for worker, count in zip(workers, counts, strict=True)]
    name = f"{case.stem}, {law}" + ("" if counts[0] == counts[1] else f" ({counts[0]} and {counts[1]} particles)")
    return compared(name, "ns per particle-step", work, options.rounds)


def commands(trees: list[Tree], case: Path | None, options: argparse.Namespace) -> dict[str, Any]:
    """CPU seconds of a whole run, or of `--help` without a case, in turns. Each is run once before."""
    arguments = ("--help",) if case is None else ("run", case)

    def of(tree: Tree) -> Callable[[], float]:
        return lambda: tree.command(*arguments)

    work = [of(tree) for tree in trees]
    for run in work:
        run()
    return compared(f"dembound {'--help' if case is None else f'run {case.stem}'}", "s", work, options.commands)


def attempted(rows: list[dict[str, Any]], name: str, measure: Callable[[], dict[str, Any]]) -> None:
    """Append a row, or say in one line why there is none."""
    try:
        rows.append(measure())
        print(COLUMNS["measured"].format(**rows[-1]), f"{rows[-1]['ratio']:.3f}", file=sys.stderr)
    except WorkerError as error:
        print(f"{name}: not compared; {error}", file=sys.stderr)


def all_rows(trees: list[Tree], options: argparse.Namespace) -> list[dict[str, Any]]:
    """All rows of the table."""
    rows: list[dict[str, Any]] = []
    cases = {name: trees[0].folder / "cases" / f"{name}.toml" for name in options.cases}
    with contextlib.ExitStack() as stack:
        workers = [stack.enter_context(tree.worker()) for tree in trees]
        for name, case in cases.items():
            for law in STEPPED[name]:
                attempted(rows, f"{name}, {law}", lambda case=case, law=law: steps(workers, case, law, options))
    if options.commands > 0:
        for case in (None, *(cases[name] for name in cases if name in options.run)):
            attempted(rows, str(case or "--help"), lambda case=case: commands(trees, case, options))
    return rows


def revision(*names: str) -> str | None:
    """The first of some names that is a commit, as its hash."""
    for name in names:
        found = git("rev-parse", "--verify", "--quiet", f"{name}^{{commit}}")
        if found:
            return found
    return None


def git(*arguments: str) -> str:
    """Output of git in this repository; empty where it fails."""
    return subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True).stdout.strip()


@contextlib.contextmanager
def tree_of(name: str | None) -> Iterator[Tree]:
    """A revision in a temporary folder; the working tree for None."""
    if name is None:
        yield Tree("working tree", ROOT)
        return
    commit = revision(name)
    if commit is None:
        sys.exit(f"{name}: no such revision")
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder, "tree")
        git("worktree", "add", "--detach", str(target), commit)
        try:
            yield Tree(commit[:12], target)
        finally:
            git("worktree", "remove", "--force", str(target))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", nargs="?", help="main, or HEAD~ where that is the present commit")
    parser.add_argument("new", nargs="?", help="the working tree")
    parser.add_argument("--cases", nargs="+", choices=STEPPED, default=["quickstart", "lu2016/table1_row1"])
    parser.add_argument("--run", nargs="*", default=["quickstart", "lu2016/table1_row1"], help="cases to run whole")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=15, help="turns of blocks")
    parser.add_argument("--seconds", type=float, default=0.3, help="CPU seconds of a block")
    parser.add_argument("--commands", type=int, default=5, help="turns of whole commands; 0 for none")
    parser.add_argument("--json", type=Path, default=Path("results/benchmarks/compare_revisions.json"))
    small_option(parser, old="HEAD", cases=["zhou2018/tunnel_a"], run=[], rounds=2, seconds=0.05, commands=1)
    options = parser.parse_args()
    old = options.old or ("main" if revision("main") not in (None, revision("HEAD")) else "HEAD~")
    facts = machine()
    with tree_of(old) as before, tree_of(options.new) as after:
        rows = all_rows([before, after], options)
        if not rows:
            sys.exit("nothing could be compared")
        print(in_one_line(facts))
        show(f"{after.name} (new) and {old}, {before.name} (old), in turns", COLUMNS, rows)
        write(options.json, {"machine": facts, "old": before.name, "new": after.name, "rows": rows})


if __name__ == "__main__":
    main()
