"""What studies ask of their users: fields with a default and the text of the help, each of which is an option.

Commands make options of these fields by `cli.options.with_tables`. As help and completion have to appear at once, this
module imports nothing that computes.
"""

from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple

Method = Literal["impedance", "ratio", "homogenised"]
"""Ways to find β."""

Ends = Literal["smooth", "grips"]
"""How platens hold the ends of a sample."""


class Asked(NamedTuple):
    """The option of a field: its help, what stands for its value, its least value, and the panel of the help."""

    help: str
    metavar: str | None = None
    least: float | None = None
    panel: str | None = None


@dataclass(frozen=True)
class Calibrating:
    """How factors of dashpots are calibrated."""

    method: Annotated[
        Method,
        Asked(
            "impedance: solve for β; ratio: multiply by M_out/M_in; homogenised: the matched β, no run.",
            metavar="METHOD",
        ),
    ] = "impedance"
    start: Annotated[float | None, Asked("First β; by default the case's own.")] = None
    tolerance: Annotated[float, Asked("Largest |M_out/M_in − 1| to accept.", least=1e-9)] = 1e-3
    full: Annotated[bool, Asked("The whole scene instead of a short strip.")] = False


AS_USUAL = Calibrating()

SAMPLES = "Samples and loading"
"""Panel of the help."""


@dataclass(frozen=True)
class Loading:
    """The size of a sample, and how it is loaded."""

    width: Annotated[
        float | None, Asked("Width of the sample (m); by default the case's.", least=0.0, panel=SAMPLES)
    ] = None
    height: Annotated[float | None, Asked("Height (m); twice a given width by default.", least=0.0, panel=SAMPLES)] = (
        None
    )
    ends: Annotated[Ends, Asked("Platens hold the normal motion only, or all.", panel=SAMPLES)] = "smooth"
    damp: Annotated[float, Asked("Local damping; strengths depend on it.", least=0.0, panel=SAMPLES)] = 0.7
    rate: Annotated[float | None, Asked("Strain rate (1/s); by default quasi-static.", least=0.0, panel=SAMPLES)] = None


USUAL_LOADING = Loading()
