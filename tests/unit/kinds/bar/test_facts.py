"""Facts about a bar's case."""

import pytest

from dembound.bar.scene import build_bar
from dembound.exact.bar import cells_per_wavelength, courant_limit
from dembound.kinds.bar.summary import bar_facts, cells_of_waves
from dembound.running import plan


def facts_of(case) -> dict[str, str]:
    planned = plan(case)
    return dict(bar_facts(planned.scene, planned.time_step))


def test_facts_are_those_of_the_bar(spalling) -> None:
    law = {"bar.fracture_energy": 1e4, "bar.strength_per_decade": 2e6, "bar.strength_rates": [1.0, 100.0]}
    facts = facts_of(spalling({"boundary.right": {"type": "viscous", "beta_p": 0.9}, "bar.attenuation": 0.2, **law}))

    assert facts.pop("right end").startswith("viscous, β_P = 0.9; returns at most ")
    expected = {
        "nodes": "41, 25 mm apart",
        "method": "peridynamics, horizon = 3, corrected_ends = false",
        "Courant number": "1",
        "bar": "1 m long, section 1 m², density 2500 kg/m³",
        "stiffness": "E = 2.5 GPa, c = 1000 m/s",
        "strength": "8 MPa, critical stretch 0.0032",
        "attenuation": "α = 0.2 1/m",
        "left end": "free",
        "load hit": "12 MPa times wave hit, on 3 nodes at the left end",
        "monitor gauge": "node 21 at 0.525 m",
        "cracks": "G_f = 10000 J/m², open at w_c = 2G_f/σ_t = 2.5 mm, characteristic length EG_f/σ_t² = 174 mm, "
        "spacing at most 34.7 mm",
        "strain rates": "strength from 8 MPa at 1 1/s to 12 MPa at 100 1/s",
    }
    assert facts.items() >= expected.items()


def test_a_layer_is_reported_with_its_length_and_what_it_returns(spalling) -> None:
    method = {"type": "finite_difference"}
    case = spalling({"boundary.right": {"type": "matched_layer", "nodes": 80}, "method": method, "run.courant": 0.5})
    layer, echo = facts_of(case)["right end"].split("; ")
    assert layer == "matched_layer, nodes = 80, power = 3, reflection = 1e-08, layer_length = 2"
    assert echo.startswith("returns at most ")
    assert echo.endswith(" of wave hit")
    assert 1e-9 < float(echo.split()[3]) < 1e-4


def test_cells_in_the_shortest_wavelength(spalling) -> None:
    found, needed = cells_of_waves(build_bar(spalling()), 2e-5)["hit"]

    # the spectrum of the even triangle of 0.4 ms has faded at 5.36 over its length, which is given to two decimals
    assert found == pytest.approx(1000.0 / (5.36 / 4e-4) / 0.025, rel=1e-3)
    assert needed == cells_per_wavelength(3, 0.8, 0.01)
    for method in ("finite_difference", "switch", "patch"):  # families of three come about only where something breaks
        changes = {"method": {"type": method} | ({} if method == "finite_difference" else {"horizon": 3})}
        of_springs = cells_of_waves(build_bar(spalling(changes)), 2e-5)["hit"][1]
        assert needed > of_springs == pytest.approx(cells_per_wavelength(1, 0.8, 0.01), rel=1e-12)
    # ends make a bar stable a little beyond the limit of an endless one, for which cells are counted
    step = courant_limit(3) * (1.0 + 1e-6) * 0.025 / 1000.0
    assert cells_of_waves(build_bar(spalling()), step)["hit"][1] == cells_per_wavelength(3, courant_limit(3), 0.01)
