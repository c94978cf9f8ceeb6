"""Arrays of laws, of disks and of bars; a law's type chooses its kernels."""

from typing import Any, NamedTuple

import numpy as np

from dembound.kernels.tables.bars import Softening
from dembound.kernels.tables.contacts import Cells, Contacts, LaneRows, NeighbourTable, PairRows


class Links(NamedTuple):
    """The elastic law on the particles of the rows; fastest (chunks,), damped (chunks, 2) : work space."""

    rows: NeighbourTable | LaneRows
    fastest: np.ndarray
    damped: np.ndarray


class WatchedLinks(NamedTuple):
    """The elastic law with a check for contacts that would leave it.

    contacts, limits : the pairs and their limits; origin : (2, n) displacements at which the list of pairs was made, of
    the n particles of the rows; skins : (n,) m, up to whose sum gaps of pairs are listed; cells : of the particles
    then; arms : (begin + n,) m, longest arm of a particle's contacts; way : (2,) m, distance surfaces have moved since
    the contacts were checked, and the distance they may move; keeps_slip : whether contacts have slid earlier.
    """

    links: Links
    contacts: Contacts
    limits: Any
    origin: np.ndarray
    skins: np.ndarray
    cells: Cells
    arms: np.ndarray
    way: np.ndarray
    keeps_slip: bool = False


class Bonded(NamedTuple):
    """The history-dependent law on the n particles of the contacts.

    limits : friction and strengths; origin : (2, n) displacements at which pairs were listed, with gaps up to the sum
    of their skins (n,) m; cells : of the particles then; stops : return after a step in which a bond broke; way : (2,)
    m, distance particles have moved since this was checked, and the distance they may move; fastest (chunks,), damped
    (chunks, 2), lost (chunks, 5) : work space.
    """

    contacts: Contacts
    limits: Any
    origin: np.ndarray
    skins: np.ndarray
    cells: Cells
    stops: bool
    way: np.ndarray
    fastest: np.ndarray
    damped: np.ndarray
    lost: np.ndarray


class LaneBonded(NamedTuple):
    """The history-dependent law in rows of copies; the other pairs come after those in rows.

    bonded : the law, for all pairs; rows : the disks, whose contacts are not used; pairs : the rows of pairs. stray :
    (k,) ascending slots of disks with ends of other pairs; stray_start (k + 1,), stray_end (e,) those ends, as in
    Contacts. extra : (3, slots), also_lost (chunks, 5) : work space.
    """

    bonded: Bonded
    rows: LaneRows
    pairs: PairRows
    stray: np.ndarray
    stray_start: np.ndarray
    stray_end: np.ndarray
    extra: np.ndarray
    also_lost: np.ndarray


class Arms(NamedTuple):
    """Relaxation arms of intact bonds, see kernels/arms.py.

    decay, weight : (p, K) e, and w/(1 − Σw), of the K arms of each type of contacts, or (1, K) where all are alike.
    lost (chunks, 5) : work space.
    """

    decay: np.ndarray
    weight: np.ndarray
    lost: np.ndarray


class Relaxing(NamedTuple):
    """The history-dependent law on bonds with relaxation arms.

    law : of the same contacts, with bonds that never break; bonded : what of it is the same in rows of copies and one
    by one. limits : friction and strengths; arms : of the bonds; stops : return after a step in which a bond broke.
    """

    law: Bonded | LaneBonded
    bonded: Bonded
    limits: Any
    arms: Arms
    stops: bool


class BarContacts(NamedTuple):
    """Contacts between ranges of a bar, see kernels.bar_contacts.

    left : (c,) nodes, each touches the next one; gap : (c,) m between them at rest; closed : (c,) bool, whether each
    has ever been closed. before (c,) m/s, push (c,) N : work space, the speed of approach before a step and the force
    in it.
    """

    left: np.ndarray
    gap: np.ndarray
    closed: np.ndarray
    before: np.ndarray
    push: np.ndarray


class BarBonds(NamedTuple):
    """Springs and bonds of a bar of n nodes; horizon m, 0 if there is no peridynamic bond.

    spring : (n − 1,) N/m of the local springs between neighbours, 0 where there is none; spring_limit : (n − 1,) m, the
    elongation at which each breaks, or where it triggers (n − 1,) the method; bond : (m, n) N/m, row p − 1
    those between nodes i and i + p. spring_broken (n − 1,), bond_broken (m, n) : step in which each broke, negative
    for not. zones : (z, 2) nodes among which there are bonds, zones share at most one node; bond_limit : (z, m) m, the
    elongation at which they break, by length. plain : (r, 2) runs of nodes between equal springs; of each plain_push
    (r,) 1/s : Δt k/m, less what attenuation takes, plain_keep (r,) : part of a velocity that remains after attenuation
    in a step, plain_limit (r,) m : where all trigger. mixed : (q, 3) the runs of all other nodes, with whether they
    have springs, and mixed_keep (q,) as plain_keep. sections : (n − 1,) m², between neighbours, 0 where nothing joins
    them. mobility : (n,) Δt/m, less what attenuation takes, 0 for supported nodes; drag : (n,) N·s/m of dashpots that
    attenuate, or (0,) for none. contacts : between ranges. through : (n − 1,) N, tension in bonds that reach into
    layers, see BarLayers, or (0,) without these. softening : bonds that open. space (n + m + 1,), mean (n,), before
    (k,), reached (1,) : work space.
    """

    spring: np.ndarray
    spring_limit: np.ndarray
    triggers: np.ndarray
    bond: np.ndarray
    bond_limit: np.ndarray
    spring_broken: np.ndarray
    bond_broken: np.ndarray
    zones: np.ndarray
    plain: np.ndarray
    plain_push: np.ndarray
    plain_keep: np.ndarray
    plain_limit: np.ndarray
    mixed: np.ndarray
    mixed_keep: np.ndarray
    sections: np.ndarray
    mobility: np.ndarray
    drag: np.ndarray
    contacts: BarContacts
    through: np.ndarray
    softening: Softening
    space: np.ndarray
    mean: np.ndarray
    before: np.ndarray
    reached: np.ndarray
