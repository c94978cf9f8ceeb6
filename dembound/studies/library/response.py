"""Histories of a library under a record, and load factors at the contacts of two monitors."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from dembound.casefile.disks.model import DiskCase
from dembound.disks.material.constants import bond_factors, brick_constants, ground_limits, strength_of
from dembound.disks.scene import DiskScene, build
from dembound.errors import CaseError
from dembound.files import make_folder
from dembound.laws.law import AnyLimits, columns_of, in_columns
from dembound.laws.linearpbond import limit_in_words, limit_lines
from dembound.results.committed import new_file
from dembound.results.datasets import describe, write
from dembound.results.new_record import DISPLACEMENT_UNIT, VELOCITY_UNIT, write_inputs
from dembound.results.reader import open_record
from dembound.running.planning import plan, warnings_before
from dembound.studies.library.build import REST, under
from dembound.studies.library.library import Library, Record


class WatchedContact(NamedTuple):
    """A contact or bond between the disks of two monitors.

    name : both, with a comma. monitors : (2,) their numbers in the library. constants : see pairwise.py.
    limits : its friction and strength. settled : (3,) stretch (m), shear (m) and turn at the end of the static stage,
    zero without one.
    """

    name: str
    monitors: tuple[int, int]
    constants: np.ndarray
    limits: AnyLimits
    settled: np.ndarray


class LoadFactor(NamedTuple):
    """The multiple of a record up to which its contacts follow the elastic law.

    factor : infinite if no limit is ever reached. contact : the first to reach a limit; limit : its name; time : of
    reaching it, s. The last three belong to the least factor.
    """

    factor: float
    contact: str
    limit: str
    time: float


def watched_contacts(library: Library, pairs: Sequence[str]) -> list[WatchedContact]:
    """The contacts between the disks of pairs of monitors, each given as two names with a comma.

    Raises CaseError with a line for each pair without a contact, and for a library whose case has no load factor.
    """
    if not library.case.output.load_factor:
        raise CaseError(["--load-factor: needs a library of a case with output.load_factor = true and its strengths"])
    if library.case.begins_stressed:
        raise CaseError(["--load-factor: does not include static.k0 and a stress at rest; take dembound run"])
    scene = build(library.case)
    found, problems = [], []
    for pair in pairs:
        try:
            found += list(_contacts(library, scene, pair))
        except CaseError as error:
            problems += error.problems
    if problems:
        raise CaseError(problems)
    return found


def load_factor(library: Library, contacts: Sequence[WatchedContact], motion: np.ndarray) -> LoadFactor:
    """The load factor of a motion (k, monitors, 6) of the library at its samples, for the given contacts."""
    least = LoadFactor(np.inf, "", "", np.nan)
    for contact in contacts:
        slopes, allowed = (each[0] for each in limit_lines(contact.constants[None], contact.limits))
        rest = contact.settled + _strain(contact, library.rest)
        grows = _strain(contact, motion - library.rest) @ slopes.T
        room = allowed - rest @ slopes.T
        factors = np.full(grows.shape, np.inf)
        np.divide(np.maximum(room, 0.0), grows, out=factors, where=grows > 0.0)  # 0 beyond a limit at rest
        sample, limit = np.unravel_index(np.argmin(factors), factors.shape)
        if factors[sample, limit] < least.factor:
            words = limit_in_words(int(limit), contact.constants)
            least = LoadFactor(float(factors[sample, limit]), contact.name, words, float(library.time[sample]))
    return least


def _contacts(library: Library, scene: DiskScene, pair: str) -> Iterator[WatchedContact]:
    """The contacts of one pair of monitors."""
    names = pair.split(",")
    if len(names) != 2 or any(name not in library.monitors for name in names):
        raise CaseError([f"--load-factor: is {pair}, must be two monitors, A,B; here: {', '.join(library.monitors)}"])
    if between := [name for name in names if name in scene.between]:
        raise CaseError([f"--load-factor: {between[0]} is no single disk, whose contacts are known"])
    disks = [scene.monitors[name] for name in names]
    pairs = scene.assembly.pairs
    forward, backward = ((pairs == order).all(axis=1) for order in (disks, disks[::-1]))
    if not (forward | backward).any():
        raise CaseError([f"--load-factor: the disks of {names[0]} and {names[1]} have neither contact nor bond"])
    constants = brick_constants(scene.ground, gaps_close=True, locked_in=0.0)
    limits = ground_limits(scene.ground, library.case.materials, strength_of)
    bonds = bond_factors(library.case, scene.ground, scene.assembly)
    numbers = library.monitors.index(names[0]), library.monitors.index(names[1])
    for place in np.flatnonzero(forward | backward):
        order = numbers if forward[place] else numbers[::-1]
        kind = scene.assembly.contact_type[place]
        own = in_columns(np.array(columns_of(limits)).T[[kind]], limits.geometry) if scene.ground.is_layered else limits
        if bonds is not None:
            factor = float(bonds.at(pairs[[place], 0], kind)[0])
            own = own._replace(tension=factor * own.tension, cohesion=factor * own.cohesion)
        contact = WatchedContact(pair, order, constants[kind], own, np.zeros(3))
        yield contact._replace(settled=_settled(library, contact, pairs[place]))


def _settled(library: Library, contact: WatchedContact, disks: np.ndarray) -> np.ndarray:
    """Stretch, shear and turn (3,) of two disks at the end of the static stage."""
    if library.case.static is None:
        return np.zeros(3)
    with open_record(library.record(REST)) as file:
        settled = file["static/displacement"][:][disks]
    motion = np.zeros((1, len(library.monitors), settled.shape[1]))
    motion[0, contact.monitors] = settled
    return _strain(contact, motion)[0]


def _strain(contact: WatchedContact, motion: np.ndarray) -> np.ndarray:
    """Stretch, shear and turn (k, 3) of a contact for small displacements; motion (k, monitors, 3 or more)."""
    first, second = (motion[:, number, :3] for number in contact.monitors)
    x, y, rest, _, offset = contact.constants[:5]
    normal, arm = np.array([x, y]) / rest, 0.5 * rest + offset
    moved = second[:, :2] - first[:, :2]
    shear = moved @ [-normal[1], normal[0]] - arm * first[:, 2] - (rest - arm) * second[:, 2]
    return np.column_stack([moved @ normal, shear, second[:, 2] - first[:, 2]])


COPIED = ("kind", "size", "time_step", "step_limit", "steps", "version")
"""Attributes that a response takes from the library."""


def case_of(library: Library, record: Record) -> DiskCase:
    """The case of the direct run of a record: with its files as file waves, other inputs silent."""
    waves = {name: {"type": "file", "path": given.as_posix()} for name, (given, _) in record.files.items()}
    case = under(library.case, waves, record.name, _texts(record))
    return replace(case, silent=frozenset(library.inputs) - set(record.files))


def record_warnings(library: Library, records: Sequence[Record]) -> Iterator[tuple[Record, str]]:
    """Warnings of `dembound run` under each record that are not due to silence: units, samples, lengths, strengths.

    Also what the library's spacing takes from it.
    """
    silent = replace(library.case, silent=frozenset(library.inputs))
    before = set(warnings_before(plan(silent)))
    for record in records:
        yield from ((record, each) for each in record.losses)
        yield from ((record, each) for each in warnings_before(plan(case_of(library, record))) if each not in before)


def _texts(record: Record) -> dict[str, str]:
    """Texts of the files of a record, by their paths."""
    return {given.as_posix(): text for given, text in record.files.values()}


def write_response(library: Library, record: Record, path: Path) -> np.ndarray:
    """Write the histories of a library under a record as a ``run.h5``; returns the motion (k, monitors, 6).

    The case in it is that of a direct run, with the record as a file wave: `dembound rerun` runs it. The attribute
    ``superposed`` has the name of the library. The folder of the path is created if it does not exist.
    """
    motion = library.motion(record.values)
    case = case_of(library, record)
    make_folder(path.parent)
    with new_file(path) as file:
        own = {"name": record.name, "title": case.title, "case": case.text, "keys": json.dumps(case.keys)}
        inherited = {name: library.attributes[name] for name in COPIED if name in library.attributes}
        describe(file, own | inherited | {"superposed": library.name, "complete": True})
        if case.silent:
            describe(file, {"silent": sorted(case.silent)})
        write_inputs(file, _texts(record))
        histories = file.create_group("histories", track_order=True)
        for index, name in enumerate(library.monitors):
            group = histories.create_group(name)
            for key, value in library.places[name].items():
                group.attrs[key] = value
            write(group, "time", library.time, "s")
            write(group, "displacement", motion[:, index, :3], DISPLACEMENT_UNIT)
            write(group, "velocity", motion[:, index, 3:], VELOCITY_UNIT)
    return motion
