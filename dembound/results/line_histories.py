"""Histories of the lines of a scene in its record: of walls and joints."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from dembound.motion.part import System
from dembound.motion.scene import Scene
from dembound.results.datasets import extend, make, write

if TYPE_CHECKING:
    import h5py

COLUMNS = {
    "walls": (("time", (), "f8", "s"), ("displacement", (2,), "f8", "m"), ("force", (2,), "f8", "N/m")),
    "joints": (
        ("time", (), "f8", "s"),
        ("slip", (), "f8", "m"),
        ("opening", (), "f8", "m"),
        ("pressure", (), "f8", "Pa"),
        ("shear", (), "f8", "Pa"),
        ("closed", (), "f8", "1"),
        ("sliding", (), "f8", "1"),
    ),
}
"""Columns that grow by the groups of a record: name, shape of a row, type, unit."""


def make_lines(file: h5py.File, scene: Scene) -> None:
    """The groups of the lines of a scene, with their points and empty columns."""
    for kind, lines in scene.lines.items():
        for name, points in lines.items():
            write(file.create_group(f"{kind}/{name}"), "points", points, "m")
            make(file[f"{kind}/{name}"], COLUMNS[kind])


class LineHistories:
    """What lines of a scene have done since it was last written.

    Attributes
    ----------
    samples : by kind, arrays (k, l, columns) of its l lines in k steps.
    """

    def __init__(self, scene: Scene) -> None:
        self._lines = {kind: tuple(lines) for kind, lines in scene.lines.items()}
        self.samples: dict[str, list[np.ndarray]] = {kind: [] for kind in self._lines}

    def datasets(self, file: h5py.File) -> Iterator[tuple[str, dict[str, h5py.Dataset]]]:
        """Kind and growing columns of each line in a record."""
        for kind, names in self._lines.items():
            for name in names:
                yield kind, {column: file[kind][name][column] for column, *_ in COLUMNS[kind]}

    def find(self, file: h5py.File) -> None:
        """Keep the columns of a record, as searching them takes as long as extending them."""
        self._found: dict[str, list[dict[str, h5py.Dataset]]] = {kind: [] for kind in self._lines}
        for kind, columns in self.datasets(file):
            self._found[kind].append(columns)

    @property
    def counts(self) -> dict[str, int]:
        """Rows of the histories of each kind."""
        found = {kind: [len(each["time"]) for each in histories] for kind, histories in self._found.items()}
        return {kind: max(found.get(kind, ()), default=0) for kind in COLUMNS}

    @property
    def kept(self) -> list[np.ndarray]:
        """All samples that are not written."""
        return [each for samples in self.samples.values() for each in samples]

    def take(self, system: System, steps: np.ndarray) -> None:
        """Keep what lines did in some of the last steps (k,)."""
        samples = {"walls": system.wall_samples, "joints": system.joint_samples}
        for kind, names in self._lines.items():
            if names:
                self.samples[kind].append(samples[kind](steps))

    def append(self, times: np.ndarray) -> None:
        """Write the samples, which are those at times (k,) s."""
        for kind, histories in self._found.items():
            for number, history in enumerate(histories):
                values, first = np.concatenate([each[:, number] for each in self.samples[kind]]), 0
                extend(history["time"], times)
                for name, shape, *_ in COLUMNS[kind][1:]:
                    extend(history[name], values[:, first : first + math.prod(shape)].reshape(-1, *shape))
                    first += math.prod(shape)
            self.samples[kind] = []
