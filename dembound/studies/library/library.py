"""A library: the responses of a scene to its inputs, and histories under any record as sums of them."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import ConfigDict, Field

from dembound.casefile.disks import DiskCase
from dembound.casefile.model import as_kind
from dembound.errors import CaseError, RecordError
from dembound.kinds import loads
from dembound.results.reader import open_record
from dembound.results.text_files import read_json
from dembound.studies.library.build import FILE, HAT, REST, inputs_of, is_at_rest
from dembound.studies.library.record import RecordTimes
from dembound.version import __version__

MOST_LEAD = 10**6
"""Largest number of spacings before the values of a record."""

WIDTH = 6
"""Columns of a monitor: displacement x, y, rotation (m, rad), velocity x, y, rotation (m/s, rad/s)."""


@dataclass
class _Facts:
    """The contents of the file of a library."""

    version: str
    name: str
    spacing: Annotated[float, Field(gt=0.0)]
    lead: Annotated[int, Field(ge=0, le=MOST_LEAD)]
    inputs: Annotated[list[str], Field(min_length=1)]
    case: str

    __pydantic_config__ = ConfigDict(allow_inf_nan=False)


class Library:
    """A library in a folder.

    Attributes
    ----------
    folder : with the runs. name : of the case it was made from. case : the case with silent inputs. inputs : names of
    the waves that records replace. spacing : of records, s; lead : number of spacings after their first value
    during which they are zero. monitors : their names. time : (k,) s, of the samples of histories. attributes : of the
    runs' record; places : attributes of each monitor's history.

    Raises CaseError where there is no library, or one of another version.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        if not (folder / FILE).is_file():
            raise CaseError([f"{folder}: contains no library, must be a folder written by `dembound library`"])
        facts = read_json(folder / FILE, _Facts)
        self.name, self.spacing, self.inputs, self.lead = facts.name, facts.spacing, facts.inputs, facts.lead
        if facts.version != __version__:
            raise CaseError(
                [f"{folder}: is a library of dembound {facts.version}, this is {__version__}; make it anew"]
            )
        try:
            self.case = as_kind(loads(facts.case, folder, self.name), DiskCase, "is the case of a bar")
        except CaseError as error:
            raise RecordError([f"{folder / FILE}: is damaged, its case: {error.problems[0]}"]) from None
        if facts.inputs != inputs_of(self.case):
            raise RecordError([f"{folder / FILE}: is damaged: its inputs are not those of its case"])
        with open_record(self._record(f"{HAT}{self.inputs[0]}")) as file:
            groups = file["histories"]
            self.monitors = list(groups)
            times = groups[self.monitors[0]]["time"][:]
            self.attributes = dict(file.attrs)
            self.places = {name: dict(group.attrs) for name, group in groups.items()}

        self._per_spacing = max(1, round(self.spacing / (times[1] - times[0]))) if len(times) > 1 else 1
        self.time = times[: len(times) - self.lead * self._per_spacing]

    @property
    def clock(self) -> RecordTimes:
        """Spacing, lead and duration of records."""
        return RecordTimes(self.spacing, self.case.run.duration, self.lead)

    @cached_property
    def rest(self) -> np.ndarray:
        """Motion (k, monitors, 6) without waves, see `WIDTH`."""
        return self._rest_of_runs[: len(self.time)]

    @cached_property
    def _rest_of_runs(self) -> np.ndarray:
        """Motion without waves, as long as the runs."""
        if not is_at_rest(self.case):
            return self._motion(REST)
        return np.zeros((len(self.time) + self.lead * self._per_spacing, len(self.monitors), WIDTH))

    def response(self, name: str) -> np.ndarray:
        """Motion (k, monitors, 6) that one triangle of unit height of an input adds, which rises from time 0."""
        added = self._motion(f"{HAT}{name}") - self._rest_of_runs
        return added[self.lead * self._per_spacing :]

    def motion(self, values: Mapping[str, np.ndarray]) -> np.ndarray:
        """Motion (k, monitors, 6) under records.

        values : input -> velocities at the times 0, Δ, 2Δ …, the first `lead` + 1 of which are 0.

        Samples of histories and times of records lie on common times, so every `_per_spacing`-th sample is a
        discrete convolution of the record with the response at such samples, computed by Fourier transforms.
        """
        from scipy.fft import irfft, rfft

        summed: np.ndarray | float = 0.0
        for name, record in values.items():
            crests = record[1 : self._rows + 1]  # the first triangle has its crest at Δ
            spectrum = rfft(crests, self._length)
            summed = summed + spectrum[:, None] * self._spectra[name]
        rows = np.asarray(irfft(np.atleast_2d(summed), self._length, axis=0))[: self._rows]
        samples = rows.reshape(-1, len(self.monitors), WIDTH)[: len(self.time)]
        moved: np.ndarray = samples + self.rest
        return moved

    @property
    def _rows(self) -> int:
        """Number of spacings in the histories."""
        return -(-len(self.time) // self._per_spacing)

    @cached_property
    def _length(self) -> int:
        """Length of the transforms, in spacings, with as many zeros as a convolution needs."""
        from scipy.fft import next_fast_len

        return int(next_fast_len(2 * self._rows, real=True))

    @cached_property
    def _spectra(self) -> dict[str, np.ndarray]:
        """Transforms (length/2 + 1, samples in a spacing · columns) of each input's response, along its spacings."""
        from scipy.fft import rfft

        found = {}
        for name in self.inputs:
            response = self.response(name).reshape(len(self.time), -1)
            padded = np.zeros((self._rows * self._per_spacing, response.shape[1]))
            padded[: len(response)] = response
            found[name] = np.asarray(rfft(padded.reshape(self._rows, -1), self._length, axis=0))
        return found

    @property
    def record_at_rest(self) -> Path:
        """The record of the run without waves."""
        return self._record(REST)

    def _motion(self, run: str) -> np.ndarray:
        """Motion (k, monitors, 6) in one of the library's runs."""
        with open_record(self._record(run)) as file:
            each = [np.hstack([group["displacement"][:], group["velocity"][:]]) for group in file["histories"].values()]
        return np.stack(each, axis=1)

    def _record(self, run: str) -> Path:
        """The record of one of the library's runs."""
        return self.folder / run / "run.h5"
