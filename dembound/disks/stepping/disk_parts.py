"""The disks of a scene as parts that are stepped: the free-field column and the body, and the seam between them."""

from collections.abc import Mapping

import numpy as np

from dembound.disks.body import DiskBody
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.contacts.layout import with_supports
from dembound.disks.stepping.contact_lists import contact_lists
from dembound.disks.stepping.continuum_ties import tied_nodes
from dembound.disks.stepping.damped_ground import disk_memories, ties_remembering
from dembound.disks.stepping.part import DiskPart, FreeFieldSeam
from dembound.disks.stepping.start import Start
from dembound.kernels.contacts import UPDATED


class DiskParts:
    """The parts of disks of a scene, which change their law together.

    Parameters
    ----------
    scene : the scene. start : gives the contacts if the scene's law has a history; None: contacts as built.
    watches : whether the loop returns before a contact leaves the elastic law. time_step : s, for which damped ground
    remembers forces; None: damping and dashpots are left out, as in a static stage.

    Attributes
    ----------
    parts : the free-field column, if there is one, and the body. seams : one if there is a column. contacts : the pairs
    of each part by name, empty if the scene's law has no history. damped_ties : the memories of ties; None without ties
    or damping.
    """

    def __init__(self, scene: DiskBody, start: Start | None, time_step: float | None, *, watches: bool) -> None:
        lists: Mapping[str, ContactList] = {}
        if scene.has_history:
            lists = contact_lists(scene) if start is None else start.contacts
        supported = scene.layout.slot[np.union1d(scene.supports.node, tied_nodes(scene))]
        self.parts = tuple(
            DiskPart(
                name, scene.ground, scene.assembly.part(nodes), nodes, with_supports(rows, supported), scene.layout,
                lists.get(name), scene.at_rest,
                None if time_step is None else disk_memories(scene, nodes, rows, supported, time_step),
            )
            for (name, nodes), rows in zip(scene.parts.items(), scene.rows, strict=True)
        )  # fmt: skip
        for part in self.parts:
            part.watches = watches
            part.dashes = time_step is not None
        self.contacts = {part.name: part.contacts for part in self.parts if part.contacts is not None}
        self.seams = () if scene.seam is None else (FreeFieldSeam(scene.seam, self.parts[0]),)
        self.damped_ties = None if time_step is None else ties_remembering(scene, tied_nodes(scene), time_step)

    @property
    def law_name(self) -> str:
        """Name of the law in use, for reports."""
        return self.parts[-1].law_name

    @property
    def uses_history(self) -> bool:
        """Whether the history-dependent law is in use."""
        return all(part.uses_history for part in self.parts)

    @property
    def geometry_follows(self) -> bool:
        """Whether the normals and arms of the history-dependent law follow the motion."""
        return any(pairs.limits.geometry == UPDATED for pairs in self.contacts.values())

    def adopt(self, displacement: np.ndarray) -> None:
        """Set all contacts to the state of the elastic law at displacements (3, n)."""
        for pairs in self.contacts.values():
            pairs.start_from_displacements(displacement)

    def use_history(self) -> None:
        """Use the history-dependent law in all parts from now on."""
        for part in self.parts:
            part.uses_history = True

    @property
    def are_damped(self) -> bool:
        """Whether forces are remembered."""
        return any(part.memories is not None for part in self.parts)

    def rest_at(self, displacement: np.ndarray, of_ties: np.ndarray) -> None:
        """Let memories begin at rest at displacements (3, n), with forces of ties (3, n) other than of seams."""
        for part in self.parts:
            if part.memories is not None:
                part.memories.rest_at(part.layout.spread(displacement), part.elastic_forces(displacement))
        if self.damped_ties is not None:
            force = of_ties.copy()
            for tie in self.seams:
                force[:, tie.nodes] += tie.elastic_forces(displacement)
            self.damped_ties.rest_at(force)

    def stop_at_breaks(self, stops: bool) -> None:
        """Set whether the loop returns after a step in which a bond broke."""
        for part in self.parts:
            part.stops_at_breaks = stops
