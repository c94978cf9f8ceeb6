"""The forces across contacts and bonds: which pairs act, along which vectors, and as columns of a record."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from dembound.kernels.common import CHUNKS
from dembound.kernels.contacts import BONDED, INTACT, REFERENCE, SLID, push
from dembound.kernels.tables import Contacts, Limits
from dembound.motion.layout import Layout

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
        rest, touch = contacts.constants[:, 2:4].T
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
        near = 0.5 + rows[:, 4] / np.hypot(*vector)
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
    push(u, u, 0.0, 0, copies, UNYIELDING, np.empty((CHUNKS, 4)), 0)  # zero step: at rest
    return copies
