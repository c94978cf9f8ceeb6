"""The ``[[layer]]`` tables, what follows from them, their mistakes, and the ``[outside]`` table of ground beyond."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal, Optional

from pydantic import ValidationError, create_model

from dembound.casefile.disks.material import TARGET_KEYS, Material
from dembound.casefile.disks.stiffness import MODULI_KEYS, RATIO_KEYS, STIFFNESS_KEYS, WAVE_SPEED_KEYS
from dembound.casefile.disks.targets import PAIRS
from dembound.casefile.messages import numbered, places, show
from dembound.packings import Packing
from dembound.packings.base import TYPED
from dembound.table import Box, FileName, Table, quantity

THINNEST = 2.0
"""Least thickness of a layer over the mean diameter of the disks: bonds then join neighbouring layers only."""

_WITHOUT = dict(zip(PAIRS, ((), ("along",), ("plane",)), strict=True))
"""Keys of `TARGET_KEYS` that each pair of targets does not have."""


class Differing(Table):
    """A part of the ground that has some keys of [material] of its own."""

    name: str | None

    @classmethod
    def help_of(cls, name: str) -> str:
        """What a field means, of a key of [material] as there."""
        own = super().help_of(name)
        return own or (Material.help_of(name).split("; absent")[0] if name in Material.model_fields else "")

    @property
    def own(self) -> dict[str, Any]:
        """The keys of [material] that it gives."""
        return {key: value for key, value in self.given().items() if key in Material.model_fields}

    def merged(self, material: Material) -> Material:
        """Its material: that beside it with the keys that it gives. Raises ValidationError for mistakes in it."""
        own, gone = self.own, set[str]()
        if not own.keys().isdisjoint(STIFFNESS_KEYS):
            gone |= {*STIFFNESS_KEYS, *(() if "p_wave_speed" in own else ("match",))}
            pair = next((pair for pair in PAIRS if own.keys() >= {*pair}), None)
            gone |= {*RATIO_KEYS, "match", *_WITHOUT[pair]} if pair else {*TARGET_KEYS}
        if not own.keys().isdisjoint(MODULI_KEYS):
            gone |= {*WAVE_SPEED_KEYS}
        return Material(**{key: value for key, value in material.given().items() if key not in gone} | own)


OF_PARTS = (
    *("p_wave_speed", "s_wave_speed", "young", "poisson", "bulk", "shear", "plane", "along", "emod", "pb_emod"),
    *("kratio", "pb_kratio", "fric", "rr_fric", "pb_ten", "pb_coh", "pb_fa", "pb_mcf"),
)
"""Keys of [material] that every part of the ground may have."""


def with_keys_of_material(table: type[Differing], name: str, keys: Sequence[str]) -> Any:
    """The table of a part of the ground with keys of [material], which may all be absent; name : of the class."""
    fields: dict[str, Any] = {}
    for key in keys:
        field, described = Material.model_fields[key], Material.described(key)
        limits = {name: value for each in field.metadata for name, value in asdict(each).items()}
        own = quantity(None, unit=described["unit"], means=described["means"], **limits)
        fields[key] = (Optional[field.annotation], own)  # noqa: UP045  # known at run time
    return create_model(name, __base__=table, __doc__=table.__doc__, __module__=table.__module__, **fields)


class LayerTable(Differing):
    """A horizontal layer of the ground, from the surface down in the order of the file.

    Absent keys are those of [material], but none for stiffness (wave speeds, targets, `emod`, `pb_emod`) where it
    gives one.
    """

    name: FileName | None = quantity(None)
    """name; absent: its number, from 1 at the surface"""
    thickness: float | None = quantity(None, unit="m", means="length", gt=0.0)
    """thickness; the last layer may have none and goes on below"""
    bottom: float | None = quantity(None, unit="m", means="place")
    """height y at which it ends, for thickness"""
    side: Literal["left", "right"] | None = quantity(None)
    """the side of ground.meet at which it is; absent: at both"""
    k0: float | None = quantity(None, means="ratio of stresses", ge=0.0, le=5.0)
    """stress along x over that along y due to weight; absent: static.k0, which it needs"""

    def mistakes(self) -> Iterator[str]:
        """Two ends."""
        if self.thickness is not None and self.bottom is not None:
            yield "bottom: is not allowed together with thickness; give one of them"


if TYPE_CHECKING:
    Layer = LayerTable
else:
    Layer = with_keys_of_material(LayerTable, "Layer", ("density", *OF_PARTS, "quality_factor"))


def completed_by_layers(tables: Mapping[str, Any]) -> tuple[Mapping[str, Any], list[str]]:
    """The tables of a file, in which [material] need not give a density or stiffness that every layer gives.

    [material] then has those of the lowest layer, which no layer takes from it. Returns also a line for each layer that
    lacks what neither gives.
    """
    layers, material = tables.get("layer"), tables.get("material", {})
    if not isinstance(layers, list) or not isinstance(material, Mapping):
        return tables, []
    own = [layer if isinstance(layer, Mapping) else {} for layer in layers]
    added, lacking = dict[str, Any](), list[str]()
    stiffness = ("p_wave_speed", *STIFFNESS_KEYS), "; give it a wave speed, targets or moduli"
    for keys, words in ((("density",), ""), stiffness):
        giving = [{key: layer[key] for key in keys if key in layer} for layer in own]
        if any(giving) and not any(key in material for key in keys):
            added |= next(given for given in reversed(giving) if given)
            lacking += [
                f"{place}.{keys[0]}: is missing in the layer and in [material]{words}"
                for place, given in zip(places("layer", layers), giving, strict=True)
                if not given
            ]
    return {**tables, "material": {**material, **added}}, lacking


def stack(layers: Sequence[Layer | None], side: str) -> list[tuple[int, Layer]]:
    """The layers of one side, its own and the common ones, from the surface down, with their numbers from 0."""
    return [(number, layer) for number, layer in enumerate(layers) if layer and layer.side in (None, side)]


def bottoms(layers: Sequence[Layer], surface: float) -> list[float]:
    """Height y (m) at which each layer ends, −∞ without an end. surface : height of the free surface, m."""
    found, top = list[float](), surface
    for layer in layers:
        if layer.bottom is not None:
            top = layer.bottom
        else:
            top = -float("inf") if layer.thickness is None else top - layer.thickness
        found.append(top)
    return found


def place_of(number: int, layer: Layer) -> str:
    """The place of a layer in messages, such as ``layer[1, soil]``; number : from 0."""
    return f"layer[{number + 1}{f', {layer.name}' if layer.name else ''}]"


def layer_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """Check the layers with [material] and the ground; a table, or an entry, that is invalid on its own is None."""
    layers, material = tables["layer"], tables["material"]
    if material:
        for place, layer in numbered("layer", layers):
            yield from problems_of_material(place, layer, material)
    if not layers or None in layers:
        return
    first = dict[str, int]()
    for number, layer in enumerate(layers, start=1):
        name = layer.name or str(number)
        if first.setdefault(name, number) != number:
            yield f"layer[{number}].name: {show(name)} is taken by layer[{first[name]}]"
    if (below := tables["boundary"].get("bottom")) is not None and below.is_periodic:
        yield 'layer: boundary.bottom is "periodic", below which the surface follows again; layers need another side'
    if tables["ground"] and tables["packing"] and not ("bottom" in tables["boundary"] and below is None):
        goes_on, box = below is not None and below.is_outside, tables["ground"].box(tables["packing"])
        lines = [
            line
            for side in ("left", "right")
            for line in _problems_of_heights(stack(layers, side), tables["packing"], box, goes_on)
        ]
        yield from dict.fromkeys(lines)


def problems_of_material(place: str, part: Differing, material: Material) -> Iterator[str]:
    """Mistakes of [material] with the keys of a part of the ground, at the part."""
    try:
        part.merged(material)
    except ValidationError as error:
        for line in str(error.errors()[0]["ctx"]["error"]).splitlines():
            yield f"{place}.{line}"


def _problems_of_heights(
    numbered_layers: Sequence[tuple[int, Layer]], packing: Packing, box: Box, goes_on: bool
) -> Iterator[str]:
    """Layers that have no end or no room, are too thin, or leave ground below; goes_on : it does so below its box.

    numbered_layers : of one side, see `stack`.
    """
    layers = [layer for _, layer in numbered_layers]
    lowest, surface, least = box[1], box[3], THINNEST * 2.0 * packing.radius
    heights, near = [surface, *bottoms(layers, surface)], TYPED * max(abs(box[1]), abs(box[3]), packing.radius)
    for (number, layer), (top, bottom) in zip(numbered_layers, pairwise(heights), strict=True):
        last, key = layer is layers[-1], "thickness" if layer.bottom is None else "bottom"
        place = f"{place_of(number, layer)}.{key}"
        if layer.thickness is None and layer.bottom is None:
            if not last:
                yield f"{place}: is missing; only the last layer may go on below, give thickness or bottom"
                return
        elif top - bottom < least - near:
            what = f"{bottom:.10g}" if key == "bottom" else f"{layer.thickness:.10g}"
            must = f"at most {top - least:.10g}" if key == "bottom" else f"at least {least:.10g}"
            yield (
                f"{place}: is {what}, must be {must} (m): the layer begins at {top:.10g} m, and must have two "
                "diameters of the disks"
            )
        elif last and bottom > lowest + near:
            yield f"{place}: ends at {bottom:.10g} m, above the bottom of the ground at {lowest:.10g} m; leave it out"
        elif last and not goes_on and bottom < lowest - near:
            yield (
                f"{place}: ends at {bottom:.10g} m, below the bottom of the ground at {lowest:.10g} m, where nothing "
                "goes on; leave it out, or make the ground higher"
            )
        if layer is not layers[0] and not goes_on and top < lowest + least - near:
            yield (
                f"{place}: the layer begins at {top:.10g} m, must have two diameters of the disks above the bottom of "
                f"the ground at {lowest:.10g} m"
            )


MOST_ELEMENTS = 1000
"""Largest number of elements of a margin or of layers: six absorbing ones are enough, and a margin of 100 beside a
lasting load.
"""

CONTINUUM = ".continuum"
"""Suffix of the names of sides of the continuum."""


class OutsideTable(Table):
    """The continuum beyond sides of type "outside", of spectral elements; keys left out follow from `accuracy`.

    Outer elements absorb.
    """

    order: int = quantity(4, means="count", ge=3, le=6)
    """order of the elements, nodes along a side less one"""
    accuracy: float = quantity(1e-3, means="share", gt=0.0, lt=1.0)
    """error of velocities for which the keys left out are chosen"""
    element: float | None = quantity(None, unit="m", means="length", gt=0.0)
    """largest side of an element; absent: from waves and accuracy"""
    margin: int | None = quantity(None, means="count", ge=1, le=MOST_ELEMENTS)
    """elements before those that absorb; absent: 1, more under lasting loads"""
    layers: int | None = quantity(None, means="count", ge=2, le=MOST_ELEMENTS)
    """elements that absorb, one behind the other; absent: from accuracy"""
    reflection: float | None = quantity(None, means="share", gt=0.0, lt=1.0)
    """R0, what a P wave keeps through the layers and back; absent: accuracy/10"""
    shift: float = quantity(0.3, means="setting", gt=0.0)
    """α of the layers over c_p/2L, L being the larger side of what lies within them"""
    delay: float = quantity(0.1, means="setting", ge=0.0)
    """τ of the layers, in time steps; 0 grows in long runs"""
    damping: float = quantity(0.1, means="setting", ge=0.0)
    """dashpots of the ties between disks and continuum, over ρ c_p D"""
