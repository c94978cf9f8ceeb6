"""The results of a run of disks, as numbers for scripts and in words, and warnings from them."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.material import with_history
from dembound.disks.debris import pieces
from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.rest.settled import Settled, Uniformity
from dembound.disks.scene import DiskScene
from dembound.disks.sides import layers_beside, media_of
from dembound.disks.stepping.load_factor import load_factor_in_words, load_factor_of
from dembound.disks.stepping.near_ties import OPENED, near_tie_warnings
from dembound.disks.stepping.side_watch import WARNS, lasting_force_warnings, reach_warnings
from dembound.disks.stepping.system import DiskSystem
from dembound.disks.watches import FarDisks, Turns, far_warnings, turn_warnings
from dembound.kinds.disks.debris import debris_in_words, rest_warnings
from dembound.kinds.disks.ground import describe_layers, packing_quantities
from dembound.kinds.disks.joints import describe_joints, first_events, joint_warnings
from dembound.motion.part import MANY
from dembound.motion.trackers import Run
from dembound.results.reader import cracks_until, laws_in_words, open_record
from dembound.results.warnings import energy_warnings, still_moving
from dembound.words import numbers, percent, with_unit

T = TypeVar("T")

SHOWN = 1e-3
"""Share of the stress below which what differs in the packing itself is not printed."""


COLUMNS_AT_REST = ("column", "right_column")
"""Keys of the results of free-field columns in those of a static stage: of the only or left one, of the right one."""

SEVERAL = "contacts slid or opened while the body settled, so that its rest is one of several"
"""Said of a static stage that left the elastic law."""


def disk_outcome(summary: Mapping[str, Any]) -> list[str]:
    """Reductions, the static stage, changes of law, broken bonds and the energy error."""
    facts = [*summary["reduced"], *summary["not_reduced"]]
    unknown = summary.get("joints") or any("side" in each for each in summary.get("layers", ()))  # of errors
    if (static := summary["static"]) is not None:
        stages = [("static stage", static)]
        if (before := static["before"]) is not None:
            stages = [("static stage before the excavation", before), ("static stage after the excavation", static)]
        lines = [line for name, stage in stages for line in _stages(name, stage)]
        took = with_unit(summary["seconds"]["settle"], "s", 2)
        facts += [*lines[:-1], f"{lines[-1]}; {took}{' for all stages' if len(lines) > 1 else ''}"]
        if not static["elastic"]:
            facts.append(SEVERAL if unknown else f"{SEVERAL}: dembound estimate says how far they differ")
    if summary["has_history"]:
        facts.append(laws_in_words([(used["law"], used["from"]) for used in summary["laws"]]))
        facts += _broken(summary["cracks"], static, "" if unknown else ": see dembound estimate --repeat")
        if error := summary["energy"]["relative_error"]:  # zero if no energy was supplied
            facts.append(
                f"largest error of the energy balance: {percent(error)}{_worked(summary.get('forces_at_rest'))}"
            )
    elif summary.get("joints"):
        facts += _broken(summary["cracks"], static, "")
    facts += debris_in_words(summary.get("debris"))
    facts += first_events(summary.get("joints", {}))
    if (found := summary["load_factor"]) is not None:
        facts.append(load_factor_in_words(found))
    return facts


def _worked(found: Mapping[str, Any] | None) -> str:
    """Work of forces at rest, which the error of the ledger does not include, if it is more than waves explain."""
    work = None if found is None else found["work"]
    if work is None or work["size"] <= WARNS:
        return ""
    return f"; forces at rest did {percent(work['size'])} of what came in or was stored, on ground that left its side"


def _broken(cracks: Mapping[str, int], static: Mapping[str, Any] | None, more: str) -> list[str]:
    """Numbers and modes of all broken bonds, without those of the static stages, which are reported with them.

    more : where to find by how much draws differ, if they are many.
    """
    count = cracks["tension"] + cracks["shear"]
    if count == 0:
        return []
    modes = f"({cracks['tension']:,} tension, {cracks['shear']:,} shear)"
    stages = [] if static is None else [each["cracks"] for each in (static, static["before"]) if each is not None]
    if [count] == stages:
        return [f"bonds broke only in the static stage {modes}"]
    draw = f", one draw of many{more}" if count - sum(stages) > MANY else ""
    return [f"{count:,} bonds broke{' in all' if any(stages) else ''} {modes}{draw}"]


def _stages(name: str, static: Mapping[str, Any]) -> list[str]:
    """Results of a static stage, after those of its free-field columns if there are any."""
    columns = [each for key in COLUMNS_AT_REST if (each := static.get(key)) is not None]
    beside = ["free-field column"] if len(columns) == 1 else ["left free-field column", "right free-field column"]
    own = [f"{name} of the {words}: {_stage(each)}" for words, each in zip(beside, columns, strict=False)]
    return [*own, f"{name}: {_stage(static)}"]


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


def summarise_disks(scene: DiskScene, run: Run) -> dict[str, Any]:
    """Entries of a summary of disks in addition to those of every run: plain JSON values, SI units."""
    system, factor, far, turns = run.system, load_factor_of(run), _owner(run, FarDisks), _owner(run, Turns)
    assert isinstance(system, DiskSystem)
    return {
        "particles": scene.disk_count,
        "has_history": scene.has_history,
        "contacts": len(scene.assembly.pairs),
        "loose_disks_left_out": scene.assembly.loose,
        "packing": numbers(packing_quantities(scene)),
        "layers": describe_layers(scene),
        "load_factor": None if factor is None else factor.describe(run) or {"factor": None},
        "forces_at_rest": None if system.balance is None else system.side_watch.describe(),
        "far": None if far is None else far.describe(run.time_step),
        "turns": None if turns is None else turns.describe(run),
        "joints": describe_joints(run),
        "boundaries": {side: _describe_edge(scene, run, side) for side in scene.edges},
    }


def _owner(run: Run, kind: type[T]) -> T | None:
    """The tracker of a kind, whose arrays the state of a run has; None where there is none."""
    found = run.state.owners.get(getattr(kind, "name", ""))
    return found if isinstance(found, kind) else None


def asked_stress(scene: DiskScene) -> list[float] | None:
    """The target stress (Pa) of the static stage, if any, and if it is the same everywhere."""
    static = scene.case.static
    if scene.at_rest is not None and not scene.at_rest.is_uniform:
        return None
    return None if static is None or static.stress is None else list(static.stress)


def describe_static(settled: Settled, asked: list[float] | None) -> dict[str, Any]:
    """The static stage: steps, force ratio, mean reaction of supports and tractions and mean residual (N), stress (Pa).

    Also whether it ended under the elastic law, the deviation of the stress in blocks from the requested one, and the
    same entries for the free-field column, if there is one, for that at the right, if it is another, and before an
    excavation, if there was one. asked : target stress, Pa.
    """
    columns = dict(zip_longest(COLUMNS_AT_REST, settled.columns))
    return stage_numbers(settled) | {
        "stress": settled.stress.tolist(),
        "asked": asked,
        "uniformity": None if settled.uniformity is None else _describe_uniformity(settled.uniformity),
        "elastic": not settled.start.left_elastic_law,
        **{name: None if one is None else describe_static(one, None) for name, one in columns.items()},
        "before": None if settled.before is None else describe_static(settled.before, asked),
    }


def stage_numbers(settled: Settled) -> dict[str, Any]:
    """Numbers of a static stage, as in records."""
    return {
        "steps": settled.steps,
        "ratio": settled.ratio,
        "mean_reaction": settled.mean_reaction,
        "mean_residual": settled.mean_residual,
        "stress": settled.stress,
        "cracks": len(settled.cracks),
    }


def _describe_uniformity(found: Uniformity) -> dict[str, Any]:
    """The deviation of the stress in blocks from the requested one, see `Uniformity`."""
    return {
        "block": found.block.tolist(),
        "deviation": found.deviation,
        "place": found.place.tolist(),
        "packing": found.packing,
        "beyond": found.beyond,
        "near_holes": None if np.isnan(found.near_holes) else found.near_holes,
    }


def describe_side(scene: DiskScene, side: str) -> dict[str, Any]:
    """One side in numbers: type, particles, diameters (m), ΣD/H, and the numbers of its table.

    In several layers the latter are those of the lowest, and `layers` has those of each, the lowest first.
    """
    table, parts = scene.case.side(side), media_of(scene, side)
    edge = (scene.sides if table.is_outside else scene.edges)[side]
    described: dict[str, Any] = {
        "type": table.type,
        "particles": len(edge.nodes),
        "length": edge.length,
        "diameter_min": edge.diameters.min(),
        "diameter_mean": edge.diameters.mean(),
        "diameter_max": edge.diameters.max(),
        "diameter_sum_ratio": edge.diameter_sum_ratio,
    }
    if len(parts) == 1 or table.is_outside:
        return described | table.describe(edge, parts[0][1])
    names = (scene.case.beside(side).layer_names[number] for number in layers_beside(scene, side))
    each = [{"layer": name} | table.describe(*part) for name, part in zip(names, parts, strict=True)]
    return described | table.describe(*parts[0]) | {"layers": each}


def _describe_edge(scene: DiskScene, run: Run, side: str) -> dict[str, Any]:
    """A side in numbers, with mean and standard deviation of its particles' largest |velocity| in x and y.

    With a continuum also when and where the first contacts near its ties opened or slid.
    """
    described = describe_side(scene, side)
    largest = np.abs(run.edge_peaks(side)[:, :2]).max(axis=2)
    system = run.system
    if isinstance(system, DiskSystem) and system.near_ties is not None and scene.case.side(side).is_outside:
        system.look_near_ties(run.state)  # also in runs shorter than from one look to the next
        described[OPENED] = system.near_ties.describe(side, run.time_step)
    described["peak_velocity"] = largest.mean(axis=0).tolist()
    described["peak_velocity_deviation"] = largest.std(axis=0).tolist()
    return described


UNEVEN = 0.01
"""Deviation of a block, over the largest requested principal stress, up to which there is no warning."""

AT_REST = 1e-14
"""Velocity over that of waves, so strain, below which the motion of a settled body is rounding.

Settled strains of 1e-6 to 1e-2 are known to 1e-16 of themselves; slopes under their weight move by 1e-17.
"""


def warnings_after_disks(scene: DiskScene, summary: Mapping[str, Any], record: Path) -> list[str]:
    """Warnings from the summary and record of a run of disks, one line each."""
    with open_record(record) as file:
        cracks = cracks_until(file, np.inf)
        at_rest = 0.0 if scene.case.static is None else AT_REST * slowest_speed(scene.ground)
        moving = still_moving(scene, summary["duration"], file, _pieces(scene, cracks["particles"]), at_rest)
        return [
            *_uneven(scene.case, summary["static"]),
            *moving,
            *_not_elastic(summary.get("load_factor")),
            *near_tie_warnings(scene, summary, cracks),
            *lasting_force_warnings(summary.get("forces_at_rest")),
            *reach_warnings(summary.get("forces_at_rest")),
            *far_warnings(summary.get("far")),
            *rest_warnings(scene.case, summary),
            *turn_warnings(summary.get("turns"), scene.case.material.law, has_history=scene.has_history),
            *joint_warnings(summary.get("joints", {})),
            *energy_warnings(scene, summary["energy"], file),
        ]


def _uneven(case: DiskCase, static: Mapping[str, Any] | None) -> Iterator[str]:
    """A warning about blocks that deviate from the target stress; beside holes and under steady loads they should.

    static : of the summary.
    """
    stages = [] if static is None else [static, static["before"]]
    steady = any(load.wave is None for load in case.load)
    for found in (each["uniformity"] for each in stages if each is not None):
        if found is None or steady or found["near_holes"] is not None or found["deviation"] <= UNEVEN:
            continue
        x, y = found["place"]
        yield (
            f"static.stress: in {block_in_words(found)} the stress differs by up to {percent(found['deviation'])} "
            f"of the largest principal stress requested, most at ({x:.4g}, {y:.4g}) m; {_whence(found)}"
        )


def _whence(found: Mapping[str, Any]) -> str:
    """The reason why blocks deviate, in words."""
    if found["packing"] < SHOWN:
        return "sides that are held, contacts that slid or opened, or too large a static.ratio"
    return (
        f"the endless elastic packing has {percent(found['packing'])} by itself, less in larger blocks, "
        f"and the body differs by {percent(found['beyond'])} from that packing"
    )


def _not_elastic(found: Mapping[str, Any] | None) -> Iterator[str]:
    """A warning about a load factor below 1: the motion is not that of the material."""
    if found is not None and found["factor"] is not None and found["factor"] < 1.0:
        law = f"take law = {with_history()}, or smaller waves"
        yield f'material.law: is "elastic", but {load_factor_in_words(found)}; {law}'


def _pieces(scene: DiskScene, broken: np.ndarray) -> np.ndarray:
    """Number (n,) of the piece of each particle; pieces are connected by pairs of the start that have not broken.

    broken (k, 2) particles; without any, the body is in one piece, as built.
    """
    if len(broken) == 0:
        return np.zeros(scene.disk_count, dtype=np.int8)
    return pieces(scene.disk_count, scene.assembly.pairs, broken)
