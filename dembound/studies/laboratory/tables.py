"""The results of a laboratory test in files: ``test.csv``, ``curves.csv``, ``test.json``, and the cases of its runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from dembound.errors import RecordError
from dembound.files import make_folder, write_text
from dembound.results.recording import TestName
from dembound.results.text_files import read_json, write_csv, write_json
from dembound.studies.laboratory.study import UNITS, Tested
from dembound.studies.sweep.tables import Statistic
from dembound.version import __version__

MOST_POINTS = 400
"""Largest number of rows of one curve in ``curves.csv``."""

SUMMARY = "test.json"

OPPOSITES: dict[TestName, tuple[TestName, ...]] = {
    **dict.fromkeys(("ucs", "biaxial"), ("tension", "brazilian")),
    **dict.fromkeys(("tension", "brazilian"), ("ucs", "biaxial")),
}
"""Tests with whose strength that of a test makes the ratio of uniaxial compressive and tensile strength."""


class Ratio(NamedTuple):
    """The uniaxial compressive strength over the tensile one, means of both; other : test that gave the second one."""

    value: float
    other: TestName
    folder: Path


@dataclass
class _Mean:
    """A mean that another test has left; None where it is not finite."""

    quantity: str
    mean: float | None


@dataclass
class _Summary:
    """What is read of the summary of another test."""

    material: dict[str, Any]
    statistics: list[_Mean]


def write_tables(tested: Tested, ratios: Sequence[Ratio]) -> list[Path]:
    """Write all tables, and the case of each run, into the folder of a test; returns the paths."""
    test, curves, summary, cases = (tested.folder / name for name in ("test.csv", "curves.csv", SUMMARY, "cases"))
    write_csv(test, _rows(tested))
    write_csv(curves, _points(tested))
    write_json(summary, _summary(tested, ratios))
    make_folder(cases)
    for specimen in tested.specimens:
        write_text(cases / f"{specimen.member.name}.toml", specimen.member.case.text)
    return [test, curves, summary, cases]


def _rows(tested: Tested) -> Iterator[Sequence[Any]]:
    """A head, and a row for each run: name, state, seed, pressure (Pa), and its quantities in SI units."""
    values = {each.member.name: tested.values(each) for each in tested.done}
    names = list(dict.fromkeys(name for row in values.values() for name in row))
    yield ["run", "state", "seed", "pressure", *names]
    for specimen, state in zip(tested.specimens, tested.states, strict=True):
        own = values.get(specimen.member.name, {})
        yield [specimen.member.name, state, specimen.seed, specimen.pressure, *(own.get(name) for name in names)]


def _points(tested: Tested) -> Iterator[Sequence[Any]]:
    """A head, and rows of each curve: time, strain of the platens, strains of the middle, stress, broken bonds."""
    yield ["run", "time", "strain", "axial_strain", "lateral_strain", "stress", "tension_cracks", "shear_cracks"]
    for name, curve in tested.curves.items():
        for number in np.unique(np.linspace(0, len(curve.time) - 1, MOST_POINTS).round().astype(int)):
            time = float(curve.time[number])
            inner = [float(np.interp(time, curve.gauge_time, each)) for each in (curve.axial, curve.lateral)]
            cracks = [curve.cracks(shear=shear, until=time) for shear in (False, True)]
            yield [name, time, float(curve.strain[number]), *inner, float(curve.stress[number]), *cracks]


def _summary(tested: Tested, ratios: Sequence[Ratio]) -> dict[str, Any]:
    """The contents of ``test.json``, see docs/tasks/laboratory.md."""
    sample = tested.sample
    size = {key: getattr(sample, key) for key in ("width", "height", "ends", "damp", "rate")}
    homogenised = dict(zip(("young", "poisson", "p_wave_speed"), sample.elastic, strict=True))
    runs, statistics = [], []
    for each, state in zip(tested.specimens, tested.states, strict=True):
        own = {"name": each.member.name, "seed": each.seed, "pressure": each.pressure, "state": state}
        runs.append(own | (tested.values(each) if state == "done" else {}))
    for mean in tested.statistics:
        numbers = {key: getattr(mean, key) for key in ("count", "mean", "spread", "interval")}
        unit = UNITS.get(mean.quantity, "1")
        statistics.append({**mean.group, "quantity": mean.quantity, "unit": unit, **numbers})
    return {
        **{"test": sample.test, "case": sample.case.name, "version": __version__},
        **{"sample": size | {"shares": list(tested.shares)}, "packing": sample.packing, "material": sample.material},
        **{"homogenised": homogenised, "runs": runs, "statistics": statistics},
        "ratios": [{"value": each.value, "other": each.other, "folder": str(each.folder)} for each in ratios],
        "warnings": list(tested.warnings),
    }


def ratios_of(tested: Tested, output: Path) -> Iterator[Ratio]:
    """Uniaxial compressive over tensile strength, with each other test of the same material in a folder of results."""
    sample = tested.sample
    own = _uniaxial(sample.test, tested.statistics)
    for other in OPPOSITES[sample.test]:
        folder = output / f"{sample.case.name}_{other}"
        found = _strength_in(folder, other, sample.material)
        if own is not None and found is not None:
            yield Ratio(own / found if sample.test in ("ucs", "biaxial") else found / own, other, folder)


def _strength_in(folder: Path, test: TestName, material: dict[str, Any]) -> float | None:
    """The strength (Pa) that a test has left in a folder; None without one of this material."""
    try:
        there = read_json(folder / SUMMARY, _Summary)
    except (OSError, RecordError):
        return None
    return _uniaxial(test, there.statistics) if there.material == material else None


def _uniaxial(test: TestName, statistics: Sequence[_Mean | Statistic]) -> float | None:
    """The mean uniaxial strength (Pa) among the statistics of a test."""
    name = "uniaxial" if test == "biaxial" else "strength"
    return next((each.mean for each in statistics if each.quantity == name and each.mean), None)
