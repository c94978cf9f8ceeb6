"""What happened in a run, in words, from its summary."""

from collections.abc import Sequence
from typing import Any

from dembound.case import Case, DiskCase
from dembound.results import laws_in_words

GAINED = 1e-3
"""Share of the energy that fracture may give instead of taking it before a run says so."""

TOLD = 3
"""Spalls that are told one by one."""


def outcome(summary: dict[str, Any], case: Case) -> list[str]:
    """What became of a case."""
    if isinstance(case, DiskCase):
        return disk_outcome(summary, remembers=case.material.law != "elastic")
    return bar_outcome(summary)


def bar_outcome(summary: dict[str, Any]) -> list[str]:
    """What became of a bar: changes of method, and where and when it spalled, and what of that converges."""
    facts = [f"{used['law']} from {used['from'] * 1e3:.4g} ms" for used in summary["laws"][1:]]
    facts += [
        f"spall at {_range(spall['start'])} m, {spall['time'] * 1e3:.4f} ms" for spall in summary["spalls"][:TOLD]
    ]
    if (more := len(summary["spalls"]) - TOLD) > 0:
        facts.append(f"and {more} more, see summary.json")
    if summary["spalls_note"] is not None:
        facts.append(summary["spalls_note"])
    if not summary["spalls"] and summary["bar"]["strength"] is not None:
        facts.append("no spall")
    gained = -summary["energy"]["crack"]
    if gained > GAINED * abs(summary["energy"]["outside"]):
        facts.append(
            f"bonds broke within single steps and gave {gained / abs(summary['energy']['outside']):.1%} of the energy, "
            "take a smaller bar.spacing or run.courant"
        )
    if error := summary["energy"]["relative_error"]:
        facts.append(f"energy closes to {100.0 * error:.2g} %")
    return facts


def disk_outcome(summary: dict[str, Any], *, remembers: bool) -> list[str]:
    """What became of disks: their static stage, and what a law that remembers came to."""
    facts = []
    if (static := summary["static"]) is not None:
        if (before := static["before"]) is not None:
            facts += _settled(before, "settled")
        facts += _settled(static, "settled" if before is None else "after the excavation")
    if remembers:
        facts.append(laws_in_words([(used["law"], used["from"]) for used in summary["laws"]]))
        tension, shear = summary["cracks"]["tension"], summary["cracks"]["shear"]
        if tension + shear > 0:
            facts.append(f"{tension + shear:,} bonds broke ({tension:,} tension, {shear:,} shear)")
        if error := summary["energy"]["relative_error"]:  # zero where nothing came in
            facts.append(f"energy closes to {100.0 * error:.2g} %")
    return facts


def _range(ends: Sequence[float]) -> str:
    """Ends of a range as "0.906–0.909", a single place as it is."""
    return "–".join(f"{end:.4g}" for end in sorted(set(ends)))


def _settled(static: dict[str, Any], words: str) -> list[str]:
    """How a static stage went, after that of its free-field column if there is one."""
    column = [] if static["column"] is None else [f"column settled in {_stage(static['column'])}"]
    return [*column, f"{words} in {_stage(static)}"]


def _stage(static: dict[str, Any]) -> str:
    """How a static stage went, in words, from its summary."""
    reached = ""
    if (asked := static["asked"]) is not None:  # supports may have kept the body from it
        reached = f" and a stress of {_in_mpa(static['stress'])} where {_in_mpa(asked)} MPa was asked for"
    broken = f", breaking {static['cracks']:,} bonds" if static["cracks"] else ""
    return f"{static['steps']:,} steps to a force ratio of {static['ratio']:.1e}{reached}{broken}"


def _in_mpa(stress: Sequence[float]) -> str:
    """A stress xx, yy, xy in Pa as a bracket of MPa; what is nothing beside the largest is told as nothing."""
    least = 1e-3 * max(map(abs, stress))
    return f"({', '.join(f'{value / 1e6 if abs(value) > least else 0.0:.3g}' for value in stress)})"
