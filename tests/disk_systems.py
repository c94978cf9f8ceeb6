"""Systems of disks that begin to move: random packings that nothing holds or drives, their starts and states."""

import numpy as np

from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.scene_parts import Start, contact_lists
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.state import State

ELASTIC, BONDED = "elastic", "linearpbond"

STEP = 1e-4
EPS = np.finfo(float).eps
FREE_FIELD = {side: {"type": "free_field"} for side in ("left", "right")}
SIDES = {"free": {}, "free field": FREE_FIELD}
WRAP = {side: {"type": "periodic"} for side in ("left", "right", "bottom", "top")}
BODY = {"boundary": {}, "wave": {}, "monitor": [], "motion.held": []}
"""Changes of the small bar of disks after which nothing holds or drives it."""

DENSE = {"pattern": "B", "size": [4.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
TWO_BRICKS = DENSE | {"size": [8.0, 4.0]}
TOUGH = {"material.law": "linearpbond", "material.fric": 0.5}
WITH_HISTORY = {**TOUGH, "material.locked_in": 10e6, "static": {}}
"""Contacts that the locked-in stress keeps closed."""

LAMB = {
    "packing": {"pattern": "A", "size": [40.0, 20.0], "radius": 0.5},
    "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom")},
    "motion.held": [],
    "monitor": [],
    "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.2}},
    "load": [{"name": "f", "position": [20.5, 19.5], "force": [0.0, -1e6], "wave": "pulse"}],
}
"""Changes of the small bar into Lamb's problem on 40 m × 20 m of a lattice in a continuum."""

AT_ONCE = {"material.elastic_start": False}
REFERENCE = {"material.geometry": "reference"}
WEIGHT = {
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "static": {"boundary": {"bottom": {"type": "fixed"}}},
}


def shaken(body: DiskScene, size: float, seed: int = 3) -> np.ndarray:
    """Random motions or forces (3, n)."""
    return size * np.random.default_rng(seed).uniform(-1.0, 1.0, (3, body.count))


def begun(system: DiskSystem, datum: np.ndarray | None = None) -> State:
    """The state of a system that has begun at rest at a datum (3, n)."""
    still = np.zeros((3, system.scene.count))
    datum = still if datum is None else datum
    layout = system.scene.layout
    state = State(layout, layout.spread(datum), layout.spread(still), datum, np.zeros((0, 3, 2)), np.zeros(0))
    system.begin(state)
    return state


def forces_of(system: DiskSystem, lists: dict[str, ContactList], displacement: np.ndarray) -> np.ndarray:
    """Forces and moments (3, n) of the history-dependent law at displacements (3, n) reached at rest, seam included."""
    for contacts in lists.values():
        contacts.push(displacement)
    return system.forces.last(lists)


def locked_in_forces(body: DiskScene) -> np.ndarray:
    """Forces and moments (3, n) of a body as built."""
    return forces_of(DiskSystem(body, STEP), contact_lists(body), np.zeros((3, body.count)))


def settled(body: DiskScene, *, has_history: bool, size: float = 1e-6) -> Start:
    """A start at some displacements, with contacts as built."""
    return Start(shaken(body, size), contact_lists(body) if body.has_history else {}, has_history)


def turn(angle: float) -> np.ndarray:
    """Rotation matrix (2, 2)."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def fitted(places: np.ndarray, moved: np.ndarray) -> float:
    """Rotation that is nearest to the motion of some places (2, m), by a polar decomposition."""
    a, r = (x - x.mean(axis=1, keepdims=True) for x in (places, places + moved))
    left, _, right = np.linalg.svd(r @ a.T)
    rotation = left @ np.diag([1.0, np.linalg.det(left @ right)]) @ right
    return float(np.arctan2(rotation[1, 0], rotation[0, 0]))
