"""Warnings from the finished record of a run, for all kinds of bodies."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from dembound.boundaries import driven_components
from dembound.casefile.magnitudes import waves_used
from dembound.motion.energy import opposed
from dembound.motion.scene import Scene
from dembound.results.compare import largest_component
from dembound.results.reader import energy_of
from dembound.words import percent

if TYPE_CHECKING:
    import h5py

MOVING = 0.2
"""Share of a monitor's peak velocity that its velocity, and the change of it, must exceed to count as moving.

Behind a pulse, random packings have a coda of some per cent, and sides with factors of 1 reflect up to a sixth; both
are below this share. A velocity above this share that does not change is a steady motion of a piece in flight, a grip,
or a body that drifts on its dashpots.
"""

LATELY, NOW = 0.1, 0.05
"""Last parts of a run: the velocity must change over the first part, and must be large in the second.

The first is at least half a period, as the velocity hardly changes near its crest.
"""

UNEXPLAINED = 0.01
"""Share of the supplied energy that may be lost by the length of the step, or be unaccounted for, without a warning."""

QUIET = 0.01
"""Share of the largest known velocity; a monitor with a smaller peak has not been reached by the motion.

The largest known velocity is the largest peak of all monitors, or, if larger, the root mean square velocity of the
whole body at any time of the ledger, which part of the body exceeds."""


def still_moving(
    scene: Scene, duration: float, file: h5py.File, pieces: np.ndarray, at_rest: float = 0.0
) -> Iterator[str]:
    """A warning about monitors that still move at the end of the run and would come to rest later.

    A test to failure ends in motion and has none.

    duration : of the run, s. file : its open record. pieces : (n,) number of the piece of each node at the end. at_rest
    : m/s, velocity of bodies at rest.
    """
    braked = _braked(scene, pieces)
    histories = {
        name: (velocity := group["velocity"][:, :2])[:, largest_component(velocity)]
        for name, group in file["histories"].items()
        if name in scene.places and (name in scene.between or braked[scene.monitors[name]])
    }
    peaks = {name: float(np.abs(velocity).max()) for name, velocity in histories.items()}
    period = max((scene.case.wave[name].dominant_period() for name in waves_used(scene.case)), default=0.0)
    lately = max(LATELY, min(0.5, 0.5 * period / duration))
    moving = {}
    if scene.case.run.is_test or max(peaks.values(), default=0.0) <= at_rest:
        return
    quiet = QUIET * max(*peaks.values(), _mean_velocity(scene, file))
    for name, velocity in histories.items():
        late, last = (velocity[-max(2, round(share * len(velocity))) :] for share in (lately, NOW))
        at_the_end = float(np.abs(last).max())
        if peaks[name] > quiet and min(at_the_end, float(np.ptp(late))) > MOVING * peaks[name]:
            moving[name] = at_the_end / peaks[name]
    if moving:
        worst = max(moving, key=lambda name: moving[name])
        yield (
            f"monitor.{worst}: its velocity is {100.0 * moving[worst]:.0f} % of its peak when the run ends after "
            f"{duration:.3g} s, and still changes ({len(moving)} of {len(histories)} monitors); "
            f"{_why_moving(scene)}"
        )


def _mean_velocity(scene: Scene, file: h5py.File) -> float:
    """The largest root mean square velocity (m/s) of the body in its ledger; 0 without a ledger."""
    kinetic = file["energy/kinetic"][:] if "energy/kinetic" in file else np.zeros(0)
    return math.sqrt(2.0 * max(0.0, float(kinetic.max(initial=0.0))) / float(scene.mass.sum()))


def _why_moving(scene: Scene) -> str:
    """Reason why waves stay in a damped body, in words: opposite sides that reflect them, or too short a run."""
    motion, kept = getattr(scene.case, "motion", None), []
    for axis, pair in (("x", ("left", "right")), ("y", ("bottom", "top"))):
        if motion is not None and axis in motion.held:
            continue
        tables = [scene.case.side(side) for side in pair if side in scene.edges]
        if len(tables) == 2 and not any(table.absorbs for table in tables):
            kept.append(" and ".join(f"{side} ({table.type})" for side, table in zip(pair, tables, strict=True)))
    if not kept:
        return "the motion is not over, take a longer run.duration"
    return (
        f"the motion is not over: waves between {', and between '.join(kept)} are not absorbed there, and fade only as "
        "far as they reach sides that absorb; give these sides an absorbing type, as a longer run.duration may not help"
    )


def share_of_supplied(energy: float, supplied: float) -> str:
    """An energy in words, as a share of the supplied energy, which may be 0; both in one unit."""
    return f"{percent(energy / supplied)} of the supplied energy" if supplied > 0.0 else "energy though none came in"


def energy_warnings(scene: Scene, energy: Mapping[str, float], file: h5py.File) -> Iterator[str]:
    """Warnings about energy lost or gained by the length of the step, about unaccounted energy, and terms that cancel.

    energy : the entry of the summary. file : the open record.
    """
    supplied, closing = energy["supplied"], energy["closing"]
    high, low, share = opposed(energy_of(file))
    if share > 1.0:
        yield (
            f"energy.{low}: is opposite to {high}, both up to {share:.3g} times all the energy there was: velocities "
            "and forces swing from step to step by more than waves do; take shorter steps, or waves that rise slower"
        )
    if abs(closing) > UNEXPLAINED * supplied:
        key = "safety" if scene.case.run.time_step == "auto" else "time_step"
        yield (
            f"run.{key}: contacts that open and close within a step have {'taken' if closing > 0.0 else 'added'} "
            f"{share_of_supplied(abs(closing), supplied)}; shorter steps change it less"
        )
    if (error := energy["relative_error"]) > UNEXPLAINED:
        yield f"energy.error: {percent(error)} of the supplied energy is unaccounted for; take shorter steps"


def never_silent(scene: Scene, ended: object, file: h5py.File) -> Iterator[str]:
    """A warning about a run that should have ended when all monitors were silent, and did not.

    ended : the entry of the summary on an early end, None for a whole run. file : its open record.
    """
    run = scene.case.run
    if run.until != "silent" or ended is not None:
        return
    shares = {}
    for name in (monitor.name for monitor in scene.case.monitor):
        speed = np.abs(file[f"histories/{name}/velocity"][:, :2]).max(axis=1)
        late = float(speed[-max(1, round(NOW * len(speed))) :].max())
        shares[name] = late / float(speed.max()) if late > 0.0 else 0.0
    loudest = max(shares, key=lambda name: shares[name])
    why = f"the velocity of monitor.{loudest} is still {percent(shares[loudest])} of its peak"
    if shares[loudest] <= run.silent_level:
        why = "not all were so for long enough, or waves had not passed them all"
    yield (
        f'run.until: is "silent", but the run went on for its whole duration, {run.duration:g} s: the monitors did not '
        f"become silent ({100.0 * run.silent_level:g} % of their peaks), {why}; take a longer run.duration or a higher "
        "run.silent_level"
    )


def never_past_peak(scene: Scene, ended: object, file: h5py.File) -> Iterator[str]:
    """A warning about a run that should have ended past the peak of the forces on driven sides; see `never_silent`."""
    run, high = scene.case.run, []
    if run.until != "peak" or ended is not None:
        return
    for side, axis in driven_components(scene.case.boundary):
        force = file[f"boundaries/{side}/force"][:, axis]
        added = np.abs(force - force[0])
        high.append(f"{percent(float(added[-1] / added.max()) if added.any() else 0.0)} on {side}")
    yield (
        f'run.until: is "peak", but the run took its whole duration, {run.duration:g} s: the forces at its end are '
        f"{', '.join(high)} of their peaks; take a longer run.duration, faster platens or a higher run.peak_share"
    )


def _braked(scene: Scene, pieces: np.ndarray) -> np.ndarray:
    """The nodes (n,) bool whose motion is damped: all with local damping, else nodes connected to absorbing sides.

    Pieces that have broken off continue to move and vibrate.
    """
    if scene.damp > 0.0:
        return np.ones(scene.count, dtype=np.bool_)
    tables = {side: scene.case.side(side) for side in scene.edges}
    sides = [scene.edges[side] for side, table in tables.items() if table.absorbs]
    ends = np.concatenate([np.zeros(0, dtype=np.int64), *(edge.nodes for edge in sides)])
    return np.isin(pieces, pieces[ends])
