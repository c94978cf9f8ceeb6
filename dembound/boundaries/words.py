"""A side's table in words, for reports."""

from collections.abc import Mapping
from typing import Any

FACTORS = {"beta_p": "β_P", "beta_s": "β_S"}
"""Keys of the factors of dashpots, and their symbols."""

IN_WORDS = {
    *("type", "particles", "length", "diameter_min", "diameter_mean", "diameter_max", "diameter_sum_ratio"),
    *("beta_p", "beta_s", "half_mass", "alpha_n", "alpha_s", "shear_modulus", "distance_min", "distance_max"),
}
"""Keys of a side that are printed in another way, or by the caller."""


def side_in_words(side: Mapping[str, Any]) -> str:
    """Type and numbers of a described side, except the number and sizes of its particles; see `Boundary.describe`."""
    factors = "".join(f", {sign} = {side[key]:g}" for key, sign in FACTORS.items() if key in side)
    half = ", half mass" if side.get("half_mass") else ""
    return f"{side['type']}{factors}{half}{_springs_in_words(side)}{_others(side)}"


def _others(side: Mapping[str, Any]) -> str:
    """All other numbers; types of other packages may have some."""
    return "".join(f", {key} = {value}" for key, value in side.items() if key not in IN_WORDS)


def _springs_in_words(side: Mapping[str, Any]) -> str:
    """The springs of the side, if it has any."""
    if "alpha_n" not in side:
        return ""
    nearest, farthest = side["distance_min"], side["distance_max"]
    reach = f"{nearest:.4g}" + (f"…{farthest:.4g}" if farthest > nearest else "")
    return (
        f"; springs α_n = {side['alpha_n']:g}, α_s = {side['alpha_s']:g}, "
        f"G = {side['shear_modulus'] / 1e9:.4g} GPa, L = {reach} m"
    )
