"""The functions by which the loops over pairs call their law, which the type of its limits chooses.

A law is one file in laws/: its constants (`COLUMNS`), its limits and the functions below, see pairwise.is_pair_law. k
is the pair's row of constants, kind its row of limits where these differ by type. The loops know the rest: geometry,
contacts that open, the test against a limit, bonds that break.
"""

from typing import Any

from numba import njit

from dembound.kernels.common import INLINED
from dembound.kernels.compiler.bundles import passed_by_address
from dembound.kernels.law import answer, generic
from dembound.pairwise import COMPILERS, PAIR_LAWS


@generic
def acts(limits, constants, k):
    """Whether a pair has a contact beside its bond."""


@generic
def normal(limits, constants, k, overlap):
    """Force (N) with which a contact of this overlap (m) pushes; at most 0 for a gap."""


@generic
def stored_between(limits, constants, k, before, now):
    """Energy (J) that a contact stores by its overlap `now`, less that by the overlap `before`; both at least 0."""


@generic
def shear_of(limits, constants, k, overlap, shear, slip):
    """Shear force (N) of a contact of this overlap (m), whose surfaces moved by `shear` (m) and slid by `slip` (m)."""


@generic
def slip_at(limits, constants, k, overlap, shear, force):
    """Slip (m) of a contact of this overlap (m) that bears a shear force (N) after a motion of `shear` (m)."""


@generic
def slips_by_overlap(limits):
    """Whether the slip of contacts also changes with their overlap; a constant, True or False."""


@generic
def slip_after(limits, constants, k, before, now, shear, slip):
    """Slip (m) of a contact whose overlap has changed from `before` to `now` (m); shear : motion (m) until then."""


@generic
def rubbed(limits, constants, k, before, now, was, shear, slip, slid, force, pushed):
    """Energy (J) that a contact takes by its shear in a step in which its slip changes from `slip` to `slid` (m).

    before, now : overlap; was, shear : motion of its surfaces (m); force, pushed : shear force (N), before and after.
    """


@generic
def most_shear(limits, kind, push):
    """Largest shear force (N) of a contact that pushes with a force (N)."""


@generic
def rolls(limits):
    """Whether closed contacts without bonds resist rolling; a constant, True or False."""


@generic
def rolling(limits, constants, k):
    """Stiffness (N·m/rad) of a closed contact without bond against rolling, and the effective radius R̄ (m)."""


@generic
def most_moment(limits, kind, radius, push):
    """Largest moment (N·m) by which a contact of effective radius (m) that pushes with a force (N) resists rolling."""


@generic
def bond(limits, constants, k, stretch, shear, turn):
    """Normal and shear force (N) and moment (N·m) of an intact bond."""


@generic
def breaks(limits, constants, k, kind, factor, pull, side, moment):
    """Whether a bond breaks in tension, and whether in shear, under its forces; factor : of its strengths."""


@generic
def viscosity(limits, constants, k, overlap):
    """Viscosity of a contact of this overlap (m), over the one of its dashpots."""


@generic
def contact_energy(limits, constants, k, overlap, slid):
    """Energy (J) stored in a contact: overlap (m), motion of its surfaces less what has slid (m)."""


@generic
def bond_energy(limits, constants, k, stretch, shear, turn):
    """Energy (J) stored in an intact bond."""


@generic
def contact_room(limits, constants, k, kind, overlap, stuck):
    """Least relative motion (m) of two surfaces after which a closed contact may open or slide."""


@generic
def bond_room(limits, constants, k, kind, factor, stretch, shear, turn):
    """Least relative motion (m) of two surfaces after which an intact bond may break."""


def _compile(limits: type, functions: dict[str, Any]) -> None:
    """Make the functions above call those of a law for limits of its type."""
    passed_by_address(limits)
    for name, function in functions.items():
        answer(globals()[name], limits, njit(**INLINED)(function))


COMPILERS.append(_compile)
for _limits, _functions in PAIR_LAWS.items():
    _compile(_limits, _functions)
