"""Cases of the added types, in a process that has found them installed: runs, calibrations, estimates and choices.

Prints what comes out as JSON.
"""

import json
import sys
import warnings
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    import dembound.kinds as kinds

from dembound.accuracy.estimate import advise, causes_of
from dembound.accuracy.judge import extended
from dembound.accuracy.of_disks.candidates import disk_choices
from dembound.accuracy.of_disks.coarser import coarser
from dembound.accuracy.of_disks.exact.references import ExactPlaneWave
from dembound.accuracy.of_disks.law import elastic_twin
from dembound.accuracy.of_disks.measured import cause_of_packing
from dembound.accuracy.of_disks.options import Options
from dembound.accuracy.runner import Runner, at_step
from dembound.boundaries.description import side_in_words
from dembound.casefile.types import BOUNDARIES
from dembound.disks.matching import Held
from dembound.disks.reflection import measure_side
from dembound.disks.scene import build
from dembound.disks.trials import trials_of_disks
from dembound.errors import CaseError, RunError
from dembound.formulas.cause import share_of
from dembound.formulas.disks.near_disks import wall_errors
from dembound.formulas.history import History
from dembound.kinds.bar.summary import cells_of_waves
from dembound.kinds.disks.side_warnings import side_warnings
from dembound.kinds.disks.summary import describe_side
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.running import plan
from dembound.studies.asked import Calibrating
from dembound.studies.calibration import calibrate
from dembound.studies.dispersion import lattices_of, measure
from dembound.studies.library.build import build_library

GROUND = {
    "packing": {"pattern": "A", "size": [20.0, 2.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "law": "linear"},
    "boundary": {"left": {"type": "other_input", "wave_s": "bell"}, "right": {"type": "viscous"}},
    "wave": {"bell": {"type": "gauss", "amplitude": 0.5, "width": 0.004}},
    "monitor": [{"name": "middle", "position": [10.25, 1.25]}],
    "run": {"duration": 0.03},
}
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
PERIODIC = {"type": "periodic"}
STRIP = {"boundary.bottom": PERIODIC, "boundary.top": PERIODIC, "motion.held": ["x"]}
ROCK = {"material.law": "elastic", "material.kratio": 2.0}
ROUND = {side: {"type": "viscous"} for side in ("left", "right", "bottom", "top")}
HEXAGONS = ROCK | {
    "packing.pattern": "hexagonal",
    "packing.size": [10.0, 10.392305],
    "boundary": ROUND,
    "load": [{"name": "push", "force": [1e6, 3e5], "region": [4.5, 4.5, 5.5, 5.5], "wave": "bell"}],
    "monitor": [
        {"name": "beside", "position": [7.6, 5.2]},
        {"name": "above", "position": [3.1, 7.0]},
        {"name": "right", "position": [9.9, 5.2]},
        {"name": "top", "position": [5.0, 10.3]},
    ],
    "run.duration": 0.05,
}
DRAWN = ROCK | {
    "packing": {"pattern": "drawn", "radius": 0.25, "size": [10.0, 5.0]},
    "monitor": [{"name": "middle", "position": [5.0, 2.5]}],
}
B = {"pattern": "B", "radius": 0.25, "radius_ratio": 1.5, "brick": [5.0, 5.0], "seed": 1, "size": [10.0, 5.0]}
SHAFT = {"type": "diamond", "name": "shaft", "centre": [2.0, 2.0], "half": 1.0}
DIAMOND = SHAFT | {"centre": [12.0, 2.5], "half": 1.2}
CAVE = {"type": "rectangle", "name": "cave", "corners": [1.0, 1.0, 2.0, 2.2]}


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


def run(made: Any) -> tuple[dict[str, History], int]:
    """Records of the monitors of a run along x and y, as an estimate reads them, and its work."""
    done = Runner().run(made)
    motions = {
        name: replace(each, values={key: values[:, :2] for key, values in each.values.items()})
        for name, each in done.motions.items()
    }
    return motions, done.work


def estimated(made: Any) -> dict[str, Any]:
    """Causes of a run's errors of velocities at its monitors, and notes; or the reason why there are none."""
    try:
        motions, work = run(made)
        found = causes_of(made, motions, plan(made).time_step, work)
    except CaseError as error:
        return {"refused": list(error.problems)}
    own = found.motions or motions
    shares = {
        cause.name: {name: cause.share(name, "velocity", each) for name, each in own.items()} for cause in found.found
    }
    known = {name: each for name, each in shares.items() if name not in [cause.name for cause in found.unknown]}
    return {"causes": known, "unknown": [f"{cause.name}: {cause.words}" for cause in found.unknown]}


def of_far_sides(made: Any) -> dict[str, float]:
    """Errors of the velocity of monitors by the sides of a case, from a run with all of them out of reach."""
    step = plan(made).time_step
    (own, _), (far, _) = (run(at_step(each, step)) for each in (made, extended(made).case))
    there = {name: far[name].at(each.time) for name, each in own.items()}
    added = {name: own[name].values["velocity"] - there[name].values["velocity"] for name in own}
    return {name: share_of(added[name], "velocity", there[name]) for name in own}


def held(made: Any) -> list[list[float]]:
    """Springs per metre of the right side, for a case and for disks three times as large; or an error message."""
    scene = build(made)
    try:
        larger = build(coarser(made, scene, plan(made).time_step, 1.5).case)
    except CaseError as error:
        return [list(error.problems)]
    return [Held.of(each, "right").stiffness.tolist() for each in (scene, larger)]


def companion(**changes: object) -> list[Any]:
    """Dashpots per metre of the right side of a strip with disks three times as large, and its table.

    Or an error message. Also the part of what whole cells add, see `coarser.Coarser`.
    """
    made = case(**STRIP, **changes)
    try:
        found = coarser(made, build(made), plan(made).time_step, 1.5)
    except CaseError as error:
        return list(error.problems)
    return [Held.of(build(found.case), "right").damping.tolist(), found.case.boundary["right"].given(), found.weight]


def other_draw(made: Any) -> dict[str, Any]:
    """Source and share of the scatter between packings."""
    motions, _ = run(made)
    (cause,) = cause_of_packing(made, motions, 2).found
    return {"words": cause.words, "share": cause.share("middle", "velocity", motions["middle"])}


def larger(made: Any) -> list[Any]:
    """Whether disks only discretise the ground, and the radius of disks half as large that make the same one."""
    options = Options(plan(made), 0.01, ())
    found = options.of(0.5)
    return [0.5 in options.factors, found[0].case.packing.radius if found else None]


springs = {"stiffness": 0.5 * 1e9 / 10.0 * 0.5}  # those of α = ½, E = 2 GPa, ν = 0 and L = 10 m on disks of 0.5 m
viscoelastic = {"type": "viscoelastic", "young_modulus": 2e9, "distance": 10.0, "alpha_n": 0.5, "alpha_s": 0.5}
sides = {
    "viscoelastic": viscoelastic,
    "quilt": {"type": "quilt", **springs},
    "mattress": {"type": "mattress", **springs},
}
late = {"monitor.middle.position": [17.25, 1.25], "run.duration": 0.07}  # after the wave has come back
uneven = late | {"boundary.right": {"type": "heather", **springs}}
one = {"damper": 0.5 * 2500.0 * build(case(**STRIP)).ground.wave_speeds(0)[1]}  # ρc_s D
of_sides = {name: case(**STRIP, **late, **{"boundary.right": table}) for name, table in sides.items()}
hexagons, unsaid = case(**HEXAGONS), case(**HEXAGONS | {"packing.pattern": "unsaid"})
drawn, b = case(**DRAWN), case(**DRAWN | {"packing": B})
strong = {"law": "brittle", "contact_share": 0.0, "pb_ten": 1e9, "pb_coh": 1e9}  # bonds alone, which hold
brittle = case(**STRIP, **{f"material.{key}": value for key, value in strong.items()})


free = {
    "motion.held": ["y"],
    "boundary": {"left": {"type": "velocity", "wave_p": "bell"}, "right": {"type": "viscous"}},
}
rows = case(**free), case(**free, **ROCK | {"packing.pattern": "hexagonal", "packing.size": [20.0, 2.598076]})
wide = {"pattern": "drawn", "radius": 0.25, "size": [20.0, 10.0]}


def twin_of(made: Any) -> str | None:
    """The law of a case that may replace its own."""
    planned = plan(made)
    found = elastic_twin(made, planned, 1e6, (), Runner())
    return None if found is None else found.case.material.law


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


def with_short_waves(made: Any, hole: dict[str, Any]) -> Any:
    """A case with a hole and waves much shorter than that."""
    return kinds.with_changes(made, {"hole": [hole], "wave.bell.width": 1e-4})


strip = case(**STRIP, **{"boundary.left.beta_s": 0.9})
hexagonal = {"packing.pattern": "hexagonal", "material.law": "elastic", "monitor": []}
whole = hexagonal | {"packing.size": [5.0, 5.19615]}
half = {"type": "viscous", "half_mass": True}
full = calibrate(strip, "right", Calibrating(full=True))
bar = case(BAR)
lattices, rod = lattices_of(bar), plan(bar).scene
wavenumbers = lattices[0].shortest * np.array([0.2, 0.5, 0.9])
json.dump(
    {
        "types": [table.__name__ for table in BOUNDARIES],
        "warnings": [str(each.message) for each in said],
        "tips": bounced(case(TWO)),
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
        "frequencies": measure(lattices[0], wavenumbers).tolist(),
        "formula": lattices[0].frequency(wavenumbers).tolist(),
        "usual": replace(lattices[0], shares=None).frequency(wavenumbers).tolist(),
        "limit": [rod.step_limit(), lattices[0].courant_limit * lattices[0].spacing / 2000.0],
        "cells": cells_of_waves(rod, 1e-7)["bell"][1],
        "held": {name: held(of_sides[name]) for name in sides} | {"heather": held(case(**STRIP, **uneven))},
        "sides": {name: estimated(of_sides[name]) for name in ("quilt", "viscoelastic")},
        "calibrated": {name: calibrate(of_sides[name], "right").result for name in sides},
        "shock": companion(**{"boundary.right": {"type": "shock", **one}}),
        "like shock": companion(**{"boundary.right": {"type": "viscous", "beta_s": 1.0}}),
        "pads": companion(**{"boundary.right": {"type": "pads", **one}}),
        "twin": twin_of(brittle),
        "shortened": calibrate(brittle, "right").shortened,
        "hexagonal": estimated(hexagons),
        "far sides": of_far_sides(hexagons),
        "larger": [larger(each) for each in (hexagons, unsaid, case(**STRIP, **{"material.law": "graded"}))],
        "walls": [
            wall_errors(with_short_waves(made, hole), build(made).ground, 0.5)["velocity"]
            for made, hole in ((hexagons, CAVE), (unsaid, CAVE), (hexagons, SHAFT))
        ],
        "plane": [ExactPlaneWave.of(each) is not None for each in rows],
        "described": [
            side_in_words(describe_side(build(case(**STRIP, **{"boundary.right": table})), "right"))
            for table in ({"type": "shock", "damper": 5e5}, sides["mattress"])
        ],
        "mirrors": [
            list(side_warnings(build(kinds.with_changes(made, {"boundary.bottom": {"type": "symmetry"}}))))
            for made in (hexagons, unsaid)
        ],
        "rubber": refusals(case(**STRIP, **{"material.law": "rubber"})),
        "drawn": [other_draw(each) for each in (drawn, b)],
        "charted": [changes for _, changes in islice(disk_choices(case(**DRAWN | {"packing": wide})), 2)],
    },
    sys.stdout,
    default=lambda value: value.tolist() if isinstance(value, np.ndarray | np.generic) else str(value),
)
