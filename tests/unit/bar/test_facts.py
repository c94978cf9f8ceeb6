"""What a bar's case would come to."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.bar.facts import bar_facts, cells_of_waves, method_in_words
from dembound.bar.scene import build_bar
from dembound.bar.warnings import bar_warnings
from dembound.boundaries import Viscous
from dembound.check import check
from dembound.exact.dispersion import cells_per_wavelength, courant_limit
from dembound.running import plan

PULSE = 5.36 / 4e-4
"""Where the spectrum of the even triangle of 0.4 ms has faded, Hz: 5.36 over its length."""


def facts_of(case) -> dict[str, str]:
    planned = plan(case)
    return dict(bar_facts(planned.scene, planned.time_step))


def test_facts_are_those_of_the_bar(spalling) -> None:
    ends = {"boundary.right": {"type": "viscous", "beta_p": 0.9}, "bar.attenuation": 0.2}
    facts = facts_of(spalling(ends))

    assert facts["nodes"] == "41, 0.025 m apart"
    assert facts["method"] == "peridynamics, horizon = 3, corrected_ends = false"
    assert facts["Courant number"] == "1"
    assert facts["bar"] == "1 m long, section 1 m², density 2500 kg/m³"
    assert facts["stiffness"] == "E = 2.5 GPa, c = 1000 m/s"
    assert facts["strength"] == "8 MPa, critical stretch 0.0032"
    assert facts["attenuation"] == "α = 0.2 1/m"
    assert facts["left end"] == "free"
    assert facts["right end"].startswith("viscous, β_P = 0.9; returns at most ")
    assert facts["load hit"] == "12 MPa times wave hit, on 3 nodes at the left end"
    assert facts["monitor gauge"] == "node 21 at 0.525 m"


def test_numbers_of_an_end_of_another_type_are_told(spalling) -> None:
    class Layered(Viscous):
        """A dashpot whose description includes its depth."""

        def describe(self, edge, medium):
            return super().describe(edge, medium) | {"depth": 2.5}

    case = replace(spalling(), boundary={"right": Layered(type="viscous")})
    assert dict(bar_facts(build_bar(case), 2.5e-5))["right end"].split("; ")[0] == "viscous, β_P = 1, depth = 2.5"


def test_a_layer_is_told_with_its_length_and_what_it_returns(spalling) -> None:
    method = {"type": "finite_difference"}
    case = spalling({"boundary.right": {"type": "matched_layer", "nodes": 80}, "method": method, "run.courant": 0.5})
    layer, echo = facts_of(case)["right end"].split("; ")
    assert layer == "matched_layer, nodes = 80, power = 3.0, reflection = 1e-08, layer_length = 2.0"
    assert echo.startswith("returns at most ")
    assert echo.endswith(" of wave hit")
    assert 1e-9 < float(echo.split()[3]) < 1e-4


def test_what_a_bar_lacks_is_not_told(spalling) -> None:
    bar = {"length": 1.0, "spacing": 0.025, "density": 2500.0, "wave_speed": 1000.0}
    facts = facts_of(spalling({"bar": bar, "monitor": [], "load": []}))

    assert facts["strength"] == "unbreakable"
    assert not {"attenuation", "load hit", "monitor gauge"} & set(facts)


def test_the_largest_pressure_is_told_whatever_a_wave_reaches(spalling) -> None:
    load = {"name": "hit", "pressure": -1.0, "side": "right", "wave": "hit"}
    facts = facts_of(spalling({"load": [load], "wave.hit.amplitude": 9e6}))

    assert facts["load hit"] == "up to 9 MPa: -1 Pa times wave hit, on 1 node at the right end"


def test_methods_in_words(spalling) -> None:
    assert method_in_words(spalling({"method": {"type": "finite_difference"}})) == "finite_difference"
    patch = {"type": "patch", "horizon": 3, "reach": 5}
    assert method_in_words(spalling({"method": patch})) == "patch, horizon = 3, trigger = 0.9, reach = 5"


def test_cells_in_the_shortest_wavelength(spalling) -> None:
    found, needed = cells_of_waves(build_bar(spalling()), 2e-5)["hit"]

    # 5.36 is given to two decimals
    assert found == pytest.approx(1000.0 / PULSE / 0.025, rel=1e-3)
    assert needed == cells_per_wavelength(3, 0.8, 0.01)


@pytest.mark.parametrize(
    "method",
    [
        {"type": "finite_difference"},
        {"type": "peridynamics", "horizon": 1},
        {"type": "switch", "horizon": 3},
        {"type": "patch", "horizon": 3},
    ],
    ids=str,
)
def test_cells_needed_are_those_of_the_horizon_that_carries_waves(spalling, method: dict) -> None:
    # families of three spacings come about only where something breaks
    needed = cells_of_waves(build_bar(spalling({"method": method})), 2e-5)["hit"][1]
    assert needed == pytest.approx(cells_per_wavelength(1, 0.8, 0.01), rel=1e-12)
    assert needed < cells_of_waves(build_bar(spalling()), 2e-5)["hit"][1]


def test_waves_count_where_they_load_the_bar_or_enter_it(spalling) -> None:
    short = {"type": "triangle", "amplitude": 1.0, "rise": 1e-6, "fall": 1e-6}
    entrance = {"type": "viscous_input", "wave_p": "in"}
    case = spalling({"boundary.left": entrance, "wave.in": short, "wave.spare": short})

    assert set(cells_of_waves(build_bar(case), 2e-5)) == {"hit", "in"}


def test_cells_needed_at_the_limit_of_a_short_bar(spalling) -> None:
    # ends make a bar stable a little beyond the limit of an endless one, for which cells are counted
    step = courant_limit(3) * (1.0 + 1e-6) * 0.025 / 1000.0
    assert cells_of_waves(build_bar(spalling()), step)["hit"][1] == cells_per_wavelength(3, courant_limit(3), 0.01)


def test_a_wave_that_has_no_highest_frequency_is_never_long_enough(spalling) -> None:
    step = {"type": "constant", "amplitude": 1.0}
    found, needed = cells_of_waves(build_bar(spalling({"wave.hit": step})), 2e-5)["hit"]

    assert found == 0.0 < needed < np.inf


def test_check_tells_of_the_run_and_the_bar(spalling) -> None:
    facts, warnings = check(spalling())

    assert facts["steps"] == "60 for 0.0015 s"
    assert facts["time step"].startswith("2.5e-05 s, ")
    assert facts["estimated time"] == "less than 1 s with 1 thread, without building, pictures"
    assert facts["nodes"] == "41, 0.025 m apart"
    assert warnings == bar_warnings(build_bar(spalling()), 2.5e-5)


def test_facts_of_cracks_that_open(spalling) -> None:
    law = {"bar.strength_per_decade": 2e6, "bar.strength_rates": [1.0, 100.0]}
    facts = facts_of(spalling({"bar.fracture_energy": 1e4, **law}))

    assert facts["cracks"] == (
        "G_f = 10000 J/m², open at w_c = 2G_f/σ_t = 2500 µm, characteristic length EG_f/σ_t² = 173.6 mm, spacing at "
        "most 34.72 mm"
    )
    assert facts["strain rates"] == "strength from 8 MPa at 1 1/s to 12 MPa at 100 1/s"
    assert not {"cracks", "strain rates"} & facts_of(spalling()).keys()
