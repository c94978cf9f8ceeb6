"""PFC's linear parallel-bond law: contacts without tension and with friction, bonds with a strength.

A contact resists overlap and the part of the motion of its surfaces that has not slid, N = k_n a and S = k_s (s − slip)
up to |S| = μN. A bond resists stretch e, shear s and rotation θ from the start, and breaks where σ + pb_mcf |M|R̄/J
reaches pb_ten or |τ| reaches pb_coh − σ tan pb_fa, with σ = k̄_n e and τ = k̄_s s. At rest the stiffness is that of the
elastic law, whose constants it has.

With rr_fric a closed contact without a bond also resists rolling, as PFC's rolling resistance linear model: by a moment
k_r times the rotation that has not slid, k_r = k_s R̄², up to rr_fric R̄ N, with R̄ = R₁R₂/(R₁ + R₂) (J. Ai et al.,
Powder Technology 206, 2011, model C without its damper).
"""

from typing import ClassVar

import numpy as np

from dembound.laws.elastic import Elastic
from dembound.laws.law import AnyLimits, K, Limits, RollingLimits
from dembound.pairwise import at_most, is_pair_law, limit_of, magnitude


class LinearPBond(Elastic):
    """The springs of the elastic law, in a history-dependent law."""

    name: ClassVar[str] = "linearpbond"
    has_history: ClassVar[bool] = True
    relaxes: ClassVar[bool] = True
    rolls: ClassVar[bool] = True
    elsewhere: ClassVar[tuple[str, ...]] = (
        "linear_parallel_bond",
        "parallel_bond",
        "pbond",
        "linearparallelbond",
        "parallelbond",
    )
    help: ClassVar[str] = "contacts open and slip, bonds break for good"

    @property
    def linear(self) -> str:
        """Name of the elastic law."""
        return Elastic.name

    def limits(self, strength: AnyLimits) -> AnyLimits:
        """All limits, but without rolling if contacts do not resist it."""
        if isinstance(strength, Limits) or np.any(strength.rolling):
            return strength
        return Limits(**{name: value for name, value in strength._asdict().items() if name != "rolling"})


def acts(limits, constants, k):
    """See pair_law.acts."""
    return constants[k, K.kn] > 0.0 or constants[k, K.ks] > 0.0


def normal(limits, constants, k, overlap):
    """N = k_n a, see pair_law.normal."""
    return constants[k, K.kn] * overlap


def stored_between(limits, constants, k, before, now):
    """½k_n (a₂² − a₁²), see pair_law.stored_between."""
    return 0.5 * (constants[k, K.kn] * ((now - before) * (now + before)))


def shear_of(limits, constants, k, overlap, shear, slip):
    """S = k_s (s − slip), see pair_law.shear_of."""
    return constants[k, K.ks] * (shear - slip)


def slip_at(limits, constants, k, overlap, shear, force):
    """The slip s − S/k_s, see pair_law.slip_at."""
    return shear - force * (1.0 / constants[k, K.ks])


def most_shear(limits, kind, push):
    """Friction, μN, see pair_law.most_shear."""
    return limit_of(limits.friction, kind) * push


def bond(limits, constants, k, stretch, shear, turn):
    """Forces of three springs, see pair_law.bond."""
    return constants[k, K.bond_kn] * stretch, constants[k, K.bond_ks] * shear, constants[k, K.bending] * turn


def breaks(limits, constants, k, kind, factor, pull, side, moment):
    """Stresses at the edge of the bond beside its strengths, see pair_law.breaks."""
    stress = pull * constants[k, K.per_area]
    edge = stress + magnitude(moment) * constants[k, K.per_section]
    strength = factor * limit_of(limits.cohesion, kind) - stress * limit_of(limits.tan_fa, kind)
    sheared = magnitude(side) * constants[k, K.per_area]
    return at_most(factor * limit_of(limits.tension, kind), edge), at_most(strength, sheared)


def rolls(limits):
    """See pair_law.rolls."""
    return True


def rolling(limits, constants, k):
    """k_s R̄² and R̄ of disks that, if they overlap at the start, just touch there; see pair_law.rolling."""
    offset, both = constants[k, K.offset], constants[k, K.touch]
    radius = 0.25 * both - offset * offset / both
    return constants[k, K.ks] * (radius * radius), radius


def most_moment(limits, kind, radius, push):
    """rr_fric R̄ N, see pair_law.most_moment."""
    return limit_of(limits.rolling, kind) * (radius * push)


def contact_energy(limits, constants, k, overlap, slid):
    """½k_n a² + ½k_s s², see pair_law.contact_energy."""
    return 0.5 * (constants[k, K.kn] * overlap * overlap + constants[k, K.ks] * slid * slid)


def bond_energy(limits, constants, k, stretch, shear, turn):
    """Energy of three springs, see pair_law.bond_energy."""
    along = constants[k, K.bond_kn] * stretch * stretch + constants[k, K.bond_ks] * shear * shear
    return 0.5 * along + 0.5 * constants[k, K.bending] * turn * turn


def contact_room(limits, constants, k, kind, overlap, stuck):
    """Up to no overlap, and up to friction, which changes with the overlap, too; see pair_law.contact_room."""
    room = overlap
    ks = constants[k, K.ks]
    if ks > 0.0:
        most = limit_of(limits.friction, kind) * constants[k, K.kn]
        room = min(room, (most * overlap - ks * abs(stuck)) / (ks + most))
    return room


def bond_room(limits, constants, k, kind, factor, stretch, shear, turn):
    """Up to the strengths; stretch, shear and R̄θ change by at most the relative motion; see pair_law.bond_room."""
    per_area = constants[k, K.per_area]
    stress = constants[k, K.bond_kn] * stretch * per_area
    turned = constants[k, K.bending] * constants[k, K.per_section] * abs(turn)
    normal = constants[k, K.bond_kn] * per_area  # per length: tension k̄ and bending k̄ R̄·(1/R̄) alike
    sheared = constants[k, K.bond_ks] * per_area
    pressed = limit_of(limits.tan_fa, kind)
    torn = (factor * limit_of(limits.tension, kind) - stress - turned) / (2.0 * normal)
    strength = factor * limit_of(limits.cohesion, kind) - stress * pressed - sheared * abs(shear)
    return min(torn, strength / (sheared + normal * pressed))


FUNCTIONS = {
    each.__name__: each
    for each in (
        *(acts, normal, stored_between, shear_of, slip_at, most_shear, bond, breaks),
        *(contact_energy, bond_energy, contact_room, bond_room),
    )
}
is_pair_law(Limits, **FUNCTIONS)
is_pair_law(RollingLimits, **FUNCTIONS, rolls=rolls, rolling=rolling, most_moment=most_moment)


LIMITS = ("opens", "slides", "slides", "breaks in tension", "breaks in tension", "breaks in shear", "breaks in shear")
"""Description of each limit of `limit_lines`."""

BOND_LIMITS = 3
"""Number of the first limit of bonds, whose strengths scatter."""


def limit_lines(constants: np.ndarray, limits: AnyLimits) -> tuple[np.ndarray, np.ndarray]:
    """Limits of pairs as lines a·e + b·s + c·θ ≤ d in their stretch e (m), shear s (m) and turn θ.

    A closed contact opens at k_n(e − e_0) = 0, one with a gap closes there, e_0 being its overlap at the start, and a
    closed one slides at |k_s s| = μk_n(e_0 − e); bonds break as above.

    Parameters
    ----------
    constants : (p, 12 or more). limits : friction and strength, numbers or columns (p,).

    Returns (a, b, c) (p, 7, 3) in the order of `LIMITS`, and d (p, 7), infinite where a pair has no such limit.
    """
    rest, touch, normal, shear = (constants[:, each] for each in (K.rest, K.touch, K.kn, K.ks))
    bond, bond_shear, bending = (constants[:, each] for each in (K.bond_kn, K.bond_ks, K.bending))
    per_area, per_section = constants[:, K.per_area], constants[:, K.per_section]
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


def limit_in_words(limit: int, constants: np.ndarray) -> str:
    """Description of a limit of `limit_lines` for a pair with these constants."""
    has_gap = constants[K.touch] < constants[K.rest]
    return "closes" if limit == 0 and has_gap else LIMITS[limit]
