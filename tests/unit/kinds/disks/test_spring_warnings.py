"""Springs of sides that are not those of the ground beyond."""

import pytest
from small_cases import small
from warned_cases import GROUND

from dembound.disks.scene import build
from dembound.kinds.disks.side_warnings import spring_warnings

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
        (at(8.0, 9.0), {"load": [BLOW]}, None),
        (at(36e3, 10.0), {"load": [BLOW]}, FROM_LOAD),
        (at(10.0, -2.0), {"load": [BLOW]}, FROM_LOAD),
        (at(10.0, 40.0), {"load": [BLOW]}, FROM_LOAD),
        # a cavity is a centre of waves; without a centre a source may be anywhere near
        (at(10.0, 5.0), IN_CAVITY, None),
        (at(10.0, 500.0), IN_CAVITY, "waves come from"),
        (at(10.0, 100.0), DRIVEN, None),
        (at(10.0, -36e3), DRIVEN, "times its diagonal"),
        # the disks have G = ρc_s² = 1.25 GPa, with c_s = c_p/√2 or c_p/2 of 625 MPa
        ({"distance": 10.0, "young_modulus": 2.0e9}, {"load": [BLOW]}, None),
        ({"distance": 10.0, "young_modulus": 2.0e6}, {"load": [BLOW]}, MODULUS),
        ({"distance": 10.0, "young_modulus": 2.0e12}, {"load": [BLOW]}, MODULUS),
        # ten diagonals of 20 × 10 m are 223.6 m
        ({"distance": 220.0}, {"load": [BLOW]}, None),
        ({"distance": 230.0}, {"load": [BLOW]}, "boundary.bottom.distance: is 230 m, 10.3 times"),
        ({"distance": 10.0, "alpha_n": 0.0}, {}, None),
        ({"distance": 10.0, "alpha_n": 0.0, "alpha_s": 0.0}, {}, "alpha_n and alpha_s are 0, so it has no springs"),
    ],
)
def test_springs_that_are_not_those_of_the_ground_are_warned_of(side: dict, tables: dict, words: str | None) -> None:
    springs = {"boundary.bottom": {"type": "viscoelastic", **side}}
    found = list(spring_warnings(build(small(GROUND, changes={**springs, **tables}))))
    assert len(found) == (words is not None)
    assert words is None or words in found[0]
