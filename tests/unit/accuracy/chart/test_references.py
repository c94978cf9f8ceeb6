"""Exact solutions of cases, and the times for which they are valid."""

import math
from dataclasses import replace

import numpy as np
import pytest

from dembound.accuracy.chart.references import exact_of
from dembound.accuracy.of_bars.causes import PulseInBar
from dembound.accuracy.of_disks.exact.references import ExactContinuum, ExactPlaneWave
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.formulas.history import History
from dembound.kinds import load, with_changes
from dembound.shipped import folder

ECHO = (75.0 * (1.0 + 3**0.5) - 20.0) / (1000.0 / 2**0.5) + (math.hypot(0.5, 150.5) - 20.0) / 1000.0
"""Time (s) when the SV wave of `cases/oblique.toml` has met the wall of the hole, and the P wave that leaves there
has come back from the surface at the monitor below it, on the disk's place half a metre beside the axis."""

EVEN = {"boundary.left": {"type": "viscous_input", "wave_p": "pulse"}}


def test_a_bar_that_spalls_has_one_until_then(spalling) -> None:
    # s = 8/12, rise and fall 0.2 ms: d = ½·1000·0.2e-3·s from the free end, at rise + (L + d)/c
    found = exact_of(spalling())
    assert isinstance(found, PulseInBar)
    assert found.findings["spall place"] == pytest.approx(1.0 - 0.2 / 3.0)
    assert found.until == found.findings["spall time"] == pytest.approx(0.2e-3 + (1.0 + 0.2 / 3.0) / 1000.0)
    assert exact_of(spalling({"bar.strength": 13e6})).until == math.inf


@pytest.mark.parametrize(("end", "echo"), [("free", 1.0), ("fixed", -1.0), ("matched_layer", 0.0)])
def test_the_far_end_of_a_bar_reflects(spalling, end: str, echo: float) -> None:
    case = spalling({"bar.strength": 1e9, "boundary.right": {"type": end}})
    time = np.array([0.7e-3, 1.7e-3])  # 0.5 m from the load: the crest of 0.2 ms, and its echo
    at = History.of(np.array([0.5, 0.0]), time, np.zeros((2, 3)), np.zeros((2, 3)), np.zeros(2))
    crest = 12e6 / (2500.0 * 1000.0)
    found = exact_of(case).motions(case, {"gauge": at})["gauge"]
    assert found.velocity[:, 0] == pytest.approx([crest, echo * crest])
    assert found.values["stress"][:, 0] == pytest.approx([-12e6, echo * 12e6])


def test_a_plane_wave_that_leaves_has_one(bar) -> None:
    found = exact_of(bar(EVEN))
    assert isinstance(found, ExactPlaneWave)
    assert (found.side, found.motion) == ("left", "p")
    sides = {f"boundary.{side}": {"type": "periodic"} for side in ("bottom", "top")}
    wave = {"boundary.left": {"type": "viscous_input", "wave_s": "pulse"}, "motion.held": []}
    assert exact_of(bar({**wave, **sides})).motion == "s"


@pytest.mark.parametrize(
    ("body", "changes"),
    [
        ("spalling", {"bar.attenuation": 0.1}),
        ("spalling", {"load.1.side": "right"}),
        ("spalling", {"boundary.left": {"type": "viscous"}}),
        ("spalling", {"wave.hit": {"type": "cosine", "amplitude": 1.0, "period": 4e-4}}),
        # waves that do not stay plane or do not leave
        ("bar", EVEN | {"motion.held": []}),
        ("bar", EVEN | {"boundary.right": {"type": "free"}}),
        ("bar", EVEN | {"hole": [{"name": "h", "type": "circle", "centre": [8.0, 0.5], "radius": 0.3}]}),
        ("bar", EVEN | {"material.law": "linearpbond"}),
        ("bar", {"boundary.left": {"type": "viscous_input", "wave_s": "pulse"}, "motion.held": []}),
    ],
)
def test_other_cases_have_none(request, body: str, changes: dict) -> None:
    with pytest.raises(CaseError, match="no exact solution"):
        exact_of(request.getfixturevalue(body)(changes))


@pytest.mark.parametrize(
    ("name", "problem", "until"),
    [
        ("zhou2018/lamb_viscous", "lamb", math.inf),
        ("charts/blast", "cavity", math.inf),
        ("charts/cavity", "scattering", math.inf),
        ("charts/garvin", "garvin", math.inf),
        ("oblique", "scattering", pytest.approx(ECHO)),
    ],
)
def test_problems_of_a_continuum_have_one(name, problem, until) -> None:
    found = exact_of(load(folder() / f"{name}.toml"))
    assert isinstance(found, ExactContinuum)
    assert (found.name, found.until) == (problem, until)


def test_its_motion_is_that_of_each_choice_at_the_monitors_of_the_choice() -> None:
    """The same hole and monitors in a larger box, and a monitor elsewhere."""
    case = load(folder() / "charts" / "blast.toml")
    larger, other = (
        with_changes(case, next(each.set for each in case.chart.choice if each.name == name))
        for name in ("outside, 80 m, disks of 0.5 m", "outside, 40 m, disks of 1 m")
    )
    solution = exact_of(case)
    still = History.of(np.zeros(2), np.zeros(1), np.zeros((1, 3)), np.zeros((1, 3)))
    here, there, elsewhere = (
        solution.motions(each, {name: replace(still, place=place) for name, place in build(each).monitored.items()})
        for each in (case, larger, other)
    )
    np.testing.assert_allclose(there["side"].place - here["side"].place, [20.0, 20.0])
    size = np.abs(here["side"].velocity).max()
    np.testing.assert_allclose(there["side"].velocity, here["side"].velocity, atol=1e-6 * size)
    # 12.25 m and 12.5 m from the axis: the crest decays with the root of the distance, as a cylindrical wave
    radii = [float(np.hypot(*(gauges["side"].place - 20.0))) for gauges in (here, elsewhere)]
    crests = [np.hypot(*gauges["side"].velocity[:, :2].T).max() for gauges in (here, elsewhere)]
    assert radii[1] > radii[0]
    assert crests[1] < crests[0]
    # a quarter beside mirror planes is another problem
    quarter = with_changes(case, {"boundary.left": {"type": "symmetry"}})
    with pytest.raises(CaseError, match=r'boundary\.left\.type: is "symmetry", must be a side beyond'):
        solution.motions(quarter, {})
