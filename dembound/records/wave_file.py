"""A motion as the file of a wave that a case names."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from dembound.files import replacing
from dembound.records.processing import Motion

HEAD = "time (s),velocity (m/s)"
"""Line above the numbers."""


def write_wave(path: Path, motion: Motion, origin: Sequence[str]) -> None:
    """Write the velocity of a motion as CSV, completely or not at all, times counted from its first sample.

    origin : lines on where it is from; they and what was done are comments at the top. Raises FileNotFoundError if the
    folder of the path does not exist.
    """
    lines = [*origin, *motion.steps, f"times: from the first sample, {motion.time[0]:g} s of the record"]
    head = "".join(f"# {line}\n" for line in lines) + HEAD
    times = motion.time_step * np.arange(len(motion.time))
    columns = np.column_stack([times, motion.velocity + 0.0])
    with replacing(path) as file:
        np.savetxt(file, columns, "%.9g", ",", header=head, comments="", encoding="utf-8")
