"""Amplification along the surface of the ground: the motion of monitors beside that of the free field at its surface.

The free field of a monitor is the undisturbed ground of its own side, at the surface: the highest of all twins there.
The own twins of monitors on a slope or in a canyon are as deep as these are, where the reflected wave cancels some
frequencies.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from dembound.casefile.disks.monitor_rows import NUMBERED
from dembound.casefile.messages import choices, counted
from dembound.errors import CaseError
from dembound.interrupts import look
from dembound.results.histories import FREE_FIELD, MonitorRecord, read_histories
from dembound.results.reader import is_line, open_record
from dembound.spectra import FADED, fourier_spectrum, shown_frequencies, smoothed

PEAKS = ("velocity", "acceleration")
"""Quantities whose peaks are compared."""

FREQUENCIES = 60
"""Number of frequencies of the spectra."""

LAST = 0.1
"""Share of the run over which the displacement at its end is a mean."""

FEWEST = 16
"""Least number of samples of a history."""


@dataclass(frozen=True)
class Amplification:
    """The motion of monitors at x and y (k, 2) m beside that of their free field, in the order of x.

    Attributes
    ----------
    names, fields : the monitors, and the histories that are their free fields.
    field_places : (k, 2) m.
    peaks : by quantity (k, 2): largest size of the components x and y over that of the free field.
    frequency, spectra : (f,) Hz, and (k, f, 2): smoothed Fourier amplitudes of the velocity over those of the free
        field, nan where this has no energy.
    at_end : (k, 2) m, mean displacement over the last tenth of the run, less that of the free field.
    over_size : (2,) bool, whether a component is over the size |v| of the free field instead, √(x² + y²) of spectra, as
        its own component does not move.
    deep : m, by which free fields are below the surface of their ground, 0 if by less than a diameter.
    """

    names: list[str]
    places: np.ndarray
    fields: list[str]
    field_places: np.ndarray
    peaks: Mapping[str, np.ndarray]
    frequency: np.ndarray
    spectra: np.ndarray
    at_end: np.ndarray
    over_size: tuple[bool, bool]
    deep: float

    def words(self, component: int) -> str:
        """What a component is relative to, such as "free field's x"."""
        return f"free field's {'size' if self.over_size[component] else 'xy'[component]}"

    def notes(self, components: Sequence[int] = (0, 1)) -> Iterator[str]:
        """What is to be known of the free field of some components, one line each."""
        for name in dict.fromkeys(self.fields):
            y = self.field_places[self.fields.index(name), 1]
            yield f"free field: {name} at y = {y:.4g} m, of {counted(self.fields.count(name), 'monitor')}"
        for c in components:
            if self.over_size[c]:
                yield f"the free field does not move along {'xy'[c]}: {'xy'[c]} is over its size √(x² + y²)"
        if self.deep > 0.0:
            yield f"the free field is up to {self.deep:.3g} m below the surface; add a monitor on level ground"

    def rows(self) -> list[list[Any]]:
        """A table: its heads with units, and a row for each monitor."""
        heads = ["monitor", "x (m)", "y (m)", "free field", "y of the free field (m)"]
        cells: list[Any] = [self.names, *self.places.T, self.fields, self.field_places[:, 1]]
        for c, name in enumerate("xy"):
            heads += [f"peak {of} {name} over {self.words(c)} (–)" for of in self.peaks]
            cells += [values[:, c] for values in self.peaks.values()]
        for c, name in enumerate("xy"):
            heads.append(f"displacement {name} at the end less the free field's (m)")
            cells.append(self.at_end[:, c])
        for c, name in enumerate("xy"):
            heads += [f"Fourier amplitude {name} over {self.words(c)} at {f:.4g} Hz (–)" for f in self.frequency]
            cells += list(self.spectra[:, :, c].T)
        return [heads, *(list(map(_cell, row)) for row in zip(*cells, strict=True))]


def _cell(value: Any) -> Any:
    """A name, or a number with six digits."""
    return value if isinstance(value, str) else None if np.isnan(value) else float(f"{value:.6g}")


def amplification(path: Path, monitors: Sequence[str] | None = None, reference: str | None = None) -> Amplification:
    """The amplification at monitors of a run.

    Parameters
    ----------
    monitors
        names of monitors, and of rows, which stand for all their monitors; by default the only row, or without rows
        all monitors that have a free field.
    reference
        history that is the free field of all monitors; by default the highest twin of the side of each.

    Raises CaseError for a file that cannot be read, several rows without a choice, unknown names, a run without free
    fields, and free fields that do not move.
    """
    velocity, acceleration = read_histories(path, "velocity"), read_histories(path, "acceleration")
    displacement = read_histories(path, "displacement")
    sides, tops, diameter = _sides(path, velocity)
    if not sides and reference is None:
        raise CaseError(
            [f"RESULTS: {path} has no free field of its monitors, which a wave from below gives beside sides "
             '"outside" or "free_field"; name another history with --reference']
        )  # fmt: skip
    names = _chosen([name for name in velocity if reference or name in sides], velocity, monitors)
    names.sort(key=lambda name: tuple(velocity[name].position))
    if reference is not None and reference not in velocity:
        raise CaseError([f"--reference: is {reference}, must be one of {choices(reference, _listed(velocity))}"])
    highest = {
        side: max((f"{name}{FREE_FIELD}" for name in sides if sides[name] == side), key=lambda t: _height(velocity[t]))
        for side in set(sides.values())
    }
    fields = [reference or highest[sides[name]] for name in names]
    used = list(dict.fromkeys(fields))
    if still := [name for name in used if not velocity[name].values[:, :2].any()]:
        raise CaseError([f"RESULTS: the free field, {still[0]}, does not move in this run"])
    over_size = _over_size([velocity[name].values for name in used])
    motions = zip(PEAKS, (velocity, acceleration), strict=True)
    peaks = {quantity: _peaks(records, names, fields, over_size) for quantity, records in motions}
    frequency, spectra = _spectra(velocity, names, fields, over_size)
    ends = {name: _end(displacement[name]) for name in (*names, *used)}
    own = [] if reference else [sides[name] for name in names]
    depths = [tops[side] - _height(velocity[highest[side]]) for side in own]
    return Amplification(
        names=names,
        places=np.array([velocity[name].position for name in names]),
        fields=fields,
        field_places=np.array([velocity[name].position for name in fields]),
        peaks=peaks,
        frequency=frequency,
        spectra=spectra,
        at_end=np.array([ends[name] - ends[field] for name, field in zip(names, fields, strict=True)]),
        over_size=over_size,
        deep=max((depth for depth in depths if depth > diameter), default=0.0),
    )


def _height(history: MonitorRecord) -> float:
    """Height y (m) of a monitor's place."""
    return float(history.position[1])


def _sides(path: Path, histories: Mapping[str, MonitorRecord]) -> tuple[dict[str, str], dict[str, float], float]:
    """Monitors that have twins -> the side of these, the height y (m) of the surface by side, and the mean diameter, m.

    Records of earlier versions have neither: one ground as high as the box of disks.
    """
    with open_record(path) as file:
        if is_line(file.attrs["size"]):
            raise CaseError([f"RESULTS: {path} is of a bar, which has no surface"])
        box_top = float(file.attrs["corner"][1] + file.attrs["size"][1])
        diameter = 2.0 * float(file["particles/radius"][:].mean())
        sides, tops = {}, {}
        for name in (name for name in histories if f"{name}{FREE_FIELD}" in histories):
            twin = file[f"histories/{name}{FREE_FIELD}"].attrs
            sides[name] = str(twin.get("side", "left"))
            tops[sides[name]] = float(twin.get("surface", box_top))
    return sides, tops, diameter


def _chosen(known: Sequence[str], histories: Mapping[str, MonitorRecord], asked: Sequence[str] | None) -> list[str]:
    """The names of the monitors that are shown, see `amplification`."""
    known = [name for name in known if not name.endswith(FREE_FIELD)]
    rows = _rows(known)
    if asked is None and len(rows) > 1:
        raise CaseError([f"--monitor: is missing; name one of the rows {', '.join(sorted(rows))}, or single monitors"])
    found: list[str] = []
    for name in asked if asked is not None else rows or known:
        own = rows.get(name, [])
        if name not in known and not own:
            what = "has no free field" if name in histories else f"must be one of {choices(name, _listed(known))}"
            raise CaseError([f"--monitor: is {name}, {what}"])
        found += [name] if name in known else own
    return list(dict.fromkeys(found))


def _rows(names: Iterable[str]) -> dict[str, list[str]]:
    """The rows among some monitors, each with its monitors: two or more of a name and numbers."""
    rows: dict[str, list[str]] = {}
    for name in names:
        if found := NUMBERED.fullmatch(name):
            rows.setdefault(found[1], []).append(name)
    return {row: own for row, own in rows.items() if len(own) > 1}


def _listed(names: Iterable[str]) -> list[str]:
    """The rows and the monitors of none, for messages."""
    rows = _rows(each for each in names if not each.endswith(FREE_FIELD))
    in_rows = {each for own in rows.values() for each in own}
    return [*rows, *(each for each in names if each.removesuffix(FREE_FIELD) not in in_rows)]


def _over_size(fields: Sequence[np.ndarray]) -> tuple[bool, bool]:
    """Whether the components x and y of one of some velocities (n, 3) do not move: below `FADED` of its size."""
    still = [np.abs(each[:, :2]).max(axis=0) < FADED * np.hypot(*each[:, :2].T).max() for each in fields]
    x, y = np.any(still, axis=0)
    return bool(x), bool(y)


def _peaks(
    records: Mapping[str, MonitorRecord], names: Sequence[str], fields: Sequence[str], over_size: tuple[bool, bool]
) -> np.ndarray:
    """Largest sizes (k, 2) of the components of histories over those of their free fields."""
    below = {}
    for name in set(fields):
        motion = records[name].values[:, :2]
        below[name] = np.where(over_size, np.hypot(*motion.T).max(), np.abs(motion).max(axis=0))
    sizes = [np.abs(records[name].values[:, :2]).max(axis=0) for name in names]
    return np.array([size / below[of] for size, of in zip(sizes, fields, strict=True)])


def _spectra(
    velocity: Mapping[str, MonitorRecord], names: Sequence[str], fields: Sequence[str], over_size: tuple[bool, bool]
) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (f,) Hz at equal ratios over all where a free field has energy, and the ratios (k, f, 2)."""
    time = velocity[names[0]].time
    if len(time) < FEWEST:
        raise CaseError([f"RESULTS: has {len(time)} samples of its monitors, a spectrum needs at least {FEWEST}"])
    step = float(time[-1] - time[0]) / (len(time) - 1)

    def power(name: str, centres: np.ndarray) -> np.ndarray:
        """Smoothed power (f, 2) of both components."""
        look()
        both = [fourier_spectrum(velocity[name].values[:, c], step) for c in (0, 1)]
        return np.stack([smoothed(frequency, np.abs(spectrum) ** 2, centres) for frequency, spectrum in both], axis=1)

    def below(name: str, centres: np.ndarray) -> np.ndarray:
        """Smoothed power (f, 2) of both components of a free field, nan where it has no energy."""
        own = power(name, centres)
        own = np.where(over_size, own.sum(axis=1, keepdims=True), own)
        return np.where(own >= FADED**2 * own.max(axis=0), own, np.nan)

    every = shown_frequencies(len(time), step)
    shown = every[np.any([np.isfinite(below(name, every)).any(axis=1) for name in set(fields)], axis=0)]
    centres = np.geomspace(shown[0], shown[-1], FREQUENCIES)
    of = {name: below(name, centres) for name in set(fields)}
    return centres, np.sqrt([power(name, centres) / of[field] for name, field in zip(names, fields, strict=True)])


def _end(displacement: MonitorRecord) -> np.ndarray:
    """Mean (2,) m of a displacement over the last tenth of the run."""
    begin = displacement.time[-1] - LAST * (displacement.time[-1] - displacement.time[0])
    last: np.ndarray = displacement.values[displacement.time >= begin, :2].mean(axis=0)
    return last
