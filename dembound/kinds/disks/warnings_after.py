"""Warnings from the results of a run of disks."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.material import with_history
from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.load_factor import load_factor_in_words
from dembound.disks.stepping.near_ties import near_tie_warnings
from dembound.disks.stepping.side_watch import lasting_force_warnings, reach_warnings
from dembound.disks.watches import far_warnings, turn_warnings
from dembound.kinds.disks.summary import SHOWN, block_in_words
from dembound.results.reader import cracks_until, open_record
from dembound.results.warnings import energy_warnings, still_moving
from dembound.words import percent

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
            *turn_warnings(summary.get("turns"), scene.case.material.law, has_history=scene.has_history),
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
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    pairs = scene.assembly.pairs
    listed, gone = (np.sort(each.astype(np.int64), axis=1) @ [scene.disk_count, 1] for each in (pairs, broken))
    pairs = pairs[~np.isin(listed, gone)]
    joined = coo_matrix((np.ones(len(pairs), np.int8), tuple(pairs.T)), shape=(scene.disk_count, scene.disk_count))
    return connected_components(joined, directed=False)[1]
