"""What the tests of disks in motion share."""

import pytest
from disk_systems import DENSE

from dembound.disks.scene import DiskScene, build


@pytest.fixture
def loose(bar):
    """Makes random packings that nothing holds or drives."""

    def make(**changes: object) -> DiskScene:
        bare = {"packing": DENSE, "boundary": {}, "wave": {}, "monitor": [], "motion.held": []}
        return build(bar({**bare, **changes}))

    return make
