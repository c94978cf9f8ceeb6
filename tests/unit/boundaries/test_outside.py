"""Sides in words, neighbours impossible beside a continuum, and the profile of a matched layer."""

import numpy as np
import pytest
from pydantic import ValidationError
from small_cases import BODY

from dembound.boundaries import MatchedLayer
from dembound.boundaries.boundary import Layer
from dembound.boundaries.description import side_in_words
from dembound.boundaries.matched_layer import usual_reflection
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.kinds import loads

WAVES = BODY + '[wave.w]\ntype = "cosine"\namplitude = 1.0\nperiod = 0.1\n'
CASE = WAVES + '[boundary.left]\ntype = "outside"\n'
BELOW = WAVES + '[boundary.bottom]\ntype = "outside"\nwave_s = "w"\n'
PERIODIC = '[boundary.left]\ntype = "periodic"\n[boundary.right]\ntype = "periodic"\n'


def problems(text: str) -> str:
    with pytest.raises(CaseError) as error:
        loads(text)
    return str(error.value)


@pytest.mark.parametrize(
    ("more", "line"),
    [
        ('[boundary.bottom]\ntype = "viscous_input"\nwave_s = "w"\n', 'bottom.type: is "viscous_input"; beside'),
        ('[boundary.top]\ntype = "fixed"\n', 'boundary.top.type: is "fixed"; beside boundary.left it must be "free"'),
        ('[boundary.bottom]\ntype = "symmetry"\n[static]\n', 'is "symmetry", which takes [static] and loads on all'),
        ('[boundary.right]\ntype = "free_field"\n', 'right.type: is "free_field", which cannot be in a case'),
        ('[motion]\nheld = ["y"]\n', 'boundary.left.type: "outside" moves freely, but motion.held holds y'),
    ],
)
def test_what_it_cannot_be_beside_gets_one_line(more: str, line: str) -> None:
    assert line in problems(CASE + more)


def test_waves_enter_through_the_bottom_of_a_periodic_body() -> None:
    case = loads(BELOW + PERIODIC)
    assert case.driving == {"bottom": {"s": "w"}}
    assert not case.side("bottom").at_rest().waves
    assert build(case).outside is not None
    assert 'waves enter through it only where boundary.left and right are both "outside" or' in problems(BELOW)
    assert "through which waves enter at the bottom only" in problems(BELOW.replace("bottom", "top") + PERIODIC)
    assert "boundary.bottom.wave_s" in problems(BELOW.replace('"w"\n', '"v"\n') + PERIODIC)


def test_no_surface_is_where_waves_of_the_bottom_would_come_back_from_it() -> None:
    """The column of the ground that waves enter by has a free surface."""
    top = '[boundary.top]\ntype = "outside"\n'
    assert "boundary.top.type" in problems(BELOW + PERIODIC + top)
    loads(WAVES + PERIODIC + top)


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


def test_a_wave_decays_by_the_root_of_r0_by_rates_that_are_a_power_of_the_depth() -> None:
    """exp(−∫d dx/c) over the length, by the trapezoidal rule: to the 1e-7 of 10,000 intervals."""
    layer, spacing, speed = Layer(nodes=25, power=3.0, reflection=1e-5), 0.02, 3000.0
    depth = np.linspace(0.0, 25.0, 10_001)
    decay = np.exp(-np.trapezoid(layer.rates(depth, spacing, speed), depth * spacing) / speed)
    assert decay == pytest.approx(np.sqrt(1e-5), rel=1e-6)
    rates = Layer(nodes=10, power=2.0, reflection=0.01).rates(np.array([-3.0, 0.0, 5.0, 10.0]), 0.5, 100.0)
    largest = 3.0 * 100.0 * np.log(100.0) / (2.0 * 5.0)
    np.testing.assert_allclose(rates, [0.0, 0.0, 0.25 * largest, largest], rtol=1e-14)


@pytest.mark.parametrize(("nodes", "reflection"), [(20, 1e-5), (80, 1e-8), (5000, 1e-12)])
def test_usual_reflections(nodes: int, reflection: float) -> None:
    assert usual_reflection(nodes) == pytest.approx(reflection, rel=1e-12)
    assert MatchedLayer(type="matched_layer", nodes=nodes).layer.reflection == usual_reflection(nodes)
    assert MatchedLayer(type="matched_layer", reflection=1e-3).layer == Layer(40, 3.0, 1e-3)
    for keys in ({"nodes": 3}, {"reflection": 1.0}, {"nodes": 20_000}):
        with pytest.raises(ValidationError):
            MatchedLayer(type="matched_layer", **keys)
