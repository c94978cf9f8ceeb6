"""Small scenes by which `error_bound.py` measures the choices of `dembound run --error`.

60 disks wide or less, with S waves of 50 to 40 disks, sides near the loads, and pulses without high frequencies.
"""

from __future__ import annotations

from collections.abc import Iterator

from scene_tables import ROCK, Tables, lattice

WAVES: dict[str, Tables] = {
    "ricker": {"type": "ricker", "amplitude": 1.0, "frequency": 10.0},
    "cosine": {"type": "cosine", "amplitude": 1.0, "period": 0.08},
}
VISCOUS: Tables = {"type": "viscous"}


def lamb(sides: str, wide: float, high: float, wave: str) -> Tables:
    """A force on the surface of a half-space."""
    middle = 0.5 * wide
    tables = {"type": sides} | ({"source": [middle, high]} if sides == "viscoelastic" else {})
    return {
        "packing": lattice(wide, high, 1.0),
        "material": ROCK,
        "boundary": {side: tables for side in ("left", "right", "bottom")},
        "wave": {"pulse": WAVES[wave]},
        "load": [
            {"name": "hit", "force": [0.0, -1e6], "region": _around(middle, high - 0.5, 4.0, 1.0), "wave": "pulse"}
        ],
        "monitor": [
            {"name": "surface", "position": [middle + 10.5, high - 0.5]},
            {"name": "deep", "position": [middle + 4.5, high - 8.5]},
        ],
        "run": {"duration": 0.2},
    }


def embedded(wide: float, wave: str, force: tuple[float, float]) -> Tables:
    """A force within rock that goes on beyond all sides."""
    middle = 0.5 * wide
    return {
        "packing": lattice(wide, wide, 1.0),
        "material": ROCK,
        "boundary": dict.fromkeys(("left", "right", "bottom", "top"), VISCOUS),
        "wave": {"pulse": WAVES[wave]},
        "load": [{"name": "push", "force": list(force), "region": _around(middle, middle, 2.0, 2.0), "wave": "pulse"}],
        "monitor": [
            {"name": "beside", "position": [middle + 7.5, middle + 0.5]},
            {"name": "above", "position": [middle - 4.5, middle + 8.5]},
        ],
        "run": {"duration": 0.2},
    }


def below_a_surface(wave: str) -> Tables:
    """A force on one disk below a surface, at a place where most larger and smaller disks have none."""
    tables = lamb("viscous", 36.0, 36.0, wave)
    places = {"above": [16.5, 30.5], "aside": [26.5, 20.5]}
    return tables | {
        "load": [{"name": "hit", "force": [4e5, -4e5], "position": [14.5, 20.5], "wave": "pulse"}],
        "monitor": [{"name": name, "position": place} for name, place in places.items()],
    }


def two_loads(sides: str, wave: str) -> Tables:
    """Two forces on the surface, one of them along it."""
    tables = lamb(sides, 50.0, 24.0, wave)
    second = {"name": "drag", "force": [5e5, 0.0], "region": [12.0, 23.0, 14.0, 24.0], "wave": "pulse"}
    return tables | {"load": [*tables["load"], second]}


def blast(sides: str, wide: float, wave: str) -> Tables:
    """A pressure in a rectangular hole, whose walls are straight on every lattice."""
    middle = 0.5 * wide
    tables = {"type": sides} | ({"source": [middle, middle]} if sides == "viscoelastic" else {})
    return {
        "packing": lattice(wide, wide, 1.0),
        "material": ROCK,
        "boundary": {side: tables for side in ("left", "right", "bottom", "top")},
        "wave": {"pulse": WAVES[wave]},
        "hole": [{"name": "cave", "type": "rectangle", "corners": _around(middle, middle, 6.0, 6.0)}],
        "load": [{"name": "blast", "pressure": 1e6, "hole": "cave", "wave": "pulse"}],
        "monitor": [
            {"name": "right", "position": [middle + 9.5, middle + 0.5]},
            {"name": "corner", "position": [middle + 7.5, middle + 7.5]},
        ],
        "run": {"duration": 0.2},
    }


def bar(motion: str, wave: str, length: float, side: str) -> Tables:
    """A bar that is driven at its left end, and ends within rock that goes on."""
    return {
        "packing": lattice(length, 3.0, 1.0),
        "material": ROCK,
        "motion": {"held": ["y" if motion == "p" else "x", "rotation"]},
        "boundary": {"left": {"type": "velocity", f"wave_{motion}": "pulse"}, "right": {"type": side}},
        "wave": {"pulse": WAVES[wave]},
        "monitor": [{"name": "near", "position": [10.5, 1.5]}, {"name": "far", "position": [length - 10.5, 1.5]}],
        "run": {"duration": 0.25},
    }


def ground(wave: str, hole: bool) -> Tables:
    """Ground under an S wave from below: level with a free field, or with a rectangular tunnel in a continuum."""
    tables: Tables = {
        "packing": lattice(60.0, 40.0, 1.0),
        "material": ROCK,
        "boundary": {
            "left": {"type": "free_field"},
            "right": {"type": "free_field"},
            "bottom": {"type": "viscous_input", "wave_s": "pulse", "half_mass": True},
        },
        "wave": {"pulse": WAVES[wave]},
        "monitor": [{"name": "surface", "position": [30.5, 39.5]}, {"name": "wall", "position": [40.5, 20.5]}],
        "run": {"duration": 0.3},
    }
    cave = {"name": "cave", "type": "rectangle", "corners": [22.0, 14.0, 38.0, 26.0]}
    beyond = {
        "left": {"type": "outside"},
        "right": {"type": "outside"},
        "bottom": {"type": "outside", "wave_s": "pulse"},
    }
    return tables | ({"hole": [cave], "boundary": beyond} if hole else {})


def confined(tables: Tables, stress: float) -> Tables:
    """The tables with a pressure (Pa) at rest, and contacts that may open or slide, and bonds that may break."""
    strength = {"law": "linearpbond", "fric": 0.5, "pb_ten": 2.0 * stress, "pb_coh": 2.0 * stress, "pb_fa": 30.0}
    return tables | {"material": ROCK | strength, "static": {"stress": [-stress, -stress, 0.0]}}


def bonded(tables: Tables) -> Tables:
    """The tables with bonds that may break, and no contacts."""
    strength = {"law": "linearpbond", "contact_share": 0.0, "pb_ten": 1e8, "pb_coh": 1e8}
    return tables | {"material": ROCK | strength}


def lasting(tables: Tables, duration: float) -> Tables:
    """The tables with a longer duration (s)."""
    return tables | {"run": {"duration": duration}}


def _around(x: float, y: float, wide: float, high: float) -> list[float]:
    """A rectangle round its middle."""
    return [x - 0.5 * wide, y - 0.5 * high, x + 0.5 * wide, y + 0.5 * high]


def scenes() -> Iterator[tuple[str, Tables]]:
    """All scenes by name."""
    for wave in WAVES:
        for sides in ("viscous", "viscoelastic", "outside"):
            for wide, high in ((40.0, 20.0), (60.0, 40.0)):
                yield f"lamb {sides} {wide:g} m {wave}", lamb(sides, wide, high, wave)
        for wide in (30.0, 50.0):
            yield f"embedded {wide:g} m along x {wave}", embedded(wide, wave, (1e6, 0.0))
            yield f"embedded {wide:g} m inclined {wave}", embedded(wide, wave, (1e6, 5e5))
        yield f"below a surface {wave}", below_a_surface(wave)
        for sides in ("viscous", "outside"):
            yield f"two loads {sides} {wave}", two_loads(sides, wave)
        for sides, wide in (("viscous", 30.0), ("viscoelastic", 50.0)):
            yield f"blast {sides} {wide:g} m {wave}", blast(sides, wide, wave)
        for motion in ("p", "s"):
            yield f"{motion.upper()} bar {wave}", bar(motion, wave, 60.0, "viscous")
        yield f"tunnel {wave}", ground(wave, hole=True)
        yield f"level ground {wave}", ground(wave, hole=False)
        rock = embedded(30.0, wave, (1e6, 5e5))
        yield f"confined lamb {wave}", confined(lamb("viscous", 40.0, 20.0, wave), 1e6)
        yield f"confined embedded {wave}", confined(rock, 1e6)
        yield f"confined embedded 10 MPa {wave}", confined(rock, 1e7)
        yield f"bonded P bar {wave}", bonded(bar("p", wave, 60.0, "viscous"))
        yield f"lasting lamb {wave}", lasting(lamb("viscous", 40.0, 20.0, wave), 0.5)
        yield f"lasting embedded {wave}", lasting(rock, 0.5)
        yield f"lasting P bar {wave}", lasting(bar("p", wave, 60.0, "viscous"), 1.0)
