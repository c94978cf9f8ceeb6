"""Records of disks as estimates read them: velocities and displacements along x and y."""

from dataclasses import replace

from dembound.accuracy.runner import Run, measure
from dembound.casefile import Case
from dembound.formulas.history import History, Motions
from dembound.running import Progress


def in_plane(motions: Motions) -> dict[str, History]:
    """Motions without rotations."""
    return {
        name: replace(own, values={quantity: own.values[quantity][:, :2] for quantity in ("velocity", "displacement")})
        for name, own in motions.items()
    }


def ran(case: Case) -> Run:
    """The outcome of a run."""
    return measure(case, Progress())[0]


def recorded(case: Case) -> dict[str, History]:
    """The motions of a run without rotations."""
    return in_plane(ran(case).motions)
