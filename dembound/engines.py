"""The two ways a scene is stepped: the history-free elastic law, and the contact law with a memory.

Both move the same displacements with the same supports and records; they differ in how contacts push.
"""

from functools import cached_property

import numpy as np

from dembound.balance import Balance
from dembound.contacts import NO_CRACKS, ContactList, Cracks, plain_contacts
from dembound.engine import Engine
from dembound.kernels import bonded, elastic
from dembound.kernels.contacts import REFERENCE, UPDATED, strain_energy
from dembound.kernels.tables import Body, Contacts, Followers, Limits, Log, Supports, Watch
from dembound.scene import Scene

_IDS, _NUMBERS = np.zeros(0, dtype=np.uint32), np.zeros(0)
UNWATCHED = Watch(
    contacts=Contacts(
        first=_IDS,
        second=_IDS,
        kind=_IDS,
        palette=np.zeros((0, 12)),
        state=np.zeros(0, dtype=np.uint8),
        shear=_NUMBERS,
        slip=_NUMBERS,
        cracked=np.zeros(0, dtype=np.int64),
        force=np.zeros((0, 4)),
        start=_IDS,
        end=_IDS,
    ),
    limits=Limits(0.0, np.inf, np.inf, 0.0, 0),
    origin=np.zeros((2, 0)),
    skin=0.0,
    arms=_NUMBERS,
)
"""For a scene whose own law is the elastic one."""


NO_FOLLOWERS = Followers(
    opposite=np.zeros(0, dtype=np.int64),
    start=np.zeros(1, dtype=np.int64),
    member=np.zeros(0, dtype=np.int64),
    twin=np.zeros(0, dtype=np.int64),
    arm=np.zeros((2, 0)),
    node=np.zeros(0, dtype=np.int64),
    side=np.zeros((2, 0), dtype=np.int64),
    force=np.zeros((2, 2, 0)),
    steady=np.zeros((2, 0)),
    extra=np.zeros((2, 0)),
    datum=np.zeros((3, 0)),
)
"""For a body whose stress nothing balances."""


class Elastic(Engine):
    """The history-free law (kernels/elastic.py), on watch if the scene's law is another one.

    Parameters
    ----------
    scene : what moves.
    contacts : the pairs to watch; None where the elastic law is the scene's own.
    """

    name = "elastic"

    def __init__(self, scene: Scene, contacts: ContactList | None) -> None:
        self.scene = scene
        self.contacts = contacts
        self.ended = False

    def force(self, displacement: np.ndarray) -> np.ndarray:
        """Contact and seam forces and moments (3, n) at displacements (3, n), those of the start left out."""
        force = np.empty_like(displacement)
        elastic.contact_forces(displacement, self.scene.rows, force)
        if self.scene.seam is not None:
            table = self.scene.seam_table(self.scene.seam.node)
            across = np.empty((len(table.twin), 3))
            elastic.seam_forces(displacement, self.scene.rows, table, across)
            force[:, self.scene.seam.node] += across.T
        return force

    def advance(
        self, u: np.ndarray, spare: np.ndarray, v: np.ndarray, number: int, body: Body, supports: Supports, log: Log
    ) -> int:
        """Advance by the steps of supports.drive, or as far as the law holds; returns the steps done.

        `ended` turns true where the next step needs the law with a memory.
        """
        done, why = elastic.advance(u, spare, v, self.scene.rows, body, supports, log, self._watch())
        if why == elastic.LIST_ENDS:
            self.contacts.search(u)  # type: ignore[union-attr]  # only a watch ends early
        self.ended = why == elastic.LAW_ENDS
        return int(done)

    def stored(self, displacement: np.ndarray) -> tuple[float, float]:
        """Energy (J) in contacts and in bonds."""
        pairs = self._plain_contacts if self.contacts is None else self.contacts.arrays
        return strain_energy(displacement, pairs, REFERENCE)

    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since this was last called, as in a static stage before."""
        return NO_CRACKS if self.contacts is None else self.contacts.take_cracks()

    @cached_property
    def _plain_contacts(self) -> Contacts:
        return plain_contacts(self.scene.ground, self.scene.assembly)

    def _watch(self) -> Watch:
        contacts = self.contacts
        if contacts is None:
            return UNWATCHED
        return Watch(contacts.arrays, contacts.limits, contacts.origin, contacts.skin, contacts.arms)


class Bonded(Engine):
    """The history-dependent contact law (kernels/bonded.py), on a list of pairs with their history.

    Parameters
    ----------
    contacts : the pairs.
    balance : what balances the stress of a settled body; None for a body that starts as built.

    Attributes
    ----------
    followers : forces that turn with their sides, where the law follows the motion.
    """

    name = "linearpbond"

    def __init__(self, contacts: ContactList, balance: Balance | None = None) -> None:
        self.contacts = contacts
        self.balance = balance
        follow = balance is not None and contacts.limits.geometry == UPDATED
        self.followers = balance.followers if balance is not None and follow else NO_FOLLOWERS
        self._seam_ends: np.ndarray | None = None

    def advance(
        self, u: np.ndarray, spare: np.ndarray, v: np.ndarray, number: int, body: Body, supports: Supports, log: Log
    ) -> int:
        """Advance by the steps of supports.drive, or until pairs must be looked for anew; returns the steps done."""
        contacts = self.contacts
        if self._seam_ends is None:
            self._seam_ends = contacts.seam_ends().astype(np.uint32)
        supports = supports._replace(seam=supports.seam._replace(end=self._seam_ends))
        done, why = bonded.advance(
            u,
            spare,
            v,
            number,
            contacts.arrays,
            contacts.limits,
            contacts.origin,
            contacts.skin,
            body,
            supports,
            self.followers,
            self.balance is not None,
            log,
        )
        if self.balance is not None and why in (elastic.BROKE, elastic.LIST_ENDS):  # pieces may have parted
            self.balance.end_on_debris(contacts, u, v, body.step, body.load)
        if why == elastic.LIST_ENDS:
            contacts.search(u)
            self._seam_ends = None
        return int(done)

    def stored(self, displacement: np.ndarray) -> tuple[float, float]:
        """Energy (J) in contacts and in bonds."""
        return strain_energy(displacement, self.contacts.arrays, self.contacts.limits.geometry)

    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since this was last called."""
        return self.contacts.take_cracks()

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Intact bonds and pushing contacts of every particle."""
        return {"coordination": (self.contacts.coordination(), "1")}
