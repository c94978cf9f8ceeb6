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
from dembound.disks.columns import COLUMNS
from dembound.disks.material.at_rest import stressed
from dembound.disks.material.constants import bond_factors, brick_constants, ground_limits, strength_of
from dembound.disks.material.grouped import BEFORE
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.common import CHUNKS
from dembound.kernels.compiler.start_strain import began_of
from dembound.kernels.load_factor import least_factors
from dembound.laws.law import columns_of, in_columns
from dembound.laws.linearpbond import BOND_LIMITS, limit_in_words, limit_lines
from dembound.motion.kind import Finding
from dembound.motion.trackers import Every, Run
from dembound.pairwise import STRAIN, of_law
from dembound.places import is_within
from dembound.table import EVERYWHERE, Box

LOAD_FACTOR = "load factor"
"""Name of the finding."""


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
    evolving = ("due", "factor", "_found")

    def __init__(self, case: DiskCase, system: DiskSystem) -> None:
        super().__init__(1)
        scene = system.scene
        plain = brick_constants(scene.inside, gaps_close=True, locked_in=0.0)
        materials = scene.case.materials if scene.groups is None else scene.groups.materials_at(case, BEFORE)
        limits = ground_limits(scene.inside, materials, strength_of)
        if scene.inside.is_layered:
            plain = np.column_stack([plain, *columns_of(limits)])
        self._pairs = []
        for part in system.disks.parts:
            constants, kind, _ = stressed(scene.inside, plain, part.assembly, scene.at_rest_of(part.name))
            constants, columns = np.split(constants, [scene.ground.law.width + STRAIN], axis=1)
            pairs = part.pairs._replace(
                constants=of_law(constants), began=began_of(constants), contact_type=kind.astype(np.uint32)
            )
            own = in_columns(columns, limits.geometry) if scene.inside.is_layered else limits
            bonds = bond_factors(scene.case, scene.ground, part.assembly, alike=part.name in COLUMNS)
            strength = 1.0 if bonds is None else bonds.at(part.assembly.pairs[:, 0], part.assembly.contact_type)
            if scene.intact is not None:  # bonds that do not break have no limit
                kept = scene.intact[part.nodes][part.assembly.pairs].any(axis=1)
                strength = np.where(kept, np.inf, strength)
            self._pairs.append((pairs, (*limit_lines(pairs.constants, own), BOND_LIMITS, strength)))
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
        constants = pairs.constants[pairs.contact_type[pair]]
        middle = (run.scene.positions[particles[0]] + 0.5 * constants[:2]).tolist()
        found = {"factor": self.factor, "limit": limit_in_words(limit, constants), "time": step * run.time_step}
        return found | {"position": middle, "particles": particles}


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


def load_factor_in_words(found: Mapping[str, Any]) -> str:
    """A load factor of a summary as text."""
    if found["factor"] is None:
        return "the elastic law holds under any multiple of the waves"
    x, y = found["position"]
    if found["factor"] == 0.0:
        return f"the elastic law holds under no waves: at rest the pair at ({x:.4g}, {y:.4g}) m {found['limit']}"
    what = f"the pair at ({x:.4g}, {y:.4g}) m {found['limit']} at t = {found['time']:.4g} s"
    return f"the elastic law holds up to {found['factor']:.4g} times the waves, where {what}"
