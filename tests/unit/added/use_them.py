"""Cases of the added types, in a process that has found them installed: runs and calibrations.

Prints what comes out as JSON.
"""

import json
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    import dembound.kinds as kinds

from dembound.accuracy.estimate import advise, causes_of
from dembound.casefile.types import BOUNDARIES
from dembound.disks.reflection import measure_side
from dembound.disks.trials import trials_of_disks
from dembound.errors import CaseError, RunError
from dembound.formulas.history import History
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.running import plan
from dembound.studies.asked import Calibrating
from dembound.studies.calibration import calibrate
from dembound.studies.library.build import build_library

GROUND = {
    "packing": {"pattern": "A", "size": [20.0, 2.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "law": "linear"},
    "boundary": {"left": {"type": "other_input", "wave_s": "bell"}, "right": {"type": "viscous"}},
    "wave": {"bell": {"type": "gauss", "amplitude": 0.5, "width": 0.004}},
    "monitor": [{"name": "middle", "position": [10.25, 1.25]}],
    "run": {"duration": 0.03},
}
PERIODIC = {"type": "periodic"}
STRIP = {"boundary.bottom": PERIODIC, "boundary.top": PERIODIC, "motion.held": ["x"]}
DIAMOND = {"type": "diamond", "name": "shaft", "centre": [12.0, 2.5], "half": 1.2}


def case(tables: dict[str, Any] = GROUND, **changes: object) -> Any:
    """The ground, or the case of other tables, changed."""
    made = kinds.loads(tomli_w.dumps(tables))
    return kinds.with_changes(made, changes) if changes else made


def refused(make: Any) -> list[str]:
    """Messages of what cannot be made."""
    try:
        make()
    except CaseError as error:
        return list(error.problems)
    return []


def stepped(made) -> dict:
    """Steps of a case, and the error of its energy balance."""
    planned = plan(made)
    run = Simulation(planned.scene, planned.time_step)
    ledger = Ledger(run, 1)
    run.track(ledger)
    run.run(200)
    largest = max(entry.kinetic for entry in ledger.entries)
    stored = planned.scene.ground.stiffness
    return {
        "law": run.state.laws,
        "count": planned.scene.count,
        "error": max(abs(entry.error) for entry in ledger.entries) / largest,
        "rotation": float(np.abs(run.state.velocity[2]).max()),
        "bending": float(stored.bending.max()),
        "stiffness": planned.scene.ground.material_tensor.tolist(),
    }


def failure(made) -> str:
    """Error message of a calibration of the left side of a case."""
    try:
        calibrate(made, "left")
    except RunError as error:
        return str(error)
    return ""


def halved(made) -> dict[str, list]:
    """Positions of the disks of the bottom and the top of a scene, and the part of their mass that they have."""
    scene = plan(made).scene
    edges = {side: scene.edges[side].nodes for side in ("bottom", "top")}
    return {
        side: [scene.assembly.positions[nodes].tolist(), scene.cell_fraction[nodes].tolist()]
        for side, nodes in edges.items()
    }


strong = {"law": "brittle", "contact_share": 0.0, "pb_ten": 1e9, "pb_coh": 1e9}  # bonds alone, which hold
brittle = case(**STRIP, **{f"material.{key}": value for key, value in strong.items()})


def refusals(made: Any) -> dict[str, list[str]]:
    """Messages of all functions that require a linear law."""
    still = {"middle": History(np.zeros(2), np.zeros(9), {})}
    return {
        "calibrate": refused(lambda: calibrate(made, "right")),
        "boundary": refused(lambda: measure_side(made, "right", [0.0], 1)),
        "stability": refused(lambda: trials_of_disks(made, full=False)),
        "library": refused(lambda: build_library(made, 1e-3, Path("none"))),
        "estimate": refused(lambda: causes_of(made, still, 1e-4, 1.0)),
        "advise": refused(lambda: advise(made, (0.01,))),
    }


strip = case(**STRIP, **{"boundary.left.beta_s": 0.9})
hexagonal = {"packing.pattern": "hexagonal", "material.law": "elastic", "monitor": []}
whole = hexagonal | {"packing.size": [5.0, 5.19615]}
half = {"type": "viscous", "half_mass": True}
full = calibrate(strip, "right", Calibrating(full=True))
json.dump(
    {
        "types": [table.__name__ for table in BOUNDARIES],
        "warnings": [str(each.message) for each in said],
        "linear": stepped(case(**{"packing.size": [20.0, 5.0], "hole": [DIAMOND]})),
        "hexagonal steps": stepped(case(**whole)),
        "not whole": refused(lambda: case(**hexagonal, **{"packing.size": [20.0, 5.0]})),
        "half cells": halved(case(**whole, **{"boundary.bottom": half, "boundary.top": half})),
        "no half cells": refused(lambda: case(**whole, **{"boundary.right.half_mass": True})),
        "unknown": refused(lambda: case(**{"boundary.left.type": "quarter_input"})),
        "across": refused(lambda: case(**{"motion.held": ["y"]})),
        "calibrated side": [full.kind, full.result, full.ratio[-1]],
        "late": failure(kinds.with_changes(strip, {"boundary.left.type": "late_input"})),
        "let in": calibrate(strip, "left").kind,
        "shortened": calibrate(brittle, "right").shortened,
        "rubber": refusals(case(**STRIP, **{"material.law": "rubber"})),
    },
    sys.stdout,
    default=lambda value: value.tolist() if isinstance(value, np.ndarray | np.generic) else str(value),
)
