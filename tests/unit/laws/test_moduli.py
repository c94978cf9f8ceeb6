"""Moduli from wave speeds, by hand."""

import pytest

from dembound.laws import lattice_moduli


def test_shares_and_bond_radius_divide_the_stiffness_as_equation_9_says() -> None:
    contact, bond = lattice_moduli(2500.0, 1000.0, contact_share=0.75, bond_radius_factor=0.5)

    assert (contact, bond) == (1.875e9, 1.25e9)
    assert contact + 0.5 * bond == pytest.approx(2500.0 * 1000.0**2, rel=1e-15)
