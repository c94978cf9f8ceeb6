"""The memory of a bar is counted from its nodes and bonds."""

import pytest

from dembound.bar.scene import build_bar
from dembound.errors import CaseError
from dembound.machine import Memory
from dembound.methods.opening import COLUMNS
from dembound.motion import memory


def test_bonds_are_the_sum_of_their_arrays(spalling) -> None:
    law = {"bar.fracture_energy": 1e4, "bar.strength_per_decade": 1e3, "bar.strength_rates": [1.0, 2.0]}
    bonds = build_bar(spalling({"bar.spacing": 0.001, **law})).system(1e-9).parts[0].bonds
    kept = [bonds.spring, bonds.spring_limit, bonds.spring_broken, bonds.triggers, bonds._most_carried]
    kept += [bonds.bond, bonds.bond_broken, bonds._rows]
    lengths, nodes = bonds.bond.shape

    work = 16 * nodes  # of the kernels
    # there is a spring less than nodes
    counts = {"node": nodes, "bond": lengths * nodes, "link": (lengths + 1) * nodes}
    assert memory.total(counts, "bonds") == pytest.approx(work + sum(each.nbytes for each in kept), rel=0.01)
    bundle = bonds.opening.bundle
    listed = [getattr(bundle, name) for name in COLUMNS] + [bundle.below]
    assert memory.total(counts, "opening") == sum(each.nbytes for each in listed)


def test_a_bar_too_large_is_refused_before_its_nodes_are_placed(spalling, monkeypatch) -> None:
    monkeypatch.setattr(memory, "memory_here", lambda: Memory(300e6, 250e6))
    said = r"^bar.spacing: 1,000,001 nodes with a horizon of 3 spacings need about \d+ MB of "
    with pytest.raises(CaseError, match=said):
        build_bar(spalling({"bar.spacing": 1e-6}))
