"""Warnings about probable mistakes in a bar's case, before the run."""

import numpy as np
import pytest
from small_cases import SPALLING, small

from dembound.bar.scene import build_bar
from dembound.bar.stability import choose_step
from dembound.exact.bar import triangle_spall
from dembound.kinds.bar.range_warnings import never_closing, range_warnings
from dembound.kinds.bar.summary import cells_of_waves
from dembound.kinds.bar.warnings import bar_warnings, ends_too_soon

UNBROKEN = {"bar": {"length": 1.0, "spacing": 0.025, "density": 2500.0, "wave_speed": 1000.0}}
EXACT = {"method": {"type": "finite_difference"}}
"""Changes after which, at ν = 1, waves of any length run at the speed c."""
LONG = {"wave.hit.rise": 1e-2, "wave.hit.fall": 1e-2, "run.duration": 2e-2}
"""The blow with waves far longer than the bar."""
_, SPALLED = triangle_spall(1.0, 1000.0, 2e-4, 2e-4, 12e6, 8e6)
"""Even legs of 0.2 ms: the strength is met 0.5 c t_f σ_t/p before the end, 1/15 m."""


def of_key(key: str, warnings: list[str]) -> list[str]:
    return [warning for warning in warnings if warning.startswith(f"{key}:")]


def blow(pressure: float, **more) -> dict:
    return {"load": [{"name": "blow", "pressure": pressure, "wave": "hit"} | more]}


def enters(kind: str = "viscous_input", side: str = "left", **more) -> dict:
    """The wave comes in by an end instead of a load."""
    return {"load": [], f"boundary.{side}": {"type": kind, "wave_p": "hit"} | more}


def test_a_bar_that_spalls_is_not_warned_of(spalling) -> None:
    assert bar_warnings(build_bar(spalling(EXACT)), 2.5e-5) == []


MPA, ABSORBS = "bar.strength, 8 MPa: Pa and MPa?", "is on an end that absorbs: boundary.left"
ROCK = {"length": 1.0, "spacing": 0.025, "density": 2500.0}
SLOW_RISE = {"wave.hit.rise": 0.1, "wave.hit.fall": 0.01, "run.duration": 0.2}


def ending(side: str = "right", **more) -> dict:
    return {f"boundary.{side}": {"type": "viscous"} | more}


@pytest.mark.parametrize(
    ("changes", "key", "said"),
    [
        # (1 − β)/(1 + β): 0.176 at 0.7
        (ending(beta_p="matched"), "boundary.right", None),
        (ending(beta_p=0.6), "boundary.right", "sends back 25 % of the amplitude of P waves along its normal: beta_p"),
        # 1 m at 1000 m/s; a period of 0.11 s
        (SLOW_RISE, "wave.hit", "has a period of 0.11 s, 110 times its way through the scene, 0.001 s"),
        (blow(808.0), "load.blow", None),
        (blow(-792.0), "load.blow", f"its pressure is 792 Pa, 0.0099 % of {MPA}"),
        (blow(8.08e9), "load.blow", f"its pressure is 8.08 GPa, 1,010 times {MPA}"),
        (UNBROKEN | blow(1e-9), "load.blow", None),  # what cannot break has no strength to compare with
        # δ = 3·25 mm; a quarter of EG_f/σ_t², 2.5 GPa·G_f/(8 MPa)², is as long at 7.68 kJ/m²
        ({"method": SPALLING["method"], "bar.fracture_energy": 7.6e3}, "method.horizon", "is 0.075 m long"),
        ({"method": SPALLING["method"], "bar.fracture_energy": 7.8e3}, "method.horizon", None),
        # ∫p²/(ρc) dt of a triangle of 12 MPa and 4e-4 s is 144e12/3 · 4e-4/2.5e6 = 7,680 J/m²
        ({"bar.fracture_energy": 7.6e3}, "bar.fracture_energy", None),
        ({"bar.fracture_energy": 7.8e3}, "bar.fracture_energy", "is 7800 J/m², more than all waves bring in, 7.68e+03"),
        # of 12 MPa the dashpot Cv takes β/(1 + β)
        (ending("left"), "load.hit", f"{ABSORBS} takes 50 % of it, and up to 6 MPa enters the bar; on a free end"),
        ({"bar": ROCK | {"youngs_modulus": 30e9}}, "bar", None),
        ({"bar": ROCK | {"youngs_modulus": 3e6}}, "bar", "its wave speed is 34.64 m/s"),
    ],
)
def test_numbers_beside_the_bars_own_are_warned_of(spalling, changes: dict, key: str, said: str | None) -> None:
    found = of_key(key, bar_warnings(build_bar(spalling(EXACT | changes)), 2.5e-5))
    assert [line[: len(f"{key}: {said}")] for line in found] == ([f"{key}: {said}"] if said else [])


@pytest.mark.parametrize(("share", "warned"), [(0.99, True), (1.01, False)])
def test_waves_too_short_for_the_nodes_are_warned_of(spalling, share: float, warned: bool) -> None:
    _, needed = cells_of_waves(build_bar(spalling()), 0.8 * 2.5e-5)["hit"]
    half = 0.5 * 5.363 * share * needed * 2.5e-5  # 5.363 is what 5.36 comes to for an even triangle
    case = spalling({**UNBROKEN, "wave.hit.rise": half, "wave.hit.fall": half, "run.courant": 0.8})

    warnings = bar_warnings(build_bar(case), 0.8 * 2.5e-5)
    assert [warning.split(":")[0] for warning in warnings] == warned * ["wave.hit"]
    for line in warnings:
        assert f"fewer than the {needed:.3g}" in line
        assert line.endswith("take a smaller bar.spacing or method.horizon")


@pytest.mark.parametrize(
    ("method", "warned"),
    [
        ({"type": "patch", "horizon": 3}, False),
        ({"type": "peridynamics", "horizon": 3}, True),
        ({"type": "switch", "horizon": 3, "corrected_ends": True}, False),
    ],
)
def test_dashpots_at_soft_ends_are_warned_of(spalling, method: dict, warned: bool) -> None:
    ends = {"left": {"type": "viscous_input", "wave_p": "hit"}, "right": {"type": "viscous"}}
    case = spalling({**UNBROKEN, "method": method, "boundary": ends, "load": [], **LONG})

    warnings = bar_warnings(build_bar(case), 2e-5)
    assert [warning.split(":")[0] for warning in warnings] == warned * ["boundary.left", "boundary.right"]
    assert all(warning.endswith("give method.corrected_ends = true") for warning in warnings)


def test_a_run_that_ends_before_the_bar_can_spall(spalling) -> None:
    # moments of the wave are 0.4 ms/500 apart
    assert list(ends_too_soon(spalling({"run.duration": SPALLED + 1e-6}))) == []
    (warning,) = ends_too_soon(spalling({"run.duration": SPALLED - 1e-6}))
    said = "run.duration: is 0.00126567 s, too short for a spall: the wave is not back from the free right end with a "
    assert warning.startswith(f"{said}tension of the strength before 0.00126")
    assert float(warning.split()[-2]) == pytest.approx(SPALLED, abs=1e-6)
    # from the other end, and from the start of the wave on, of 1.4 ms
    later = {"wave.hit.start": 1e-3}
    for changes in (blow(12e6, nodes=3, side="right"), enters(side="right") | {"wave.hit.amplitude": -4.8}):
        (warning,) = ends_too_soon(spalling({**changes, **later, "run.duration": 2.2e-3}))
        assert "from the free left end" in warning
        assert float(warning.split()[-2]) == pytest.approx(1e-3 + SPALLED, abs=4e-6)
        assert not list(ends_too_soon(spalling({**changes, **later, "run.duration": 2.3e-3})))


STRIKER = [{"name": "striker", "length": 0.2, "velocity": 5.0}, {"name": "rod", "length": 0.4, "interface": "contact"}]


def with_ranges(ranges: list[dict], run: dict | None = None, **tables):
    bar = {key: value for key, value in SPALLING["bar"].items() if key != "length"} | {"range": ranges}
    return small({"bar": bar, "method": EXACT["method"], "run": run or {"duration": 1.0}, **tables})


def warned(case) -> list[str]:
    scene = build_bar(case)
    return bar_warnings(scene, choose_step(scene)[0])


@pytest.mark.parametrize(
    ("interface", "velocity", "doubtful"), [("bonded", 0.0, True), ("bonded", 5.0, False), ("contact", 0.0, False)]
)
def test_a_striker_that_is_bonded_is_warned_of(interface: str, velocity: float, doubtful: bool) -> None:
    case = with_ranges([STRIKER[0], STRIKER[1] | {"interface": interface, "velocity": velocity}], {"duration": 1e-3})
    said = 'bar.range[2, rod].interface: is "bonded", while striker has 5 m/s at the start and rod 0 m/s: they pull'
    assert [line[: len(said)] for line in warned(case) if "interface" in line] == doubtful * [said]


@pytest.mark.parametrize(
    ("interface", "section", "is_said"), [("bonded", 4e-4, True), ("bonded", 1e-4, False), ("contact", 4e-4, False)]
)
def test_a_monitor_between_sections_has_the_stress_of_neither(interface: str, section: float, is_said: bool) -> None:
    monitors = [{"name": str(place), "position": place} for place in (0.175, 0.2, 0.225)]
    ranges = [{"name": "thin", "length": 0.2, "section": 1e-4}, {"name": "thick", "length": 0.4, "section": section}]
    case = with_ranges([ranges[0], ranges[1] | {"interface": interface}], {"duration": 1e-3}, monitor=monitors)
    assert [line for line in warned(case) if line.startswith("monitor")] == is_said * [
        "monitor.0.2: is at the bonded interface of thin, 0.0001 m², and thick, 0.0004 m²: its stress is the force "
        "over their mean, 0.00025 m², so that of neither; place it at 0.175 or 0.225 m"
    ]


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"diameter": 0.02}, "bar.range[2, rod]: has neither section nor diameter, so 1 m², beside 0.0003142 m²"),
        ({"section": 0.02}, ""),
        ({"section": 0.0099}, "bar.range[2, rod]: its section, 1 m², is 101 times that of striker, 0.0099 m²"),
    ],
)
def test_sections_that_are_forgotten_or_of_another_unit_are_warned_of(changed: dict, said: str) -> None:
    rod = STRIKER[1] | ({} if "diameter" in changed else {"section": 1.0})
    case = with_ranges([STRIKER[0] | changed, rod])
    assert [line[: len(said)] for line in range_warnings(case, 1e-5) if "section" in line] == ([said] if said else [])


@pytest.mark.parametrize(
    ("velocity", "gap", "duration", "said"),
    [
        (5.0, 0.01, 1.9e-3, "bar.range[2, rod].gap: is 0.01 m, which 5 m/s close at 0.002 s"),
        (-5.0, 0.0, 1.0, "bar.range[2, rod]: it and striker part at 5 m/s"),
        (0.0, 0.01, 1.0, "bar.range[2, rod].gap: is 0.01 m, and never closes"),
    ],
)
def test_gaps_that_never_close_are_known_before_the_run(velocity, gap, duration, said: str) -> None:
    case = with_ranges([STRIKER[0] | {"velocity": velocity}, STRIKER[1] | {"gap": gap}], {"duration": duration})
    found = never_closing(case)
    assert list(found) == ["rod"] * bool(said)
    assert found.get("rod", "").startswith(said)


def test_a_load_over_a_length_beside_that_of_its_wave_is_warned_of() -> None:
    """The mean of a pulse (1 − cos)/2 of the length l over 2W has 1/2 + sin(2πW/l)/(4πW/l), 0.80 at W/l = 0.264."""
    case = {**UNBROKEN, "method": EXACT["method"], "run": {"duration": 4e-3}}
    case["wave"] = {"w": {"type": "cosine", "amplitude": 1.0, "period": 5e-4}}  # l = 0.5 m, W = (n − 1/2) 0.025 m

    def found(nodes: int) -> list[str]:
        load = {"name": "l", "pressure": 10e6, "nodes": nodes, "wave": "w"}
        return of_key("load.l.nodes", bar_warnings(build_bar(small(case | {"load": [load]})), 2.5e-5))

    assert found(5) == []  # W/l = 0.225
    ratio = 2.0 * np.pi * 5.5 * 0.025 / 0.5
    for nodes, share in ((6, 0.5 + 0.5 * np.sin(ratio) / ratio), (21, 0.25 * 0.5 / (20.5 * 0.025))):
        (line,) = found(nodes)  # of the second all of the pulse is within: l/4W
        assert f"only {100.0 * share:.2g} % of its peak enters" in line


@pytest.mark.parametrize(
    ("spacing", "courant", "key"), [(0.025, 1.0, None), (0.025, 0.9, "run.courant"), (0.02, 0.8, "bar.range:")]
)
def test_fronts_of_impacts_need_one_step_for_a_spacing(spacing: float, courant: float, key: str | None) -> None:
    run = {"duration": 4e-4, "courant": courant}
    lines = warned(with_ranges([STRIKER[0], STRIKER[1] | {"spacing": spacing}], run))
    found = [line for line in lines if "impacts" in line and "fracture_energy" not in line]
    assert sum("bar.fracture_energy" in line for line in lines) == (spacing == 0.025)
    assert len(found) == (key is not None)
    assert key is None or found[0].startswith(key)


def test_monitors_in_gaps_are_warned_of() -> None:
    # ranges end at 0.2 m and begin at 0.25 m
    monitors = [{"name": str(place), "position": place} for place in (0.2, 0.21, 0.25)]
    case = with_ranges([STRIKER[0], STRIKER[1] | {"gap": 0.05}], {"duration": 1e-3}, monitor=monitors)
    assert [line for line in warned(case) if line.startswith("monitor")] == [
        "monitor.0.21: is at 0.21 m, in the gap from 0.2 to 0.25 m between two ranges; it records the node at 0.25 m"
    ]
