"""The brick cache: hits, misses, damage, moving and clearing."""

import hashlib
import io
import logging
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, fields

import numpy as np
import pytest

from dembound.packings import Square
from dembound.packings.brick import clear, load_or_pack

KEY = {"pattern": "T", "radius": 0.5, "size": (1.0, 1.0)}


class Packer:
    """Packs a small brick and counts how often it was asked to."""

    calls = 0

    def __call__(self):
        self.calls += 1
        return Square(size=(1.0, 1.0), radius=0.5).pack(1e9)


@pytest.fixture
def packer():
    return Packer()


def test_second_time_comes_from_the_file(packer):
    packed, kept = load_or_pack(KEY, packer), load_or_pack(KEY, packer)
    assert packer.calls == 1
    for field in fields(packed):
        one, other = getattr(packed, field.name), getattr(kept, field.name)
        assert np.array_equal(one, other)
        assert type(one) is type(other)
        assert np.asarray(one).dtype == np.asarray(other).dtype


def test_a_damaged_file_is_packed_again_and_replaced(packer, own_cache, caplog):
    caplog.set_level(logging.INFO)
    brick = load_or_pack(KEY, packer)
    (path,) = own_cache.iterdir()
    whole = path.read_bytes()
    changes = (
        {"radii": np.zeros(1)},
        {"positions": np.full((1, 2), np.nan)},
        {"pairs": np.ones((2, 2), np.int64)},
        {"extra": np.ones(1)},
    )
    damaged = [b"", b"not a brick", whole[: len(whole) // 2]]
    for arrays in ({"size": np.ones(2)}, *(asdict(brick) | change for change in changes)):
        content = io.BytesIO()
        np.savez_compressed(content, **arrays)
        damaged.append(content.getvalue() + hashlib.sha256(content.getvalue()).digest())
    for content in damaged:
        path.write_bytes(content)
        packer.calls = 0
        assert [load_or_pack(KEY, packer).radii.tolist() for _ in range(2)] == [[0.5], [0.5]]
        assert packer.calls == 1
        assert list(own_cache.iterdir()) == [path]
    assert caplog.messages == [f"the cached brick {path} is damaged, it is packed again"] * len(damaged)


def test_the_folder_can_move_and_need_not_be_writable(packer, own_cache, tmp_path, monkeypatch):
    load_or_pack(KEY, packer)
    own_cache.rename(tmp_path / "elsewhere")
    monkeypatch.setenv("DEMBOUND_CACHE", str(tmp_path / "elsewhere"))
    load_or_pack(KEY, packer)
    assert packer.calls == 1
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("DEMBOUND_CACHE", str(tmp_path / "file" / "bricks"))
    assert len(load_or_pack(KEY, packer).radii) == 1


def test_other_parameters_are_another_brick_and_clear_counts_what_it_deletes(packer):
    assert clear() == 0
    load_or_pack(KEY, packer)
    load_or_pack({**KEY, "radius": 0.5 + 1e-15}, packer)
    assert packer.calls == clear() == 2
    load_or_pack(KEY, packer)
    assert packer.calls == 3


def test_a_brick_that_another_process_packs_is_waited_for(packer, own_cache):
    begun, may_end = threading.Event(), threading.Event()

    def slowly():
        begun.set()
        may_end.wait(10.0)
        return packer()

    with ThreadPoolExecutor(2) as pool:
        first = pool.submit(load_or_pack, KEY, slowly)
        begun.wait(10.0)
        second = pool.submit(load_or_pack, KEY, packer)
        time.sleep(0.2)
        assert not second.done()
        may_end.set()
        assert np.array_equal(first.result().positions, second.result().positions)
    assert packer.calls == 1
    assert [path.suffix for path in own_cache.iterdir()] == [".npz"]
