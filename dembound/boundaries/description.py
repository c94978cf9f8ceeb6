"""A side's table in words, for reports."""

from collections.abc import Mapping, Sequence
from typing import Any

from dembound.boundaries.edge import Motion
from dembound.words import percent, with_unit

FACTORS = {"beta_p": "β_P", "beta_s": "β_S"}
"""Keys of the factors of dashpots -> their symbols."""

IN_WORDS = {
    *("type", "layer", "particles", "length", "diameter_min", "diameter_mean", "diameter_max", "diameter_sum_ratio"),
    *("beta_p", "beta_s", "matched_p", "matched_s", "half_mass", "rock_p", "rock_s"),
    *("alpha_n", "alpha_s", "shear_modulus", "distance_min", "distance_max"),
}
"""Keys of a side that other texts print."""


TOO_MUCH = 0.2
"""Reflected share of the amplitude of a plane wave along the normal above which an absorbing side gives a warning."""


def reflected(impedance: complex, matched: complex) -> complex:
    """Reflected over incident velocity of a plane wave, (Z0 − Z)/(Z0 + Z), at an end of impedance Z; matched is Z0."""
    return (matched - impedance) / (matched + impedance)


LIKE_A_WALL = 0.9
"""Share of the amplitude from which on a side is called a free surface, or a rigid wall."""


def too_much(motions: Sequence[Motion], shares: Sequence[float], sides: int = 1) -> str:
    """The beginning of a warning that sides send back such shares of the amplitude of waves of these motions."""
    kinds = " and ".join(motion.upper() for motion in motions)
    verb, whose = ("sends", "its normal") if sides == 1 else ("send", "their normals")
    share = _range([100.0 * each for each in shares], ".0f")
    return f"{verb} back {share} % of the amplitude of {kinds} waves along {whose}"


def poor_factor(
    motions: Sequence[Motion],
    shares: Sequence[float],
    beta: float,
    matched: Sequence[float],
    wave: str | None,
    sides: int = 1,
) -> str:
    """A warning that a factor β of some sides sends back shares of the amplitude.

    motions : those with this factor. shares, matched : of all sides and motions. wave : name of the one entering there,
    or None.
    """
    enters = f" and lets in {_range([2.0 * beta / (each + beta) for each in matched], '.2g')} times wave {wave}"
    like = f", as a {'free surface' if beta < min(matched) else 'rigid wall'} does"
    keys = " and ".join(f"beta_{motion}" for motion in motions)
    verb, them = ("is", "it") if len(motions) * sides == 1 else ("are", "them")
    return (
        f"{too_much(motions, shares, sides)}{enters if wave else ''}{like if min(shares) > LIKE_A_WALL else ''}: "
        f'{keys} {verb} {beta:g}, matched would be {_range(matched, ".3g")}; leave {them} out or give "matched"'
    )


def _range(values: Sequence[float], digits: str) -> str:
    """The smallest and the largest number, or one where both have the same digits."""
    least, most = f"{min(values):{digits}}", f"{max(values):{digits}}"
    return least if least == most else f"{least} to {most}"


def side_in_words(side: Mapping[str, Any]) -> str:
    """Type and numbers of a described side, except the number and sizes of its particles; see `Boundary.describe`."""
    there = {key: sign for key, sign in FACTORS.items() if key in side}
    factors = "".join(f", {sign} = {side[key]:g}{_beside_matched(side, key)}" for key, sign in there.items())
    half = ", half mass" if side.get("half_mass") else ""
    return f"{side['type']}{factors}{half}{_springs_in_words(side)}{_rock_in_words(side)}{_others(side)}"


def _rock_in_words(side: Mapping[str, Any]) -> str:
    """The impedance of rock over that of the ground, and the amplitude it returns at normal incidence."""
    ratios = {motion.upper(): side.get(f"rock_{motion}") for motion in ("p", "s")}
    each = [
        f"{ratio:.3g} times the ground's impedance for {kind} waves, returns "
        f"{percent(reflected(ratio, 1.0).real, 3)} of their amplitude"
        for kind, ratio in ratios.items()
        if ratio is not None
    ]
    return f"; rock of {'; of '.join(each)}" if each else ""


def _beside_matched(side: Mapping[str, Any], key: str) -> str:
    """The text " (matched)" for a matched factor, else the matched value in brackets; empty if unknown."""
    if (matched := side.get(key.replace("beta", "matched"))) is None:
        return ""
    return " (matched)" if matched == side[key] else f" (matched: {matched:.4g})"


def _others(side: Mapping[str, Any]) -> str:
    """All other numbers in words; types of other packages may have some."""
    others = {key: value for key, value in side.items() if key not in IN_WORDS}
    return "".join(f", {key} = {f'{value:g}' if isinstance(value, float) else value}" for key, value in others.items())


def _springs_in_words(side: Mapping[str, Any]) -> str:
    """The springs of the side in words, if it has any."""
    if "alpha_n" not in side:
        return ""
    nearest, farthest = side["distance_min"], side["distance_max"]
    reach = f"{nearest:.4g}" + (f"…{farthest:.4g}" if farthest > nearest else "")
    return (
        f"; springs α_n = {side['alpha_n']:g}, α_s = {side['alpha_s']:g}, "
        f"G = {with_unit(side['shear_modulus'], 'Pa')}, L = {reach} m"
    )
