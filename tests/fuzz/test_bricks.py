"""A damaged file of a brick is packed again, with a line in the log; it never becomes another brick."""

import logging
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dembound.packings import RandomBrick
from dembound.packings.brick import Brick
from dembound.packings.cache import load_or_pack

KEY = {"pattern": "B"}


@pytest.fixture(scope="module")
def brick() -> Brick:
    return RandomBrick(bricks=(1, 1), radius=0.25, radius_ratio=1.5, brick=(3.0, 3.0)).pack(1e9)


def damaged(content: bytes) -> st.SearchStrategy[bytes]:
    """The bytes with one changed, some zeroed, overwritten or left out, or cut off."""
    places = st.integers(0, len(content) - 1)
    flip = st.builds(
        lambda at, by: content[:at] + bytes([content[at] ^ by]) + content[at + 1 :], places, st.integers(1, 255)
    )
    fill = st.builds(
        lambda at, new: (content[:at] + new + content[at + len(new) :])[: len(content)], places, st.binary(min_size=1)
    )
    zero = st.builds(
        lambda at, count: content[:at] + bytes(len(content[at : at + count])) + content[at + count :],
        places,
        st.integers(1, 500),
    )
    gone = st.builds(lambda at, count: content[:at] + content[at + count :], places, st.integers(1, 100))
    return st.one_of(flip, flip, fill, zero, gone, places.map(lambda at: content[:at])).filter(
        lambda new: new != content
    )


@pytest.mark.parametrize("count", [200, pytest.param(3000, marks=pytest.mark.slow)])
def test_a_damaged_brick_is_packed_again(count: int, sweep, brick, tmp_path: Path, monkeypatch, caplog) -> None:
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
