"""A damaged file of a brick is packed again, with a line in the log; it never becomes another brick."""

import logging
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given

from dembound.packings import RandomBrick
from dembound.packings.brick import Brick
from dembound.packings.cache import load_or_pack

KEY = {"pattern": "B"}


@pytest.fixture(scope="module")
def brick() -> Brick:
    return RandomBrick(bricks=(1, 1), radius=0.25, radius_ratio=1.5, brick=(3.0, 3.0)).pack(1e9)


@pytest.mark.parametrize("count", [60, pytest.param(3000, marks=pytest.mark.slow)])
def test_a_damaged_brick_is_packed_again(
    count: int, sweep, damaged, brick, tmp_path: Path, monkeypatch, caplog
) -> None:
    monkeypatch.setenv("DEMBOUND_CACHE", str(tmp_path))
    caplog.set_level(logging.INFO)
    load_or_pack(KEY, lambda: brick)
    (file,) = tmp_path.iterdir()
    content = file.read_bytes()
    packed = []

    def pack() -> Brick:
        packed.append(1)
        return brick

    @sweep(count)
    @given(damaged(content))
    def each(new: bytes) -> None:
        file.write_bytes(new)
        packed.clear()
        caplog.clear()
        found = load_or_pack(KEY, pack)
        assert len(packed) == len(caplog.records) == 1
        assert "is damaged, it is packed again" in caplog.text
        assert file.read_bytes() == content
        for field in fields(Brick):
            np.testing.assert_array_equal(getattr(found, field.name), getattr(brick, field.name))

    each()
