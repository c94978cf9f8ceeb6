"""Sides in words."""

from dembound.boundaries.description import side_in_words


def test_a_side_is_reported_with_its_numbers() -> None:
    assert side_in_words({"type": "viscous", "beta_p": 0.9, "beta_s": 1.0, "half_mass": True}) == (
        "viscous, β_P = 0.9, β_S = 1, half mass"
    )
    either = {"beta_p": 0.8, "beta_s": 1.0, "matched_p": 0.8, "matched_s": 0.75}
    assert side_in_words({"type": "viscous", **either}) == "viscous, β_P = 0.8 (matched), β_S = 1 (matched: 0.75)"
    springs = {"alpha_n": 1.0, "alpha_s": 0.5, "shear_modulus": 2e9, "distance_min": 3.0, "distance_max": 4.0}
    assert side_in_words({"type": "viscoelastic", "half_mass": False, **springs}) == (
        "viscoelastic; springs α_n = 1, α_s = 0.5, G = 2 GPa, L = 3…4 m"
    )
    assert side_in_words({"type": "deep", "depth": 5e7, "layers": 3}) == "deep, depth = 5e+07, layers = 3"
