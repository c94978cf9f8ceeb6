"""How reproducible a run with many cracks is: the same case repeated with a slightly smaller time step.

Once bonds break, differences of the size of rounding decide which one is next, and grow with every break. So a run with
another step is another draw of the same problem: what both have in common is reproducible, the rest is chance.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from dembound.accuracy.runner import STEP_AND_END
from dembound.casefile import Case
from dembound.errors import CaseError
from dembound.kinds import with_changes
from dembound.motion.part import MANY
from dembound.results.compare import largest_component, on_common_clock, relative_error
from dembound.results.histories import FREE_FIELD, Quantity, in_words, read_histories
from dembound.results.reader import energy_of, is_line, open_record, text_of
from dembound.running import run_case

SHORTER = 0.98
"""Time step of the second run over that of the first: no simple ratio, and its own error hardly differs."""

MOST = 0.95
"""Share of the cracks within the radius of their zone; the few that are farther out differ from draw to draw."""

SAME_PLACE = 1.05
"""Distance over a diameter within which two cracks are at the same place: bonds side by side in a lattice are one apart
before they move."""

QUANTITIES: tuple[Quantity, ...] = ("velocity", "displacement")


@dataclass(frozen=True)
class Cracked:
    """The bonds that broke in a run after its start.

    places : (k, 2) m. times : (k,) s. energy : taken by the breaks, in a unit. size : mean diameter of the disks, or
    largest spacing of a bar, m. time_step : of the run, s. in_bar : whether the run is one of a bar.
    """

    places: np.ndarray
    times: np.ndarray
    energy: float
    unit: str
    size: float
    time_step: float
    in_bar: bool = False

    @classmethod
    def of(cls, record: Path) -> Cracked:
        """The bonds that broke in the run of a record."""
        with open_record(record) as file:
            times, particles = file["cracks/time"][:], file["particles"]
            in_bar, x = is_line(file.attrs["size"]), np.sort(particles["position"][:, 0])
            size = float(np.diff(x).max(initial=0.0) if in_bar else 2.0 * particles["radius"][:].mean())
            places, energy = file["cracks/position"][:], float(energy_of(file)["crack"][-1])
            unit, step = text_of(file["energy/crack"].attrs["unit"]), float(file.attrs["time_step"])
        return cls(places[times > 0.0], times[times > 0.0], energy, unit, size, step, in_bar)

    def __len__(self) -> int:
        return len(self.times)

    @property
    def first(self) -> float:
        """Time of the first crack, s; infinite without one."""
        return float(self.times.min(initial=np.inf))

    @property
    def radius(self) -> float | None:
        """Distance (m) from the mean place within which `MOST` of the cracks are; None without cracks."""
        if len(self) == 0:
            return None
        return float(np.quantile(np.hypot(*(self.places - self.places.mean(axis=0)).T), MOST))

    def summary(self) -> dict[str, Any]:
        """Number, places, times and energy of the cracks as plain JSON values."""
        return {"time_step": self.time_step, "cracks": len(self), "energy": self.energy, "radius": self.radius}

    @property
    def reach(self) -> float:
        """Distance (m) within which cracks of two runs count as being at the same place."""
        return SAME_PLACE * self.size

    def one_draw(self) -> Iterator[str]:
        """A line saying that a run of disks with so many cracks is one draw of many; none if cracks are few.

        None for bars, in which several bonds break at one place.
        """
        if len(self) > MANY and not self.in_bar:
            which = "which ones, and how they move what is near, is one draw of many"
            again = f"--repeat runs the case again at {SHORTER:g} of the time step and says what remains"
            yield f"{len(self):,} bonds break: {which}; {again}"


@dataclass(frozen=True)
class Repeat:
    """The cracks of a run compared with those of the same case with a smaller time step.

    changes : monitor -> quantity -> `relative_error` of the second motion beside the first, over the whole run. cost :
    work of the second run over that of the first.
    """

    own: Cracked
    other: Cracked
    changes: Mapping[str, Mapping[str, float]]
    cost: float

    @property
    def common(self) -> float:
        """Share of the cracks of both runs that lie within `reach` of a crack of the other run."""
        near = _near(self.own, self.other) + _near(self.other, self.own)
        return near / (len(self.own) + len(self.other))

    def summary(self) -> dict[str, Any]:
        """Plain JSON values: both runs, the share of cracks in common, and changes of motion."""
        runs = {"this_run": self.own.summary(), "second_run": self.other.summary()}
        changes = {name: dict(each) for name, each in self.changes.items()}
        return runs | {"common": self.common, "within": self.own.reach, "changes": changes}

    def lines(self) -> list[str]:
        """Number, place, energy and extent of the cracks in both runs, and the change of motion, in words."""
        own, other = self.own, self.other
        cracks = (
            f"repeated at {other.time_step / own.time_step:.3g} of the time step: {len(other):,} bonds break in place "
            f"of {len(own):,}, {100.0 * self.common:.0f} % within {own.reach:.3g} m of one of the other run"
        )
        reach = (
            f"the cracks take {other.energy:.3g} in place of {own.energy:.3g} {own.unit}, and {100.0 * MOST:.0f} % of "
            f"them are within {_in_words(other.radius)} in place of {_in_words(own.radius)} of their middle"
        )
        changes = [
            f"{name} {', '.join(f'{quantity} {in_words(change)}' for quantity, change in each.items())}"
            for name, each in self.changes.items()
        ]
        return [cracks, reach, *([f"motion changes by: {'; '.join(changes)}"] if changes else [])]


def _in_words(radius: float | None) -> str:
    """A radius (m)."""
    return "none" if radius is None else f"{radius:.3g} m"


def repeated(case: Case, record: Path, own: Cracked, shorter: float = SHORTER) -> Repeat:
    """Run the case of a record, whose cracks are `own`, again with its time step times `shorter`.

    case : of the record, to the end of its run. The second run writes to a folder of its own, which is removed. Raises
    CaseError if no bond broke, and the errors of runs.
    """
    if len(own) == 0:
        raise CaseError([f"{record}: has no broken bonds that --repeat could compare"])
    run = {key: value for key, value in case.run.given().items() if key not in (*STEP_AND_END, "checkpoint")}
    run |= {"duration": case.run.duration, "time_step": shorter * own.time_step}
    output = {"history_interval": case.output.history_interval, "snapshots": 0, "pictures": False}
    with TemporaryDirectory(prefix="dembound_") as folder:
        other = run_case(with_changes(case, {"run": run, "output": output}), Path(folder)) / "run.h5"
        cracked, changes = Cracked.of(other), _changes(record, other)
    return Repeat(own, cracked, changes, own.time_step / cracked.time_step)


def _near(cracked: Cracked, other: Cracked) -> int:
    """Number of cracks that have one of another run at the same place."""
    from scipy.spatial import cKDTree

    if len(cracked) == 0 or len(other) == 0:
        return 0
    distances, _ = cKDTree(other.places).query(cracked.places)
    return int(np.count_nonzero(distances <= cracked.reach))


def _changes(record: Path, other: Path) -> dict[str, dict[str, float]]:
    """Changes of motion at all monitors that move, see `Repeat`."""
    found: dict[str, dict[str, float]] = {}
    for quantity in QUANTITIES:
        again = read_histories(other, quantity)
        for name, own in read_histories(record, quantity).items():
            values, expected = on_common_clock(again[name].time, again[name].values[:, :2], own.time, own.values[:, :2])
            if not name.endswith(FREE_FIELD) and expected.any():
                column = largest_component(expected)
                change = relative_error((values - expected)[:, column], expected[:, column])
                found.setdefault(name, {})[quantity] = change
    return found
