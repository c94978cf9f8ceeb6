"""The most RAM that a run of disks needs, from the numbers of its disks and contacts.

Bytes are counted from the shapes of arrays, for n disks in s slots with b contacts; the history-dependent law lists p
pairs, in q places. Temporary arrays are those of the largest moment of a stage. Zeros that are never written to take
no RAM: steady forces without loads, work space for contacts that are computed one by one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.material import Material
from dembound.casefile.types import LAWS
from dembound.continuum.medium import Medium
from dembound.continuum.sizing import GridSizes, body_bytes, header_bytes, snapshot_bytes
from dembound.disks.contacts.layout import LEAST_FILL
from dembound.disks.contacts.pairs import PIECE
from dembound.disks.contacts.row_plan import columns_of
from dembound.disks.material.packed_material import nominal_moduli
from dembound.disks.surroundings.settings import expected_tops, mesh_of, settings_of, signals_of
from dembound.kernels.compiler.lanes import LANES
from dembound.motion.resources import largest, ledger_bytes, motion_bytes, must_fit, record_bytes
from dembound.places import is_within

PAIRS_PER_CONTACT = 1.08
"""Listed pairs over contacts: those with a gap below `contacts.SKIN` are listed, too. In random bricks 1.07 to 1.08."""


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
    if not sides or (
        case.outside.element is None and case.static is None and not signals_of(case)
    ):  # which cannot be built
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
    return sum(each) + twin * len(each)


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
    excavated = any(hole.stage == "after" for hole in case.hole)
    return run_bytes(case, [expected], expected if excavated else None)


def run_bytes(case: DiskCase, scenes: Sequence[SceneSizes], before: SceneSizes | None = None) -> float:
    """Largest RAM (bytes) of a run.

    scenes : of the case, and, if there is one, of the row stepped in its place; before : the scene before an
    excavation.
    """
    whole, stepped = scenes[0], scenes[-1]
    built = sum(scene_bytes(case, z) for z in ([*scenes] if before is None else [*scenes, before]))
    stages = {"build": scene_bytes(case, before or whole) + building_bytes(before or whole)}
    stages["export"] = export_bytes(case, whole)
    stages["run"] = built + _run_bytes(case, whole, stepped)
    if case.static is not None:
        kept = 0.0 if before is None else pairs_bytes(case, before)  # from which the excavated body begins
        stages["settle"] = built + kept + _settling_bytes(case, before or whole)
    elif _has_history(case):
        stages["list"] = built + listing_bytes(stepped)
    return largest(stages, case)


def scene_bytes(case: DiskCase, z: SceneSizes) -> float:
    """Bytes of a scene: positions, radii, twins and tiles (36 n), slots, mass, inertia, part of a cell; its contacts.

    Pairs and types (12 b), for the kernels one by one 4 n + 16 b; in rows the node of each slot. Steady loads (3, n).
    """
    rows = 8 * z.slots if z.in_rows else 4 * z.disks + 16 * z.contacts
    if z.grid is not None:
        rows += body_bytes(z.grid) + (354 + 32 * (z.grid.order + 1)) * z.ties  # half bonds, and these for the kernels
    return (36 + 8 + 24 + 24 * bool(case.load)) * z.disks + 12 * z.contacts + rows


def building_bytes(z: SceneSizes) -> float:
    """Bytes of temporary arrays as contacts are sorted: columns and lanes (24 n), ends with their keys (66 b)."""
    return 24 * z.disks + 66 * z.contacts


def pairs_bytes(case: DiskCase, z: SceneSizes) -> float:
    """Bytes of the list of pairs with a history.

    For q places 38 bytes of numbers, types and states, and forces (4, q); per pair its place, image and two ends (18
    p); per slot the ends, arms and origin (28 s); cells (8 n); in rows also the places of disks (24 n). Factors of
    strengths take 8 q and tiles (16 n), dashpots 32 q with masses (8 s).
    """
    pairs, places = _pairs(z)
    rows = 24 * z.disks if z.in_rows else 0.0
    if case.material.pb_scatter is not None:
        rows += 8 * places + 16 * z.disks
    if case.material.has_dashpots:
        rows += 32 * places + 8 * z.slots
    return (38 + 32) * places + 18 * pairs + 28 * z.slots + 8 * z.disks + rows


def listing_bytes(z: SceneSizes) -> float:
    """Bytes while pairs are listed anew: the old list without forces (56 p), the new one, arrays to sort by.

    Sorting takes the pairs and their history (52 p), sorted (24 p) with places and owners (24 p), and the order of the
    ends with work space (24 p); the new arrays have 38 q.
    """
    pairs, places = _pairs(z)
    rows = 24 * z.disks if z.in_rows else 0.0
    return (56 + 52 + 24 + 24 + 24) * pairs + 38 * places + 28 * z.slots + 8 * z.disks + rows


def export_bytes(case: DiskCase, z: SceneSizes) -> float:
    """Bytes of a snapshot as a file for ParaView, when the scene is gone.

    Particles and fields as read (84 n), points and vertices with offsets and types (52 n), fields in single precision
    with their temporaries (72 n), bytes and text of the largest array (80 n); with stress 72 n more, with the number
    of contacts 12 n.
    """
    more = 72 * case.output.stress + 12 * _has_history(case) + 12 * case.output.peaks
    return (84 + 52 + 72 + 80 + more) * z.disks if case.output.snapshots else 0.0


def stress_bytes(z: SceneSizes) -> float:
    """Bytes of stresses: displacements in slots, moments and their quotient (3, n), and a piece of the pairs.

    For each of its pairs, their constants (12) and 15 numbers of places, vectors, forces and products.
    """
    return 24 * z.slots + 48 * z.disks + 27 * 8 * min(PIECE, _pairs(z)[1])


def checkpoint_bytes(z: SceneSizes, *, history: bool) -> float:
    """Bytes of a checkpoint: displacements and velocities of disks and nodes (48 n), columns and forces of pairs.

    The columns are numbers, types, images, states and whether they closed (13 p), shear, slip and step (24 p), and
    forces (32 p).
    """
    return 48 * (z.disks + z.moving - z.slots) + (69 * _pairs(z)[0] if history else 0.0)


def _run_bytes(case: DiskCase, whole: SceneSizes, z: SceneSizes) -> float:
    """Bytes of motion, ledger and record of the stepped scene, its pairs, and a snapshot of the whole scene."""
    moving = motion_bytes(z.moving) + ledger_bytes(z.moving) + record_bytes(z.probes, 256, 6, z.supported)
    moving += 8 * z.moving * case.output.peaks
    snapshot = 48.0 * whole.disks
    if not _has_history(case):
        pairs = 13 * z.contacts  # for the strain energy
        steady = 24 * (z.disks + z.slots) * bool(case.load)
    else:
        pairs = pairs_bytes(case, z)
        snapshot += 34 * _pairs(z)[0]  # forces, to count contacts
        steady = 24 * (z.disks + z.slots) + 24 * z.disks  # with the velocity at the change of law
    settled = 2 * 24 * z.disks * (case.static is not None)  # datum and balancing forces
    if case.is_damped:  # memories, forces and layers, and forces at rest
        drag = 48 * (case.damping.type == "rayleigh")
        settled += (24 * case.damping.memories + 25 + 24 * (case.static is not None) + drag) * z.slots
    if case.output.stress:
        snapshot = max(snapshot, 24 * z.disks + stress_bytes(z))
    header = 0.0
    if whole.grid is not None:
        snapshot += snapshot_bytes(whole.grid)
        header = header_bytes(whole.grid)
    checkpoint = checkpoint_bytes(z, history=_has_history(case)) if case.run.checkpoint > 0.0 else 0.0
    kept = max(snapshot * bool(case.output.snapshots), checkpoint, header)
    return moving + kept + pairs + steady + settled


def _settling_bytes(case: DiskCase, z: SceneSizes) -> float:
    """Bytes of a static stage: masses of its own, pairs under any law, and at its end loads, forces and stresses."""
    loads = 24 * (3 * z.disks + z.slots)  # those of the case and of the stage, also in slots, and those of contacts
    moving = motion_bytes(z.slots) + pairs_bytes(case, z) + loads + stress_bytes(z)
    return 24 * z.disks + max(listing_bytes(z), moving + record_bytes(0, 256, 6, z.supported))


def _pairs(z: SceneSizes) -> tuple[float, float]:
    """Numbers of listed pairs and of places for them."""
    pairs = PAIRS_PER_CONTACT * z.contacts
    return pairs, pairs * z.slots / z.disks


def _has_history(case: DiskCase) -> bool:
    return LAWS[case.material.law].has_history
