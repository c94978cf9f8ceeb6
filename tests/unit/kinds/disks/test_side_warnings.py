"""Warnings about sides that send back much of a wave, or take much of one along them."""

import pytest
from warned_cases import SLOW, warned

from dembound.casefile import Case

TWO_WAYS = {"motion.held": []}


def about(case: Case, side: str) -> list[str]:
    """The warnings that a side sends back too much, without its name."""
    start = f"boundary.{side}: "
    return [line.removeprefix(start) for line in warned(case) if line.startswith(f"{start}sends back")]


@pytest.mark.parametrize("beta", [0.66, 0.68, "matched", 1.49, 1.51])
def test_a_factor_is_judged_by_its_value(bar, beta) -> None:
    """The matched factor of the lattice is 1, and (1 − β)/(1 + β) is 0.2 at β = 2/3 and 3/2."""
    found = about(bar({**SLOW, "boundary.right.beta_p": beta}), "right")
    if beta in (0.68, "matched", 1.49):
        assert found == []
        return
    share = 100.0 * abs(1.0 - beta) / (1.0 + beta)
    (line,) = found
    assert line == (
        f"sends back {share:.0f} % of the amplitude of P waves along its normal: beta_p is {beta:g}, "
        'matched would be 1; leave it out or give "matched"'
    )


def test_a_factor_is_judged_by_the_packing(bar) -> None:
    """β0 of the lattice is its own S speed of 500 m/s over the one given."""
    changes = {**SLOW, **TWO_WAYS, "boundary.right.beta_s": 1.0}
    moduli = {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9}
    assert about(bar({**changes, "material": moduli | {"s_wave_speed": 500.0}}), "right") == []
    (line,) = about(bar({**changes, "material": moduli | {"s_wave_speed": 250.0}}), "right")
    start = "sends back 33 % of the amplitude of S waves along its normal: beta_s is 1, matched would be 2;"
    assert line.startswith(start)
    # a wave enters with 2β/(β0 + β) of its amplitude: 1.5 at β = 3
    (line,) = about(bar({**SLOW, "boundary.left.beta_p": 3.0}), "left")
    assert line.startswith("sends back 50 % of the amplitude of P waves along its normal and lets in 1.5 times wave p")


def test_springs_hold_long_waves_back(bar) -> None:
    """|R| = (1 + (2ωLρc/(αG))²)^(−½): at ω = 2π/s, and c_p = 2 c_s with G = ρc_s², a fifth at L = 4.9 αG/(2ωρc)."""
    wave = {"wave.pulse": {"type": "ricker", "amplitude": 0.5, "frequency": 1.0}, "run.duration": 5.0}
    for distance, far in ((20.0, False), (200.0, True)):
        springs = {"type": "viscoelastic", "distance": distance}
        found = about(bar({**wave, "boundary.right": springs}), "right")
        assert bool(found) != far
        if found:
            assert "% of the amplitude of P waves along its normal at their mean frequency, 1" in found[0]
            assert "as its springs hold" in found[0]


def test_sides_that_send_back_for_one_reason_share_a_line(bar) -> None:
    dead = {"type": "viscous", "beta_p": 0.0, "beta_s": 0.0}
    sides = {"boundary.right": dead, "boundary.top": dead, "boundary.bottom": {**dead, "beta_p": 1e6, "beta_s": 1e6}}
    found = [
        line for line in warned(bar({**SLOW, **TWO_WAYS, "packing.size": [20.0, 10.0], **sides})) if "back" in line
    ]
    assert [line.split(", matched")[0] for line in found] == [
        "boundary.right and boundary.top: send back 100 % of the amplitude of P and S waves along their normals, as a "
        "free surface does: beta_p and beta_s are 0",
        "boundary.bottom: sends back 100 % of the amplitude of P and S waves along its normal, as a rigid wall does: "
        "beta_p and beta_s are 1e+06",
    ]


def test_sides_along_a_wave_are_warned_of(bar) -> None:
    plate = {
        "packing.size": [20.0, 10.0],
        "run.duration": 0.05,
        **TWO_WAYS,
        "boundary.left": {"type": "viscous"},
        "boundary.bottom": {"type": "viscous_input", "wave_s": "pulse"},
        "monitor": [{"name": "middle", "position": [10.0, 5.0]}, {"name": "surface", "position": [10.0, 9.5]}],
    }
    (line,) = [line for line in warned(bar(plate)) if "along wave" in line]
    assert line.startswith(
        "boundary.left and boundary.right: along wave pulse from bottom no side moves as ground beyond it would; at "
        "monitor "
    )
    assert line.endswith('% where least (RMS); take "free_field", or "outside" there and at bottom')

    (same,) = [line for line in warned(bar({**plate, "static.stress": [-1e6, -2e6, 0.0]})) if "along wave" in line]
    assert same == line


@pytest.mark.parametrize("given", [{}, {"type": "free"}], ids=["forgotten", "free on purpose"])
def test_upright_sides_that_a_case_does_not_give_are_taken_as_forgotten(bar, given: dict) -> None:
    """Beside a wave from below the ground goes on beyond them, if the case does not say that they are free."""
    sides = {"left": given, "right": given} if given else {}
    enters = {"bottom": {"type": "viscous_input", "wave_s": "pulse"}}
    middle = {"monitor": [{"name": "middle", "position": [10.0, 5.0]}]}
    plate = {"packing.size": [20.0, 10.0], "run.duration": 0.1, **TWO_WAYS, **middle, "boundary": enters | sides}
    assert len([line for line in warned(bar(plate)) if "along wave" in line]) == (not given)
