"""Motion by kernels for the added types, in a process that has found them installed. Prints what comes out as JSON."""

import json
import sys
from dataclasses import replace

import numpy as np
import tomli_w

import dembound.kinds as kinds
from dembound.kinds.bar.summary import cells_of_waves
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.running import plan
from dembound.studies.dispersion import lattices_of, measure

BAR = {
    "bar": {"length": 1.0, "spacing": 0.01, "density": 2500.0, "wave_speed": 2000.0},
    "method": {"type": "cone", "horizon": 3},
    "boundary": {"left": {"type": "velocity", "wave_p": "bell"}},
    "wave": {"bell": {"type": "gauss", "amplitude": 0.5, "width": 2e-5}},
    "run": {"duration": 1e-4},
}
TWO = {
    "packing": {"pattern": "A", "size": [1.0, 0.5], "radius": 0.25},
    "material": {"density": 2500.0, "law": "tips", "tip": 1e9},
    "run": {"duration": 0.03},
}
STEP = 1e-3


def bounced(made) -> list:
    """Steps in which two disks touch, the length of a step, their speeds after it, and the laws in use."""
    run = Simulation(plan(made).scene, STEP)
    run.state.velocity = np.array([[1e-3, -1e-3], [0.0, 0.0], [0.0, 0.0]])
    ledger = Ledger(run, 1)
    run.track(ledger)
    run.run(300)
    touching = sum(bool(entry.contact > 0.0) for entry in ledger.entries)
    return [touching, STEP, run.state.velocity[0].tolist(), run.state.laws]


bar = kinds.loads(tomli_w.dumps(BAR))
lattices, rod = lattices_of(bar), plan(bar).scene
wavenumbers = lattices[0].shortest * np.array([0.2, 0.5, 0.9])
json.dump(
    {
        "tips": bounced(kinds.loads(tomli_w.dumps(TWO))),
        "frequencies": measure(lattices[0], wavenumbers).tolist(),
        "formula": lattices[0].frequency(wavenumbers).tolist(),
        "usual": replace(lattices[0], shares=None).frequency(wavenumbers).tolist(),
        "limit": [rod.step_limit(), lattices[0].courant_limit * lattices[0].spacing / 2000.0],
        "cells": cells_of_waves(rod, 1e-7)["bell"][1],
    },
    sys.stdout,
)
