"""Choices of a chart keep the scene."""

from dembound.accuracy.choice import changed
from dembound.accuracy.of_disks.chart_choices import disk_choices


def test_coarser_disks_fill_the_same_extent_where_bricks_are_counted(bar) -> None:
    case = bar({"packing": {"pattern": "A", "radius": 0.25, "bricks": [24, 12]}, "monitor": []})
    coarser = {name: changed(case, changes).packing for name, changes in disk_choices(case) if "radius" in name}
    assert {packing.radius for packing in coarser.values()} == {0.375, 0.5}
    assert all(packing.extent == case.packing.extent for packing in coarser.values())
