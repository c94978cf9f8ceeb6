"""What moves: a scene of disks or a bar. Both have the nodes, masses, supports and monitors that the loop needs."""

from dembound.bar.scene import BarScene, build_bar
from dembound.case import BarCase, Case, DiskCase
from dembound.scene import Scene, build

AnyScene = Scene | BarScene
"""Any scene: n nodes with three components each."""


def build_scene(case: Case) -> AnyScene:
    """The scene of a case of either kind; errors as `scene.build` and `bar.build_bar`."""
    if isinstance(case, BarCase):
        return build_bar(case)
    assert isinstance(case, DiskCase)
    return build(case)
