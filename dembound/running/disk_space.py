"""The size of the results of a run, computed from its plan, and the free space of the disk they are written to.

For a continued run, the size is that of the files still to be written.
"""

from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path

from dembound.machine import disk_free
from dembound.motion.energy import Entry, SideEntry
from dembound.motion.kind import Plan
from dembound.motion.ram import in_words
from dembound.running.planning import steps_between_entries, steps_between_samples

ALWAYS = 1e6
"""Bytes of pictures, the summary, and the first chunks of datasets that grow."""

MOTION = 8 + 24 + 24
"""Bytes of a sample of a monitor: time, displacement and velocity; a side has a force in place of the velocity."""


def results_bytes(planned: Plan) -> dict[str, float]:
    """Estimated bytes of the results of a run, by the key of the case that determines them.

    While a checkpoint is written, there are two of them; they contain the ledger. A run that is continued to a later
    time keeps the interval of its snapshots.
    """
    kind, scene, case = planned.kind, planned.scene, planned.scene.case
    whole, stepped = kind.storage(scene), kind.storage(planned.stepped)
    samples = planned.steps / max(1, round(case.output.history_interval / planned.time_step))
    row = len(scene.monitors) * (MOTION + 8 * (scene.record_width > 6))
    entry = 8 * (len(fields(Entry)) + len(SideEntry._fields) * len(scene.edges))
    snapshots = min(case.output.snapshots, planned.regular_steps) * planned.steps / planned.regular_steps
    snapshots += bool(snapshots and kind.stage_names(scene))
    copies = 2 if case.run.checkpoint > 0.0 else 0
    settled = len(kind.stage_names(scene)) if copies and kind.stages_from(case) is None else 0
    return {
        "output.snapshots": snapshots * whole.snapshot,
        "output.history_interval": samples * row,
        "output.side_interval": planned.steps / steps_between_samples(planned) * len(scene.edges) * (MOTION - 8),
        "output.energy_interval": planned.steps / steps_between_entries(planned) * entry * (1 + copies),
        "run.checkpoint": (copies + settled) * stepped.checkpoint,
        "": ALWAYS + whole.header,
    }


def bytes_left(planned: Plan, written: float = 0.0) -> dict[str, float]:
    """Bytes still to be written by a run, given the written bytes; all keys have an equal share."""
    sizes = results_bytes(planned)
    share = max(0.0, 1.0 - written / sum(sizes.values()))
    return {key: share * size for key, size in sizes.items()}


def space_in_words(planned: Plan, results: Path, written: float = 0.0) -> str:
    """The size of the results of a run as text, less the bytes already written, and the free space for them."""
    size = in_words(sum(bytes_left(planned, written).values()))
    return f"about {size}{_more(written)} of results{_free(results)}"


def _more(written: float) -> str:
    return " more" if written > 0.0 else ""


def _free(results: Path) -> str:
    free = disk_free(results)
    return "" if free is None else f"; the disk has {in_words(free)} free"


def space_warnings(planned: Plan, results: Path, written: float = 0.0) -> Iterator[str]:
    """A warning about results whose remaining bytes exceed the free space of their disk."""
    sizes, free = bytes_left(planned, written), disk_free(results)
    need = sum(sizes.values())
    if free is not None and need > free:
        key = max(filter(None, sizes), key=lambda name: sizes[name])
        yield (
            f"{key}: the results take about {in_words(need)}{_more(written)}, "
            f"{in_words(sizes[key])} of them by this key; the disk has {in_words(free)} free"
        )
