"""Bricks that several tests look at, packed once."""

import pytest

from dembound.packings.dense import NO_ROWS, Recipe, pack_dense
from dembound.packings.edged_brick import regular_rows

RECIPE = Recipe(size=(10.0, 8.0), radius=0.25, radius_ratio=1.5, pressure=0.008, bond_gap=0.0, seed=3)
EDGE_RADII = ((8.0 - 10.0 / 19) / 28, 10.0 / 38)  # 14 disks on what the corner leaves of 8 m, 19 on 10 m


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    folder = tmp_path / "bricks"
    monkeypatch.setenv("DEMBOUND_CACHE", str(folder))
    return folder


@pytest.fixture(scope="session")
def recipe():
    return RECIPE


@pytest.fixture(scope="session")
def random_brick():
    return pack_dense(RECIPE, NO_ROWS)


@pytest.fixture(scope="session")
def edged_brick():
    return pack_dense(RECIPE, regular_rows(RECIPE.size, EDGE_RADII))


@pytest.fixture(params=["random_brick", "edged_brick"])
def dense_brick(request):
    return request.getfixturevalue(request.param)
