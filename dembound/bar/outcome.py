"""The results of a run of a bar in words, from its summary."""

from collections.abc import Mapping, Sequence
from typing import Any

from dembound.results.warnings import of_supplied
from dembound.words import percent, with_unit

GAINED = 1e-3
"""Share of the energy above which a run reports energy that breaking bonds added instead of removing it."""

LISTED = 3
"""Number of spalls that are printed one by one."""


def bar_outcome(summary: Mapping[str, Any]) -> list[str]:
    """Changes of method, places and times of breaks and spalls, and which of these results converge."""
    facts = [f"{used['law']} from {with_unit(used['from'], 's')}" for used in summary["laws"][1:]]
    facts += [
        f"broke at the {side} end ({summary['boundaries'][side]['type']}), {with_unit(broken['time'], 's')}"
        for side, broken in summary["breaks_at_ends"].items()
    ]
    facts += [
        f"spall at {_range(spall['start'])} m, {with_unit(spall['time'], 's')}" for spall in summary["spalls"][:LISTED]
    ]
    if (more := len(summary["spalls"]) - LISTED) > 0:
        facts.append(f"and {more} more, see summary.json")
    if summary["spalls_note"] is not None:
        facts.append(summary["spalls_note"])
    if not summary["spalls"] and not summary["breaks_at_ends"] and summary["bar"]["strength"] is not None:
        facts.append("no spall")
    gained, supplied = -summary["energy"]["crack"], summary["energy"]["supplied"]
    if gained > GAINED * supplied:
        facts.append(
            f"bonds broke within single steps, adding {of_supplied(gained, supplied)}, take a smaller bar.spacing or "
            "run.courant"
        )
    if error := summary["energy"]["relative_error"]:
        facts.append(f"largest error of the energy balance: {percent(error)}")
    return facts


def _range(ends: Sequence[float]) -> str:
    """Ends of a range as "0.906–0.909", or a single position."""
    return "–".join(f"{end:.4g}" for end in sorted(set(ends)))
