"""A case of a bar: its tables, and mistakes between them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from pydantic import TypeAdapter

from dembound.boundaries.edge import normal_axis
from dembound.casefile.bar.bar import MOST_CELLS, Bar
from dembound.casefile.messages import numbered
from dembound.casefile.model import (
    Case,
    Schema,
    driving_waves,
    monitor_problems,
    never_estimated,
    run_problems,
    unknown_waves,
)
from dembound.casefile.tables import Chart, Output, Run, Sweep
from dembound.casefile.types import BarEndTable, MethodTable
from dembound.methods.method import Method
from dembound.table import FileName, Table, quantity


class BarLoad(Table):
    """A pressure on one end of a bar, on its last node or the last few in proportion to their volume.

    Coarse peridynamic bars need a load on several nodes: on one node it breaks them.
    """

    name: FileName = quantity()
    """name in messages and results"""
    pressure: float = quantity(unit="Pa", means="pressure of a load")
    """pressure on the section; negative values pull"""
    side: Literal["left", "right"] = quantity("left")
    """end of the bar it acts on"""
    nodes: int = quantity(1, means="count", ge=1, le=MOST_CELLS + 1)
    """number of nodes it is spread over, from the end inwards"""
    wave: str = quantity()
    """wave that is the time factor"""


class BarMonitor(Table):
    """A gauge: records motion and stress of the nearest node, half-way between two nodes of the left one."""

    name: FileName = quantity()
    """name of the history in the results"""
    position: float = quantity(unit="m", means="place", ge=0.0)
    """where, from the bar's left end"""


class BarRun(Run):
    """The simulated time and the time step of a bar; the step may be given by the Courant number."""

    courant: float | None = quantity(None, means="Courant number", gt=0.0)
    """Courant number ν = cΔt/Δx, instead of a time step"""

    def mistakes(self) -> Iterator[str]:
        """A step that is given twice."""
        yield from super().mistakes()
        if self.courant is not None and self.time_step != "auto":
            yield "courant: is not allowed together with time_step"
        if self.courant is not None and "safety" in self.model_fields_set:
            yield "safety: is for an automatic time step, courant gives it"


FEWEST_CELLS = 3
"""Smallest number of spacings of a bar with soft ends: with two, no spacing lies between the ends."""


def bar_problems(tables: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[str]:
    """Check the tables of a bar's case against each other.

    `tables` has the fields of `BarCase` as keys; a table that is invalid on its own is None and left out. given : the
    file's data.
    """
    loaded = [(f"{place}.wave", load.wave) for place, load in numbered("load", tables["load"])]
    yield from unknown_waves([*driving_waves(tables["boundary"]), *loaded], tables["wave"])
    for name, wave in tables["wave"].items():
        if wave and wave.motion is not None:
            yield f"wave.{name}.motion: is for sides of disks; ends of bars take the incident wave, or its velocity"
    for side, end in tables["boundary"].items():
        yield from end.problems(side, tables) if end else ()
    yield from _across_the_bar(tables["boundary"])
    yield from _loaded_but_held(tables["boundary"], tables["load"])
    yield from monitor_problems(tables)
    bar = tables["bar"]
    written = given.get("bar", {})
    if isinstance(written, Mapping) and "length" not in written and not written.get("range"):
        yield "bar.length: is missing, must be a number greater than 0 (m)"
        bar = None
    if bar:
        yield from _beyond_the_bar(bar, tables)
        if tables["method"]:
            yield from _horizon_too_long(bar, tables["method"])
    if tables["output"]:
        yield from never_estimated(tables)
        if tables["output"].load_factor:
            yield "output.load_factor: is for disks, not for bars"
    if tables["run"]:
        yield from run_problems(tables)
        if bar:
            yield from _courant_too_large(bar, tables["run"])


def _courant_too_large(bar: Bar, run: BarRun) -> Iterator[str]:
    """A step, given by its Courant number, that is longer than the run."""
    unit = min(part.spacing / part.speed for part in bar.parts)
    if run.courant is not None and (step := run.courant * unit) > run.duration:
        yield f"run.courant: makes a step of {step:g} s, must be at most run.duration, {run.duration:g} (s)"


def _across_the_bar(ends: Mapping[str, Any]) -> Iterator[str]:
    """Keys for sides of disks only: motion across, and half masses."""
    for side, end in ((side, end) for side, end in ends.items() if end):
        if "s" in end.waves:
            yield f"boundary.{side}.wave_s: moves across the bar, which moves only along its axis; use wave_p"
        if "beta_s" in end.model_fields_set:
            yield f"boundary.{side}.beta_s: is for waves across, and a bar moves only along its axis; use beta_p"
        if end.half_cells:
            yield f"boundary.{side}.half_mass: is for disks; end nodes of a bar have half a mass in any case"


def _loaded_but_held(ends: Mapping[str, Any], loads: Sequence[BarLoad | None]) -> Iterator[str]:
    """Loads on an end whose motion is prescribed, where they have no effect."""
    for place, load in numbered("load", loads):
        end = ends.get(load.side)
        if end and 0 in end.prescribed(normal_axis(load.side)):
            yield (
                f'{place}.side: is "{load.side}", whose motion boundary.{load.side} prescribes ("{end.type}"); '
                "must be an end that can move"
            )


def _beyond_the_bar(bar: Bar, tables: Mapping[str, Any]) -> Iterator[str]:
    """Gauges and loads outside the bar."""
    for place, monitor in numbered("monitor", tables["monitor"]):
        if monitor.position > bar.length:
            yield f"{place}.position: is {monitor.position:g}, must be at most bar.length, {bar.length:g} (m)"
    loads: Sequence[tuple[str, BarLoad]] = list(numbered("load", tables["load"]))
    for place, load in loads:
        if bar.range and load.nodes > (most := bar.end(load.side).cells):
            yield f"{place}.nodes: is {load.nodes}, must be at most {most}, the nodes of the {load.side} range alone"
        elif not bar.range and load.nodes > bar.cells + 1:
            yield f"{place}.nodes: is {load.nodes}, must be at most {bar.cells + 1}, the nodes of the bar"


def _horizon_too_long(bar: Bar, method: Method) -> Iterator[str]:
    """Horizons too long for the bar, or for one of its ranges."""
    cells = min(part.cells for part in bar.parts)
    where = "the shortest range" if bar.range else "the bar"
    if 2 * method.largest_horizon > cells:
        yield f"method.horizon: is {method.largest_horizon}, must be at most {cells // 2}, half of {where}'s spacings"
    elif method.soft_ends and cells < FEWEST_CELLS:
        yield f"bar.spacing: makes {cells} of them in {where}, with soft ends it must be {FEWEST_CELLS} or more"


@dataclass(frozen=True, kw_only=True, repr=False)
class BarCase(Case):
    """A case of a bar.

    Attributes
    ----------
    bar, method : the tables of these names.
    """

    bar: Bar
    method: Method
    load: tuple[BarLoad, ...] = ()
    monitor: tuple[BarMonitor, ...] = ()
    run: BarRun

    @property
    def loaded(self) -> str:
        """The end that loads act on or a wave drives: "left", "right", "both" or "none"."""
        ends = self.driving.keys() | {load.side for load in self.load}
        return "both" if len(ends) > 1 else next(iter(ends), "none")


SCHEMA = Schema(
    case=BarCase,
    noun="a bar",
    new="dembound new --from rock_bar",
    marks=("bar", "method"),
    tables={
        "bar": TypeAdapter(Bar),
        "method": TypeAdapter(MethodTable),
        "run": TypeAdapter(BarRun),
        "output": TypeAdapter(Output),
        "chart": TypeAdapter(Chart),
        "sweep": TypeAdapter(Sweep),
    },
    side=TypeAdapter(BarEndTable),
    sides=("left", "right"),
    lists={"load": TypeAdapter(BarLoad), "monitor": TypeAdapter(BarMonitor)},
    problems=bar_problems,
)
