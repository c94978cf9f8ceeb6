"""Bundles are passed to compiled code by their addresses."""

import numpy as np
import pytest
from numba import config, njit

from dembound.kernels.common import FAST, MAKES
from dembound.kernels.compiler.bundles import Written, kind_of
from dembound.kernels.tables import Bonded, Cells, Contacts
from dembound.laws.law import Limits

pytestmark = pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")  # type: ignore[attr-defined]

CONTACTS = Contacts(
    begin=-3, damps_bonds=True, first=np.zeros(2, np.uint32), second=np.ones(2, np.uint32),
    contact_type=np.zeros(2, np.uint32),
    constants=np.arange(24.0).reshape(2, 12), began=np.zeros((0, 3)), state=np.array([1, 200], np.uint8),
    shear=np.array([0.1, -0.2]), slip=np.zeros(2), closed=np.zeros(2, np.uint8), cracked=np.array([-1, 7]),
    place=np.zeros((2, 2)), kept=np.zeros(2, np.uint8), force=np.arange(8.0).reshape(4, 2),
    viscosity=np.zeros((2, 0)), drag=np.zeros((2, 0)), lag=np.zeros((0, 0)), rolled=np.zeros(0), bound=np.arange(3),
    start=np.zeros(3, np.uint32), end=np.zeros(0, np.uint32),
)  # fmt: skip
CELLS = Cells(np.arange(3), np.arange(2), np.array([2, 1]), np.array([False, True]), 0.25)
WORK = np.zeros(2), np.zeros(2), np.zeros((2, 2)), np.zeros((2, 4))


def bonded(stops: bool = True, reach: float = 0.25) -> Bonded:
    """A law with numbers of all types, two bundles within it, and an array whose rows are not one after the other."""
    limits = Limits(0.5, 1e6, -2e6, 0.0, 2)
    return Bonded(
        CONTACTS,
        limits,
        np.arange(12.0).reshape(2, 6)[:, ::2],
        np.array([0.5, -1.5]),
        CELLS._replace(reach=reach),
        stops,
        *WORK,
    )


def _read(law, found):
    contacts = law.contacts
    found[0], found[1], found[2] = contacts.begin, contacts.constants[1, 3], contacts.state[1]
    found[3], found[4], found[5] = contacts.cracked[1], law.limits.cohesion, law.limits.geometry
    found[6], found[7], found[8] = law.origin[1, 2], law.skins[1], law.cells.reach
    found[9], found[10], found[11] = law.cells.wraps[1], law.stops, contacts.force.shape[1]
    law.way[1] = 4.0


@pytest.mark.parametrize("options", [FAST, MAKES], ids=["plain", "creates arrays"])
def test_compiled_code_reads_and_writes_what_is_in_a_bundle(options) -> None:
    kernel = njit(**(options | {"cache": False}))(_read)

    def read(law: Bonded) -> list[float]:
        found = np.zeros(12)
        kernel(law, found)
        return found.tolist()

    WORK[0][:] = 0.0
    assert read(bonded()) == [-3.0, 15.0, 200.0, 7.0, -2e6, 2.0, 10.0, -1.5, 0.25, 1.0, 1.0, 2.0]
    assert WORK[0].tolist() == [0.0, 4.0]
    assert read(bonded(stops=False, reach=3.0))[7:11] == [-1.5, 3.0, 1.0, 0.0]
    assert len(kernel.signatures) == 1


def test_only_what_has_changed_is_written_and_nothing_of_another_type() -> None:
    law = bonded()
    written = Written(law)
    address, numbers = written.address, written.numbers.copy()
    assert written.takes(law._replace(cells=law.cells._replace(reach=3.0)))
    (changed,) = np.flatnonzero(written.numbers != numbers)
    assert written.numbers[changed] == np.float64(3.0).view(np.int64)
    assert written.address == address

    for other in (
        law._replace(cells=law.cells._replace(reach=1)),
        law._replace(way=law.way.astype(np.float32)),
        law._replace(origin=np.zeros((2, 3))),
        law._replace(origin=np.zeros((3, 2)).T),
        law._replace(damped=np.zeros((2, 2))[:, ::2]),
        law._replace(contacts=law.contacts._replace(slip=np.zeros((1, 2)))),
        law.limits,
    ):
        before = written.numbers.copy()
        assert kind_of(other) != kind_of(law)
        assert not written.takes(other)
        np.testing.assert_array_equal(written.numbers, before)
