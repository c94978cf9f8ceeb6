"""Cases and records of either kind are distinguished."""

import h5py

from dembound.accuracy.judges import judge_of
from dembound.accuracy.of_bars.judge import BarJudge
from dembound.accuracy.of_disks.judge import DiskJudge
from dembound.bar.scene import BarScene
from dembound.disks.scene import DiskScene
from dembound.kinds import kind_of, kind_of_record
from dembound.kinds.bar.kind import Bars
from dembound.kinds.disks.kind import Disks
from dembound.schemas import BODIES


def test_a_scene_is_of_a_bar_or_of_disks(spalling, bar) -> None:
    for case, kind, judge, scene in ((spalling(), Bars, BarJudge, BarScene), (bar(), Disks, DiskJudge, DiskScene)):
        found = kind_of(case)
        assert isinstance(found, kind)
        assert isinstance(judge_of(case), judge)
        assert BODIES[found.name].schema is found.schema
        assert isinstance(found.build(case), scene)
        assert found.build(case).kind == found.name


def test_a_record_is_of_a_bar_or_of_disks(spalled_run, small_run, tmp_path) -> None:
    assert isinstance(kind_of_record(spalled_run), Bars)
    assert isinstance(kind_of_record(small_run), Disks)
    with h5py.File(tmp_path / "run.h5", "w"):  # names no kind
        pass
    assert isinstance(kind_of_record(tmp_path / "run.h5"), Disks)
