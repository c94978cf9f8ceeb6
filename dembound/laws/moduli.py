"""Particle moduli from wave speeds on the square lattice (Z eqs 7-11)."""


def lattice_moduli(
    density: float, p_wave_speed: float, contact_share: float, bond_radius_factor: float
) -> tuple[float, float]:
    """Contact modulus E_c and bond modulus Ē_c (Pa) for a P-wave speed along the rows of a square lattice.

    Z eq. 11: E_c = α_c ρ c_p² and Ē_c = (1 − α_c) ρ c_p² / η, with η the bond's radius factor (pb_rmul).
    """
    modulus = density * p_wave_speed**2
    return contact_share * modulus, (1.0 - contact_share) * modulus / bond_radius_factor
