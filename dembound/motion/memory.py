"""What a run needs of the machine: RAM and bytes on disk, by numbers of things, and threads.

`BYTES` has the arrays and files of a run of any kind of body, with the bytes per disk, node, contact and so on, counted
from the shapes of arrays. The kinds count the things, and say which arrays there are at the largest moment of each
stage (`disks/memory.py`, `bar/body.py`).
"""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from typing import NamedTuple

import numba

from dembound.casefile.model import Case
from dembound.casefile.tables import ParaView
from dembound.errors import CaseError
from dembound.machine import Memory, memory_here

PROGRAM, PICTURES = 250e6, 285e6
"""Bytes of the interpreter, packages and compiled code during the steps of a run, and once pictures are drawn.

These two are measured, with Python 3.11 on Linux; they differ by some 10 % between versions of the packages. The first
run after an installation also compiles, which takes up to 250 MB more.
"""

DRIVEN_BYTES = 64e6
"""Largest RAM for the drives of a block; with many driven nodes blocks are shorter."""

DOUBLE = 8
"""Bytes of a double."""

Counts = Mapping[str, float]
"""Numbers of things, by the names in `BYTES`."""

BYTES: Mapping[str, Counts] = {
    # --- in RAM, of every kind; a slot is a place of a disk or node in the arrays of the kernels
    "motion": {"slot": 88},  # u, its successor and v (3), both mobilities
    "ledger": {"slot": 64},  # mass and inertia, u and v (3) at the beginning of an entry
    "record": {"sample": 16, "line": 48, "drive": 16},  # twice, of a block of steps; a line has six columns
    "peaks": {"slot": 8},
    # --- in RAM, of disks
    "scene": {"disk": 68, "contact": 12},  # positions, radii, twins, tiles (36), slot, mass, inertia, part of a cell
    "steady": {"disk": 24},  # loads (3)
    "in_rows": {"disk_slot": 8},  # the node of each slot
    "one_by_one": {"disk": 4, "contact": 16},  # for the kernels
    "sorting": {"disk": 24, "contact": 66},  # as contacts are sorted: columns and lanes, ends with their keys
    "pairs": {"place": 70, "pair": 18, "disk_slot": 28, "disk": 8},  # numbers, types, states, forces (4); image, ends
    "pairs_in_rows": {"disk": 24},  # places of disks
    "scatter": {"place": 8, "disk": 16},  # factors of strengths, tiles
    "dashpots": {"place": 32, "disk_slot": 8},  # with masses
    "rolling": {"place": 8},  # rotation that has not slid
    "arms": {"arm": 24},  # lags of relaxation arms, of three components
    "listing": {"pair": 180, "place": 38, "disk_slot": 28, "disk": 8},  # the old list (56), arrays to sort by; new ones
    "strain_energy": {"contact": 13},
    "loads": {"disk": 24, "disk_slot": 24},  # also in slots
    "change": {"disk": 24},  # velocity at the change of law
    "settled": {"disk": 48},  # datum and balancing forces
    "settling": {"disk": 24},  # masses
    "settling_loads": {"disk": 72, "disk_slot": 24},  # those of the case, the stage and contacts, also in slots
    "damping": {"memory": 24, "disk_slot": 25},  # memories of mechanisms, forces and layers
    "damped_rest": {"disk_slot": 24},  # forces at rest
    "drag": {"disk_slot": 48},  # of Rayleigh damping
    "fields": {"disk": 48},  # of a snapshot
    "contact_count": {"pair": 34},  # forces, to count contacts
    "stress": {"disk_slot": 24, "disk": 48, "piece": 216},  # u in slots, moments, quotient; of a piece of the pairs
    "stress_field": {"disk": 24},
    "saved": {"disk": 48, "node": 48},  # a checkpoint: u and v (3)
    "saved_pairs": {"pair": 69},  # numbers, types, images, states, closed (13), shear, slip, step (24), forces (32)
    "saved_rolling": {"pair": 8},
    "saved_arms": {"kept_arm": 24},
    "export": {"disk": 288},  # fields as read (84), points, vertices (52), in single (72), text of the largest (80)
    "export_stress": {"disk": 72},
    "export_number": {"disk": 12},  # of contacts, or peaks
    # --- in RAM, of a continuum; a row of points of an element, the points on its rim
    "mesh": {"node": 139, "element": 16, "row": 16, "point": 16, "rim": 40, "absorbing_row": 48},
    "layers": {"absorbing_point": 64},  # eight convolution variables
    "half_bonds": {"tie": 354, "tie_row": 32},  # and these for the kernels
    "mesh_header": {"node": 113},  # while it is written: positions and flags, cells three times
    "mesh_fields": {"node": 144, "point": 120},  # motion, its change, what is not in the file; 15 numbers for stress
    # --- in RAM, of a bar; a link is a bond, or a place with one bond more for each node
    "bar": {"node": 80},  # places, volumes, masses, inertia, slots (48), springs, sections, limits and drag (32)
    "bonds": {"node": 49, "bond": 24},  # springs, limits, work space; bonds, stiffness, steps they broke in
    "bar_motion": {"node": 56},  # u, its successor and v, of which the first of three rows is moved; mobilities
    "opening": {"link": 72},  # list of bonds that open, if all do, and the steps before they did
    "bands": {"link": 32},  # of the stiffness
    "damage": {"bond": 122},  # families; per pair volumes and factors
    "bar_layer": {"layer_link": 56},  # force, rate, stiffness and two factors; by node as much
    "bar_export": {"node": 290},
    # --- on disk: run.h5
    "header": {"disk": 37, "node": 62},  # positions, radii, twins, bonds; positions and cells
    "bar_header": {"node": 24},  # positions, volumes
    "numbers": {"disk": 4},  # of layers, and for ParaView of contacts or peaks
    "snapshot": {"disk": 48, "node": 72},
    "bar_snapshot": {"node": 64},
    "coordination": {"disk": 8},
    "pieces": {"disk": 4},  # of disks whose bonds have broken
    "tensors": {"disk": 24},
    "forces": {"contact": 41},
    "history": {"sample": 56},  # time, displacement, velocity
    "history_stress": {"sample": 8},
    "side": {"sample": 48},  # with a force in place of velocity, of which there are two
    "entry": {"number": 8},  # of the energy ledger
    # --- on disk: a checkpoint beside what `saved` has
    "state": {"disk": 104, "node": 104},  # datum, both loads, speeds
    "state_history": {"disk": 88},  # velocity at the change of law, state at the last entry, origins
    "state_settled": {"disk": 98},  # forces that balance the stress, before and after, and their datum
    "bar_state": {"node": 96},
    # --- on disk: files for ParaView, before they are text
    "vtu": {"disk": 105, "node": 105},  # position (24), motion (44; with stress 52), others (21; 1), a cell (16; 28)
    "vtu_forces": {"contact": 85},  # a line between two points of its own, with two forces
    "bar_vtu": {"node": 88},
    "bar_vtu_peaks": {"node": 4},
    "vtkhdf": {"disk": 68, "node": 76},  # position and motion
    "vtkhdf_forces": {"contact": 56},
    "vtkhdf_header": {"disk": 53, "node": 42},  # what remains
    "bar_vtkhdf": {"node": 56},
    "bar_vtkhdf_header": {"node": 36},
}
"""Bytes of the arrays and files of a run, for each thing of which there are many."""

TEXT = 4.0 / 3.0
"""Bytes in a VTU file for each byte of data, as it is base64 text."""


def total(counts: Counts, *always: str, **asked: float) -> float:
    """Bytes of rows of `BYTES` for numbers of things, 0 for things that are not counted.

    always : rows. asked : rows that are there if asked for, or so many times.
    """
    rows = dict.fromkeys(always, 1.0) | asked
    each = ((times, *item) for name, times in rows.items() for item in BYTES[name].items())
    return sum(times * size * counts.get(thing, 0.0) for times, thing, size in each)


def recorded(monitors: int, block: int, width: int, lines: float) -> dict[str, float]:
    """Counts of what is kept for a block of steps: numbers of the record, lines of the support table, and drives.

    monitors : probes, each with `width` numbers a step. lines : one for each component of a supported node.
    """
    drives = min(DRIVEN_BYTES / DOUBLE, block * lines)  # of shorter blocks where there are many
    return {"sample": float(block * width * monitors), "line": lines, "drive": drives}


def largest(stages: Mapping[str, float], case: Case) -> float:
    """Bytes of the program in the largest stage of a run.

    stages : bytes of the arrays of each stage before pictures.
    """
    need = PROGRAM + max(stages.values())
    return max(need, PICTURES) if case.output.pictures else need


class Storage(NamedTuple):
    """Bytes on disk of a scene.

    header : of data written once. snapshot : of a snapshot, in the record and in all files for ParaView.
    checkpoint : of a checkpoint, and of a settled state.
    """

    header: float
    snapshot: float
    checkpoint: float


def for_paraview(files: ParaView, vtu: float, vtkhdf: float) -> float:
    """Bytes of the requested files for ParaView, from the bytes of data in each format."""
    return TEXT * vtu * (files in ("vtu", "both")) + vtkhdf * (files in ("vtkhdf", "both"))


def must_fit(need: float, key: str, things: str) -> None:
    """Raise CaseError if a run needs more RAM (bytes) than is free on this machine.

    key : of the case, which determines the number of things; things : their number in words.
    """
    here = _memory(memory_here, int(time.monotonic()))
    if here is not None and need > here.free:
        raise CaseError([f"{key}: {things} need about {in_words(need)} of memory, {has_in_words(here)}"])


@lru_cache(maxsize=1)
def _memory(read: Callable[[], Memory | None], second: int) -> Memory | None:
    """The RAM, read once a second: a search plans hundreds of scenes, and reading takes as long as planning one."""
    return read()


def has_in_words(here: Memory) -> str:
    """The RAM of this machine as text."""
    return f"this machine has {in_words(here.total)}, {in_words(here.free)} of it free"


def in_words(size: float) -> str:
    """Bytes as text, in kB, MB, GB or TB, with three digits."""
    if size < 999.5e3:
        return f"{size / 1e3:.0f} kB"
    if size < 999.5e6:
        return f"{size / 1e6:.0f} MB"
    return f"{size / 1e9:.3g} GB" if size < 999.5e9 else f"{size / 1e12:.3g} TB"


PARTICLES_PER_THREAD = 40_000
"""Number of particles below which a step takes less than 0.2 ms, much of which would be the synchronisation of
threads.
"""


def thread_count_for(particles: int) -> int:
    """Number of threads for a scene with this number of particles, at most as many as are allowed."""
    return min(numba.get_num_threads(), max(1, particles // PARTICLES_PER_THREAD))


@contextmanager
def threads_for(particles: int) -> Iterator[None]:
    """Limit the threads of compiled loops inside to the number for a scene with this number of particles.

    Results do not depend on it.
    """
    allowed = numba.get_num_threads()
    numba.set_num_threads(thread_count_for(particles))
    try:
        yield
    finally:
        numba.set_num_threads(allowed)
