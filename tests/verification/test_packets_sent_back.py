"""Packets of oblique P and S waves that a side sends back in a run have the energies that are measured without one.

The packet is made of waves of the packing itself, and all energy but what the side absorbs remains in the strip. Of the
packet exp(−17) = 4e-8 has not yet reached the side, and the same part was beyond the strip's end: of totals of some per
cent 1e-5. What is P and what S is read from plane waves of the continuum. In a random packing motion also has other
wave numbers, some 1e-3 of the amplitude, and directions that differ by 1e-2 from these waves': 1e-5 of the energy of
each.
"""

import pytest
from reflection_packets import SOFT, SPRINGS, Packet, in_a_run, without_a_run


@pytest.mark.slow
@pytest.mark.parametrize(
    "packet",
    [Packet("B", SOFT, "p", 45.0), Packet("B", SPRINGS, "s", 30.0)],
    ids=["dashpots, P at 45°", "springs and dashpots, S at 30°"],
)
def test_packets_of_oblique_waves(packet: Packet) -> None:
    found, _, _ = in_a_run(packet)
    expected = without_a_run(packet)
    assert min(found.p, found.s) > 3e-3
    assert found.total == pytest.approx(expected.total, rel=2e-5)
    assert found.p == pytest.approx(expected.p, abs=2e-5)
    assert found.s == pytest.approx(expected.s, abs=2e-5)
