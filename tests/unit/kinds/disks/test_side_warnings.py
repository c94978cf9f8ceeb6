"""Warnings about sides that send back much of a wave, take much of one along them, or have other springs."""

import pytest
from small_cases import small
from warned_cases import GROUND, SLOW, warned

from dembound.casefile import Case
from dembound.disks.scene import build
from dembound.kinds.disks.side_warnings import spring_warnings

TWO_WAYS = {"motion.held": []}


def about(case: Case, side: str) -> list[str]:
    """The warnings that a side sends back too much, without its name."""
    start = f"boundary.{side}: "
    return [line.removeprefix(start) for line in warned(case) if line.startswith(f"{start}sends back")]


@pytest.mark.parametrize("beta", [0.66, "matched", 1.49])
def test_a_factor_is_judged_by_its_value(bar, beta) -> None:
    """The matched factor of the lattice is 1, and (1 − β)/(1 + β) is 0.2 at β = 2/3 and 3/2."""
    found = about(bar({**SLOW, "boundary.right.beta_p": beta}), "right")
    if beta in ("matched", 1.49):
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


@pytest.mark.parametrize("given", [{}, {"type": "free"}], ids=["forgotten", "free on purpose"])
def test_upright_sides_that_a_case_does_not_give_are_taken_as_forgotten(bar, given: dict) -> None:
    """Beside a wave from below the ground goes on beyond them, if the case does not say that they are free."""
    sides = {"left": given, "right": given} if given else {}
    enters = {"bottom": {"type": "viscous_input", "wave_s": "pulse"}}
    middle = {"monitor": [{"name": "middle", "position": [10.0, 5.0]}]}
    plate = {"packing.size": [20.0, 10.0], "run.duration": 0.1, **TWO_WAYS, **middle, "boundary": enters | sides}
    assert len([line for line in warned(bar(plate)) if "along wave" in line]) == (not given)


BLOW = {"name": "blow", "force": [0.0, -1e5], "position": [9.5, 9.5], "wave": "blow"}
PRESS = {"name": "press", "pressure": 1e5, "hole": "cavity", "wave": "blow"}
CAVITY = {"name": "cavity", "type": "circle", "centre": [10.0, 5.0], "radius": 2.0}
DRIVEN = {"boundary.top": {"type": "viscous_input", "wave_p": "blow"}}
IN_CAVITY = {"load": [PRESS], "hole": [CAVITY]}
FROM_LOAD = "but waves come from load.blow, at (9.5, 9.5) m"
MODULUS = "young_modulus: gives springs of G = 1"


def at(*source: float) -> dict:
    return {"source": list(source)}


@pytest.mark.parametrize(
    ("side", "tables", "words"),
    [
        # the load is 9 m above the row of the side; from −2 m springs are twice as stiff in the mean of 1/L
        (at(10.0, 10.0), {"load": [BLOW]}, None),
        (at(36e3, 10.0), {"load": [BLOW]}, FROM_LOAD),
        (at(10.0, -2.0), {"load": [BLOW]}, FROM_LOAD),
        # a cavity is a centre of waves; without a centre a source may be anywhere near
        (at(10.0, 5.0), IN_CAVITY, None),
        (at(10.0, 500.0), IN_CAVITY, "waves come from"),
        (at(10.0, -36e3), DRIVEN, "times its diagonal"),
        # the disks have G = ρc_s² = 1.25 GPa, with c_s = c_p/√2 or c_p/2 of 625 MPa
        ({"distance": 10.0, "young_modulus": 2.0e9}, {"load": [BLOW]}, None),
        ({"distance": 10.0, "young_modulus": 2.0e6}, {"load": [BLOW]}, MODULUS),
        # ten diagonals of 20 × 10 m are 223.6 m
        ({"distance": 220.0}, {"load": [BLOW]}, None),
        ({"distance": 230.0}, {"load": [BLOW]}, "boundary.bottom.distance: is 230 m, 10.3 times"),
        ({"distance": 10.0, "alpha_n": 0.0, "alpha_s": 0.0}, {}, "alpha_n and alpha_s are 0, so it has no springs"),
    ],
)
def test_springs_that_are_not_those_of_the_ground_are_warned_of(side: dict, tables: dict, words: str | None) -> None:
    springs = {"boundary.bottom": {"type": "viscoelastic", **side}}
    found = list(spring_warnings(build(small(GROUND, changes={**springs, **tables}))))
    assert len(found) == (words is not None)
    assert words is None or words in found[0]
