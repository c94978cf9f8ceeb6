"""The largest stable time step, from the largest eigenfrequency of the scene."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.disks.contacts.dashpots import brick_dashpots
from dembound.disks.contacts.layout import contact_rows
from dembound.disks.faces.springs import filling_springs
from dembound.disks.loose import beyond_neighbours, loose_eigenvalue, loose_modes, loose_viscosity, reserve
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.damped_ground import growing_by_lag
from dembound.disks.stepping.system import DiskSystem
from dembound.errors import CaseError, RunError
from dembound.kernels.compiler.start_strain import began_with
from dembound.kernels.contacts import CLOSING
from dembound.kernels.elastic import contact_forces
from dembound.laws import Stiffness
from dembound.motion.stability import largest_eigenvalue
from dembound.motion.state import Layout
from dembound.motion.trackers import Every, Run
from dembound.pairwise import P

OPENING = 0.75 / CLOSING
"""Largest ω² over 4/Δt² where contacts open and close: sin²(π/3), for first pushes multiplied by CLOSING.

A contact that opens and closes creates overtones of every motion. At ωΔt = 2 sin(π/3) a motion has three steps per
period, and its overtone, sampled at whole steps, equals the motion running backwards. They amplify each other, and
energy grows by orders of magnitude within a thousand steps. Below this limit the loss at closing
(`kernels.contacts.CLOSING`) exceeds the gain.
"""


Filling = Callable[[np.ndarray, np.ndarray], None]
"""Fills or changes its second argument (3, slots) with forces at displacements, its first one."""

MOST_ROUNDS, CONVERGED = 40, 1e-3
"""Rounds, and relative change of ω² at which they end, of the step limit where dashpots depend on it."""


def step_limit(scene: DiskScene, damp: float | None = None, *, viscous: bool = True) -> float:
    """Largest stable step 2/(ω_max √(1 + damp)) of central differences (s).

    damp is the local damping coefficient, None: the material's. At the limit, forces are opposite to velocities at
    every step, so local damping multiplies them by 1 + damp.

    ω_max² is the largest eigenvalue of M⁻¹K of the assembled scene with held and prescribed components taken out;
    centred dashpots do not change it. Under a history-dependent law the limit also holds for loose disks, and ω_max² is
    multiplied by 1.4 where contacts may open (`OPENING`).

    Dashpots C of contacts are half a step behind: in place of K stands K + 2C/Δt, whose largest eigenvalue is at most
    the sum of those of both. Where they act on unbonded contacts alone, the step must be stable in loose ground, see
    `loose_modes`, and where some bonds are broken, see `_partly_broken`. Resistance to rolling does not shorten it, see
    `loose_eigenvalue`. Rayleigh damping shortens it too, see `_with_lag`. viscous : whether these two act.

    A wall counts as a neighbour, see `beyond_neighbours`.

    Raises RunError when the iteration for the eigenvalue does not converge.
    """
    bounds, instead = [(_largest_eigenvalue(scene), 0.0)], False
    if scene.has_history:
        zones, dashed = scene.inside.zone_materials, viscous and scene.case.material.has_dashpots
        instead = dashed and not scene.case.damps_bonds
        opens = any(layer.moduli.emod > 0.0 or layer.overlaps is not None for layer in scene.inside.materials)
        if dashed and scene.case.damps_bonds:
            bounds = [(bounds[0][0], _largest_viscosity(scene))]
        for zone in zones:
            bounds += [(loose_eigenvalue(zone), loose_viscosity(scene, zone) if dashed and not instead else 0.0)]
            bounds += loose_modes(scene, zone) if instead else []
        stiffer, slower = beyond_neighbours(scene)
        bounds = [(largest + stiffer, slows + slower * viscous) for largest, slows in bounds]
        bounds = [(largest / (OPENING if opens or scene.case.wall else 1.0), slows) for largest, slows in bounds]
    damp = 1.0 + (scene.case.material.damp if damp is None else damp)
    bounds = [(largest * damp, slows * damp) for largest, slows in bounds]
    limit = min(_step_of(*bound) for bound in bounds)
    if instead:
        limit = _partly_broken(scene, *bounds[0], limit, damp, OPENING if opens or scene.case.wall else 1.0)
    return _with_lag(scene, limit) if viscous else limit


def _step_of(largest: float, slows: float) -> float:
    """The step Δt (s) at which Δt² largest + 2 Δt slows is 4: largest eigenvalues of M⁻¹K (1/s²) and M⁻¹C (1/s)."""
    if slows == 0.0:
        return float(2.0 / np.sqrt(largest)) if largest > 0.0 else np.inf
    return float(4.0 / (slows + np.sqrt(slows**2 + 4.0 * largest)))


def viscous_share(scene: DiskScene) -> float:
    """Step limit of a scene over the one that it would have without Rayleigh damping and dashpots of contacts."""
    return step_limit(scene) / step_limit(scene, viscous=False)


def _largest_viscosity(scene: DiskScene, of: Callable[[tuple[int, int]], Stiffness] | None = None) -> float:
    """The largest eigenvalue of M⁻¹C (1/s) of the dashpots of all contacts, closed as they are built.

    of : gives what stands in place of dashpots for contacts between two zones.
    """
    count, of = scene.disk_count, of or partial(brick_dashpots, scene.inside, scene.case.material)
    tables = [contact_rows(scene.assembly.part(disks), scene.inside, disks.start, of) for disks in scene.parts.values()]

    def fill(u: np.ndarray, force: np.ndarray) -> None:
        for rows in tables:
            contact_forces(u, rows, force)

    moves = np.ones((3, count), dtype=bool)
    return largest_eigenvalue(Layout.plain(count), scene.mass[:count], scene.inertia[:count], scene.free, moves, fill)


def _partly_broken(scene: DiskScene, largest: float, slows: float, limit: float, damp: float, opening: float) -> float:
    """The step (s), at most `limit`, where some contacts have bonds k̄, and others have dashpots c instead.

    largest, slows : eigenvalues with all bonds, as of `_step_of`. In place of (k + k̄)/OPENING of a contact stands
    k/OPENING + 2c/Δt, larger by 2c/Δt − k̄/OPENING if that is positive. The sum of the eigenvalues with all bonds and of
    this alone is a bound. As Δt is on both sides of the equation, it is found by iteration from above.
    """
    ground, step = scene.inside, limit
    radii = ground.brick.radii[ground.brick.pairs].T

    def excess(pairing: tuple[int, int]) -> Stiffness:
        constants = ground.pair_constants((radii[0], radii[1]), ground.brick.vectors, pairing, gaps_close=False)
        own = brick_dashpots(ground, scene.case.material, pairing)
        normal, shear = (
            np.maximum(2.0 * rate / step - ground.law.column(constants, name) / opening, 0.0)
            for name, rate in (("bond_kn", own.normal), ("bond_ks", own.shear))
        )
        return replace(own, normal=normal, shear=shear)

    for _ in range(MOST_ROUNDS):
        before = step
        if any(each.normal.any() or each.shear.any() for each in map(excess, ground.pairings)):
            step = min(limit, _step_of(largest + damp * _largest_viscosity(scene, excess), slows))
        if step >= before * (1.0 - CONVERGED):
            return step
    raise RunError("the step limit with dashpots of contacts has not converged; give a smaller dp_nratio")


def _with_lag(scene: DiskScene, limit: float) -> float:
    """The limit (s) with forces f + β(f − f')/Δt, where f' are those one step earlier; limit : that without them.

    At the limit motions change their sign in every step, so that forces are (1 + 2β/Δt)f: Δt² + 2βΔt = 4/ω². Where β
    differs between layers, Δt is found by iteration from that of the largest β, which is too short.
    """
    lags = np.array([0.0 if each is None else each.lag for each in scene.ground.mechanisms_by_layer])
    x = lags.max() / limit
    step = limit * float(np.sqrt(1.0 + x * x) - x) if lags.any() else limit
    if lags.min() == lags.max():
        return step
    for _ in range(MOST_ROUNDS):
        fill = filling_forces(scene, growing_by_lag(scene, lags, step))
        found = largest_eigenvalue(scene.layout, scene.mass, scene.inertia, scene.free, scene.moves, fill)
        before, step = step, max(step, float(2.0 / np.sqrt(found)))
        if step <= before * (1.0 + CONVERGED):
            return step
    raise RunError("the step limit with Rayleigh damping has not converged; give all layers one quality_factor")


def _largest_eigenvalue(scene: DiskScene) -> float:
    """The largest eigenvalue of M⁻¹K (1/s²), see `motion.stability`.

    With continua delays count as less mass, and dashpots of ties as more stiffness: one ηK that is half a step behind
    as a spring of K·2η/Δt beside K. So the step is on both sides of the equation, and is found by iteration from below:
    each larger step makes the ties less stiff.
    """
    continua, fill = scene.continua, filling_forces(scene)
    if not continua:
        return largest_eigenvalue(scene.layout, scene.mass, scene.inertia, scene.free, scene.moves, fill)
    mass = np.concatenate([scene.mass[: scene.disk_count], *(each.body.mass_for_limit for each in continua)])
    moving = scene.layout.spread(scene.moves.astype(float))  # ties and continua also push what does not move
    adding = [each.adds_forces(scene.layout) for each in continua]
    times, largest = 1.0, 0.0
    for _ in range(MOST_ROUNDS):

        def forces(u: np.ndarray, force: np.ndarray, times: float = times) -> None:
            fill(u, force)
            for add in adding:
                add(u, force, times)
            force *= moving

        found = largest_eigenvalue(scene.layout, mass, scene.inertia, scene.free, scene.moves, forces)
        if found <= largest * (1.0 + CONVERGED):
            return max(found, largest)
        largest = found
        times = 1.0 + continua[0].wall.lag * float(np.sqrt(largest))
    raise RunError("the step limit with ties to a continuum has not converged; outside.element may be too small")


def fill_forces(scene: DiskScene, u: np.ndarray, force: np.ndarray) -> None:
    """Fill force (3, slots) with the forces at displacements u: of contacts, of supports, none where prescribed."""
    filling_forces(scene)(u, force)


def filling_forces(scene: DiskScene, change: Filling | None = None) -> Filling:
    """`fill_forces` of a scene, to be called often; change : of the forces of contacts."""
    supports = scene.supports
    acting = np.flatnonzero(supports.prescribed | (supports.stiffness != 0.0))
    place = supports.component[acting], scene.layout.slot[supports.node[acting]]
    stiffness, prescribed = supports.stiffness[acting], supports.prescribed[acting]
    # relative springs are never stiffer than springs on the motion itself
    bearing = None if scene.bearing is None else (scene.layout.slot[scene.bearing.node], scene.bearing.stiffness.T)

    # fast motion meets unrelaxed springs; of layers all are as much stiffer as those with the lowest quality factor
    relaxed = [each.relaxed for each in scene.ground.mechanisms_by_layer if each is not None and scene.ground.relaxes]

    joints = filling_springs(scene.faces, scene.assembly.positions, scene.layout.slot)

    def fill(u: np.ndarray, force: np.ndarray) -> None:
        for rows in scene.rows:
            contact_forces(u, rows, force)
        if relaxed:
            force /= min(relaxed)
        joints(u, force)
        if change is not None:
            change(u, force)
        if bearing is not None:
            force[:2, bearing[0]] -= bearing[1] * u[:2, bearing[0]]
        force[place] = np.where(prescribed, 0.0, force[place] - stiffness * u[place])

    return fill


def largest_overlap(scene: DiskScene, step: float, damp: float | None = None) -> float:
    """Overlap (m) of contacts up to which a step (s) is stable; infinite where their stiffness does not grow with it.

    damp : local damping coefficient, which shortens the limit; None: the material's, with dashpots of contacts.

    The stiffness grows with the root of the overlap, so that the overlap goes with the power −4 of the step, also with
    dashpots, whose viscosity grows with the root of the stiffness.
    """
    ground = scene.ground
    if ground.overlaps is None:
        return float("inf")
    dashed = loose_viscosity(scene, ground) if damp is None and scene.case.material.has_dashpots else 0.0
    more = 1.0 + (scene.case.material.damp if damp is None else damp)
    limit = _step_of(loose_eigenvalue(ground) / OPENING * more, dashed * more)
    return reserve(ground) * (limit / step) ** 4


LOOKS = 64
"""Steps between two looks at overlaps, a few of the shortest period of the contacts."""


class Overlaps(Every):
    """Stops a run in which contacts overlap so far that the step is not stable.

    Parameters
    ----------
    most : overlap (m) that is allowed.
    """

    name = "overlaps"

    def __init__(self, most: float) -> None:
        super().__init__(LOOKS)
        self._most = most

    def see(self, run: Run) -> None:
        """Raise RunError, with time and place, for a contact that is too stiff for the step."""
        system, u = run.system, run.state.u
        assert isinstance(system, DiskSystem)
        for part in system.disks.parts:
            pairs = part.pairs
            rows = pairs.constants[pairs.contact_type]
            x, y = (rows[:, :2] + (u[:2, pairs.second] - u[:2, pairs.first]).T).T
            began = began_with(pairs.began, pairs.contact_type, 0)
            overlap = rows[:, P.touch] - np.hypot(x, y) - began
            if overlap[most := int(np.argmax(overlap))] > self._most:
                place = run.scene.positions[run.scene.layout.node[pairs.first[most]]]
                shorter = run.time_step * (self._most / overlap[most]) ** 0.25
                raise RunError(
                    f"contacts have become too stiff for the time step: at t = {run.time:g} s near ({place[0]:.4g}, "
                    f"{place[1]:.4g}) m one overlaps by {overlap[most]:.3g} m, the step of {run.time_step:.3g} s is "
                    f"stable up to {self._most:.3g} m; give run.time_step = {0.5 * shorter:.2g}, or slower disks"
                )


def own_step(case: DiskCase, limit: float) -> float:
    """The time step (s) of the case at a stability limit (s): a share of it, or the given step, even above it.

    Raises CaseError when the step is automatic and nothing can vibrate.
    """
    requested = case.run.time_step
    if requested != "auto":
        return float(requested)
    step = case.run.safety * limit
    if not np.isfinite(step):
        raise CaseError(["run.time_step: is auto but nothing in the scene can vibrate, give a step in s"])
    # cut to four digits, as the last bits of an eigenvalue depend on the machine's instructions
    unit = 10.0 ** (np.floor(np.log10(step)) - 3)
    return float(np.floor(step / unit) * unit)


def choose_step(scene: DiskScene) -> tuple[float, float]:
    """Time step to run with and the stability limit (s).

    Raises CaseError when the case gives a step above the limit.
    """
    limit = step_limit(scene)
    step = own_step(scene.case, limit)
    if step > limit:
        raise CaseError([f"run.time_step: is {step:g} s, must not be above the stability limit {limit:.6g} s"])
    return step, limit
