"""The most RAM that a run of disks needs, and the bytes on disk of its results, from numbers of disks and contacts.

The history-dependent law lists pairs, those of a disk in as many places as it has slots. Temporary arrays are those of
the largest moment of a stage. Zeros that are never written take no RAM: steady forces without loads, work space for
contacts that are computed one by one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.material import Material
from dembound.casefile.types import LAWS
from dembound.continuum.medium import Medium
from dembound.continuum.sizing import GridSizes
from dembound.disks.contacts.layout import LEAST_FILL
from dembound.disks.contacts.pairs import PIECE
from dembound.disks.contacts.row_plan import columns_of
from dembound.disks.material.case_material import nominal_moduli
from dembound.disks.surroundings.elements import mesh_of
from dembound.disks.surroundings.near_fields import signals_of
from dembound.disks.surroundings.settings import expected_tops, settings_of
from dembound.kernels.compiler.lanes import LANES
from dembound.motion.memory import Storage, for_paraview, largest, must_fit, recorded, total
from dembound.places import is_within

PAIRS_PER_CONTACT = 1.08
"""Listed pairs over contacts: those with a gap below `contacts.SKIN` are listed, too. In random bricks 1.07 to 1.08."""

BLOCK, WIDTH = 256, 6
"""Steps of a block of the record, and numbers of a node in it."""


@dataclass(frozen=True)
class SceneSizes:
    """Numbers of disks, of the slots that hold them, of contacts, and of lines of the support table.

    in_rows : whether copies of a disk stand side by side, see layout.py. grid : the numbers of a continuum beyond the
    sides, None without it. ties : number of half bonds to it. probes : nodes whose motion is recorded at every step.
    """

    disks: float
    slots: float
    contacts: float
    supported: float
    in_rows: bool
    grid: GridSizes | None = None
    ties: int = 0
    probes: int = 0

    @property
    def moving(self) -> float:
        """Number of slots of disks and nodes."""
        return self.slots + (0 if self.grid is None else self.grid.nodes)

    @property
    def counts(self) -> dict[str, float]:
        """Numbers of all things that take memory, see `motion.memory.BYTES`."""
        pairs = PAIRS_PER_CONTACT * self.contacts
        places = pairs * self.slots / self.disks
        beyond: dict[str, float] = {}
        if self.grid is not None:
            beyond = {**self.grid.counts, "tie": self.ties, "tie_row": self.ties * (self.grid.order + 1)}
        disks = {"disk": self.disks, "disk_slot": self.slots, "slot": self.moving, "contact": self.contacts}
        listed = {"pair": pairs, "place": places, "piece": min(PIECE, places)}
        return disks | listed | recorded(self.probes, BLOCK, WIDTH, self.supported) | beyond

    @classmethod
    def expected(cls, case: DiskCase) -> SceneSizes:
        """The numbers of a case before it is built, without its holes; for random bricks within some 3 %."""
        packing = case.packing
        across, up = packing.copies
        disks = packing.expected_disks
        lanes, in_rows = _lanes(case), stands_in_rows(case)
        if case.column_sides:
            disks *= 1.0 + case.column_rows[1] / (across * up)
        everywhere = any(load.wave is not None and (load.is_everywhere or load.region) for load in case.load)
        width, height = packing.extent
        lengths = {"left": height, "right": height, "bottom": width, "top": width}
        sides = sum(3.0 * lengths[side] / (2.0 * packing.radius) for side in case.boundary)  # three components each
        return cls(
            disks=disks,
            slots=disks * lanes if in_rows else disks,
            contacts=disks * packing.expected_contacts,
            supported=min(3.0 * disks if everywhere else sides, 3.0 * disks),
            in_rows=in_rows,
            grid=_expected_grid(case),
            probes=_expected_probes(case),
        )


def stands_in_rows(case: DiskCase) -> bool:
    """Whether copies of a disk of the brick will be held side by side in RAM, see contacts/layout.py."""
    return math.prod(case.packing.copies) > 1 and _lanes(case) * LEAST_FILL <= 1.0


def _lanes(case: DiskCase) -> float:
    """Slots per disk where copies are held side by side; in layers only those at the same height are."""
    across, up = case.packing.copies
    columns = up * -(-across // LANES) if case.layer else columns_of(min(across, up), max(across, up))
    return LANES * columns / (across * up)


def _expected_grid(case: DiskCase) -> GridSizes | None:
    """The numbers of a continuum in a medium of the nominal speed of P waves; S waves have half of it, or more.

    In layers it is that of the slowest.
    """
    sides = [side for side, table in case.boundary.items() if table.is_outside]
    cannot_be_built = case.outside.element is None and case.static is None and not signals_of(case)
    if not sides or cannot_be_built:
        return None
    speed, material = min(((_nominal_speed(each), each) for each in case.materials), key=lambda each: each[0])
    medium = Medium.isotropic(material.density, speed, 0.5 * speed)
    box, surface = case.packing.box, None
    if "top" in sides and not case.reaches_surface:
        surface = case.box[3]
    settings = settings_of(case, medium, 2.0 * case.packing.radius, box, sides)
    tops = None if any(case.periodic) else expected_tops(case, box)
    return GridSizes.of(mesh_of(settings, box, sides, surface=surface, tops=tops, periodic=case.periodic))


def _nominal_speed(material: Material) -> float:
    """Speed (m/s) of P waves that a material gives, or that follows from its moduli by Z eq. 11."""
    moduli = nominal_moduli(material)
    return material.p_wave_speed or math.sqrt((moduli.emod + moduli.pb_emod) / material.density)


def _expected_probes(case: DiskCase) -> int:
    """Number of recorded nodes: the disk at each monitor, or the element's nodes and a column disk, with twins."""
    twin = int(bool(case.column_sides))
    of_element = (case.outside.order + 1) ** 2 + twin
    of_body = [is_within(case.packing.box, monitor.position, case.packing.span) for monitor in case.monitor]
    each = [1 if is_inside else of_element for is_inside in of_body]
    each += [math.ceil(area(m.points) / (4.0 * case.packing.radius**2)) for m in case.monitor if m.points]
    return sum(each) + twin * len(each)


def area(points: Sequence[tuple[float, float]]) -> float:
    """Area (m²) of a polygon."""
    x, y = np.transpose(points)
    return 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))


def must_fit_here(case: DiskCase) -> None:
    """Raise CaseError if a run of a case needs more RAM than is free on this machine, without building it."""
    key = "packing.size" if case.packing.size is not None else "packing.bricks"
    expected = SceneSizes.expected(case)
    things = f"{expected.disks:.3g} disks"
    if expected.grid is not None:
        things += f" and {expected.grid.nodes:.3g} nodes of the continuum beyond them"
        key = "outside" if expected.grid.nodes > expected.disks else key
    must_fit(expected_bytes(case), key, things)


def expected_bytes(case: DiskCase) -> float:
    """Largest RAM (bytes) of a run of a case, computed without building it."""
    expected = SceneSizes.expected(case)
    excavated = any(hole.stage == "after" for hole in case.holes)
    return run_bytes(case, [expected], expected if excavated else None)


def run_bytes(case: DiskCase, scenes: Sequence[SceneSizes], before: SceneSizes | None = None) -> float:
    """Largest RAM (bytes) of a run.

    scenes : of the case, and, if there is one, of the row stepped in its place; before : the scene before an
    excavation.
    """
    whole, stepped, first = scenes[0], scenes[-1], before or scenes[0]
    built = sum(scene_bytes(case, z) for z in ([*scenes] if before is None else [*scenes, before]))
    stages = {"build": scene_bytes(case, first) + total(first.counts, "sorting")}
    stages["run"] = built + _run_bytes(case, whole, stepped)
    if case.output.snapshots:  # when the scene is gone
        output = case.output
        numbers = _has_history(case) + output.peaks
        stages["export"] = total(whole.counts, "export", export_stress=output.stress, export_number=numbers)
    if case.static is not None:
        kept = 0.0 if before is None else pairs_bytes(case, before)  # from which the excavated body begins
        stages["settle"] = built + kept + _settling_bytes(case, first)
    elif _has_history(case):
        stages["list"] = built + _listing_bytes(case, stepped)
    return largest(stages, case)


def scene_bytes(case: DiskCase, z: SceneSizes) -> float:
    """Bytes of a scene, with the arrays of the law of a continuum."""
    rows = {"in_rows": z.in_rows, "one_by_one": not z.in_rows}
    return total(z.counts, "scene", "mesh", "layers", "half_bonds", steady=bool(case.load), **rows)


def pairs_bytes(case: DiskCase, z: SceneSizes) -> float:
    """Bytes of the list of pairs with a history."""
    scatter, dashpots = case.material.pb_scatter is not None, case.material.has_dashpots
    every = {"pairs_in_rows": z.in_rows, "scatter": scatter, "dashpots": dashpots, "arms": case.relaxes}
    every["rolling"] = _resists_rolling(case)
    return total(_with_arms(case, z), "pairs", **every)


def _resists_rolling(case: DiskCase) -> bool:
    """Whether contacts without bonds resist rolling in some layer."""
    return any(material.rr_fric > 0.0 for material in case.materials)


def _listing_bytes(case: DiskCase, z: SceneSizes) -> float:
    """Bytes while pairs are listed anew."""
    arms = case.relaxes * (1.0 if z.in_rows else 3.0)  # of pairs in no row also the old list, and that to sort
    return total(_with_arms(case, z), "listing", pairs_in_rows=z.in_rows, arms=arms)


def _with_arms(case: DiskCase, z: SceneSizes) -> dict[str, float]:
    """Numbers of all things, with the relaxation arms of places and of pairs."""
    arms = case.damping.memories * case.relaxes
    return z.counts | {"arm": arms * z.counts["place"], "kept_arm": arms * z.counts["pair"]}


def _run_bytes(case: DiskCase, whole: SceneSizes, z: SceneSizes) -> float:
    """Bytes of motion, ledger and record of the stepped scene, its pairs, and a snapshot of the whole scene."""
    has_history, damping = _has_history(case), case.damping
    counts, remembers, settles = _with_arms(case, z), case.is_damped and not case.relaxes, case.static is not None
    if remembers:
        counts["memory"] = damping.memories * z.slots
    asked = {"peaks": case.output.peaks, "loads": bool(case.load) or has_history, "settled": settles}
    of_law = {"strain_energy": not has_history, "change": has_history, "damping": remembers}
    damped = {"damped_rest": remembers and settles, "drag": remembers and damping.type == "rayleigh"}
    moving = total(counts, "motion", "ledger", "record", **asked, **of_law, **damped)
    pairs = pairs_bytes(case, z) if has_history else 0.0
    fields = total(whole.counts, "fields", contact_count=has_history)
    if case.output.stress:
        fields = max(fields, total(counts, "stress", "stress_field"))
    fields = (fields + total(whole.counts, "mesh_fields")) * bool(case.output.snapshots)
    saved = {"saved_pairs": has_history, "saved_arms": case.relaxes, "saved_rolling": _resists_rolling(case)}
    checkpoint = total(counts, "saved", **saved) * (case.run.checkpoint > 0.0)
    return moving + pairs + max(fields, checkpoint, total(whole.counts, "mesh_header"))


def _settling_bytes(case: DiskCase, z: SceneSizes) -> float:
    """Bytes of a static stage: its motion, pairs under any law, and at its end loads, forces and stresses."""
    counts = z.counts | {"slot": z.slots, "sample": 0.0}
    moving = total(counts, "motion", "settling_loads", "stress", "record") + pairs_bytes(case, z)
    return total(counts, "settling") + max(moving, _listing_bytes(case, z))


def storage_of(case: DiskCase, z: SceneSizes) -> Storage:
    """Bytes on disk of the results of a scene."""
    counts, output, has_history, layered = _with_arms(case, z), case.output, _has_history(case), bool(case.layer)
    fields = {"tensors": output.stress, "numbers": has_history}
    numbers = has_history + output.peaks + layered
    vtu = total(counts, "vtu", vtu_forces=output.contacts, **fields | {"numbers": numbers})
    vtkhdf = total(counts, "vtkhdf", vtkhdf_forces=output.contacts, **fields)
    record = total(
        counts, "snapshot", tensors=output.stress, coordination=has_history, forces=output.contacts, pieces=has_history
    )
    fixed = for_paraview(output.paraview, 0.0, total(counts, "vtkhdf_header", numbers=layered))
    stages = {
        "saved_pairs": has_history,
        "saved_arms": case.relaxes,
        "saved_rolling": has_history and _resists_rolling(case),
        "state_history": has_history,
        "state_settled": case.static is not None,
    }
    return Storage(
        header=total(counts, "header", numbers=layered) + fixed,
        snapshot=record + for_paraview(output.paraview, vtu, vtkhdf),
        checkpoint=total(counts, "saved", "state", "layers", **stages),
    )


def _has_history(case: DiskCase) -> bool:
    return LAWS[case.material.law].has_history
