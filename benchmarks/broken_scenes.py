"""Scenes that break, for `overview.py`: a blast at a free face, a column that collapses, a slope that slides."""

from dataclasses import dataclass

from scene_tables import Tables

from dembound import api
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

GRAVITY: Tables = {"name": "gravity", "acceleration": [0.0, -9.81]}
LOOSE: Tables = {
    "law": "linearpbond", "density": 2200.0, "emod": 5e8, "kratio": 1.25, "fric": 0.5, "pb_emod": 0.0,
    "dp_nratio": 0.2, "dp_sratio": 0.2,
}  # fmt: skip
BONDED: Tables = {"law": "linearpbond", "density": 2500.0, "emod": 5e9, "pb_emod": 5e9, "fric": 0.5}
FIXED: Tables = {"type": "fixed", "artificial": False}


@dataclass(frozen=True)
class Scene:
    """A scene that breaks: the tables of its case, its number of steps, and whether it has no bonds."""

    tables: Tables
    steps: int
    is_loose: bool = False

    def simulation(self, small: bool) -> tuple[Simulation, int]:
        """The simulation, at rest, and its number of steps, fewer where it is to be small."""
        scene = build(api.case(**self.tables))
        return Simulation(scene, choose_step(scene)[0]), self.steps // (10 if small else 1)


def packing(size: tuple[float, float], brick: float, radius: float) -> Tables:
    """Random bricks of disks."""
    return {"pattern": "B", "size": list(size), "brick": [brick] * 2, "radius": radius, "radius_ratio": 1.5, "seed": 3}


def cut(*points: tuple[float, float]) -> Tables:
    """A hole of straight edges, which leaves the body."""
    return {"name": "cut", "type": "polygon", "points": [list(point) for point in points]}


def blast() -> Tables:
    """A borehole 2.5 m from a free face, in rock that breaks and flies."""
    wave = {"type": "triangle", "amplitude": 1.0, "rise": 1e-4, "fall": 6e-4}
    hole = {"name": "borehole", "type": "circle", "centre": [5.5, 3.0], "radius": 0.3}
    return {
        "packing": packing((8.0, 6.0), 2.0, 0.03),
        "material": {
            "law": "linearpbond", "density": 2650.0, "p_wave_speed": 4500.0, "fric": 0.6, "contact_share": 1e-6,
            "pb_ten": 1e7, "pb_coh": 3e7, "pb_fa": 35.0,
        },
        "hole": [hole],
        "load": [{"name": "charge", "hole": "borehole", "pressure": 2e8, "wave": "pulse"}],
        "wave": {"pulse": wave},
        "boundary": {"left": {"type": "viscous"}},
        "run": {"duration": 0.01},
    }  # fmt: skip


def column() -> Tables:
    """A column of loose disks, three times as high as half its width, that collapses on a rough floor."""
    return {
        "packing": packing((120.0, 30.0), 10.0, 0.4),
        "material": LOOSE,
        "load": [GRAVITY],
        "hole": [
            cut((-1.0, 4.0), (3.0, 4.0), (3.0, 2.0), (50.0, 2.0), (50.0, 31.0), (-1.0, 31.0)),
            cut((70.0, 31.0), (70.0, 2.0), (117.0, 2.0), (117.0, 4.0), (121.0, 4.0), (121.0, 31.0)) | {"name": "right"},
        ],
        "boundary": {"bottom": FIXED},
        "run": {"duration": 20.0},
    }


def slope() -> Tables:
    """A slope of 60°, too weak for its height, that breaks under its weight and slides."""
    return {
        "packing": packing((90.0, 40.0), 10.0, 0.6),
        "material": BONDED | {"pb_ten": 5e4, "pb_coh": 1e5, "pb_fa": 30.0, "dp_nratio": 0.1},
        "load": [GRAVITY],
        "hole": [cut((30.0, 41.0), (50.0, 8.0), (91.0, 8.0), (91.0, 41.0))],
        "boundary": {"bottom": FIXED, "left": {"type": "roller", "artificial": False}},
        "run": {"duration": 20.0},
    }


SCENES = {
    "breaking: blast at a face": Scene(blast(), 1500),
    "broken: loose column, collapsing": Scene(column(), 20_000, is_loose=True),
    "broken: slope after failure": Scene(slope(), 20_000),
}
