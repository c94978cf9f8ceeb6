"""Tables of small cases for several folders of tests; `small` makes cases from them."""

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import tomli_w

from dembound.casefile import Case
from dembound.errors import CaseError
from dembound.kinds import loads, with_changes

Tables = dict[str, Any]

HIT = {"type": "triangle", "amplitude": 1.0, "rise": 2e-4, "fall": 2e-4}

SPALLING: Tables = {
    "bar": {"length": 1.0, "spacing": 0.025, "density": 2500.0, "wave_speed": 1000.0, "strength": 8e6},
    "method": {"type": "peridynamics", "horizon": 3},
    "load": [{"name": "hit", "pressure": 12e6, "nodes": 3, "wave": "hit"}],
    "wave": {"hit": HIT},
    "monitor": [{"name": "gauge", "position": 0.525}],
    "run": {"duration": 1.5e-3, "courant": 1.0},
}
"""A bar of 41 nodes, 60 steps: a compressive pulse of 0.4 m comes back as tension and tears off its free end."""

PULLED: Tables = SPALLING | {
    "bar": SPALLING["bar"] | {"spacing": 0.01},
    "method": {"type": "patch", "horizon": 3},
    "load": [{"name": "hit", "pressure": -15e6, "nodes": 3, "wave": "hit"}],
    "monitor": [{"name": "gauge", "position": 0.5}],
    "run": {"duration": 2e-3},
    "output": {"pictures": False, "snapshots": 5, "energy_interval": 9e-5},
}
"""A bar of 101 nodes that is pulled and breaks."""

PUSHED: Tables = {
    "packing": {"pattern": "A", "size": [10.0, 2.5], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "boundary": {"left": {"type": "velocity", "wave_p": "push", "wave_s": "shake"}, "right": {"type": "viscous"}},
    "wave": {
        "push": {"type": "cosine", "amplitude": 0.5, "period": 0.01},
        "shake": {"type": "cosine", "amplitude": 0.2, "period": 0.01},
    },
    "monitor": [{"name": "front", "position": [2.4, 1.2]}, {"name": "back", "position": [9.6, 1.2]}],
    "run": {"duration": 0.01},
}
"""A lattice of 20 × 5 disks in P and S motion."""

TORN: Tables = {
    "material.law": "linearpbond",
    "material.pb_ten": 5e5,
    "material.pb_coh": 5e5,
    "wave.push.amplitude": -1.0,
    "wave.push.start": 0.002,
    "wave.shake.amplitude": 2.0,
    "wave.shake.start": 0.002,
    "output.pictures": False,
}
"""Changes of `PUSHED` by which its end is torn off, but not at once: more than ten bonds break."""

DROPPED: Tables = {
    "packing": {"pattern": "A", "size": [2.0, 2.0], "radius": 0.25},
    "material": {"law": "linearpbond", "density": 2500.0, "emod": 1e7, "pb_emod": 1e7, "pb_ten": 1e9, "pb_coh": 1e9}
    | {"dp_nratio": 0.3, "fric": 0.5},
    "wall": [
        {"name": "floor", "points": [[-9.0, 2.0], [0.4, -1.0], [2.2, -1.0], [9.0, 2.0]], "fric": 0.5, "dp_nratio": 0.3}
    ],
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "monitor": [{"name": "upper", "points": [[0.0, 1.2], [2.0, 1.2], [2.0, 2.0], [0.0, 2.0]]}],
    "run": {"duration": 20.0, "until": "rest", "rest_for": 0.3},
    "output": {"pictures": False, "paraview": "none", "snapshots": 40},
}
"""A strong block of 16 disks that falls 1 m into a trough."""

SOIL: Tables = {
    "packing": {"pattern": "A", "radius": 0.125, "bricks": [2, 50]},
    "material": {"density": 2300.0, "s_wave_speed": 700.0, "fric": 0.5, "kratio": 2.0, "pb_kratio": 2.0},
    "layer": [
        {"name": "clay", "thickness": 4.0, "density": 1800.0, "s_wave_speed": 200.0},
        {"name": "sand", "thickness": 4.5, "density": 2000.0, "s_wave_speed": 350.0},
        {"name": "rock"},
    ],
    "boundary": {
        "bottom": {"type": "viscous_input", "wave_s": "in", "beta_p": "matched", "beta_s": "matched"},
        "left": {"type": "periodic"},
        "right": {"type": "periodic"},
    },
    "wave": {"in": {"type": "ricker", "amplitude": 0.01, "frequency": 20.0}},
    "monitor": [{"name": "top", "position": [0.375, 12.375]}, {"name": "sand", "position": [0.375, 5.125]}],
    "run": {"duration": 0.35},
    "output": {"pictures": False},
}
"""A column of 2 × 50 disks: soil on rock, S waves from straight below."""

OPEN: Tables = {
    "boundary": {
        side: {"type": "viscous", "beta_p": "matched", "beta_s": "matched"}
        for side in ("left", "right", "bottom", "top")
    },
    "load": [{"name": "hit", "force": [0.0, 1.0], "position": [0.25, 9.0], "wave": "in"}],
}
"""Tables of `SOIL` by which ground goes on beyond all sides, and a force acts in it."""

GRAINS: Tables = {
    "packing": {"pattern": "B", "size": [8.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]},
    "material": PUSHED["material"],
    "boundary": {
        "bottom": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"},
        "right": {"type": "viscous"},
    },
    "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.01}},
    "monitor": [{"name": "middle", "position": [4.0, 2.0]}, {"name": "top", "position": [4.0, 4.0]}],
    "run": {"duration": 0.03},
    "output": {"pictures": False, "snapshots": 5, "history_interval": 4e-4, "energy_interval": 1.1e-3},
}
"""Two bricks of random disks that a wave enters from below."""


SURROUNDED: Tables = {
    "packing": {"pattern": "A", "size": [12.0, 6.0], "radius": 0.5},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
    "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom")},
    "outside": {"element": 3.0, "margin": 1, "layers": 2},
    "monitor": [{"name": "middle", "position": [6.5, 3.5]}],
    "run": {"duration": 0.01},
}
"""A lattice of 12 × 6 disks in a continuum of 40 elements, whose outer ones absorb."""

GROUND: Tables = {
    "packing": {"pattern": "A", "size": [30.0, 20.0], "radius": 0.5},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom")},
    "wave": {"w": {"type": "cosine", "amplitude": 1.0, "period": 0.1}},
    "run": {"duration": 0.1},
}
"""A lattice of 30 × 20 disks in a continuum, wide enough for a slope, and a wave without motion."""


FULL: Tables = {
    "title": "full",
    "packing": {"pattern": "A", "size": [10.0, 5.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1e3, "kratio": 1.0, "damp": 0.1, "law": "linearpbond"}
    | {"pb_ten": 1e6, "pb_coh": 2e6, "pb_fa": 30.0, "locked_in": 1e6, "geometry": "reference", "elastic_start": True},
    "motion": {"held": ["y"]},
    "boundary": {"left": {"type": "viscous_input", "wave_p": "w", "beta_p": 1.0}, "right": {"type": "fixed"}},
    "static": {"stress": [0.0, 0.0, 1.0], "ratio": 1e-4, "damp": 0.5, "max_steps": 10}
    | {"boundary": {"left": {"type": "fixed"}, "bottom": {"type": "roller"}}},
    "wave": {
        "w": {"type": "cosine", "amplitude": 1.0, "period": 1.0, "start": 0.0},
        "s": {"type": "sine_burst", "amplitude": 1.0, "frequency": 1.0, "cycles": 2, "taper": True},
    },
    "load": [
        {"name": "a", "force": [1.0, 0.0], "region": [0.0, 0.0, 1.0, 1.0], "wave": "w"},
        {"name": "b", "acceleration": [1.0, 0.0], "position": [0.0, 0.0]},
    ],
    "monitor": [{"name": "a", "position": [0.0, 0.0]}],
    "run": {"duration": 1.0, "time_step": 0.1, "safety": 0.5},
    "output": {"history_interval": 0.0, "energy_interval": 0.0, "snapshots": 1, "pictures": False},
}
"""A case with keys of every kind."""


def small(tables: Tables, name: str = "small", changes: Mapping[str, Any] | None = None) -> Case:
    """The case of tables, with some keys changed; its name has no other characters than a folder may have."""
    case = loads(tomli_w.dumps(tables), name=re.sub(r"\W+", "_", name))
    return with_changes(case, changes) if changes else case


def problems_of(text: str, folder: Path = Path()) -> list[str]:
    """All lines the text of a case is refused with; none if it is not."""
    return problems_in(lambda: loads(text, folder))


def problems_in(make: Callable[[], object]) -> list[str]:
    """All lines that making a case or a scene is refused with; none if it is not."""
    try:
        make()
    except CaseError as error:
        return error.problems
    return []


def around(kind: str | dict[str, Any], *sides: str) -> Tables:
    """Tables of sides of one type: left, right and bottom, or those named."""
    return {side: {"type": kind} if isinstance(kind, str) else kind for side in sides or ("left", "right", "bottom")}


def rows(table: str) -> list[tuple[str, ...]]:
    r"""The rows of a table, its cells between bars; \n in a cell is the end of a line, # begins a line of comment."""
    lines = [line for line in table.strip("\n").split("\n") if line and not line.startswith("# ")]
    return [tuple(cell.strip(" ").replace(r"\n", "\n") for cell in line.split(" | ")) for line in lines]


BODY = """\
[packing]
pattern = "A"
size = [10.0, 5.0]
radius = 0.25

[material]
density = 2500.0
p_wave_speed = 1000.0

[run]
duration = 0.1

"""
"""The text of a lattice of 20 × 10 disks."""
