"""A measured ground motion: the channels of a file, in SI units."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

Quantity = Literal["acceleration", "velocity", "displacement"]
"""What a channel measured."""


@dataclass(frozen=True)
class Channel:
    """One component of a ground motion, sampled evenly.

    Attributes
    ----------
    component : as the file names it: "90", "EW", "UP"; empty where it has no name.
    quantity : what was measured.
    values : (n,) in m/s², m/s or m.
    time_step : from one sample to the next, s.
    begin : time of the first sample, s.
    stated_peak : largest |value| as the file's header states it, in the unit of the values; None without one. That of
    K-NET and KiK-net is of the values without their mean, that of digitised film is of the points, before resampling.
    unit : in which the file has the values, as it is spelled there.
    """

    component: str
    quantity: Quantity
    values: np.ndarray
    time_step: float
    begin: float = 0.0
    stated_peak: float | None = None
    unit: str = ""


@dataclass(frozen=True)
class Record:
    """The channels of a file.

    Attributes
    ----------
    format : its name: "PEER AT2", "CSMIP V1", …
    title : station, event and the like in one line, as the header states them.
    channels : in the order of the file; they may have different lengths and rates.
    remarks : one line for each contradiction between the header and the samples that does not prevent reading.
    chosen : what was taken for what, where the file could be read otherwise.
    """

    format: str
    title: str
    channels: tuple[Channel, ...]
    remarks: tuple[str, ...] = ()
    chosen: tuple[str, ...] = ()
