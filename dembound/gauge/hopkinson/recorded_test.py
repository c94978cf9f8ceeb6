"""A split Hopkinson test in the record of a run: its bars, gauges and specimen compared with the options."""

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import h5py
import numpy as np

from dembound.casefile.bar.bar import Bar
from dembound.casefile.toml import parsed
from dembound.gauge.gauge_io import differs
from dembound.gauge.reading.recorded import is_record
from dembound.results.reader import open_record, text_of

UNITS = {
    "--wave-speed": "m/s",
    "--density": "kg/m³",
    "--bar-diameter": "m",
    "--attenuation": "1/m",
    "--youngs-modulus": "Pa",
    "--incident-gauge": "m",
    "--transmitted-gauge": "m",
    "--second-gauge": "m",
    "--specimen-length": "m",
    "--specimen-diameter": "m",
    "--specimen-area": "m²",
    "--bar-length": "m",
}
"""Options that a record contradicts, with their units."""

OF_BARS = {
    "wave_speed": "--wave-speed",
    "density": "--density",
    "attenuation": "--attenuation",
    "youngs_modulus": "--youngs-modulus",
}
"""Attribute of a monitor -> option."""


def contradictions(sources: Sequence[tuple[Path, str | None]], given: Mapping[str, float | None]) -> Iterator[str]:
    """A line for each option, by name, whose value differs from that in the results.

    sources : files with the monitors of the incident bar, of the transmission bar, and of a second gauge if there is
    one. Text files are left out; positions and specimen are known where all monitors are of one record.
    """
    known: dict[str, list[float]] = {}
    for path, name in sources:
        if is_record(path):
            with open_record(path) as file:
                for option, value in _of_bar(file[f"histories/{name}"]):
                    known.setdefault(option, []).append(value)
    if len({path for path, _ in sources}) == 1 and is_record(sources[0][0]):
        with open_record(sources[0][0]) as file:
            known |= {option: [value] for option, value in _of_test(file, [str(name) for _, name in sources])}
    for option, unit in UNITS.items():
        chosen = given.get(option)
        if chosen is not None and (other := [each for each in known.get(option, ()) if differs(chosen, each)]):
            yield f"{option}: is {chosen:.5g} {unit}, the results have {other[0]:.5g}"


def _of_bar(monitor: h5py.Group) -> Iterator[tuple[str, float]]:
    """Options with the values that a monitor's bar has."""
    for attribute, option in OF_BARS.items():
        if attribute in monitor.attrs:
            yield option, float(monitor.attrs[attribute])
    if "section" in monitor.attrs:
        yield "--bar-diameter", _diameter(float(monitor.attrs["section"]))


def _of_test(file: h5py.File, names: Sequence[str]) -> Iterator[tuple[str, float]]:
    """Options with the values of the recorded test, if one range lies between the ranges of both gauges."""
    monitors = [file[f"histories/{name}"] for name in names]
    if "case" not in file.attrs or not all("range" in each.attrs for each in monitors):
        return
    bar = Bar.model_validate(parsed(text_of(file.attrs["case"]))["bar"])
    order = [each.name for each in bar.range]
    first, last = (order.index(text_of(each.attrs["range"])) for each in monitors[:2])
    if abs(last - first) != 2:
        return
    middle, parts, starts = (first + last) // 2, bar.parts, bar.starts
    near, far = (0.0, parts[middle].length) if first < last else (parts[middle].length, 0.0)
    faces = (starts[middle] + near, starts[middle] + far, starts[middle] + near)
    places = [float(np.ravel(each.attrs["position"])[0]) for each in monitors]
    gauges = ("--incident-gauge", "--transmitted-gauge", "--second-gauge")
    yield from ((option, abs(face - place)) for option, face, place in zip(gauges, faces, places, strict=False))
    yield "--specimen-length", parts[middle].length
    yield "--specimen-area", parts[middle].area
    yield "--specimen-diameter", _diameter(parts[middle].area)
    yield "--bar-length", min(parts[first].length, parts[last].length)


def _diameter(area: float) -> float:
    """Diameter (m) of a circle of an area, m²."""
    return math.sqrt(4.0 * area / math.pi)
