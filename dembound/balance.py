"""The constant forces that balance the internal stress of a settled body: Z's unbalanced forces F_eq, sign turned.

Under the law that follows the motion they turn with the side they act on, and they end on debris.
"""

import numpy as np

from dembound.boundaries import OPPOSITE, FreeField
from dembound.contacts import ContactList
from dembound.kernels.follower import side_rotations
from dembound.kernels.fragments import outside_largest
from dembound.kernels.tables import Followers
from dembound.scene import Scene


class Balance:
    """Forces that balance the stress of a body at a datum.

    Parameters
    ----------
    scene : the body and its sides.
    force : (3, n) N and N·m at the datum.
    steady : (3, n) other steady forces, which never turn.
    datum : (3, n) displacements at which the body is in equilibrium.
    across : (3, n) N and N·m, what comes through free-field seams at the datum: no load, but it turns with the body and
        ends on debris all the same.

    Attributes
    ----------
    force : (3, n) N and N·m, in the directions of the datum.
    followers : what turns them, for the kernels.
    """

    def __init__(
        self, scene: Scene, force: np.ndarray, steady: np.ndarray, datum: np.ndarray, across: np.ndarray
    ) -> None:
        self.force = force
        self.followers = _followers(scene, force, steady, datum, across)
        self._datum, self._across = datum, across
        self._of_ended = 0.0
        self._ended = np.zeros(scene.count, dtype=np.bool_)

    def work(self, displacement: np.ndarray) -> float:
        """Work (J) done up to displacements (3, n), without what turning has added, which the kernels count."""
        return self._of_ended + float(np.sum(self.force * (displacement - self._datum)))

    def end_on_debris(
        self, contacts: ContactList, displacement: np.ndarray, velocity: np.ndarray, step: float, load: np.ndarray
    ) -> None:
        """End the forces on particles that neither bonds nor closed contacts join to their body's largest piece.

        displacement (3, n) and velocity (3, n) are those after a step (s). load (3, n), all steady forces, loses what
        ends; what keeps coming through a seam is taken off by its constant part.
        """
        loose = np.zeros(len(self._ended), dtype=np.bool_)
        for body in contacts.bodies:
            loose[body] = outside_largest(contacts.arrays, body.start, body.stop)
        loose &= ~self._ended
        if not loose.any():
            return
        self._ended |= loose
        change = np.where(loose, -self._across - self.force, 0.0)
        # the force of the last step acted until half a step before the displacements of now
        self._of_ended -= float(np.sum(change * (displacement - 0.5 * step * velocity - self._datum)))
        self.force += change
        load += change
        followers = self.followers
        turned = loose[followers.node]
        load[:2, followers.node[turned]] -= followers.extra[:, turned]
        followers.force[..., turned] = 0.0
        followers.extra[:, turned] = 0.0
        followers.steady[:, turned] += change[:2, followers.node[turned]]


def mean_rotations(scene: Scene, moved: np.ndarray) -> dict[str, float]:
    """Rotation (rad) by which forces on each side turn, of a body that has moved by (3, n), see `side_rotations`."""
    still = np.zeros_like(moved)
    followers = _followers(scene, still, still, still, still)
    return dict(zip(_body_sides(scene), side_rotations(moved, followers).tolist(), strict=True))


def _body_sides(scene: Scene) -> dict[str, np.ndarray]:
    """The particles of each side, without those of a free-field column, which cannot turn."""
    first = 0 if scene.seam is None else scene.seam.count
    sides = {side: edge.nodes[edge.nodes >= first] for side, edge in scene.edges.items()}
    return {side: nodes for side, nodes in sides.items() if len(nodes) > 1}


def _followers(scene: Scene, force: np.ndarray, steady: np.ndarray, datum: np.ndarray, across: np.ndarray) -> Followers:
    """The forces on the sides of a body, half of a corner's with each of its two sides; words as in `Balance`."""
    sides = _body_sides(scene)
    places = scene.assembly.positions.T + datum[:2]
    arms = [places[:, nodes] - places[:, nodes].mean(axis=1, keepdims=True) for nodes in sides.values()]
    members = np.concatenate([np.zeros(0, np.int64), *sides.values()])
    node, side = _side_numbers(scene, sides)
    share = (side >= 0) / (side >= 0).sum(axis=0)
    names = list(sides)
    return Followers(
        opposite=np.array(
            [names.index(OPPOSITE[side] if OPPOSITE[side] in names else side) for side in names], np.int64
        ),
        start=np.cumsum([0, *(len(nodes) for nodes in sides.values())]),
        member=members,
        twin=np.full(len(members), -1) if scene.seam is None else scene.seam.twin[members],
        arm=np.concatenate([np.zeros((2, 0)), *arms], axis=1),
        node=node,
        side=side,
        force=share[:, None, :] * (force + across)[:2, node],
        steady=(steady + force)[:2, node],
        extra=np.zeros((2, len(node))),
        datum=datum,
    )


def _side_numbers(scene: Scene, sides: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Particles (q,) on which forces turn, and the numbers (2, q) of the one or two sides of each, −1 for none.

    Those of the sides, and beside a free field those with contacts beyond it.
    """
    pushed = dict(sides)
    if scene.seam is not None:
        left = scene.assembly.positions[scene.seam.node, 0] < 0.5 * scene.size[0]
        for side, near in (("left", left), ("right", ~left)):
            if isinstance(scene.case.boundary.get(side), FreeField) and side in sides:
                pushed[side] = np.union1d(sides[side], scene.seam.node[near])
    node = np.unique(np.concatenate([np.zeros(0, np.int64), *pushed.values()]))
    number = np.full((2, len(node)), -1)
    for k, nodes in enumerate(pushed.values()):
        at = np.searchsorted(node, nodes)
        row = (number[:, at] >= 0).sum(axis=0)
        number[row[row < 2], at[row < 2]] = k  # of a very narrow body a particle may have a third side, left out
    return node, number
