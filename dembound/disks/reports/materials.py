"""The materials of a scene, each with the names of its keys in the case file."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from dembound.casefile.disks.material import Material
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.scene import DiskScene


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
