"""The load factor of a run under the elastic law: the multiple of its waves up to which this law holds.

The law is linear, so the motion under f times the waves is u_rest + f·(u − u_rest). Every limit of a pair, also those
of sizes such as |F_s| ≤ μF_n, is one of straight lines in its stretch, shear and turn, which this motion meets at a
factor known in closed form. The least over all pairs, limits and steps is the load factor; it is 0 if a pair is at, or
beyond, a limit at rest.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.disks.material.at_rest import stressed
from dembound.disks.material.constants import bond_factors, brick_constants, ground_limits, strength_of
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.common import CHUNKS
from dembound.kernels.compiler.limits import in_columns
from dembound.kernels.compiler.start_strain import began_of
from dembound.kernels.load_factor import least_factors
from dembound.kernels.tables import Limits
from dembound.motion.kind import Finding
from dembound.motion.state import Arrays
from dembound.motion.trackers import Every, Run
from dembound.places import is_within
from dembound.table import EVERYWHERE, Box

LIMITS = ("opens", "slides", "slides", "breaks in tension", "breaks in tension", "breaks in shear", "breaks in shear")
"""Description of each limit of `limit_lines`."""

LOAD_FACTOR = "load factor"
"""Name of the finding."""


def limit_lines(constants: np.ndarray, limits: Limits) -> tuple[np.ndarray, np.ndarray]:
    """Limits of pairs as lines a·e + b·s + c·θ ≤ d in their stretch e (m), shear s (m) and turn θ.

    A closed contact opens at k_n(e − e_0) = 0, one with a gap closes there, e_0 being its overlap at the start, and a
    closed one slides at |k_s s| = μk_n(e_0 − e); bonds break at σ + |M|R̄/J = pb_ten with σ = k̄_n e, and at
    |k̄_s s| + σ tan pb_fa = pb_coh.

    Parameters
    ----------
    constants : (p, 15 or more), see kernels/contacts.py. limits : friction and strength, numbers or columns (p,).

    Returns (a, b, c) (p, 7, 3) in the order of `LIMITS`, and d (p, 7), infinite where a pair has no such limit.
    """
    rest, touch, normal, shear = constants[:, 2], constants[:, 3], constants[:, 5], constants[:, 6]
    bond, bond_shear, bending, per_area, per_section = constants[:, 7:12].T
    closed, zero = touch >= rest, np.zeros(len(constants))
    overlap = touch - rest
    acts, sticks = normal > 0.0, closed & (shear > 0.0)
    sense = np.where(closed, 1.0, -1.0)
    press = limits.friction * normal
    pulled, turned, sheared = bond * per_area, bending * per_section, bond_shear * per_area
    lines = [
        (sense * normal, zero, zero, np.where(acts, sense * normal * overlap, np.inf)),
        *((press, sign * shear, zero, np.where(sticks, press * overlap, np.inf)) for sign in (1.0, -1.0)),
        *((pulled, zero, sign * turned, np.where(bond > 0.0, limits.tension, np.inf)) for sign in (1.0, -1.0)),
        *(
            (limits.tan_fa * pulled, sign * sheared, zero, np.where(bond > 0.0, limits.cohesion, np.inf))
            for sign in (1.0, -1.0)
        ),
    ]
    slopes = np.array([np.column_stack(line[:3]) for line in lines])
    return np.ascontiguousarray(slopes.transpose(1, 0, 2)), np.column_stack([line[3] for line in lines])


class LoadFactor(Every):
    """Finds the load factor of a run, at every step.

    Parameters
    ----------
    case : with friction and strength. system : its parts; all pairs count that are in contact, or bonded, at the start.

    Attributes
    ----------
    factor : the least one so far, infinite for none.
    """

    name = "load_factor"

    def __init__(self, case: DiskCase, system: DiskSystem) -> None:
        super().__init__(1)
        scene = system.scene
        plain = brick_constants(scene.ground, gaps_close=True, locked_in=0.0)
        limits = ground_limits(scene.ground, scene.case.materials, strength_of)
        if scene.ground.is_layered:
            plain = np.column_stack([plain, *limits[:4]])
        self._pairs = []
        for part in system.disks.parts:
            constants, kind, _ = stressed(scene.ground, plain, part.assembly, scene.at_rest)
            pairs = part.pairs._replace(
                constants=np.ascontiguousarray(constants[:, :12]),
                began=began_of(constants),
                contact_type=kind.astype(np.uint32),
            )
            own = in_columns(constants[:, 15:], limits.geometry) if scene.ground.is_layered else limits
            bonds = bond_factors(scene.case, scene.ground, part.assembly, alike=part.name == "column")
            strength = 1.0 if bonds is None else bonds.at(part.assembly.pairs[:, 0], part.assembly.contact_type)
            if scene.intact is not None:  # bonds that do not break have no limit
                kept = scene.intact[part.nodes][part.assembly.pairs].any(axis=1)
                strength = np.where(kept, np.inf, strength)
            self._pairs.append((pairs, (*limit_lines(pairs.constants, own), strength)))
        self._least, self._where = np.empty(CHUNKS), np.empty((CHUNKS, 2), dtype=np.int64)
        self._rest = np.zeros((3, 0))
        self.factor = np.inf
        self._found = np.zeros(4, dtype=np.int64)  # step, part, pair, limit

    def see(self, run: Run) -> None:
        """Compare the pairs with their limits."""
        state = run.state
        if self._rest.size == 0:
            self._rest = state.layout.spread(state.datum)
        for number, (pairs, lines) in enumerate(self._pairs):
            least_factors(state.u, self._rest, pairs, *lines, self._least, self._where)
            chunk = int(np.argmin(self._least))
            least = max(0.0, float(self._least[chunk]))  # below 0 beyond a limit at rest
            if least < self.factor:
                self.factor = least
                self._found = np.array([state.step, number, *self._where[chunk]])

    def describe(self, run: Run) -> dict[str, Any] | None:
        """Factor, limit in words, time (s), place (m) and particles (2,) of the first pair; None if there is none."""
        if np.isinf(self.factor):
            return None
        step, part, pair, limit = self._found.tolist()
        (pairs, _), layout = self._pairs[part], run.state.layout
        particles = [int(layout.node[side[pair]]) for side in (pairs.first, pairs.second)]
        way = pairs.constants[pairs.contact_type[pair], :2]
        return {
            "factor": self.factor,
            "limit": limit_in_words(limit, pairs.constants[pairs.contact_type[pair]]),
            "time": step * run.time_step,
            "position": (run.scene.positions[particles[0]] + 0.5 * way).tolist(),
            "particles": particles,
        }

    def saved_arrays(self) -> Arrays:
        """The least factor found so far with its pair, and the next step."""
        return {**super().saved_arrays(), "factor": np.array(self.factor), "found": self._found}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        super().restore(saved)
        self.factor, self._found = float(saved["factor"]), saved["found"].copy()


def load_factor_of(run: Run) -> LoadFactor | None:
    """The tracker of a run that finds its load factor; None if it has none."""
    found = run.state.owners.get(LoadFactor.name)
    return found if isinstance(found, LoadFactor) else None


def least_load_factor(run: Run, inside: Box | None = None) -> dict[str, Finding]:
    """The load factor as a finding to compare between runs; empty without one, or if it is not reached inside."""
    tracker = load_factor_of(run)
    found = None if tracker is None else tracker.describe(run)
    if found is None or not is_within(inside or EVERYWHERE, found["position"], float(run.scene.size.max())):
        return {}
    return {LOAD_FACTOR: Finding(found["factor"], "1")}


def limit_in_words(limit: int, constants: np.ndarray) -> str:
    """Description of a limit of `limit_lines` for a pair with these constants (15,)."""
    has_gap = constants[3] < constants[2]
    return "closes" if limit == 0 and has_gap else LIMITS[limit]


def load_factor_in_words(found: Mapping[str, Any]) -> str:
    """A load factor of a summary as text."""
    if found["factor"] is None:
        return "the elastic law holds under any multiple of the waves"
    x, y = found["position"]
    if found["factor"] == 0.0:
        return f"the elastic law holds under no waves: at rest the pair at ({x:.4g}, {y:.4g}) m {found['limit']}"
    what = f"the pair at ({x:.4g}, {y:.4g}) m {found['limit']} at t = {found['time']:.4g} s"
    return f"the elastic law holds up to {found['factor']:.4g} times the waves, where {what}"
