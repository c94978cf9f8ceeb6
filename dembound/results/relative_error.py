"""The relative error of a motion at a monitor, the one that compare, chart, estimate and advise print.

It is the RMS of the error over the RMS of the motion, both along the axis, x or y, on which the motion has its largest
value. Of two runs the reference is the motion, of an estimate the run itself.

One component is taken, not the vector: the formulas and companions of estimates give errors of P and S waves along
their axes, and were checked against true errors of that component. Beside a vector, whose smaller component counts
less, they would be other numbers: of the velocity under a hammer 39 % in place of 46 %. What the error of the smaller
component is over its own motion is another question, which `compare` answers in a column of its own.
"""

import numpy as np


def largest_component(motion: np.ndarray) -> int:
    """The column of a motion (k, c), 0 along x or 1 along y, with the largest value; 0 without samples."""
    return int(np.argmax(np.abs(motion[:, :2]).max(axis=0, initial=0.0)))


def relative_error(error: np.ndarray, motion: np.ndarray) -> float:
    """RMS of an error (k,) over the RMS of the motion (k,) along the same axis; nan at rest."""
    size = float(np.linalg.norm(motion))
    return float(np.linalg.norm(error)) / size if size > 0.0 else np.nan


def peak_error(error: np.ndarray, motion: np.ndarray) -> float:
    """Largest value of an error (k,) over that of the motion (k,) along the same axis; nan at rest."""
    size = float(np.abs(motion).max(initial=0.0))
    return float(np.abs(error).max()) / size if size > 0.0 else np.nan
