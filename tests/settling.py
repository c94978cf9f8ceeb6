"""Small bodies of a lattice in a static stage."""

from disk_systems import BODY

from dembound.disks.scene import DiskScene, build

G = 9.81
MASS = 2500.0 * 0.5**2
"""Mass of a disk, kg."""

FIXED = {"type": "fixed"}
WEIGHT = {"load": [{"name": "weight", "acceleration": [0.0, -G]}]}
STANDING = {**BODY, **WEIGHT, "packing.size": [1.0, 2.0]}
WRAP = {"left": {"type": "periodic"}, "right": {"type": "periodic"}}


def scene(bar, **changes: object) -> DiskScene:
    """A scene whose static stage is supported at the bottom and ends at a ratio of 1e-8 unless `changes` differ.

    bar : makes the small bar of disks with keys changed.
    """
    return build(bar({**BODY, "static": {"ratio": 1e-8, "boundary": {"bottom": FIXED}}, **changes}))
