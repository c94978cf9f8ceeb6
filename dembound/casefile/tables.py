"""The tables ``[run]``, ``[output]``, ``[chart]`` and ``[sweep]``, which cases of all kinds of bodies have."""

import re
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, Field

from dembound.table import Table, quantity

RANGE = re.compile(r"(-?\d{1,18}):(-?\d{1,18})(?::(\d{1,18}))?")
"""First and last whole number, and maybe the step from one to the next."""

MOST_VALUES = 100_000
"""Largest number of values of a key."""


def range_of(text: Any) -> list[int] | None:
    """The whole numbers of a range: "1:20" is 1, 2, … 20, "0:100:25" is 0, 25, … 100; None for anything else.

    Raises ValueError for a range without a number, and for one of more than `MOST_VALUES`.
    """
    found = RANGE.fullmatch(text) if isinstance(text, str) else None
    if found is None:
        return None
    first, last, step = int(found[1]), int(found[2]), int(found[3] or 1)
    if step == 0 or last < first:
        raise ValueError(f"{text} is a range without a number, must be FIRST:LAST or FIRST:LAST:STEP upwards")
    if (last - first) // step >= MOST_VALUES:
        raise ValueError(f"{text} has more than {MOST_VALUES:,} numbers")
    return list(range(first, last + 1, step))


def _lists(vary: dict[str, Any]) -> dict[str, Any]:
    """The lists by dotted key, also where TOML has made a table of every dot."""
    flat = dict(_flattened(vary, ""))
    found = {key: range_of(values) or values for key, values in flat.items()}
    if wrong := [key for key, values in found.items() if not isinstance(values, list) or not values]:
        raise ValueError(f'{wrong[0]} must have a list of values, such as [0.25, 0.5], or a range, such as "1:20"')
    return found


def _flattened(tables: Mapping[str, Any], place: str) -> Iterator[tuple[str, Any]]:
    """Entries of nested tables by dotted key."""
    for name, value in tables.items():
        if isinstance(value, Mapping):
            yield from _flattened(value, f"{place}{name}.")
        else:
            yield f"{place}{name}", value


Vary = Annotated[dict[str, Any], AfterValidator(_lists)]
"""Dotted key -> list of values; in a file a range may stand in place of a list."""


ENDING_KEYS = {"silent": ("silent_level", "silent_for"), "peak": ("peak_share", "peak_for"), "rest": ("rest_for",)}
"""Ends before the duration, and the keys that belong to each."""

ENDING = ("until", *(key for keys in ENDING_KEYS.values() for key in keys))
"""Keys of ``[run]`` that end a run before its duration."""


class Run(Table):
    """Simulated time and time step, and whether the run ends before it."""

    duration: float = quantity(unit="s", gt=0.0)
    """simulated time"""
    time_step: Annotated[float, Field(gt=0.0)] | Literal["auto"] = quantity("auto", unit="s")
    """time step; "auto" takes it from the stability limit"""
    safety: float = quantity(0.9, means="share", gt=0.0, le=1.0)
    """share of the stability limit of an automatic step"""
    checkpoint: float = quantity(300.0, unit="s", means="wall time", ge=0.0)
    """wall time between checkpoints; 0: none"""
    until: Literal["duration", "silent", "peak", "rest"] = quantity("duration")
    """its end: "duration"; before, "silent": all monitors are so; "peak": the forces on all sides that a wave moves
    have passed their peaks; "rest": disks that fell are at rest"""
    silent_level: float = quantity(1e-3, means="share", gt=0.0, lt=1.0)
    """share of its peak so far below which a velocity is silent"""
    silent_for: float | None = quantity(None, unit="s", gt=0.0)
    """time over which all monitors must be silent; absent: the longest wave, or echo from a side"""

    peak_share: float = quantity(0.7, means="share", gt=0.0, lt=1.0)
    """share of its peak below which a side's force has fallen"""
    peak_for: float | None = quantity(None, unit="s", gt=0.0)
    """time for which all forces must have fallen; absent: that in which the slowest wave crosses the body twice"""
    rest_for: float | None = quantity(None, unit="s", gt=0.0)
    """time for which what fell must be at rest; absent: a free fall from the height of the body"""

    @property
    def is_test(self) -> bool:
        """Whether it is a test to failure, in which waves are not what is studied."""
        return self.until == "peak"

    def lasting(self, duration: float) -> Self:
        """The run with another duration (s), without times of an earlier end that are longer than it."""
        times = [key for key in ("silent_for", "peak_for", "rest_for") if (getattr(self, key) or 0.0) > duration]
        return self.model_copy(update={"duration": duration, **dict.fromkeys(times)})

    def mistakes(self) -> Iterator[str]:
        """Keys that belong to another end."""
        for until, keys in ENDING_KEYS.items():
            for key in keys:
                if self.until != until and key in self.model_fields_set:
                    yield f'{key}: is only allowed with until = "{until}"'


MOST_SNAPSHOTS = 10_000
"""Largest number of snapshots: they make a movie of minutes, and each is a file for ParaView.

Most commands go through all snapshots of a record, which takes 1 ms each and more.
"""

ParaView = Literal["vtu", "vtkhdf", "both", "none"]
"""Formats of snapshots for ParaView: a VTU file each with a PVD file of their times, one VTKHDF file, both, or none."""


class Output(Table):
    """What a run records and writes."""

    history_interval: float = quantity(0.0, unit="s", ge=0.0)
    """time between samples of histories; 0: every step"""
    side_interval: float = quantity(0.0, unit="s", ge=0.0)
    """time between samples of sides; 0: every eighth step, or the history_interval"""
    energy_interval: float = quantity(0.0, unit="s", ge=0.0)
    """time between entries of the ledger; 0: a hundred"""
    snapshots: int = quantity(1, means="count", ge=0, le=MOST_SNAPSHOTS)
    """snapshots of the scene, the last at the end; [static] adds one at rest"""
    stress: bool = quantity(False)
    """stress of every particle in snapshots"""
    contacts: bool = quantity(False)
    """forces of every contact and bond in snapshots"""
    paraview: ParaView = quantity("vtu")
    """snapshots for ParaView: "none"; "vtu", a file for each; "vtkhdf", one of all; or "both" of these"""
    peaks: bool = quantity(False)
    """largest speed of every particle in the run"""
    load_factor: bool = quantity(False)
    """find the factor of the waves up to which the elastic law holds"""
    estimate: bool = quantity(False)
    """estimate the errors when the run is over"""
    pictures: bool = quantity(True)
    """draw pictures when the run is over"""


ReferenceName = Literal["exact", "extended", "finer", "finest"]

End = Literal["break", "end"]

MOST_REPEATS = 1000
"""Largest number of timed runs: the fastest of a few is as fast as that of many, to some per cent."""


class ChartChoice(Table):
    """A choice of which several keys change together."""

    name: str = quantity(min_length=1)
    """name of the choice in the chart"""
    set: dict[str, Any] = quantity()
    """changed keys, such as { "run.safety" = 0.5 }"""


class Chart(Table):
    """Choices that `dembound chart` compares; runs do not depend on it."""

    vary: Vary = quantity({})
    """key -> list of values, or range such as "1:20"; all combinations are choices"""
    choice: tuple[ChartChoice, ...] = quantity(())
    """additional choices, a table [[chart.choice]] each"""
    repeats: int = quantity(3, means="count", ge=1, le=MOST_REPEATS)
    """timed runs of every choice"""
    reference: ReferenceName | None = quantity(None)
    """reference of the errors; absent: the first that the case allows"""
    until: End = quantity("break")
    """end of the compared histories: "break", the first spall or broken bond of the reference; "end" """


Action = Literal["run", "calibrate"]

Method = Literal["impedance", "ratio", "homogenised"]

MOST_PROCESSES = 10_000
"""Largest number of members at once: the cores of a large cluster."""


class Sweep(Table):
    """Members of `dembound sweep`, whose options override it; runs do not depend on it."""

    vary: Vary = quantity({})
    """key -> list of values, or range such as "1:20" or, with a step, "0:100:25" """
    together: bool = quantity(False)
    """first values of all keys are one member, second ones the next; else all combinations"""
    action: Action = quantity("run")
    """action for every member"""
    method: Method = quantity("impedance")
    """how β is calibrated"""
    processes: int | None = quantity(None, means="count", ge=1, le=MOST_PROCESSES)
    """members at once; absent: as many as there are cores"""
