"""What contacts and bonds make of a body: moduli, wave speeds, anisotropy; the materials of a scene by name."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dembound.casefile.disks.material import Material
from dembound.disks.material.confined import require_stiffness
from dembound.disks.material.first_crack import first_crack
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.packing_waves import DIRECTIONS, phase_speeds
from dembound.disks.material.targets import moduli_of
from dembound.disks.scene import DiskScene
from dembound.packings.brick import Brick
from dembound.words import Quantity, in_one_unit, numbers, percent, sentences, with_unit


@dataclass(frozen=True)
class Own:
    """A material of a case, and that of the packing; layer, its name, and given, its own keys: of a layer."""

    material: Material
    ground: PackedMaterial
    layer: str = ""
    given: Mapping[str, Any] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Words after the names of its facts: " of" its layer, or nothing."""
        return f" of {self.layer}" if self.layer else ""

    def key(self, name: str) -> str:
        """The path of a key of the material: in the layer if that gives it, else in [material]."""
        return f"layer.{self.layer}.{name}" if name in self.given else f"material.{name}"


def materials_of(scene: DiskScene) -> Iterator[Own]:
    """The materials from the surface down; one of uniform ground."""
    case, grounds = scene.case, scene.ground.materials
    if not case.layer:
        yield Own(case.material, grounds[0])
        return
    each = zip(case.materials, grounds, case.layer_names, (layer.own for layer in case.layer), strict=True)
    yield from (Own(*own) for own in each)


def brick_quantities(brick: Brick) -> list[Quantity]:
    """The numbers of a packing."""
    return [
        Quantity("mean_diameter", "m", brick.mean_diameter, "{}"),
        Quantity("solid_fraction", "1", brick.solid_fraction, "solid fraction {:.3f}"),
        Quantity("coordination", "1", brick.coordination, "{:.3g} contacts per disk"),
    ]


PLANES = {"strain": "solid in plane strain", "stress": "2D sample"}
"""Meanings of elastic constants, as for `material.plane`, in words."""

DIGITS = 4
"""Digits of the printed numbers."""

LOADS = {"compression": -1.0, "tension": 1.0}
"""Signs of the stress along y under which the first bond breaks."""


def describe_materials(scene: DiskScene) -> list[dict[str, Any]]:
    """Micro-parameters and the body's properties, of each layer from the surface down: plain values, SI units.

    Without layers there is one entry, of an empty name. Raises CaseError for contacts without pressure that have no
    stiffness without it.
    """
    require_stiffness(scene.ground)
    return [{"layer": own.layer, **_describe(own)} for own in materials_of(scene)]


def _describe(own: Own) -> dict[str, Any]:
    ground, moduli = own.ground, own.ground.moduli
    brick, tensor = ground.brick, ground.material_tensor
    speeds = phase_speeds(ground, np.pi * np.arange(DIRECTIONS) / DIRECTIONS)
    names = ("emod", "pb_emod", "kratio", "pb_kratio", "pb_rmul", "fric")
    cracks = {name: first_crack(ground, own.material, sign) for name, sign in LOADS.items()}
    lattice_shear = moduli.pb_rmul * moduli.pb_emod / moduli.pb_kratio
    if moduli.fric > 0.0:
        lattice_shear += moduli.emod / moduli.kratio
    return {
        "micro": {name: getattr(moduli, name) for name in names},
        "density": ground.density,
        "packing": {"disks": len(brick.radii), **numbers(brick_quantities(brick)), "pressure": ground.packed_pressure},
        "moduli": {
            **{plane: _constants(tensor, plane, "isotropic") for plane in PLANES},
            "along": {axis: {plane: _constants(tensor, plane, axis) for plane in PLANES} for axis in ("x", "y")},
        },
        "speeds": {
            name: _speeds(*values)
            for name, values in {
                "isotropic": _isotropic(ground),
                "x": speeds[0],
                "45": speeds[DIRECTIONS // 4],
                "y": speeds[DIRECTIONS // 2],
                "lattice": np.sqrt(
                    np.array([moduli.emod + moduli.pb_rmul * moduli.pb_emod, 0.5 * lattice_shear]) / ground.density
                ),
            }.items()
        },
        "anisotropy": _speeds(*(speeds.max(axis=0) / speeds.min(axis=0) - 1.0)),
        "first_crack": {name: None if found is None else found._asdict() for name, found in cracks.items()},
    }


def _constants(tensor: np.ndarray, plane: str, along: str) -> dict[str, float]:
    """E and ν, and of the isotropic body also K and G, see `PlaneModuli`; E, K and G in Pa."""
    found = moduli_of(tensor, along, by_waves=False)
    young = {"young": float(found.young(plane)), "poisson": float(found.poisson(plane))}
    if along != "isotropic":
        return young
    return young | {"bulk": float(found.compression(plane)), "shear": float(found.shear)}


def _isotropic(ground: PackedMaterial) -> np.ndarray:
    """Speeds (2,) m/s of P and S waves of the nearest isotropic body."""
    found = moduli_of(ground.material_tensor, "isotropic", by_waves=True)
    return np.sqrt(np.array([found.uniaxial, found.shear]) / ground.density)


def _speeds(p: float, s: float) -> dict[str, float]:
    return {"p": float(p), "s": float(s)}


def material_rows(found: dict[str, Any]) -> list[tuple[str, Sequence[Sequence[str]]]]:
    """Titles and rows, the first of which is the head, of the tables about an entry of `describe_materials`."""
    micro, moduli, speeds = found["micro"], found["moduli"], found["speeds"]
    stiffness, unit = in_one_unit([micro["emod"], micro["pb_emod"]], "Pa", DIGITS + 1)
    ratios = [f"{micro[name]:.{DIGITS + 1}g}" for name in ("kratio", "pb_kratio", "pb_rmul", "fric")]
    each = [moduli[plane] for plane in PLANES]
    along = [[moduli["along"][axis][plane] for plane in PLANES] for axis in ("x", "y")]
    body = [
        ["E", *(with_unit(one["young"], "Pa", DIGITS) for one in each)],
        ["ν", *(f"{one['poisson']:.{DIGITS}f}" for one in each)],
        ["K", *(with_unit(one["bulk"], "Pa", DIGITS) for one in each)],
        ["G", *(with_unit(one["shear"], "Pa", DIGITS) for one in each)],
    ]
    for axis, pair in zip("xy", along, strict=True):
        body.append([f"E along {axis}", *(with_unit(one["young"], "Pa", DIGITS) for one in pair)])
        body.append([f"ν along {axis}", *(f"{one['poisson']:.{DIGITS}f}" for one in pair)])
    ways = {"isotropic": "mean", "x": "along x", "45": "at 45°", "y": "along y", "lattice": "square lattice"}
    waves = [
        [words, *(f"{speeds[name][kind]:.5g}" for kind in "ps"), f"{speeds[name]['p'] / speeds[name]['s']:.{DIGITS}g}"]
        for name, words in ways.items()
    ]
    waves.append(["largest over least", *(f"+{percent(found['anisotropy'][kind])}" for kind in "ps"), ""])
    cracks = [
        [
            name,
            with_unit(crack["stress"], "Pa"),
            f"breaks in {crack['limit']}",
            with_unit(crack["young"], "Pa", DIGITS),
            f"{crack['poisson']:.{DIGITS}f}",
        ]
        for name, crack in found["first_crack"].items()
        if crack is not None
    ]
    tables: list[tuple[str, Sequence[Sequence[str]]]] = [
        (
            "Contacts and bonds",
            [
                ["emod", "pb_emod", "kratio", "pb_kratio", "pb_rmul", "fric"],
                [*(f"{value} {unit}" for value in stiffness), *ratios],
            ],
        ),
        ("Body", [["", *PLANES.values()], *body]),
        ("Wave speeds (m/s)", [["", "c_p", "c_s", "c_p/c_s"], *waves]),
    ]
    if cracks:
        tables.append(
            (
                "First crack under stress along y with free sides",
                [["", "stress", "bond", "E till then", "ν till then"], *cracks],
            )
        )
    return tables


def packing_line(ground: PackedMaterial) -> str:
    """The packing of a ground in words."""
    packed = sentences(brick_quantities(ground.brick), "mean_diameter", "solid_fraction", "coordination")
    parts = [f"{len(ground.brick.radii):,} disks of {packed}"]
    if ground.packed_pressure > 0.0:
        parts.append(f"packed under {with_unit(ground.packed_pressure, 'Pa')}")
    return ", ".join([*parts, f"density {with_unit(ground.density, 'kg/m³', DIGITS)}"])
