"""Fixtures for tests of disks in motion."""

import pytest
from disk_systems import BODY, DENSE

from dembound.disks.scene import DiskScene, build


@pytest.fixture
def loose(bar):
    """Makes random packings that nothing holds or drives."""

    def make(**changes: object) -> DiskScene:
        return build(bar({**BODY, "packing": DENSE, **changes}))

    return make
