"""What a run of a bar will do that was probably not meant."""

from dataclasses import replace

import numpy as np
import pytest
from small_cases import SPALLING, small

from dembound.bar.facts import cells_of_waves
from dembound.bar.range_warnings import never_closing, range_warnings
from dembound.bar.scene import build_bar
from dembound.bar.stability import choose_step
from dembound.bar.warnings import bar_warnings, ends_too_soon, stress_beside_strength
from dembound.boundaries import ViscousInput
from dembound.exact.bar import triangle_spall

UNBROKEN = {"bar": {"length": 1.0, "spacing": 0.025, "density": 2500.0, "wave_speed": 1000.0}}

EXACT = {"method": {"type": "finite_difference"}}
"""At ν = 1 waves of any length run at their speed."""

LONG = {"wave.hit.rise": 1e-2, "wave.hit.fall": 1e-2, "run.duration": 2e-2}
"""The blow drawn out to waves far longer than the bar."""


def of_key(key: str, warnings: list[str]) -> list[str]:
    return [warning for warning in warnings if warning.startswith(f"{key}:")]


def test_a_bar_that_spalls_is_not_warned_of(spalling) -> None:
    assert bar_warnings(build_bar(spalling(EXACT)), 2.5e-5) == []


@pytest.mark.parametrize(("beta", "share"), [(1.0, None), (0.7, None), ("matched", None), (0.6, 25), (5.0, 67)])
def test_a_factor_that_sends_back_much_is_warned_of(spalling, beta: float | str, share: int | None) -> None:
    end = {"boundary.right": {"type": "viscous", "beta_p": beta}}
    found = of_key("boundary.right", bar_warnings(build_bar(spalling({**EXACT, **end})), 2.5e-5))

    # (1 − β)/(1 + β): 0.176 at 0.7
    start = (
        f"boundary.right: sends back {share} % of the amplitude of P waves along its normal: beta_p is {beta:g}"
        if share
        else ""
    )
    assert [line.startswith(start) for line in found] == ([] if share is None else [True])


@pytest.mark.parametrize(("share", "warned"), [(0.99, True), (1.01, False)])
def test_waves_too_short_for_the_nodes_are_warned_of(spalling, share: float, warned: bool) -> None:
    _, needed = cells_of_waves(build_bar(spalling()), 0.8 * 2.5e-5)["hit"]
    half = 0.5 * 5.363 * share * needed * 2.5e-5  # 5.363 is what 5.36 comes to for an even triangle
    case = spalling({**UNBROKEN, "wave.hit.rise": half, "wave.hit.fall": half, "run.courant": 0.8})

    warnings = bar_warnings(build_bar(case), 0.8 * 2.5e-5)
    assert [warning.split(":")[0] for warning in warnings] == warned * ["wave.hit"]
    if warned:
        assert f"fewer than the {needed:.3g}" in warnings[0]
        assert warnings[0].endswith("take a smaller bar.spacing or method.horizon")


def test_only_waves_in_use_can_be_too_short(spalling) -> None:
    short = {"type": "triangle", "amplitude": 1.0, "rise": 1e-6, "fall": 1e-6}
    entrance = {"type": "viscous_input", "wave_p": "in"}
    ends = {"boundary.left": entrance, "method.corrected_ends": True}
    case = spalling({**LONG, **ends, "wave.in": short, "wave.spare": short, "load": []})

    warnings = bar_warnings(build_bar(case), 2e-5)
    assert len([warning for warning in warnings if "shortest wavelength" in warning]) == 1
    assert {warning.split(":")[0] for warning in warnings} == {"wave.in"}


def test_a_step_has_less_than_one_cell_and_is_allowed_to_a_slow_grip(spalling) -> None:
    step = {"type": "constant", "amplitude": 1e-4, "rise": 0.0}
    ends = {"boundary.right": {"type": "velocity", "wave_p": "in"}}
    for duration, few in ((0.099, 1), (0.101, 0)):  # at 1000 m/s, 100 ways of 1 m are 0.1 s
        case = spalling({**LONG, **ends, "wave.in": step, "run.duration": duration})
        found = [each for each in of_key("wave.in", bar_warnings(build_bar(case), 2e-5)) if "wavelength" in each]
        assert len(found) == few
        assert all("has less than one cell in its shortest wavelength" in each for each in found)


def test_only_a_horizon_can_be_made_smaller(spalling) -> None:
    for method in (
        {"type": "finite_difference"},
        {"type": "peridynamics", "horizon": 1},
        {"type": "switch", "horizon": 3},
        {"type": "patch", "horizon": 3},
    ):
        case = spalling({"method": method, "wave.hit.rise": 1e-6, "wave.hit.fall": 1e-6})
        (warning,) = [each for each in bar_warnings(build_bar(case), 1e-7) if "shortest wavelength" in each]
        assert warning.endswith("take a smaller bar.spacing")


@pytest.mark.parametrize(
    ("method", "warned"),
    [
        ({"type": "finite_difference"}, False),
        ({"type": "patch", "horizon": 3}, False),
        ({"type": "peridynamics", "horizon": 3}, True),
        ({"type": "peridynamics", "horizon": 3, "corrected_ends": True}, False),
        ({"type": "switch", "horizon": 3}, True),
        ({"type": "switch", "horizon": 3, "corrected_ends": True}, False),
    ],
    ids=str,
)
def test_dashpots_at_soft_ends_are_warned_of(spalling, method: dict, warned: bool) -> None:
    ends = {"left": {"type": "viscous_input", "wave_p": "hit"}, "right": {"type": "viscous"}}
    case = spalling({**UNBROKEN, "method": method, "boundary": ends, "load": [], **LONG})

    warnings = bar_warnings(build_bar(case), 2e-5)
    assert [warning.split(":")[0] for warning in warnings] == warned * ["boundary.left", "boundary.right"]
    assert all(warning.endswith("give method.corrected_ends = true") for warning in warnings)
    # without dashpots nothing has to be absorbed
    ends = {"left": {"type": "fixed"}, "right": {"type": "free"}}
    assert bar_warnings(build_bar(spalling({"method": method, "boundary": ends, "load": []})), 2e-5) == []


@pytest.mark.parametrize(("unit", "warned"), [(1.0, False), (1e6, True)])
def test_a_record_in_microseconds_is_warned_of(spalling, tmp_path, unit: float, warned: bool) -> None:
    # of a millisecond; 1.4 ms of its first 10 s are in the run, in which it rises to sin²(0.01π) of its peak
    time = np.linspace(0.0, 1e-3, 101)
    path = tmp_path / "blow.txt"
    np.savetxt(path, np.column_stack([unit * time, 1.0 - np.cos(2e3 * np.pi * time)]))
    case = spalling({**UNBROKEN, **EXACT, "wave.hit": {"type": "file", "path": str(path), "start": 1e-4}})

    said = (
        "wave.hit: reaches 1.4e-05 % of its peak, which comes at 500 s, within the run of 0.0015 s; "
        "are all times in s and lengths in m?"
    )
    assert bar_warnings(build_bar(case), 2.5e-5) == warned * [said]


def test_a_wave_is_compared_with_the_way_along_the_bar(spalling) -> None:
    # 1 m at 1000 m/s; a period of 0.11 s
    slow = {"wave.hit.rise": 0.1, "wave.hit.fall": 0.01, "run.duration": 0.2}
    said = "wave.hit: has a period of 0.11 s, 110 times its way through the scene, 0.001 s"
    assert [warning[: len(said)] for warning in bar_warnings(build_bar(spalling(slow)), 2.5e-5)] == [said]


@pytest.mark.parametrize(("pressure", "said"), [(808.0, None), (-792.0, "792 Pa, 0.0099 % of")])
def test_a_weak_load_beside_the_strength(spalling, pressure: float, said: str | None) -> None:
    load = {"name": "blow", "pressure": pressure, "wave": "hit"}
    expected = [] if said is None else [f"load.blow: its pressure is {said} bar.strength, 8 MPa: Pa and MPa?"]
    assert of_key("load.blow", bar_warnings(build_bar(spalling({"load": [load]})), 2.5e-5)) == expected


@pytest.mark.parametrize(("pressure", "warned"), [(7.92e9, False), (8.08e9, True)])
def test_a_load_far_beyond_the_strength(spalling, pressure: float, warned: bool) -> None:
    load = {"name": "blow", "pressure": pressure, "wave": "hit"}
    said = "load.blow: its pressure is 8080 MPa, 1,010 times bar.strength, 8 MPa: Pa and MPa?"
    assert bar_warnings(build_bar(spalling({**EXACT, "load": [load]})), 2.5e-5) == warned * [said]


def test_waves_at_ends_beside_the_strength(spalling) -> None:
    # ρc = 2.5e6 Pa·s/m and a critical stretch of 0.0032, which is 8 MPa
    bar = {**UNBROKEN["bar"], "critical_stretch": 0.0032}
    for velocity, weak in ((3.3e-4, False), (3.1e-4, True)):
        for kind in ("viscous_input", "velocity"):
            ends = {"boundary.left": {"type": kind, "wave_p": "hit"}, "wave.hit.amplitude": velocity}
            found = list(stress_beside_strength(spalling({"bar": bar, "load": [], **ends})))
            said = "wave.hit: its stress ρcv is 775 Pa, 0.0097 % of bar.critical_stretch, 8 MPa: Pa and MPa?"
            assert found == weak * [said]


def test_a_bar_that_cannot_break_has_no_strength_to_compare_with(spalling) -> None:
    load = {"name": "blow", "pressure": 1e-9, "wave": "hit"}
    assert bar_warnings(build_bar(spalling({**UNBROKEN, **EXACT, "load": [load], "run.duration": 1e-3})), 2.5e-5) == []


def ends_at(duration: float, changes: dict | None = None):
    return {"run.duration": duration, **(changes or {})}


def test_a_run_that_ends_before_the_bar_can_spall(spalling) -> None:
    # even legs of 0.2 ms: the strength is met 0.5 c t_f σ_t/p before the end, 1/15 m
    _, spalled = triangle_spall(1.0, 1000.0, 2e-4, 2e-4, 12e6, 8e6)

    # moments of it are 0.4 ms/500 apart
    assert list(ends_too_soon(spalling(ends_at(spalled + 1e-6)))) == []
    (warning,) = ends_too_soon(spalling(ends_at(spalled - 1e-6)))
    assert warning.startswith(
        "run.duration: is 0.00126567 s, too short for a spall: the wave is not back from the free right end with a "
        "tension of the strength before 0.00126"
    )
    assert float(warning.split()[-2]) == pytest.approx(spalled, abs=1e-6)


def test_the_time_of_a_spall_counts_from_the_start_of_the_wave_and_from_either_end(spalling) -> None:
    _, spalled = triangle_spall(1.0, 1000.0, 2e-4, 2e-4, 12e6, 8e6)
    load = {"name": "hit", "pressure": 12e6, "nodes": 3, "wave": "hit", "side": "right"}
    driven = {"load": [], "boundary.right": {"type": "viscous_input", "wave_p": "hit"}, "wave.hit.amplitude": -4.8}
    for changes in ({"load": [load]}, driven):
        (warning,) = ends_too_soon(spalling({**changes, "wave.hit.start": 1e-3, "run.duration": 2.2e-3}))
        assert "from the free left end" in warning
        assert float(warning.split()[-2]) == pytest.approx(1e-3 + spalled, abs=4e-6)  # moments of 1.4 ms
        assert not list(ends_too_soon(spalling({**changes, "wave.hit.start": 1e-3, "run.duration": 2.3e-3})))


@pytest.mark.parametrize(("duration", "warned"), [(1.19e-3, True), (1.21e-3, False)])
def test_a_wave_too_weak_to_spall_is_back_when_its_crest_is(spalling, duration: float, warned: bool) -> None:
    load = {"name": "hit", "pressure": 7e6, "wave": "hit"}
    said = (
        "run.duration: is 0.00119 s, too short for any tension: the wave's crest is not at the free right end, which "
        "returns it as tension, before 0.0012 s"
    )
    assert list(ends_too_soon(spalling(ends_at(duration, {"load": [load]})))) == warned * [said]


def test_a_dashpot_takes_half_of_a_load(spalling) -> None:
    # what is left of 12 MPa is less than the strength, of 24 MPa 12
    _, spalled = triangle_spall(1.0, 1000.0, 2e-4, 2e-4, 12e6, 8e6)
    end = {"boundary.left": {"type": "viscous"}}
    (weak,) = ends_too_soon(spalling(ends_at(1e-3, end)))
    load = {"name": "hit", "pressure": 24e6, "wave": "hit"}
    (strong,) = ends_too_soon(spalling(ends_at(1e-3, {**end, "load": [load]})))

    assert weak.endswith("before 0.0012 s")
    assert float(strong.split()[-2]) == pytest.approx(spalled, abs=1e-6)


@pytest.mark.parametrize(
    "changes",
    [
        UNBROKEN,
        {"boundary.right": {"type": "viscous"}},
        {"boundary.right": {"type": "fixed"}},
        {"load": []},
        {"load": [{"name": side, "pressure": 12e6, "wave": "hit", "side": side} for side in ("left", "right")]},
        {"load": [{"name": "pull", "pressure": -12e6, "wave": "hit"}]},  # which breaks it on the way
    ],
    ids=str,
)
def test_there_is_nothing_to_wait_for(spalling, changes: dict) -> None:
    assert list(ends_too_soon(spalling(ends_at(1e-4, changes)))) == []


class LateInput(ViscousInput):
    """Transmits its wave half a millisecond later, with twice the amplitude."""

    def support(self, edge, medium, waves, supports) -> None:
        ((name, damping),) = zip(self.waves.values(), self.dampings(edge, medium)[0], strict=True)
        supports.add(edge.nodes, 0, damping=damping)
        supports.add(edge.nodes, 0, drive=4.0 * damping, signal=lambda t: waves[name].velocity(t - 5e-4))


class Grip(LateInput):
    """Moves as its wave, half a millisecond later."""

    def prescribed(self, normal_axis: int) -> tuple[int, ...]:
        return (0,)

    def support(self, edge, medium, waves, supports) -> None:
        (name,) = self.waves.values()
        supports.add(edge.nodes, 0, drive=1.0, signal=lambda t: waves[name].velocity(t - 5e-4), prescribed=True)


@pytest.mark.parametrize(("end", "factor"), [(LateInput, 2.0), (Grip, 1.0)])
def test_a_wave_is_where_and_as_strong_as_its_boundary_lets_it_in(spalling, end: type, factor: float) -> None:
    # ρc = 2.5e6 Pa·s/m: 12 MPa, of which the strength is 8
    _, spalled = triangle_spall(1.0, 1000.0, 2e-4, 2e-4, 12e6, 8e6)
    case = spalling({"load": [], "wave.hit.amplitude": 4.8 / factor, "run.duration": 1.4e-3})
    late = {"left": end(type="viscous_input", wave_p="hit")}

    (warning,) = ends_too_soon(replace(case, boundary=late))
    assert float(warning.split()[-2]) == pytest.approx(5e-4 + spalled, abs=4e-6)
    longer = replace(case, run=case.run.model_copy(update={"duration": 5e-4 + spalled + 5e-6}))
    assert not list(ends_too_soon(replace(longer, boundary=late)))


def test_a_wave_that_never_comes_in_is_not_told_of(spalling) -> None:
    case = spalling({"load": [], "run.duration": 4e-4})
    assert not list(ends_too_soon(replace(case, boundary={"left": LateInput(type="viscous_input", wave_p="hit")})))


def test_the_stress_of_a_wave_is_what_its_boundary_lets_in(spalling) -> None:
    for beta, amplitude in ((1.0, 3.1e-4), (3.0, 3.1e-4 / 1.5)):  # 2β/(1 + β) of it
        ends = {"boundary.left": {"type": "viscous_input", "wave_p": "hit", "beta_p": beta}}
        found = list(stress_beside_strength(spalling({"load": [], **ends, "wave.hit.amplitude": amplitude})))
        assert found == ["wave.hit: its stress ρcv is 775 Pa, 0.0097 % of bar.strength, 8 MPa: Pa and MPa?"]


def test_a_pressure_that_stays_makes_no_tension_but_a_crest(spalling) -> None:
    stays = {"wave.hit": {"type": "constant", "amplitude": 1.0, "rise": 2e-4}}
    (warning,) = ends_too_soon(spalling(ends_at(1e-3, stays)))
    assert warning.endswith("before 0.0012 s")


@pytest.mark.parametrize(("energy", "warned"), [(7.6e3, True), (7.8e3, False)])
def test_long_bonds_across_cracks_are_warned_of(spalling, energy: float, warned: bool) -> None:
    # δ = 3·25 mm; a quarter of EG_f/σ_t², 2.5 GPa·G_f/(8 MPa)², is as long at 7.68 kJ/m²
    found = of_key("method.horizon", bar_warnings(build_bar(spalling({"bar.fracture_energy": energy})), 2e-5))
    assert len(found) == warned


STRIKER = [
    {"name": "striker", "length": 0.2, "velocity": 5.0},
    {"name": "rod", "length": 0.4, "interface": "contact"},
]


def struck(spacing: float, courant: float):
    """A striker on a rod of the same stone, with its own spacing."""
    bar = {key: value for key, value in SPALLING["bar"].items() if key != "length"}
    ranges = [STRIKER[0], STRIKER[1] | {"spacing": spacing}]
    run = {"duration": 4e-4, "courant": courant}
    method = {"type": "finite_difference"}
    return small({"bar": bar | {"range": ranges}, "method": method, "monitor": SPALLING["monitor"], "run": run})


@pytest.mark.parametrize(
    ("spacing", "courant", "key"), [(0.025, 1.0, None), (0.025, 0.9, "run.courant"), (0.02, 0.8, "bar.range:")]
)
def test_fronts_of_impacts_need_one_step_for_a_spacing(spacing: float, courant: float, key: str | None) -> None:
    scene = build_bar(struck(spacing, courant))
    found = [line for line in bar_warnings(scene, choose_step(scene)[0]) if "impacts" in line]
    assert len(found) == (key is not None)
    assert key is None or found[0].startswith(key)


@pytest.mark.parametrize(
    ("interface", "velocity", "warned"), [("bonded", 0.0, True), ("bonded", 5.0, False), ("contact", 0.0, False)]
)
def test_a_striker_that_is_bonded_is_warned_of(interface: str, velocity: float, warned: bool) -> None:
    ranges = [STRIKER[0], STRIKER[1] | {"interface": interface, "velocity": velocity}]
    bar = {key: value for key, value in SPALLING["bar"].items() if key != "length"} | {"range": ranges}
    scene = build_bar(small(SPALLING | EXACT | {"bar": bar, "load": [], "wave": {}}))
    found = [line for line in bar_warnings(scene, choose_step(scene)[0]) if "interface" in line]
    said = 'bar.range[2, rod].interface: is "bonded", while striker has 5 m/s at the start and rod 0 m/s: they pull'
    assert [line[: len(said)] for line in found] == warned * [said]


def test_monitors_in_gaps_are_warned_of() -> None:
    # ranges end at 0.2 m and begin at 0.25 m
    ranges = [STRIKER[0], STRIKER[1] | {"gap": 0.05}]
    bar = {key: value for key, value in SPALLING["bar"].items() if key != "length"} | {"range": ranges}
    places = {"left": 0.2, "inside": 0.21, "right": 0.25}
    monitors = [{"name": name, "position": place} for name, place in places.items()]
    scene = build_bar(small(SPALLING | {"bar": bar, "load": [], "wave": {}, "monitor": monitors}))
    found = [line for line in bar_warnings(scene, choose_step(scene)[0]) if line.startswith("monitor")]
    assert found == [
        "monitor.inside: is at 0.21 m, in the gap from 0.2 to 0.25 m between two ranges; it records the node at 0.25 m"
    ]


@pytest.mark.parametrize(("modulus", "warned"), [(3e6, True), (30e9, False)])
def test_a_stiffness_and_a_density_that_do_not_fit_are_warned_of(modulus: float, warned: bool) -> None:
    bar = {key: value for key, value in SPALLING["bar"].items() if key not in ("wave_speed", "strength")}
    scene = build_bar(small(SPALLING | {"bar": bar | {"youngs_modulus": modulus}}))
    found = of_key("bar", bar_warnings(scene, choose_step(scene)[0]))
    assert any("wave speed" in line for line in found) == warned


@pytest.mark.parametrize(
    ("end", "said"),
    [
        ({"type": "free"}, None),
        ({"type": "viscous"}, "takes 50 % of it, and up to 6 MPa enters the bar; on a free end all of it does"),
        ({"type": "viscous", "beta_p": 3.0}, "takes 75 % of it, and up to 3 MPa enters"),
    ],
)
def test_a_load_on_an_end_that_takes_of_it_is_warned_of(spalling, end: dict, said: str | None) -> None:
    """Of 12 MPa the dashpot Cv takes β/(1 + β)."""
    found = of_key("load.hit", bar_warnings(build_bar(spalling({**EXACT, "boundary.left": end})), 2.5e-5))
    assert len(found) == (said is not None)
    assert said is None or said in found[0]


@pytest.mark.parametrize(("energy", "tough"), [(7.6e3, False), (7.8e3, True)])
def test_a_fracture_energy_above_that_of_the_waves_is_warned_of(spalling, energy: float, tough: bool) -> None:
    """∫p²/(ρc) dt of a triangle of 12 MPa and 4e-4 s is 144e12/3 · 4e-4/2.5e6 = 7,680 J/m²."""
    case = spalling({**EXACT, "bar.fracture_energy": energy})
    found = of_key("bar.fracture_energy", bar_warnings(build_bar(case), 2.5e-5))
    assert len(found) == tough
    assert not tough or "is 7800 J/m², more than all waves bring in, 7.68e+03 J/m², so no crack" in found[0]


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"diameter": 0.02}, "bar.range[2, rod]: has neither section nor diameter, so 1 m², beside 0.0003142 m²"),
        ({"section": 0.02}, ""),
        ({"section": 0.0099}, "bar.range[2, rod]: its section, 1 m², is 101 times that of striker, 0.0099 m²"),
        ({"section": 0.0101}, ""),
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
        (5.0, 0.01, 2.1e-3, ""),
        (-5.0, 0.0, 1.0, "bar.range[2, rod]: it and striker part at 5 m/s"),
        (0.0, 0.01, 1.0, "bar.range[2, rod].gap: is 0.01 m, and never closes"),
        (0.0, 0.0, 1.0, ""),
    ],
)
def test_gaps_that_never_close_are_known_before_the_run(
    velocity: float, gap: float, duration: float, said: str
) -> None:
    case = with_ranges([STRIKER[0] | {"velocity": velocity}, STRIKER[1] | {"gap": gap}], {"duration": duration})
    found = never_closing(case)
    assert list(found) == ["rod"] * bool(said)
    assert found.get("rod", "").startswith(said)


def test_no_gap_is_foreseen_where_waves_move_the_bar() -> None:
    """A striker held at its end, another impact, a load: each sends waves by which a range may turn round."""
    away = [STRIKER[0] | {"velocity": -5.0}, STRIKER[1]]
    assert never_closing(with_ranges(away))
    assert not never_closing(with_ranges(away, boundary={"left": {"type": "fixed"}}))
    assert not never_closing(
        with_ranges([*away, {"name": "c", "length": 0.2, "velocity": -1.0, "interface": "contact"}])
    )
    assert not never_closing(with_ranges(away, load=SPALLING["load"], wave=SPALLING["wave"]))


def with_ranges(ranges: list[dict], run: dict | None = None, **tables):
    bar = {key: value for key, value in SPALLING["bar"].items() if key != "length"} | {"range": ranges}
    return small({"bar": bar, "method": EXACT["method"], "run": run or {"duration": 1.0}, **tables})


def test_a_load_over_a_length_beside_that_of_its_wave_is_warned_of() -> None:
    """The mean of a pulse (1 − cos)/2 of the length l over 2W has 1/2 + sin(2πW/l)/(4πW/l), 0.80 at W/l = 0.264."""
    case = {**UNBROKEN, "method": EXACT["method"], "run": {"duration": 4e-3}}
    case["wave"] = {"w": {"type": "cosine", "amplitude": 1.0, "period": 5e-4}}  # l = 0.5 m, W = (n − 1/2) 0.025 m

    def found(nodes: int) -> list[str]:
        load = {"name": "l", "pressure": 10e6, "nodes": nodes, "wave": "w"}
        scene = build_bar(small(case | {"load": [load]}))
        return of_key("load.l.nodes", bar_warnings(scene, 2.5e-5))

    assert found(5) == []  # W/l = 0.225
    (line,) = found(6)
    ratio = 2.0 * np.pi * 5.5 * 0.025 / 0.5
    assert f"only {100.0 * (0.5 + 0.5 * np.sin(ratio) / ratio):.2g} % of its peak enters" in line
    (line,) = found(21)  # all of the pulse within: l/4W
    assert f"only {100.0 * 0.25 * 0.5 / (20.5 * 0.025):.2g} % of its peak enters" in line
