"""A body that a static stage has brought to rest."""

from dataclasses import dataclass, fields
from typing import Any, Self

import numpy as np

from dembound.disks.rest.block_stress import Uniformity
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.contact_lists import contact_lists
from dembound.disks.stepping.start import Start
from dembound.motion.cracks import Cracks
from dembound.motion.state import Arrays, within
from dembound.table import every_key

NUMBERS = ("steps", "ratio", "mean_reaction", "mean_residual", "stress")
"""Names of the numbers of a stage kept besides its body, cracks and blocks."""


@dataclass(frozen=True)
class Settled:
    """A body at rest, and the results of its static stage.

    Attributes
    ----------
    start : the state in which the run begins.
    steps : number of steps of the stage.
    ratio : mean unbalanced over mean contact force at the end.
    mean_reaction : N, mean force of supports and tractions on the particles they act on.
    mean_residual : N, mean unbalanced force on all other particles, which F_0 balances too.
    stress : (3,) mean xx, yy, xy in Pa inside the body's rim, tension positive, see `block_stress`. uniformity :
    deviation of blocks from a target stress; None without one.
    cracks : the bonds that broke during the stage.
    before : results before an excavation, if there was one, with the numbering of particles before it. column : results
    of the free-field column settled by itself, if there is one.
    """

    start: Start
    steps: int
    ratio: float
    mean_reaction: float
    mean_residual: float
    stress: np.ndarray
    cracks: Cracks
    uniformity: Uniformity | None = None
    before: "Settled | None" = None
    column: "Settled | None" = None

    def saved_arrays(self) -> Arrays:
        """All arrays from which `restored` restores the settled body in another run; without the stages before."""
        start = self.start
        kept = {name: np.array(getattr(self, name)) for name in NUMBERS}
        kept |= {"displacement": start.displacement, "has_history": np.array(start.has_history)}
        if self.uniformity is not None:
            kept |= {f"uniformity/{name}": values for name, values in self.uniformity.saved_arrays().items()}
        kept |= {f"cracks/{field.name}": getattr(self.cracks, field.name) for field in fields(Cracks)}
        for part, pairs in start.contacts.items():
            kept |= {f"contacts/{part}/{name}": values for name, values in pairs.saved_arrays().items()}
        return kept

    @classmethod
    def restored(cls, scene: DiskScene, saved: Arrays) -> Self:
        """The settled body of an equal scene restored from the arrays returned by `saved_arrays`."""
        contacts = contact_lists(scene) if any(name.startswith("contacts/") for name in saved) else {}
        for part, pairs in contacts.items():
            pairs.restore(within(saved, f"contacts/{part}"))
        cracks, uniformity = within(saved, "cracks"), within(saved, "uniformity")
        return cls(
            start=Start(among(saved["displacement"], scene), contacts, bool(saved["has_history"])),
            steps=int(saved["steps"]),
            ratio=float(saved["ratio"]),
            mean_reaction=float(saved["mean_reaction"]),
            mean_residual=float(saved["mean_residual"]),
            stress=saved["stress"].copy(),
            cracks=Cracks(**{field.name: cracks[field.name] for field in fields(Cracks)}),
            uniformity=Uniformity.restored(uniformity) if uniformity else None,
        )


def among(displacement: np.ndarray, scene: DiskScene) -> np.ndarray:
    """Displacements (3, …) of a scene's disks extended to all its nodes, zero for nodes of continua.

    The displacement of a continuum is counted from rest: forces of its ties at rest are part of the balanced forces.
    """
    of_all = np.zeros((3, scene.count))
    of_all[:, : scene.disk_count] = displacement[:, : scene.disk_count]
    return of_all


def settling_keys(scene: DiskScene) -> dict[str, Any]:
    """All inputs that determine the result of a scene's static stage, as plain JSON values by key.

    Boundaries: free fields, which settle too, half cells, whose mass is halved, sides that belong to the packing, and
    continua that settle beside a free-field column, with all settings, also chosen ones. Loads: the steady ones.
    """
    case = scene.case
    if case.static is None:
        return {}
    tables = {name: getattr(case, name) for name in ("packing", "material", "motion", "hole", "static")}
    loads = [load for load in case.load if load.wave is None]
    sides = {side: every_key(table) for side, table in case.boundary.items() if table.needs_column}
    joined = {side: {"type": t.type} for side, t in case.boundary.items() if t.is_periodic or t.is_mirror}
    halved = {side: True for side, table in case.boundary.items() if table.half_cells}
    keys = {**tables, "load": loads, "boundary": sides | joined, "half_mass": halved}
    if scene.outside is not None and scene.outside.twin is not None:
        keys["outside"] = case.outside.model_copy(update=scene.outside.settings.given)
        keys["outside_sides"] = scene.outside.sides
        if scene.ground.is_layered:
            keys["outside_rows"] = [float(height) for height in scene.outside.body.mesh.heights]
    if case.intact:
        keys["intact"] = case.intact
    if case.layer:
        keys["layer"] = case.layer
    if scene.ground.is_damped:
        keys["unrelaxed"] = [each and each.unrelaxed for each in scene.ground.mechanisms_by_layer]
    settling = every_key(keys) | {"particles": scene.disk_count, "reduced": list(scene.reduced)}
    del settling["static"]["from"]
    return settling
