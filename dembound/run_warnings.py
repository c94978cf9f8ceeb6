"""What a run has shown that was probably not meant, from its finished record and its summary."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from dembound.any_scene import AnyScene
from dembound.bar.scene import BarScene
from dembound.bar.warnings import ends_too_soon, stress_beside_strength
from dembound.boundaries.viscous import Dashpots
from dembound.case import BarCase
from dembound.case.monitor import FREE_FIELD
from dembound.magnitudes import period_of, waves_used
from dembound.results import open_record
from dembound.scene import Scene

MOVING = 0.2
"""Share of a monitor's peak velocity by which it must move, and its velocity change, to count as moving.

Behind a pulse random packings leave a coda of some per cent, and sides whose factors are 1 return up to a sixth:
neither is what a run is made for. What moves by such a share and does not change is a steady motion: a piece in flight,
a grip, a body that drifts on its dashpots.
"""

LATELY, NOW = 0.1, 0.05
"""Last parts of a run: over the one a velocity must change, in the other it must be that large.

The one is half a period at least, as a velocity stands still for a moment at its crest.
"""

NOTHING = 0.05
"""Share of the strength that a tension must reach: what rings behind a pulse comes to some per cent of it."""

QUIET = 0.01
"""Share of the largest peak of all monitors below which one has not been reached by the motion."""


def run_warnings(scene: AnyScene, summary: Mapping[str, Any], record: Path) -> list[str]:
    """All of them, one line each, of a scene, its run's summary and its record."""
    with open_record(record) as file:
        found = [*_still_moving(scene, summary, file)]
        if isinstance(scene, BarScene):
            found += [*_torn_by_the_load(scene.case, summary), *_no_tension(scene.case, file)]
    return found


def _still_moving(scene: AnyScene, summary: Mapping[str, Any], file: h5py.File) -> Iterator[str]:
    """Monitors whose motion the end of the run cuts off, though it would come to an end."""
    braked = _braked(scene, summary, file)
    histories = {
        name: _largest_component(group["velocity"][:, :2])
        for name, group in file["histories"].items()
        if scene.monitors[name] in braked and not name.endswith(FREE_FIELD)
    }
    peaks = {name: float(np.abs(velocity).max()) for name, velocity in histories.items()}
    period = max((period_of(scene.case.wave[name]) for name in waves_used(scene.case)), default=0.0)
    lately = max(LATELY, min(0.5, 0.5 * period / summary["duration"]))
    moving = {}
    for name, velocity in histories.items():
        late, last = (velocity[-max(2, round(share * len(velocity))) :] for share in (lately, NOW))
        at_the_end = float(np.abs(last).max())
        if peaks[name] > QUIET * max(peaks.values()) and min(at_the_end, float(np.ptp(late))) > MOVING * peaks[name]:
            moving[name] = at_the_end / peaks[name]
    if moving:
        worst = max(moving, key=lambda name: moving[name])
        yield (
            f"monitor.{worst}: its velocity is {100.0 * moving[worst]:.0f} % of its peak when the run ends after "
            f"{summary['duration']:.3g} s, and still changes ({len(moving)} of {len(histories)} monitors); the motion "
            "is not over, take a longer run.duration"
        )


def _braked(scene: AnyScene, summary: Mapping[str, Any], file: h5py.File) -> set[int]:
    """Nodes from which motion is taken away: all under local damping, else those that hang together with dashpots.

    Pieces that have come off fly on and ring.
    """
    if scene.damp > 0.0:
        return set(range(scene.count))
    sides = [edge for side, edge in scene.edges.items() if isinstance(scene.case.boundary.get(side), Dashpots)]
    ends = np.concatenate([np.zeros(0, dtype=np.int64), *(edge.nodes for edge in sides)])
    if isinstance(scene, BarScene):
        cuts = np.array([spall["end"] for spall in summary["spalls"]]).reshape(-1, 2).mean(axis=1)
        pieces = np.searchsorted(np.sort(cuts), scene.positions[:, 0])
    else:
        pieces = _pieces(scene, file["cracks/particles"][:])
    return set(np.flatnonzero(np.isin(pieces, pieces[ends])).tolist())


def _pieces(scene: Scene, broken: np.ndarray) -> np.ndarray:
    """Number (n,) of the piece that each particle belongs to, joined by the pairs of the start that have not broken.

    broken (k, 2) particles.
    """
    pairs = np.sort(scene.assembly.pairs.astype(np.int64), axis=1)
    left = pairs[~np.isin(pairs @ [scene.count, 1], np.sort(broken, axis=1) @ [scene.count, 1])]
    joined = coo_matrix((np.ones(len(left)), left.T), shape=(scene.count, scene.count))
    return connected_components(joined, directed=False)[1]


def _largest_component(velocity: np.ndarray) -> np.ndarray:
    """Of velocities (k, 2) the component (k,) that comes to the largest value."""
    return velocity[:, int(np.abs(velocity).max(axis=0).argmax())]


def _torn_by_the_load(case: BarCase, summary: Mapping[str, Any]) -> Iterator[str]:
    """A first spall where a load acts, before any wave can be back there."""
    if not summary["spalls"]:
        return
    first, bar, horizon = summary["spalls"][0], case.bar, case.method.largest_horizon
    near = horizon * bar.length / bar.cells
    for load in case.load:
        start = case.wave[load.wave].start
        distance = first["start"][0] if load.side == "left" else bar.length - first["start"][1]
        if distance < near and first["time"] < start + 2.0 * bar.length / bar.speed:
            cure = f"give load.{load.name}.nodes = {horizon}" if load.nodes < horizon else "take a smaller bar.spacing"
            yield (
                f"load.{load.name}: the load itself tore the bar, at {first['time']:.4g} s and {distance:g} m from the "
                f"loaded end, before any wave was back there; {cure}"
            )


def _no_tension(case: BarCase, file: h5py.File) -> Iterator[str]:
    """A bar with a strength that no recorded tension comes near.

    Silent where a warning before the run has said so.
    """
    strength = case.bar.breaking_stretch * case.bar.modulus
    foreseen = [*stress_beside_strength(case), *ends_too_soon(case)]
    if np.isinf(strength) or len(file["cracks/time"]) > 0 or foreseen:
        return
    groups = [*file["histories"].values(), *file["snapshots"].values()]
    tension = max(0.0, *(float(np.max(group["stress"][:])) for group in groups))
    if tension < NOTHING * strength:
        yield (
            f"bar: the largest tension reached is {tension:.3g} Pa, {100.0 * tension / strength:.2g} % of the "
            f"strength, {strength:g} Pa; nothing can break"
        )
