"""Cases of either kind become scenes."""

from dembound.any_scene import build_scene
from dembound.bar.scene import BarScene
from dembound.scene import Scene


def test_a_scene_is_of_a_bar_or_of_disks(spalling, bar) -> None:
    assert isinstance(build_scene(spalling()), BarScene)
    assert isinstance(build_scene(bar()), Scene)
