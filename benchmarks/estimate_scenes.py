"""The scenes of `estimates.py`: small, each with what its true error is measured against.

The first part of a name is the family: the bar, Lamb's problem, an embedded force, the tunnel, contacts, gravity,
layers, continuum, blast. All run in seconds.
"""

from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from typing import Any

from scene_tables import (
    ISOTROPIC,
    ROCK,
    SIDES,
    VISCOUS,
    Tables,
    grains,
    lattice,
    monitors,
    point,
    pulse,
    viscoelastic,
)

FINER = 3
"""Diameter of the disks over those of a finer reference; an odd number, so that disks of both have the same centres."""


@dataclass(frozen=True)
class Scene:
    """A scene, and the reference for its error.

    reference : "extended", the same disks with sides so far away that nothing returns, for the error of the sides
    only; "finer", such a scene with disks `FINER` times smaller; "layer", plane waves in a layer with a free top;
    "changed", the scene with `changes`, keys of a case file, whose continuum is larger and finer.
    """

    name: str
    tables: Tables
    reference: str = "extended"
    changes: Mapping[str, Any] = field(default_factory=dict)

    @property
    def family(self) -> str:
        """The first word of its name."""
        return self.name.split()[0]


def bar(packing: Tables, motion: str, beta: float, end: str = "viscous") -> Tables:
    """A bar of 100 m whose left end moves and whose right one absorbs; periodic sideways."""
    far = {"type": end, "beta_p": beta, "beta_s": beta} | ({"distance": 100.0} if end == "viscoelastic" else {})
    return {
        "packing": packing,
        "material": ROCK,
        "motion": {"held": ["y" if motion == "p" else "x"]} if packing["pattern"] == "A" else {},
        "boundary": {
            "left": {"type": "velocity", f"wave_{motion}": "pulse"},
            "right": far,
            "bottom": {"type": "periodic"},
            "top": {"type": "periodic"},
        },
        "wave": pulse(0.05 if motion == "p" else 0.1),
        "monitor": monitors(middle=(50.25, 5.25), end=(99.75, 5.25)),
        "run": {"duration": 0.25 if motion == "p" else 0.45},
    }


def bars() -> Iterator[Scene]:
    """Bars whose right end has the right factor, or one that is 10 to 50 % off."""
    packed = {"A": lattice(100.0, 10.0, 0.5)}
    packed |= {pattern: grains(100.0, 10.0, 0.5, 10.0, pattern=pattern) for pattern in "BC"}
    right = {"A": {"p": 1.0, "s": 1.0}, "B": {"p": 0.76, "s": 0.79}, "C": {"p": 0.9, "s": 0.9}}
    factors = {"A": (1.0, 0.9, 0.5, 1.5), "B": (1.0, 0.8, 1.3), "C": (1.0, 0.7)}
    for pattern, packing in packed.items():
        for motion in "ps":
            for factor in factors[pattern]:
                name = f"bar {pattern} {motion.upper()} β × {factor:g}"
                yield Scene(name, bar(packing, motion, factor * right[pattern][motion]))
    yield Scene("bar A P springs", bar(packed["A"], "p", 1.0, "viscoelastic"))
    half = bar(packed["A"], "p", 1.0)
    half["boundary"]["right"]["half_mass"] = True
    yield Scene("bar A P half cells", half)
    short = bar(lattice(100.0, 10.0, 2.0), "p", 0.8)
    yield Scene("bar A P coarse, total", short | {"monitor": monitors(middle=(51.0, 5.0), end=(99.0, 5.0))}, "finer")


def lamb(side: Tables, diameter: float = 0.5, size: float = 20.0, duration: float = 0.4) -> Tables:
    """Half of Lamb's problem."""
    d = diameter
    return {
        "packing": lattice(size, size, d),
        "material": ISOTROPIC | {"p_wave_speed": 300.0},
        "boundary": {"left": {"type": "symmetry"}, "right": dict(side), "bottom": dict(side)},
        "wave": pulse(0.1 * size / 20.0, 1.0, "cubic_spline"),
        "load": [
            {"name": "hammer", "force": [0.0, -225e3], "region": [0.0, size - d, d, size], "wave": "pulse"},
        ],
        "monitor": monitors(
            near=(10.5 * d, size - 0.5 * d),
            far=(30.5 * d, size - 0.5 * d),
            deep=(5.5 * d, 0.5 * (size + d)),
        ),
        "run": {"duration": duration},
    }  # fmt: skip


def lambs() -> Iterator[Scene]:
    """Lamb's problem with every kind of side."""
    top = (0.0, 20.0)
    sides: dict[str, Tables] = {
        "viscous": VISCOUS,
        "viscous β 0.7": {"type": "viscous", "beta_p": 0.7, "beta_s": 0.7},
        "viscoelastic 1, 0.5": viscoelastic(top),
        "viscoelastic 2, 1": viscoelastic(top, 2.0, 1.0),
        "viscoelastic 0.3, 0.15": viscoelastic(top, 0.3, 0.15),
        "viscoelastic, wrong source": viscoelastic((0.0, -10.0)),
        "free": {"type": "free", "artificial": True},
        "fixed": {"type": "fixed"},
        "roller": {"type": "roller"},
        "outside": {"type": "outside"},
    }
    for name, side in sides.items():
        yield Scene(f"lamb A {name}", lamb(side))
    yield Scene("lamb A viscous, twice as large", lamb(sides["viscous"], size=40.0, duration=0.8))
    yield Scene("lamb A coarse viscous, total", lamb(sides["viscous"], 1.0, 40.0, 0.8), "finer")
    yield Scene("lamb A coarse outside, total", lamb(sides["outside"], 1.0, 40.0, 0.8), "finer")
    for name in ("viscous", "viscoelastic 1, 0.5", "free", "outside"):
        yield Scene(f"lamb B {name}", whole_lamb(grains(40.0, 20.0, 0.5, 20.0), sides[name]))
    yield Scene("lamb B viscous, small bricks", whole_lamb(grains(40.0, 20.0, 0.5, 10.0, 2), sides["viscous"]))
    yield Scene("lamb C viscous", whole_lamb(grains(40.0, 20.0, 0.5, 20.0, pattern="C"), sides["viscous"]))


def whole_lamb(packing: Tables, side: Tables) -> Tables:
    """Lamb's problem on both sides of the force, with a right β of random packings."""
    own = dict(side)
    if side["type"] in ("viscous", "viscoelastic"):
        own |= {"beta_p": 0.78, "beta_s": 0.79}
    if "source" in side:
        own["source"] = [20.0, 20.0]
    return lamb(own) | {
        "packing": packing,
        "boundary": {name: dict(own) for name in ("left", "right", "bottom")},
        "load": [point((0.0, -450e3), (20.0, 20.0))],
        "monitor": monitors(near=(25.0, 20.0), far=(35.0, 20.0), deep=(22.0, 10.0)),
    }


def embedded() -> Iterator[Scene]:
    """Forces within ground that goes on beyond all sides; two of them."""
    middle, force = (15.25, 15.25), (0.0, 450e3)
    first: Tables = {
        "packing": lattice(30.0, 30.0, 0.5),
        "material": ISOTROPIC,
        "boundary": {side: VISCOUS for side in SIDES},
        "wave": pulse(0.03, 1.0, "cubic_spline"),
        "load": [point(force, middle)],
        "monitor": monitors(above=(15.25, 20.25), beside=(22.25, 15.25), corner=(28.25, 28.25)),
        "run": {"duration": 0.12},
    }
    yield Scene("embedded A viscous", first)
    springs = {side: viscoelastic(middle) for side in SIDES}
    yield Scene("embedded A viscoelastic", first | {"boundary": springs})
    two = [point(force, (10.25, 15.25)), point((300e3, 0.0), (20.25, 10.25), "second")]
    yield Scene("embedded A viscous, two forces", first | {"load": two})
    mixed = {side: VISCOUS for side in SIDES} | {"left": {"type": "fixed"}, "top": {"type": "free"}}
    yield Scene("embedded A, one side fixed", first | {"boundary": mixed})
    body = [{"name": "push", "acceleration": [50.0, 0.0], "region": [5.0, 5.0, 10.0, 12.0], "wave": "pulse"}]
    yield Scene("embedded A viscous, a pushed region", first | {"load": body})
    yield Scene("embedded B viscous", first | {"packing": grains(30.0, 30.0, 0.5, 10.0)})


def tunnel(packing: Tables, side: Tables, base: Tables, motion: str = "s") -> Tables:
    """A tunnel of 6 m radius in 60 m × 60 m of ground under a wave from below."""
    return {
        "packing": packing,
        "material": ROCK,
        "boundary": {
            "left": dict(side),
            "right": dict(side),
            "bottom": {"type": "viscous_input", f"wave_{motion}": "pulse", **base},
        },
        "hole": [{"name": "tunnel", "type": "circle", "centre": [30.0, 30.0], "radius": 6.0}],
        "wave": pulse(0.12 if motion == "s" else 0.06),
        "monitor": monitors(wall=(23.5, 30.5), crown=(30.5, 36.5), surface=(30.5, 59.5)),
        "run": {"duration": 0.5 if motion == "s" else 0.25},
    }


def tunnels() -> Iterator[Scene]:
    """Tunnels under P and S waves, with free fields and dashpots at their sides."""
    free_field, viscous, half = {"type": "free_field"}, VISCOUS, {"half_mass": True}
    ground = lattice(60.0, 60.0, 1.0)
    yield Scene("tunnel A free field", tunnel(ground, free_field, half))
    yield Scene("tunnel A free field, P", tunnel(ground, free_field, half, "p"))
    yield Scene("tunnel A viscous", tunnel(ground, viscous, half))
    yield Scene("tunnel A viscous, P", tunnel(ground, viscous, half, "p"))
    yield Scene("tunnel A fixed", tunnel(ground, {"type": "fixed"}, half))
    yield Scene("tunnel A outside", tunnel(ground, {"type": "outside"}, {}) | {"boundary": _open("s")})
    for pattern in "BC":
        packing = grains(60.0, 60.0, 1.0, 20.0, pattern=pattern)
        betas = {"beta_p": 0.84, "beta_s": 0.87}
        yield Scene(
            f"tunnel {pattern} free field", tunnel(packing, free_field | betas, {"beta_p": 0.76, "beta_s": 0.8})
        )
        yield Scene(f"tunnel {pattern} viscous", tunnel(packing, viscous | betas, {"beta_p": 0.76, "beta_s": 0.8}))


def _open(motion: str) -> Tables:
    """A continuum beyond left, right and bottom, through which a wave enters."""
    sides = {side: {"type": "outside"} for side in ("left", "right", "bottom")}
    return sides | {"bottom": {"type": "outside", f"wave_{motion}": "pulse"}}


def contacts() -> Iterator[Scene]:
    """Contacts that open and slide, at rest under stress or weight before the wave."""
    d = 0.5
    law = {"law": "linearpbond", "fric": 0.5, "pb_ten": 50e6, "pb_coh": 50e6}
    scene: Tables = {
        "packing": lattice(20.0, 20.0, d),
        "material": ISOTROPIC | law,
        "static": {"stress": [-1e5, -1e5, 0.0], "damp": 0.3},
        "boundary": {side: VISCOUS for side in SIDES},
        "wave": pulse(0.03, 1.0, "cubic_spline"),
        "load": [point((0.0, 1e6), (10.25, 10.25))],
        "monitor": monitors(above=(10.25, 15.25), beside=(15.25, 10.25)),
        "run": {"duration": 0.08},
    }
    yield Scene("contacts A, confined, open", scene)
    yield Scene("contacts A, confined, closed", scene | {"load": [point((0.0, 1e4), (10.25, 10.25))]})
    yield Scene("contacts A, no stage, open", {key: value for key, value in scene.items() if key != "static"})
    packing = grains(20.0, 20.0, d, 10.0)
    locked = scene | {"packing": packing, "material": scene["material"] | {"locked_in": 2e5}, "static": {"damp": 0.7}}
    yield Scene("contacts B, locked-in stress", locked)
    weight = {"name": "gravity", "acceleration": [0.0, -9.81]}
    held = {"bottom": {"type": "fixed"}, "left": {"type": "roller"}, "right": {"type": "roller"}}
    ground = {side: {"type": "viscoelastic", "distance": 20.0} for side in ("left", "right")}
    base = {"bottom": {"type": "viscous_input", "wave_s": "pulse"}}
    heavy = scene | {
        "packing": lattice(40.0, 20.0, d),
        "static": {"boundary": held},
        "boundary": ground | base,
        "wave": pulse(0.06, 0.05),
        "load": [weight],
        "monitor": monitors(surface=(20.25, 19.75), middle=(20.25, 10.25)),
        "run": {"duration": 0.16},
    }
    yield Scene("gravity A, S pulse", heavy)
    yield Scene("gravity A, elastic", heavy | {"material": ISOTROPIC})
    blow = heavy | {
        "boundary": {side: VISCOUS for side in ("left", "right", "bottom")},
        "load": [weight, point((0.0, -2e5), (20.25, 19.75))],
        "monitor": monitors(surface=(26.25, 19.75), middle=(20.25, 10.25)),
    }
    yield Scene("gravity A, a blow on the surface", blow | {"wave": pulse(0.03, 1.0, "cubic_spline")})


def layers() -> Iterator[Scene]:
    """Plane waves that enter a layer through dashpots, and return from its free surface."""
    for name, d, beta in (("", 0.5, 1.0), (", β 0.8", 0.5, 0.8), (", coarse", 2.0, 1.0), (", half cells", 0.5, 1.0)):
        for motion, period, end in (("p", 0.03, 0.15), ("s", 0.06, 0.3)):
            base = {"type": "viscous_input", f"wave_{motion}": "pulse", f"beta_{motion}": beta}
            scene: Tables = {
                "packing": lattice(10.0, 40.0, d),
                "material": ROCK,
                "boundary": {
                    "bottom": base | ({"half_mass": True} if "half" in name else {}),
                    "left": {"type": "periodic"},
                    "right": {"type": "periodic"},
                },
                "wave": pulse(period),
                "monitor": monitors(middle=(5.0 + d / 2, 20.0 + d / 2), surface=(5.0 + d / 2, 40.0 - d / 2)),
                "run": {"duration": end},
            }
            yield Scene(f"layer A {motion.upper()}{name}", scene, "layer")


def continua() -> Iterator[Scene]:
    """Canyons and benches with a continuum beyond the sides, compared with larger and finer ones."""
    canyon: Tables = {
        "ground": {"size": [80.0, 60.0]},
        "packing": lattice(40.0, 20.0, 1.0) | {"origin": [20.0, 40.0]},
        "material": ISOTROPIC,
        "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom")},
        "hole": [{"name": "canyon", "type": "circle", "centre": [40.0, 60.0], "radius": 8.0}],
        "incident": {"type": "sv", "angle": 30.0, "wave": "pulse"},
        "wave": pulse(0.1),
        "monitor": monitors(rim=(31.5, 59.5), floor=(40.5, 51.5), right=(49.5, 59.5)),
        "run": {"duration": 0.35},
    }
    finer = {"outside.accuracy": 2e-4, "packing.size": [60.0, 30.0], "packing.origin": [10.0, 30.0]}
    yield Scene("continuum A canyon", canyon, "changed", finer)
    yield Scene("continuum A canyon, poor elements", canyon | {"outside": {"accuracy": 0.02}}, "changed", finer)
    bench: Tables = {
        "packing": lattice(40.0, 25.0, 1.0),
        "material": ISOTROPIC,
        "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom")},
        "hole": [
            {"name": "slope", "type": "polygon", "points": [[20.0, 25.5], [27.0, 13.0], [40.5, 13.0], [40.5, 25.5]]},
            {"name": "gallery", "type": "circle", "centre": [10.0, 12.0], "radius": 3.0},
        ],
        "load": [{"name": "blast", "hole": "gallery", "pressure": 2e6, "wave": "burst"}],
        "wave": {"burst": {"type": "cosine", "amplitude": 1.0, "period": 0.06}},
        "monitor": monitors(crest=(18.5, 24.5), face=(23.5, 17.5), floor=(36.5, 12.5)),
        "run": {"duration": 0.2},
    }
    yield Scene("continuum A bench", bench)


def blasts() -> Iterator[Scene]:
    """A pressure in a hole, in rock that goes on beyond all sides."""
    blast: Tables = {
        "packing": lattice(30.0, 30.0, 0.5),
        "material": ISOTROPIC,
        "hole": [{"name": "hole", "type": "circle", "centre": [15.0, 15.0], "radius": 4.0}],
        "load": [{"name": "blast", "hole": "hole", "pressure": 5e6, "wave": "pulse"}],
        "wave": pulse(0.03, 1.0, "cubic_spline"),
        "boundary": {side: VISCOUS for side in SIDES},
        "monitor": monitors(wall=(19.25, 15.25), rock=(24.25, 15.25), corner=(24.25, 24.25)),
        "run": {"duration": 0.1},
    }
    yield Scene("blast A viscous", blast)
    yield Scene("blast A viscoelastic", blast | {"boundary": {side: viscoelastic((15.0, 15.0)) for side in SIDES}})
    yield Scene("blast A outside", blast | {"boundary": {side: {"type": "outside"} for side in SIDES}})
    yield Scene("blast B viscous", blast | {"packing": grains(30.0, 30.0, 0.5, 15.0)})
    yield Scene("blast A viscous, total", blast, "finer")


def scenes() -> list[Scene]:
    """All scenes."""
    families = (bars, lambs, embedded, tunnels, contacts, layers, continua, blasts)
    return [Scene(each.name, deepcopy(each.tables), each.reference, each.changes) for one in families for each in one()]
