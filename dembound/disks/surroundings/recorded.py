"""Records of the continuum round a body: its nodes, and their motion with and without the ground's own motion.

Beside a free-field column, and where waves come in that the ground has without the body, the continuum is computed with
the scattered motion only, which is the change by the body. Records have this, and its sum with the ground's motion.
"""

from functools import cached_property

import numpy as np

from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.ground_waves import GroundMotion, UnlikeWaves
from dembound.disks.surroundings.layered_waves import Undisturbed
from dembound.motion.scene import Beside
from dembound.packings.column import nearest_in_column
from dembound.packings.tiling import Assembly


class RecordedContinuum(Beside):
    """The m nodes of the continuum round a body.

    Parameters
    ----------
    outside : the continuum.
    waves : the motion of the ground without the body; None without any.
    disks : the scene's disks, those of its free-field columns first.
    mass : (n,) kg, of the scene's nodes. diameter : m, mean of the brick's disks.
    """

    def __init__(
        self, outside: Surroundings, waves: Undisturbed | None, disks: Assembly, mass: np.ndarray, diameter: float
    ) -> None:
        self.nodes = outside.nodes
        self._outside, self._waves = outside, waves
        self._disks, self._mass, self._diameter = disks, mass, diameter

    @property
    def columns(self) -> dict[str, tuple[np.ndarray, str]]:
        """Data of the nodes for the record: mesh, nearest disks of a column, and where the total motion is known."""
        more: dict[str, tuple[np.ndarray, str]] = {}
        if self._twin is not None:
            more["twin"] = (self._twin, "1")
        if self._is_scattered:
            below = np.zeros(self._outside.count, dtype=np.bool_) if self._twin is None else self._twin < 0
            more["total"] = (~below, "1")
        return self._outside.columns | more

    def motion(self, values: np.ndarray, of: str, time: float) -> dict[str, np.ndarray]:
        """Motion (m, 3) of the nodes by name, from the motion of all nodes of the scene (n, 3).

        With a scattered motion, names with the prefix "scattered_" contain it, and names without the total motion.
        """
        own = values[self.nodes].copy()
        own[:, 2] = 0.0  # elements do not rotate
        if not self._is_scattered:
            return {"": own}
        total = own.copy()
        if self._twin is not None:
            for there, ground, column in zip(self._beside, self._grounds, self._disks.columns, strict=True):
                total += np.where(there[:, None], ground.at_heights(values[column.disks]), 0.0)
        if self._waves is not None:
            total += self._incoming(of, time)
        return {"": total, "scattered_": own}

    def _incoming(self, of: str, time: float) -> np.ndarray:
        """Motion (m, 3) of the ground without the body at the nodes, of either side where these are unlike."""
        assert self._waves is not None
        mesh, times = self._outside.body.mesh, np.array([time])
        if not isinstance(self._waves, UnlikeWaves):
            return self._waves.motion(of, times, mesh.positions)[0]
        left, right = (self._waves.beside(side, of, times, mesh.positions)[0] for side in ("left", "right"))
        return np.where(self._is_right[:, None], right, left)

    @cached_property
    def _is_right(self) -> np.ndarray:
        """Whether each node (m,) is of elements right of the body, also below it."""
        mesh = self._outside.body.mesh
        right = np.zeros(mesh.count, dtype=np.bool_)
        right[mesh.nodes[mesh.is_right].ravel()] = True  # beside a slit none of them are also of other elements
        return right

    @property
    def _is_scattered(self) -> bool:
        """Whether the continuum has the scattered motion only, without the ground's own motion."""
        return bool(self._disks.columns) or self._waves is not None

    @cached_property
    def _numbers(self) -> np.ndarray:
        """The number (m,) of the free-field column that each node moves relative to."""
        return self._is_right.astype(np.int64) if len(self._disks.columns) > 1 else np.zeros_like(self._is_right, int)

    @cached_property
    def _twin(self) -> np.ndarray | None:
        """Disk (m,) of the free-field column nearest to each node, modulo its width; None without a column.

        −1 for nodes below the ground that the column represents.
        """
        if not self._disks.columns:
            return None
        places, twin = self._outside.body.mesh.positions, np.full(self._outside.count, -1)
        for number in range(len(self._disks.columns)):
            own = self._numbers == number
            twin[own] = nearest_in_column(self._disks, places[own], number)
        return twin

    @property
    def _beside(self) -> list[np.ndarray]:
        """Whether each node (m,) moves relative to each of the columns, at its height."""
        assert self._twin is not None
        there = self._twin >= 0
        return [there & (self._numbers == number) for number in range(len(self._disks.columns))]

    @cached_property
    def _grounds(self) -> list[GroundMotion]:
        """The motion of the ground at the nodes, from that of each column."""
        up, heights = self._disks.positions[:, 1], self._outside.body.mesh.positions[:, 1]
        columns = [column.disks for column in self._disks.columns]
        return [GroundMotion(up[own], self._mass[own], self._diameter, heights) for own in columns]
