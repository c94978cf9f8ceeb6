"""Forces across pairs of disks, the pairs of the elastic law, and the first bonds that break."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from dembound.disks.contacts.placing import NO_ARMS, NO_DASHPOTS
from dembound.disks.material.at_rest import AtRest, stressed
from dembound.disks.material.constants import brick_constants
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.common import CHUNKS
from dembound.kernels.compiler.start_strain import began_of
from dembound.kernels.contacts import BONDED, INTACT, LOST, NONE, REFERENCE, SLID, push_each
from dembound.kernels.single_pairs import push
from dembound.kernels.tables.contacts import Contacts
from dembound.laws import Law
from dembound.laws.law import Limits
from dembound.motion.kind import Finding
from dembound.motion.state import Layout
from dembound.motion.trackers import Run
from dembound.packings.tiling import Assembly
from dembound.pairwise import P, of_law
from dembound.places import is_within
from dembound.table import EVERYWHERE, Box

PIECE = 2**18
"""Number of pairs whose stresses are evaluated at once: this limits the temporary arrays of large scenes."""

UNYIELDING = Limits(friction=0.0, tension=np.inf, cohesion=np.inf, tan_fa=0.0, geometry=REFERENCE)
"""Under the elastic law there are no strength and friction limits."""


class Piece(NamedTuple):
    """k pairs of a list.

    first, second : (k,) particles, numbered as in the scene. bonded : (k,) bool. acting : (k,) bool, see `acting`.
    vector : (2, k) m from the centre of the first to that of the second, or of its image across a periodic side. near :
    (k,) part of the vector on the side of the first. force : (2, k) N per metre on the first.
    """

    first: np.ndarray
    second: np.ndarray
    bonded: np.ndarray
    acting: np.ndarray
    vector: np.ndarray
    near: np.ndarray
    force: np.ndarray


def acting(contacts: Contacts, geometry: int) -> np.ndarray:
    """Whether each pair (b,) has an intact bond or a closed contact.

    geometry : REFERENCE or SLID for the elastic law, under which contacts remain as they are at the start; else those
    with a force in the last step are closed.
    """
    if geometry >= REFERENCE:
        rest, touch = contacts.constants[:, P.rest], contacts.constants[:, P.touch]
        closed = (touch >= rest)[contacts.contact_type]
    else:
        closed = contacts.force[:2].any(axis=0)
    whether: np.ndarray = (contacts.state == INTACT) | closed
    return whether


def pieces(layout: Layout, contacts: Contacts, displacement: np.ndarray, geometry: int) -> Iterator[Piece]:
    """The forces of all pairs, piece by piece; the pairs are not changed.

    Parameters
    ----------
    layout : the slots of the particles.
    contacts : the pairs.
    displacement : (3, n) m and rad.
    geometry : see kernels/contacts.py. REFERENCE and SLID: forces of the elastic law at the displacements, along the
    vectors of the start; SLID: of contacts that have slid before. Else the pairs' last forces, along the vectors at the
    displacements; BONDED: along those of the start where a bond is intact.
    """
    u = layout.spread(displacement) if geometry >= REFERENCE else None
    for begin in range(0, max(1, len(contacts.first)), PIECE):
        part = _cut(contacts, slice(begin, begin + PIECE))
        first, second = layout.node[part.first], layout.node[part.second]
        rows, bonded = part.constants[part.contact_type], part.state == INTACT
        vector = rows[:, :2].T
        if u is not None:
            part = _pushed(part, u, slid=geometry == SLID)
        else:
            moved = displacement[:2, second] - displacement[:2, first]
            vector = vector + (np.where(bonded, 0.0, moved) if geometry == BONDED else moved)
        near = 0.5 + rows[:, P.offset] / np.hypot(*vector)
        yield Piece(first, second, bonded, acting(part, geometry), vector, near, part.force[:2])


def contact_columns(found: Iterator[Piece]) -> dict[str, tuple[np.ndarray, str]]:
    """The b pairs that act as columns of a record, by name: values and unit.

    particles : (b, 2) numbers of first and second. vector : (b, 2) m as in `Piece`. normal_force : (b,) N/m, force
    along the vector, tension positive. shear_force : (b,) N/m, force on the first along the vector turned by a quarter
    anticlockwise. bonded : (b,) bool. The force on the first is normal_force·n + shear_force·t with these two unit
    vectors, that on the second is the opposite.
    """
    kept = [_acting_ones(piece) for piece in found]
    first, second, bonded, vector, force = (np.concatenate(column, axis=-1) for column in zip(*kept, strict=True))
    along, across = vector, np.stack([-vector[1], vector[0]])
    length = np.hypot(*vector)
    return {
        "particles": (np.stack([first, second], axis=1).astype(np.int32), "1"),
        "vector": (np.ascontiguousarray(vector.T), "m"),
        "normal_force": ((force * along).sum(axis=0) / length, "N/m"),
        "shear_force": ((force * across).sum(axis=0) / length, "N/m"),
        "bonded": (bonded, "1"),
    }


def _acting_ones(piece: Piece) -> tuple[np.ndarray, ...]:
    """First, second, bonded, vector and force of the acting pairs."""
    columns = (piece.first, piece.second, piece.bonded, piece.vector, piece.force)
    return tuple(column[..., piece.acting] for column in columns)


def _cut(contacts: Contacts, piece: slice) -> Contacts:
    """A slice of the pairs, without the rows of contact ends."""
    names = ("first", "second", "contact_type", "state", "shear", "slip", "closed", "cracked", "place", "kept")
    columns = {name: getattr(contacts, name)[piece] for name in names}
    return contacts._replace(**columns, force=contacts.force[:, piece])


def _pushed(contacts: Contacts, u: np.ndarray, *, slid: bool) -> Contacts:
    """Copies of pairs with the forces of the elastic law at displacements u (3, slots)."""
    count = len(contacts.first)
    copies = contacts._replace(
        shear=np.zeros(count),
        slip=contacts.slip.copy() if slid else np.zeros(count),
        closed=np.zeros(count, dtype=np.uint8),
        cracked=np.full(count, -1),
        force=np.empty((4, count)),
    )
    push_at_rest(u, copies, UNYIELDING)
    return copies


def push_at_rest(u: np.ndarray, contacts: Contacts, limits: Any) -> int:
    """Compute the forces of all pairs at displacements u (3, slots) at rest; returns the number of bonds that broke.

    Those of pairs in no row are the same bits as in a run, so that what balances them leaves a body at rest.
    """
    still, undamped, lost = np.zeros_like(u), contacts._replace(**NO_DASHPOTS), np.zeros((CHUNKS, LOST))
    reference = limits.geometry == REFERENCE
    if not reference:
        push(u, still, 0.0, 0, undamped, limits, lost)
    others = np.arange(len(contacts.first) if reference else contacts.bound[0], dtype=np.uint32)
    push_each(others, u, still, 0.0, 0, undamped, limits, lost[0])
    return int(lost[:, 3].sum())


BREAK_TIME, BREAK_X, BREAK_Y = "break time", "break x", "break y"
"""Names of the findings about the first broken bonds."""


def first_break(run: Run, inside: Box | None = None) -> dict[str, Finding]:
    """Time (s) of the step in which the first bonds break, and the mean of their places (m) then; empty without one.

    inside : the part of the scene that counts, by default all. The run's list of broken bonds is emptied, as by every
    `System.take_cracks`.
    """
    cracks = run.system.take_cracks(run.state.step)
    settled = 0.5 * run.state.datum[:2, cracks.pair].sum(axis=2).T
    places = cracks.position - settled
    counted = is_within(inside or EVERYWHERE, places, float(run.scene.size.max()))
    if not counted.any():
        return {}
    step = int(cracks.step[counted].min())
    x, y = np.mean(places[counted & (cracks.step == step)], axis=0)
    return {
        BREAK_TIME: Finding(float(step * run.time_step), "s"),
        BREAK_X: Finding(float(x), "m"),
        BREAK_Y: Finding(float(y), "m"),
    }


def plain_contacts(
    ground: PackedMaterial, assembly: Assembly, slot: np.ndarray, at_rest: AtRest | None = None
) -> Contacts:
    """The contacts of the elastic law, without history, forces and rows, for its strain energy.

    slot : (n,) in which kernels hold the assembly's particles. at_rest : stress that they begin with; None: none.
    """
    plain = brick_constants(ground, gaps_close=False, locked_in=0.0)
    constants, kind, _ = stressed(ground, plain, assembly, at_rest)
    first, second = slot[assembly.pairs.T].astype(np.uint32, order="C")
    nothing = np.zeros(0)
    return Contacts(
        begin=int(slot.min()),
        first=first,
        second=second,
        contact_type=kind.astype(np.uint32),
        constants=of_law(constants),
        began=began_of(constants),
        state=bonds_of(ground.law, constants, kind),
        shear=nothing,
        slip=nothing,
        closed=np.zeros(0, dtype=np.uint8),
        cracked=np.zeros(0, dtype=np.int64),
        place=np.zeros((0, 2)),
        kept=np.zeros(0, dtype=np.uint8),
        force=np.zeros((4, 0)),
        **NO_DASHPOTS,
        **NO_ARMS,
        start=first[:0],
        end=first[:0],
        bound=np.linspace(0, len(first), CHUNKS + 1).astype(np.int64),
    )


def bonds_of(law: Law, constants: np.ndarray, contact_type: np.ndarray) -> np.ndarray:
    """States (b,) of contacts as built: intact where the rows of their types in constants have a bond."""
    return np.where(law.column(constants, "bond_kn")[contact_type] > 0.0, INTACT, NONE).astype(np.uint8)
