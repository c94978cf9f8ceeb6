"""The TOML tables of the packings."""

import hashlib
import io
import logging
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, fields

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from dembound.casefile.types import PackingTable
from dembound.errors import CaseError
from dembound.packings import Square
from dembound.packings import random_brick as random_module
from dembound.packings.brick import clear, load_or_pack

B = {"pattern": "B", "size": [20.0, 10.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [10.0, 10.0]}
C = {**B, "pattern": "C", "edge_radius": 0.26}


def read(table):
    return TypeAdapter(PackingTable).validate_python(table)


def test_the_extent_is_given_in_metres_or_in_bricks():
    assert read(B).copies == (2, 1)
    assert Square(size=(0.3, 0.6), radius=0.05).copies == (3, 6)  # 0.3/0.1 is not 3 in floating point
    assert Square(size=(2.66667, 2.0), radius=1.0 / 3.0).copies == (4, 3)  # six digits
    assert Square(bricks=(4, 3), radius=0.25).extent == (2.0, 1.5)
    assert Square(size=(2.0, 1.5), radius=0.25).with_copies(5, 1).extent == (2.5, 0.5)
    for both in ({}, {"size": (2.0, 1.5), "bricks": (4, 3)}):
        with pytest.raises(ValidationError, match="must have exactly one of size"):
            Square(radius=0.25, **both)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"size": [1010.0, 50.0], "brick": [50.0, 50.0]},
         "size: 1010 m is not a whole number of bricks of 50 m; 1000 or 1050 would be"),
        ({"brick": [1.0, 10.0]}, "brick: 1 m is too small, 2.4 m is the least"),
        ({"size": [1e19, 1e19]}, r"size: holds 4e\+38 disks of this radius, must hold at most 500,000,000"),
        ({"radius": 0.001, "size": [10.0, 10.0]}, r"brick: holds 2.5e\+07 disks of this radius, must hold at most 1"),
        ({"brick": [5e-324, 5e-324]}, "is 4.94066e-324, must be 0 or of a size between 1e-30 and 1e"),
        ({"bond_gap": 0.3}, "bond_gap: 0.3 m is larger than the mean radius"),
    ],
)  # fmt: skip
def test_mistakes_are_named(change, message):
    with pytest.raises(ValidationError, match=message):
        read({**B, **change})


def test_edge_radii_are_adjusted_to_whole_disks():
    table = read({**C, "size": [50.0, 50.0], "brick": [50.0, 50.0]})
    assert table.edge_radii == pytest.approx((25.0 / 96, 25.0 / 96), rel=1e-14)
    on_x, on_y = read({**C, "size": [10.0, 8.0], "brick": [10.0, 8.0]}).edge_radii
    assert 38 * on_y == pytest.approx(10.0)  # 19 disks of about 0.52 m
    assert 28 * on_x + 2 * on_y == pytest.approx(8.0)  # the corner disk and 14 more


@pytest.mark.parametrize(
    ("keys", "modulus", "said"),
    [
        ({"confining_stress": 1e7}, 1e7, r"packing\.confining_stress: 10 MPa .* can be packed"),
        ({"radius_ratio": 1.05, "confining_stress": 1e6}, 1e10, r"packing\.radius_ratio: is 1\.05, must .* crystals"),
    ],
)
def test_stresses_out_of_range_and_loose_packings_of_nearly_equal_disks_are_refused(keys, modulus, said):
    with pytest.raises(CaseError, match=said):
        read({**B, **keys}).pack(modulus)


def test_bricks_are_packed_once_for_a_stress_over_the_modulus(monkeypatch):
    first = read(B).pack(1.25e9)
    assert first.stress[:2].mean() == pytest.approx(-8e-3, rel=1e-3)  # 0.8 %, reached within 0.1 %
    monkeypatch.setattr(random_module, "pack_dense", None)  # packing again would fail
    for modulus, change in ((1.25e9, {}), (1e12, {}), (2.5e9, {"confining_stress": 2e7})):
        assert np.array_equal(read({**B, **change}).pack(modulus).positions, first.positions)
    monkeypatch.undo()
    edged = read({**C, "size": [5.2, 5.2], "brick": [5.2, 5.2]}).pack(1.25e9)
    assert edged.radii[edged.edge_rows.any(axis=1)] == pytest.approx(np.full(19, 0.26))  # ten on each side


KEY = {"pattern": "T", "radius": 0.5, "size": (1.0, 1.0)}


@pytest.fixture
def packer():
    """Packs a small brick and counts how often it was asked to."""

    def pack():
        pack.calls += 1
        return Square(size=(1.0, 1.0), radius=0.5).pack(1e9)

    pack.calls = 0
    return pack


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
