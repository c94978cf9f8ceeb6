"""The results of a run of disks in words, from its summary."""

from collections.abc import Mapping, Sequence
from typing import Any

from dembound.disks.stepping.load_factor import load_factor_in_words
from dembound.disks.stepping.side_watch import WARNS
from dembound.motion.cracks import MANY
from dembound.results.reader import laws_in_words
from dembound.words import percent, with_unit

SHOWN = 1e-3
"""Share of the stress below which what differs in the packing itself is not printed."""


SEVERAL = "contacts slid or opened while the body settled, so that its rest is one of several"
"""Said of a static stage that left the elastic law."""


def disk_outcome(summary: Mapping[str, Any]) -> list[str]:
    """Reductions, the static stage, changes of law, broken bonds and the energy error."""
    facts = [*summary["reduced"], *summary["not_reduced"]]
    if (static := summary["static"]) is not None:
        stages = [("static stage", static)]
        if (before := static["before"]) is not None:
            stages = [("static stage before the excavation", before), ("static stage after the excavation", static)]
        lines = [line for name, stage in stages for line in _stages(name, stage)]
        took = with_unit(summary["seconds"]["settle"], "s", 2)
        facts += [*lines[:-1], f"{lines[-1]}; {took}{' for all stages' if len(lines) > 1 else ''}"]
        if not static["elastic"]:
            facts.append(f"{SEVERAL}: dembound estimate says how far they differ")
    if summary["has_history"]:
        facts.append(laws_in_words([(used["law"], used["from"]) for used in summary["laws"]]))
        facts += _broken(summary["cracks"], static)
        if error := summary["energy"]["relative_error"]:  # zero if no energy was supplied
            facts.append(
                f"largest error of the energy balance: {percent(error)}{_worked(summary.get('forces_at_rest'))}"
            )
    if (found := summary["load_factor"]) is not None:
        facts.append(load_factor_in_words(found))
    return facts


def _worked(found: Mapping[str, Any] | None) -> str:
    """Work of forces at rest, which the error of the ledger does not include, if it is more than waves explain."""
    work = None if found is None else found["work"]
    if work is None or work["size"] <= WARNS:
        return ""
    return f"; forces at rest did {percent(work['size'])} of what came in or was stored, on ground that left its side"


def _broken(cracks: Mapping[str, int], static: Mapping[str, Any] | None) -> list[str]:
    """Numbers and modes of all broken bonds, without those of the static stages, which are reported with them."""
    count = cracks["tension"] + cracks["shear"]
    if count == 0:
        return []
    modes = f"({cracks['tension']:,} tension, {cracks['shear']:,} shear)"
    stages = [] if static is None else [each["cracks"] for each in (static, static["before"]) if each is not None]
    if [count] == stages:
        return [f"bonds broke only in the static stage {modes}"]
    draw = ", one draw of many: see dembound estimate --repeat" if count - sum(stages) > MANY else ""
    return [f"{count:,} bonds broke{' in all' if any(stages) else ''} {modes}{draw}"]


def _stages(name: str, static: Mapping[str, Any]) -> list[str]:
    """Results of a static stage, after those of its free-field column if there is one."""
    column = [] if static["column"] is None else [f"{name} of the free-field column: {_stage(static['column'])}"]
    return [*column, f"{name}: {_stage(static)}"]


def _stage(static: Mapping[str, Any]) -> str:
    """Results of a static stage in words, from its summary."""
    reached = ""
    if (asked := static["asked"]) is not None:  # supports may have prevented it
        reached = f", stress {_in_mpa(static['stress'])} of {_in_mpa(asked)} MPa requested"
        reached += _even(static["uniformity"])
    broken = f", breaking {static['cracks']:,} bonds" if static["cracks"] else ""
    return f"{static['steps']:,} steps, unbalanced force ratio {static['ratio']:.1e}{reached}{broken}"


def _even(uniformity: Mapping[str, Any]) -> str:
    """Deviation of the stress in blocks from the requested stress, in words."""
    own, beyond, near = (uniformity[key] for key in ("packing", "beyond", "near_holes"))
    return (
        f", within {percent(uniformity['deviation'])} in {block_in_words(uniformity)}"
        f"{f', {percent(beyond)} beyond what the packing has by itself' if own >= SHOWN else ''}"
        f"{f', {percent(near)} next to holes' if near is not None else ''}"
    )


def block_in_words(uniformity: Mapping[str, Any]) -> str:
    """The blocks of a summary's `uniformity`."""
    width, height = uniformity["block"]
    return f"blocks of {width:.3g} m × {height:.3g} m"


def _in_mpa(stress: Sequence[float]) -> str:
    """A stress xx, yy, xy in Pa as text in MPa; components negligible compared with the largest are printed as 0."""
    least = 1e-3 * max(map(abs, stress))
    return f"({', '.join(f'{value / 1e6 if abs(value) > least else 0.0:.3g}' for value in stress)})"
