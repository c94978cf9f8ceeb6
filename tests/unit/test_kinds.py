"""Cases and records of either kind are distinguished."""

import tomllib

import h5py
import pytest

from dembound.bar.kind import Bars
from dembound.bar.scene import BarScene
from dembound.disks.kind import Disks
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError
from dembound.kinds import KINDS, kind_of, kind_of_record, with_changes


def test_a_scene_is_of_a_bar_or_of_disks(spalling, bar) -> None:
    assert isinstance(kind_of(spalling()), Bars)
    assert isinstance(kind_of(spalling()).build(spalling()), BarScene)
    assert isinstance(kind_of(bar()), Disks)
    assert isinstance(kind_of(bar()).build(bar()), DiskScene)


def test_a_record_is_of_a_bar_or_of_disks(spalled_run, small_run) -> None:
    assert isinstance(kind_of_record(spalled_run), Bars)
    assert isinstance(kind_of_record(small_run), Disks)


def test_a_record_that_names_no_kind_is_of_disks(tmp_path) -> None:
    with h5py.File(tmp_path / "run.h5", "w"):
        pass
    assert isinstance(kind_of_record(tmp_path / "run.h5"), Disks)


def test_scenes_have_the_names_of_their_kinds(spalling, bar) -> None:
    assert [kind().name for kind in KINDS.values()] == list(KINDS) == ["bar", "disks"]
    for case in (spalling(), bar()):
        assert kind_of(case).build(case).kind == kind_of(case).name


def test_a_changed_case_remains_of_its_kind(spalling, bar) -> None:
    other = dict.fromkeys(tomllib.loads(bar().text)) | tomllib.loads(spalling().text)
    with pytest.raises(CaseError, match="of another kind of body after these changes"):
        with_changes(bar(), other)
