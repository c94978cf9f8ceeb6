"""Pairs listed anew: near ones are met, distant ones without bond are left, and the others keep their history."""

from typing import Any

import numpy as np

from dembound.disks.contacts.pair_list import NO_LIMITS, PairList
from dembound.disks.contacts.placing import SPARE, ContactHistory, Pairs, numbers_of, with_ends
from dembound.disks.contacts.skins import skins_of
from dembound.disks.material.constants import shared_constants
from dembound.kernels import contacts as kernel
from dembound.kernels.contacts import NONE, SHEAR
from dembound.kernels.listing import merged
from dembound.kernels.near import near_keys, pairs_of, room
from dembound.laws.law import columns_of
from dembound.motion.part import Cracks
from dembound.pairwise import STRAIN, of_law

HISTORY = ("state", "shear", "slip", "closed", "cracked", "kept")
"""The arrays of the pairs' history variables, in the order of `ContactHistory`."""

GRAIN = 1e-12
"""To which share of the mean diameter places of near pairs are rounded, so that copies of a pair share a row."""


class RenewedList(PairList):
    """Pairs that are listed anew as particles move; attributes are those of `ContactList`."""

    skin: float
    time_step: float
    locked_in: float
    retired: np.ndarray
    _friction: np.ndarray | None
    _rolling: np.ndarray
    _built: Pairs
    _built_keys: np.ndarray
    _built_order: np.ndarray
    _held: np.ndarray
    _left_out: int
    _beside: np.ndarray | None
    _apart: np.ndarray
    _cracks: list[Cracks]

    def is_old(self, u: np.ndarray) -> bool:
        """Whether at displacements (3, slots) a particle has moved so far that pairs may be missing."""
        return bool(room(u, self._slots.start, self.origin, self.skins, self.cells) < 0.0)

    def search(self, displacement: np.ndarray) -> None:
        """List the pairs anew for displacements (3, n) of disks at rest, see `list_anew`."""
        self.list_anew(self.spread(displacement))

    def list_anew(self, u: np.ndarray, v: np.ndarray | None = None) -> None:
        """List the pairs anew for displacements u (3, slots): add near pairs, remove distant ones without bond.

        v : (3, slots) m/s, by which fast particles get wider skins; None: all have the same, and pairs at the same
        place of different bricks share their constants.
        """
        self.note_cracks()
        moved = u[:2, self._slot].T
        if not np.isfinite(moved).all():
            return  # the `Watch` of the run raises the error
        if np.count_nonzero(self.retired) > self._left_out:
            self._leave_out_retired()
        skins = np.full(self._slots.stop - self._slots.start, 0.5 * self.skin)
        if v is not None:
            skins = skins_of(v, self._slots.start, self.cells, self.time_step, self.ground.brick.mean_diameter)
        old = self._keys[self._in_rows :]
        near = self._near(moved, skins)
        keys, source = merged(near, old, self.arrays.state[self._singles], self._held, self._row_keys)
        met = self._met(keys[source < 0], source, shares=v is None)
        begin = self._singles.start
        if len(keys) > len(self.arrays.first) - begin:
            self._list(*self._all(), room=len(keys))
        self._carry(source, met)
        self.arrays = with_ends(self.arrays, keys, begin, self._slots.stop)
        self.live = np.concatenate([self.live[: self._in_rows], begin + np.arange(len(keys))])
        self._keys = np.concatenate([self._keys[: self._in_rows], keys])
        self._note_strays()
        self._set_origin(moved.T, skins[self._slot - self._slots.start])

    @property
    def _singles(self) -> slice:
        """Places of the pairs in no row."""
        return slice(int(self.arrays.bound[0]), int(self.arrays.bound[-1]))

    def _near(self, moved: np.ndarray, skins: np.ndarray) -> np.ndarray:
        """Keys of pairs with gaps up to the sum of their skins (slots,) m, of particles that moved (m, 2) m."""
        ranks, radii = self._ranks, self.assembly.radii[self._ranks]
        slot = self._slot[ranks]
        own = skins[slot - self._slots.start]
        reach = np.where(self.retired[ranks], -np.inf, radii + own)
        usual = (float(radii.max()) + float(own.min())) * (1.0 + 1e-12)  # of disks that are not fast
        lengths = np.array([length or 0.0 for length in self.periods])
        keys = near_keys((self.assembly.positions + moved)[ranks], reach, lengths, slot, usual)
        if self._beside is None:
            return keys
        keys = keys[~self._across_joint(keys)]
        return keys if len(self._apart) == 0 else np.setdiff1d(keys, self._apart, assume_unique=True)

    def _across_joint(self, keys: np.ndarray) -> np.ndarray:
        """Whether pairs of some keys (k,) have faces on both sides of a joint, so that their disks never touch."""
        assert self._beside is not None
        one, other = self._beside[pairs_of(keys, self._slots.stop)[0].T]
        opposite: np.ndarray = ((one[:, :, None] == -other[:, None, :]) & (one[:, :, None] != 0)).any(axis=(1, 2))
        return opposite

    def end_faces(self, displacement: np.ndarray, particles: np.ndarray) -> None:
        """Let particles (k,) whose faces have ended touch those beyond their joint, once they overlap no more.

        To be called at fixed steps, also without particles. displacement : (3, n) m.
        """
        if self._beside is None or len(particles) + len(self._apart) == 0:
            return
        moved = displacement[:2, self.nodes].T
        beside, self._beside = self._beside, None
        touching = self._near(moved, np.zeros(self._slots.stop - self._slots.start))
        self._beside = beside
        between = touching[self._across_joint(touching)]
        self._beside[self._slot[particles]] = 0
        ended = between[~self._across_joint(between)]
        still = np.intersect1d(self._apart, touching, assume_unique=True)
        changes = len(still) < len(self._apart) or len(particles) > 0
        self._apart = np.union1d(still, ended)
        if changes:
            self.search(displacement)

    def _met(self, keys: np.ndarray, source: np.ndarray, *, shares: bool) -> Pairs:
        """Pairs (k,) of some keys that are not listed; contacts of the brick that had parted have their constants.

        source : of all pairs, see `merged`; shares : whether constants are shared.
        """
        both, image = pairs_of(keys, self._slots.stop)
        first, second = (self.layout.node[both] - self.nodes.start).T
        kind, built = np.zeros(len(keys), dtype=np.int64), self._built
        at = numbers_of(keys, self._built_keys, self._built_order)
        parted, own = at >= 0, at[at >= 0]
        first[parted], second[parted], image[parted] = built.first[own], built.second[own], built.image[own]
        kind[parted] = built.contact_type[own]
        new = ~parted
        kind[new] = self._enter(first[new], second[new], image[new], source, shares=shares)
        return Pairs(first, second, image, kind)

    def _enter(
        self, first: np.ndarray, second: np.ndarray, image: np.ndarray, source: np.ndarray, *, shares: bool
    ) -> np.ndarray:
        """Types (k,) of new pairs: rows of constants, in layered ground with limits, that no pair uses any more."""
        if len(first) == 0:
            return first
        positions, radii = self.assembly.positions, self.assembly.radii
        vectors = positions[second] - positions[first] + image * [length or 0.0 for length in self.periods]
        unit = GRAIN * self.ground.brick.mean_diameter
        vectors = np.round(vectors / unit) * unit  # alike in copies of a brick, whatever other pairs there are
        zones = self.ground.zone_of(positions[first]), self.ground.zone_of(positions[second])
        both_radii, locked_in = (radii[first], radii[second]), self.locked_in
        constants = self.ground.pair_constants(both_radii, vectors, zones, bonded=False, locked_in=locked_in)
        if self._friction is not None:
            constants = np.column_stack([constants, self._limits_of_met(first, second)])
        row_of = np.arange(len(constants))
        if shares:
            constants, row_of = shared_constants(constants, np.column_stack(zones), self.ground.law.width)
        used = np.zeros(len(self._constants), dtype=np.bool_)
        used[: len(self.bonds)] = True
        used[self.arrays.contact_type[self._singles][source[source >= 0]]] = True
        row = np.flatnonzero(~used)[: len(constants)]
        if len(row) < len(constants):
            before, more = len(self._constants), len(constants) + len(self._constants) // SPARE
            self._constants = np.vstack([self._constants, np.zeros((more, self._constants.shape[1]))])
            self._list(*self._all())
            row = np.concatenate([row, before + np.arange(len(constants) - len(row))])
        self._constants[row] = constants
        own, limits = np.split(constants, [self.ground.law.width + STRAIN], axis=1)
        self.arrays.constants[row] = of_law(own)
        for name, values in zip(self.limits._fields, limits.T, strict=False):
            getattr(self.limits, name)[row] = values
        return row[row_of]

    def _limits_of_met(self, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        """Columns (k, 4 or 5) of the limits of contacts of particles (k,) that meet."""
        assert self._friction is not None
        limits = np.repeat(NO_LIMITS[:, : len(columns_of(self.limits))], len(first), axis=0)
        limits[:, 0] = np.minimum(self._friction[first], self._friction[second])
        limits[:, 4:] = np.minimum(self._rolling[first], self._rolling[second])[:, None]
        return limits

    def _carry(self, source: np.ndarray, met: Pairs) -> None:
        """Fill the places of pairs in no row: with those listed before, by number (b,), or with met ones in turn."""
        arrays, before, is_met = self.arrays, self._singles, source < 0
        index = np.where(is_met, before.stop - before.start + np.cumsum(is_met) - 1, source)
        first, second = self._slot[met.first], self._slot[met.second]
        nowhere, nothing = int(self._slot[0]), len(arrays.constants) - 1
        columns: list[tuple[np.ndarray, Any, int]] = [
            (arrays.first, first, nowhere), (arrays.second, second, nowhere),
            (arrays.contact_type, met.contact_type, nothing), (arrays.state, NONE, NONE), (arrays.shear, 0, 0),
            (arrays.slip, 0, 0), (arrays.closed, kernel.OPEN, kernel.OPEN), (arrays.cracked, -1, -1),
            (arrays.place.T, 0, 0), (arrays.kept, 0, 0), (arrays.force, 0, 0), (self._images.T, met.image.T, 0),
        ]  # fmt: skip
        if self.dashpots is not None:
            viscosity = self.dashpots.between(first, second, arrays.constants[met.contact_type])
            columns += [(arrays.viscosity, viscosity, 0), (arrays.drag, 0, 0)]
        if self.lags > 0:
            columns.append((arrays.lag, 0, 0))
        if self.rolls:
            columns.append((arrays.rolled, 0, 0))
        if self.factors is not None:
            factors = self._factors_of(self.factors, met.first, met.contact_type)
            columns.append((np.asarray(self.limits.factor), factors, 1))
        for column, values, empty in columns:
            new = np.empty((*column.shape[:-1], len(met.first)), dtype=column.dtype)
            new[...] = values
            now = np.concatenate([column[..., before], new], axis=-1).take(index, axis=-1)
            column[..., before] = empty
            column[..., before.start : before.start + len(source)] = now

    def _all(self) -> tuple[Pairs, ContactHistory]:
        """All pairs with their history."""
        history = ContactHistory(*(self.of(name) for name in (*HISTORY, "place")))
        drag = None if self.dashpots is None else self.drag
        rolled = self.of("rolled") if self.rolls else None
        history = history._replace(force=self.force, drag=drag, lag=self.lag if self.lags > 0 else None, rolled=rolled)
        return Pairs(*self.pairs, self.image, self.of("contact_type")), history

    @property
    def drag(self) -> np.ndarray:
        """Last forces (b, 2) N of the dashpots of the pairs, pushing and along the shear."""
        return self.arrays.drag[:, self.live].T

    @property
    def lag(self) -> np.ndarray:
        """Lags (b, 3K) m, m and rad of the relaxation arms of the pairs, see `Contacts`."""
        return self.arrays.lag[:, self.live].T

    def _leave_out_retired(self) -> None:
        """Remove the pairs of particles that meet no others any more."""
        self._left_out = int(np.count_nonzero(self.retired))
        pairs, history = self._all()
        stays = ~(self.retired[pairs.first] | self.retired[pairs.second])
        left = Pairs(**{name: each[stays] for name, each in vars(pairs).items()})
        columns: list[Any] = [None if each is None else each[stays] for each in history]
        self._list(left, ContactHistory(*columns))

    def note_cracks(self) -> None:
        """Record the bonds that broke since the last call, with their positions."""
        if not (self.arrays.cracked >= 0).any():
            return
        cracked, state = self.of("cracked"), self.of("state")
        broken = np.flatnonzero(cracked >= 0)
        first, second = (particles[broken] for particles in self.pairs)
        order = np.lexsort((second, first, cracked[broken]))
        broken, first, second = broken[order], first[order], second[order]
        half = 0.5 * self._constants[self.of("contact_type")[broken], :2]
        middle = self.assembly.positions[first] + half + self.of("place")[broken]
        both = np.column_stack([first, second]) + self.nodes.start
        self._cracks.append(Cracks(cracked[broken], both, middle, state[broken] == SHEAR))
        self.arrays.cracked[:] = -1
