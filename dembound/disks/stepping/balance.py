"""The constant forces that balance the stress of a settled body: Z's unbalanced forces F_eq with opposite sign.

Under ``geometry = "updated"`` they rotate with the side they act on. On debris they end, and the disks that remain at
its side carry them.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from dembound.boundaries import OPPOSITE
from dembound.disks.body import DiskBody
from dembound.disks.stepping.carriers import BEARS, carried, carriers_of, on_side, relative_work, standing
from dembound.disks.stepping.part import DiskPart
from dembound.kernels.follower import GONE, side_rotations
from dembound.kernels.fragments import broken_off
from dembound.kernels.tables import Followers
from dembound.motion.state import Arrays, Owner


class Balance(Owner):
    """Forces that balance the stress of a body in a reference state, the datum.

    Parameters
    ----------
    scene : the body and its sides.
    force : (3, n) N and N·m at the datum.
    steady : (3, n) other steady forces, which do not rotate.
    datum : (3, n) displacements at which the body is in equilibrium.
    across : (3, n) N and N·m, forces through free-field seams at the datum. They are not a load, but they also rotate
    with the body and end on debris.

    Attributes
    ----------
    force : (3, n) N and N·m, in the directions of the datum. datum : (3, n), as given.
    followers : arrays with which the kernels rotate them. let_go : (n,) disks that have broken off or lost all their
    bonds, on which the free field beyond no longer acts.
    """

    evolving = (
        *("force", "datum", "let_go", "_steady", "_across", "_begun", "_ended", "_torn", "_stands"),
        *("_of_ended", "_across_ended", "_relative", "_free"),
    )

    def __init__(
        self, scene: DiskBody, force: np.ndarray, steady: np.ndarray, datum: np.ndarray, across: np.ndarray
    ) -> None:
        self.force = force
        self.followers = _followers(scene, force, steady, datum, across)
        self.datum = datum
        self._scene, self._steady, self._across = scene, steady, across
        self._of_ended = self._across_ended = self._free = 0.0
        self._ended, self._torn, self.let_go = np.zeros((3, scene.count), dtype=np.bool_)
        self._begun = force.copy()
        self._note_begin()
        self._carriers = carriers_of(scene)
        self._relative = np.zeros(len(self._carriers))
        self._stands = np.ones(len(self._carriers), dtype=np.bool_)

    def work(self, displacement: np.ndarray) -> float:
        """Work (J) done up to displacements (3, n), without the work of their rotation, which the kernels count."""
        return self._of_ended + float(np.sum(self.force * (displacement - self.datum)))

    def work_across(self, moved: np.ndarray) -> float:
        """Work (J) of the forces at rest of free-field seams, for displacements (3, n) since the datum.

        Seams no longer act on disks that they let go; what they had done there until then counts on.
        """
        return self._across_ended + float(np.sum(np.where(self.let_go, 0.0, self._across) * moved))

    def leave_alone(self, disks: np.ndarray) -> None:
        """Have no steady force on disks (k,) from now on, which do not move any more."""
        followers = self.followers
        at = np.isin(followers.node, disks)
        followers.steady[:, at], followers.force[..., at], followers.extra[:, at] = 0.0, 0.0, 0.0

    def saved_arrays(self) -> Arrays:
        """All arrays that change during a run, by name."""
        followers = {f"follower_{name}": getattr(self.followers, name) for name in _FOLLOWING}
        return {**super().saved_arrays(), **followers}

    @classmethod
    def restored(cls, scene: DiskBody, saved: Arrays) -> Balance:
        """The balance restored from the arrays returned by `saved_arrays` in another run of the same case."""
        balance = cls(scene, *(saved[name].copy() for name in ("force", "steady", "datum", "across")))
        balance.restore(saved)
        balance._note_begin()
        for name in _FOLLOWING:
            getattr(balance.followers, name)[...] = saved[f"follower_{name}"]
        return balance

    def end_on_debris(
        self,
        parts: Sequence[DiskPart],
        displacement: np.ndarray,
        velocity: np.ndarray,
        step: float,
        load: np.ndarray,
        intact: np.ndarray | None,
    ) -> None:
        """End the forces on pieces that have broken off, and the moments on disks without bonds; others carry them.

        A piece has broken off if neither bonds nor closed contacts connect it to disks of an intact zone or, in parts
        without one, to the largest piece, and one of its bonds has broken since the start. Ground that was loose at the
        start therefore keeps its confining forces. Disks that have broken off or lost all bonds are no longer held by
        a free field, see `let_go`.

        displacement (3, n) and velocity (3, n) : after a step (s). The ended forces are removed from load (3, n), all
        steady forces. intact : (m,) disks whose bonds never break; None: there are none.
        """
        debris, alone = np.zeros((2, len(self._ended)), dtype=np.bool_)
        for part in parts:  # called in the step of every break
            body = part.nodes
            kept = np.zeros(body.stop - body.start, dtype=np.bool_) if intact is None else intact[body]
            slot, torn = part.layout.slot[body].astype(np.int64), self._torn[body]
            debris[body], alone[body] = broken_off(part.pairs, slot, torn, kept)
        debris &= ~self._ended
        alone = (alone | debris) & ~self.let_go
        if not (debris.any() or alone.any()):
            return
        moved = displacement - self.datum
        before, free = self.relative_work(displacement), self.free_work(displacement)
        change = np.where(debris, -self.force, 0.0)
        change[2] -= np.where(alone & ~debris, self.force[2], 0.0)
        lost = np.where(alone, self._across, 0.0) - change
        self._ended |= debris
        stands = standing(self._carriers, self._ended, self._begun + self._across)
        for number in np.flatnonzero(self._stands & ~stands):
            change -= on_side(self._carriers[number], self.force + change)
        self._stands = stands
        self._across_ended += float(np.sum(np.where(alone, self._across, 0.0) * (moved - 0.5 * step * velocity)))
        self.let_go |= alone
        followers = self.followers
        turned, apart = debris[followers.node], alone[followers.node]
        load[:2, followers.node[turned]] -= followers.extra[:, turned]
        share = _shares(followers.side)
        followers.force[...] -= np.where(apart, share[:, None, :] * self._across[:2, followers.node], 0.0)
        followers.force[..., turned] = 0.0
        followers.extra[:, turned] = 0.0
        self._leave_sides()
        places = self._scene.positions.T + self.datum[:2]
        change += carried(self._carriers, lost, places, self._ended, self.let_go, self._size, stands)
        self._add(change, displacement, velocity, step, load)
        followers.force[...] += np.where(turned, 0.0, share[:, None, :] * change[:2, followers.node])
        self._relative += before - self.relative_work(displacement)
        self._free += free - self.free_work(displacement)

    def _add(
        self, change: np.ndarray, displacement: np.ndarray, velocity: np.ndarray, step: float, load: np.ndarray
    ) -> None:
        """Add forces (3, n) to those at rest, but not yet to those that rotate; others as of `end_on_debris`."""
        # the force of the last step acted until half a step before the present displacements
        self._of_ended -= float(np.sum(change * (displacement - self.datum - 0.5 * step * velocity)))
        self.force += change
        load += change
        self.followers.steady[...] += change[:2, self.followers.node]

    def end(
        self, what: np.ndarray, displacement: np.ndarray, velocity: np.ndarray, step: float, load: np.ndarray
    ) -> None:
        """End the forces on some components (3, n) bool for good; nothing else carries them.

        Other arguments as of `end_on_debris`.
        """
        before, free = self.relative_work(displacement), self.free_work(displacement)
        change, followers = np.where(what, -self.force, 0.0), self.followers
        self._begun[what] = 0.0
        self._note_begin()
        self._add(change, displacement, velocity, step, load)
        followers.force[...] += _shares(followers.side)[:, None, :] * change[:2, followers.node]
        self._relative += before - self.relative_work(displacement)
        self._free += free - self.free_work(displacement)

    def relative_work(self, displacement: np.ndarray) -> np.ndarray:
        """Work (J) of the forces up to displacements (3, n), by carrier, less that on the mean motion of its side.

        Forces at rest that come through a free-field seam are included.
        """
        return self._relative + relative_work(self._carriers, self._acting, displacement - self.datum, self._ended)

    def free_work(self, displacement: np.ndarray) -> float:
        """Work (J) of the forces up to displacements (3, n) where no side prescribes the motion.

        Forces at rest that come through free-field seams are included, which others balance beside unlike columns.
        """
        return self._free + float(np.sum(self._acting * (displacement - self.datum)))

    @property
    def _acting(self) -> np.ndarray:
        """Forces (3, n) at rest, with those through free-field seams, where no side prescribes the motion."""
        return np.where(self._scene.moves, self.force + np.where(self.let_go, 0.0, self._across), 0.0)

    def share_of_ended(self) -> float:
        """Sum of the sizes of the forces at the start on disks that have broken off since, over all forces."""
        return float(self._size[self._ended].sum() / self._all) if self._size.any() else 0.0

    def largest_turn(self, displacement: np.ndarray) -> tuple[float, int]:
        """The largest rotation (rad) of a disk that bears a force at rest at a side, and the number of its carrier."""
        acts = (self._size > 0.0) & ~self.let_go
        found = 0.0, 0
        for number, each in enumerate(self._carriers):
            nodes = each.nodes[acts[each.nodes]]
            if len(nodes):
                turn = float(np.abs(displacement[2, nodes] - self.datum[2, nodes]).max())
                found = max(found, (turn, number))
        return found

    @property
    def sides(self) -> list[str]:
        """The side of each carrier."""
        return [each.side for each in self._carriers]

    def _note_begin(self) -> None:
        """Note the sizes (n,) N of the forces at the start, without those that a side takes or that are left over."""
        force = (self._begun + self._across)[:2]
        size = np.hypot(*np.where(self._scene.moves[:2], force, 0.0))
        self._size = np.where(size > BEARS * np.hypot(*force).max(initial=0.0), size, 0.0)
        self._all = float(np.hypot(*force).sum())

    def _leave_sides(self) -> None:
        """Compute the rotation of each side from its remaining particles."""
        followers = self.followers
        followers.twin[self._ended[followers.member]] = GONE
        for first, last in pairwise(followers.start):
            left = first + np.flatnonzero(followers.twin[first:last] != GONE)
            if len(left):
                followers.arm[:, left] -= followers.arm[:, left].mean(axis=1, keepdims=True)


_FOLLOWING = ("twin", "arm", "force", "steady", "extra")
"""The arrays of its followers that change."""


def mean_rotations(scene: DiskBody, moved: np.ndarray) -> dict[str, float]:
    """Rotation (rad) by which the forces on each side rotate, for displacements (3, n); see `side_rotations`."""
    still = np.zeros_like(moved)
    followers = _followers(scene, still, still, still, still)
    return dict(zip(_body_sides(scene), side_rotations(moved.copy(), followers).tolist(), strict=True))


def _body_sides(scene: DiskBody) -> dict[str, np.ndarray]:
    """The particles of each side of a body that can rotate: not of a free-field column or a periodic body."""
    if any(table.is_periodic for table in scene.case.boundary.values()):
        return {}
    first = scene.column_count
    sides = {}
    for side, edge in scene.edges.items():
        own = edge.nodes[edge.nodes >= first]
        # the column does not end at the level of a box in the ground, whose disks there are those with ties
        sides[side] = own if len(own) > 1 else scene.tied.get(side, own)
    return {side: nodes for side, nodes in sides.items() if len(nodes) > 1}


def _followers(
    scene: DiskBody, force: np.ndarray, steady: np.ndarray, datum: np.ndarray, across: np.ndarray
) -> Followers:
    """The forces on the sides of a body; a force at a corner is shared equally by its two sides. See `Balance`."""
    sides = _body_sides(scene)
    places = scene.positions.T + datum[:2]
    arms = [places[:, nodes] - places[:, nodes].mean(axis=1, keepdims=True) for nodes in sides.values()]
    members = np.concatenate([np.zeros(0, np.int64), *sides.values()])
    node, side = _side_numbers(scene, sides)
    names = list(sides)
    twin, rest = np.full(len(members), -1), datum[:2, members].copy()
    if scene.twin is not None:
        twin = scene.twin[members]
        rest -= datum[:2, twin]
    opposite = [names.index(OPPOSITE[side] if OPPOSITE[side] in names else side) for side in names]
    return Followers(
        opposite=np.array(opposite, np.int64),
        start=np.cumsum([0, *(len(nodes) for nodes in sides.values())]),
        member=members,
        twin=twin,
        arm=np.concatenate([np.zeros((2, 0)), *arms], axis=1),
        node=node,
        side=side,
        force=np.ascontiguousarray(_shares(side)[:, None, :] * (force + across)[:2, node]),
        steady=np.ascontiguousarray((steady + force)[:2, node]),
        extra=np.zeros((2, len(node))),
        rest=rest,
    )


def _shares(side: np.ndarray) -> np.ndarray:
    """Share (2, q) of a particle's force that rotates with each of its sides, by their numbers (2, q)."""
    return (side >= 0) / (side >= 0).sum(axis=0)


def _side_numbers(scene: DiskBody, sides: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Particles (q,) whose forces rotate, and the numbers (2, q) of the one or two sides of each, −1 for none.

    They are the particles of the sides, and at a free field those with contacts beyond it.
    """
    pushed = dict(sides)
    pushed |= {side: np.union1d(sides[side], near) for side, near in scene.tied.items() if side in sides}
    node = np.unique(np.concatenate([np.zeros(0, np.int64), *pushed.values()]))
    number = np.full((2, len(node)), -1)
    for k, nodes in enumerate(pushed.values()):
        at = np.searchsorted(node, nodes)
        row = (number[:, at] >= 0).sum(axis=0)
        number[row[row < 2], at[row < 2]] = k  # a third side, in a very narrow body, is ignored
    return node, number
