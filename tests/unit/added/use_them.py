"""Run cases of the added types, in a process that has found them installed; prints what comes out as JSON."""

import json
import sys
import warnings
from dataclasses import replace

import numpy as np
import tomli_w

with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    import dembound.kinds as kinds

from dembound.casefile.types import BOUNDARIES
from dembound.errors import CaseError, RunError
from dembound.kinds.bar.summary import cells_of_waves
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.running import plan
from dembound.studies.asked import Calibrating
from dembound.studies.calibration import calibrate
from dembound.studies.dispersion import lattices_of, measure

GROUND = """
[packing]
pattern = "A"
size = [20.0, 5.0]
radius = 0.25
[material]
density = 2500.0
p_wave_speed = 1000.0
law = "linear"
[boundary.left]
type = "other_input"
wave_s = "bell"
[boundary.right]
type = "viscous"
[wave.bell]
type = "gauss"
amplitude = 0.5
width = 0.004
[run]
duration = 0.03
"""
BAR = """
[bar]
length = 1.0
spacing = 0.01
density = 2500.0
wave_speed = 2000.0
[method]
type = "cone"
horizon = 3
[boundary.left]
type = "velocity"
wave_p = "bell"
[wave.bell]
type = "gauss"
amplitude = 0.5
width = 2e-5
[run]
duration = 1e-4
"""


def case(text: str, **changes: object):
    """A case, changed."""
    made = kinds.loads(text)
    return kinds.with_changes(made, changes) if changes else made


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


def refusal(text: str, **changes: object) -> list[str]:
    """The mistakes of a case."""
    try:
        case(text, **changes)
    except CaseError as error:
        return list(error.problems)
    return []


def halved(made) -> dict[str, list]:
    """Positions of the disks of the bottom and the top of a scene, and the part of their mass that they have."""
    scene = plan(made).scene
    edges = {side: scene.edges[side].nodes for side in ("bottom", "top")}
    return {
        side: [scene.assembly.positions[nodes].tolist(), scene.cell_fraction[nodes].tolist()]
        for side, nodes in edges.items()
    }


def bounced(made) -> list:
    """Steps in which two disks touch, the length of a step, their speeds after it, and the laws in use."""
    planned = plan(made)
    run = Simulation(planned.scene, 1e-4)
    run.state.velocity = np.array([[1e-3, -1e-3], [0.0, 0.0], [0.0, 0.0]])
    ledger = Ledger(run, 1)
    run.track(ledger)
    run.run(3000)
    touching = sum(entry.contact > 0.0 for entry in ledger.entries)
    return [touching, 1e-4, run.state.velocity[0].tolist(), run.state.laws]


TWO = {
    "packing": {"pattern": "A", "size": [1.0, 0.5], "radius": 0.25},
    "material": {"density": 2500.0, "law": "tips", "tip": 1e9},
    "run": {"duration": 0.03},
}
shaft = {"type": "diamond", "name": "shaft", "centre": [12.0, 2.5], "half": 1.2}
periodic = {"type": "periodic"}
strip = {"boundary.bottom": periodic, "boundary.top": periodic, "packing.size": [20.0, 2.0], "motion.held": ["x"]}
sent = case(GROUND, **strip, **{"boundary.left.beta_s": 0.9})
hexagons = {"packing.pattern": "hexagonal", "material.law": "elastic"}
wide = {"packing.size": [5.0, 5.19615]}
half = {"type": "viscous", "half_mass": True}
full = calibrate(sent, "right", Calibrating(full=True))
lattices = lattices_of(case(BAR))
wavenumbers = lattices[0].shortest * np.array([0.2, 0.5, 0.9])
bar = plan(case(BAR)).scene
json.dump(
    {
        "types": [table.__name__ for table in BOUNDARIES],
        "warnings": [str(each.message) for each in said],
        "tips": bounced(case(tomli_w.dumps(TWO))),
        "linear": stepped(case(GROUND, hole=[shaft])),
        "hexagonal": stepped(case(GROUND, **hexagons, **wide)),
        "not whole": refusal(GROUND, **hexagons),
        "half cells": halved(case(GROUND, **hexagons, **wide, **{"boundary.bottom": half, "boundary.top": half})),
        "no half cells": refusal(GROUND, **hexagons, **wide, **{"boundary.right.half_mass": True}),
        "unknown": refusal(GROUND, **{"boundary.left.type": "quarter_input"}),
        "across": refusal(GROUND, **{"motion.held": ["y"]}),
        "calibrated": [full.kind, full.result, full.ratio[-1]],
        "late": failure(kinds.with_changes(sent, {"boundary.left.type": "late_input"})),
        "let in": calibrate(sent, "left").kind,
        "frequencies": measure(lattices[0], wavenumbers).tolist(),
        "formula": lattices[0].frequency(wavenumbers).tolist(),
        "usual": replace(lattices[0], shares=None).frequency(wavenumbers).tolist(),
        "limit": [bar.step_limit(), lattices[0].courant_limit * lattices[0].spacing / 2000.0],
        "cells": cells_of_waves(bar, 1e-7)["bell"][1],
    },
    sys.stdout,
)
