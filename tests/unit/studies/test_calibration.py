"""Calibration: what is modelled, how the factor is found, what is refused."""

from dataclasses import replace

import h5py
import numpy as np
import pytest

from dembound.boundaries.viscous import Viscous
from dembound.errors import CaseError, RunError
from dembound.results.reader import text_of
from dembound.studies import calibration as module
from dembound.studies.calibration import calibrate, known

LENGTH = 1000.0 * 0.05
"""Length cT of the pulse in m; the strip needs 0.35 of it."""


SHEAR = {"type": "viscous_input", "wave_s": "pulse"}


@pytest.fixture
def long_bar(bar):
    """Makes cases: 40 m of the bar, a pulse of 140 steps, longer than the strip."""

    def make(changes: dict | None = None):
        return bar({"packing.size": [40.0, 1.0], "wave.pulse.period": 0.05, **(changes or {})})

    return make


@pytest.mark.parametrize(("side", "answer"), [("right", 2.0 / 1.5), ("left", 2.0 * 0.5 / 1.5)])
def test_the_impedance_relation_finds_the_factor_in_one_step(long_bar, side: str, answer: float) -> None:
    found = calibrate(long_bar(), side, start=0.5)

    # equal disks: β0 = 1 but for the end mass, whose |R| = qa/4 = 2π·0.5/50/4 shifts phases, not peaks: of order R²
    # = 2e-4. A step of T/140 misses the crest by up to (π/280)² = 1e-4.
    assert found.ratio[0] == pytest.approx(answer, abs=1e-3)
    assert found.beta[0] == 0.5
    assert len(found.beta) == 2
    assert found.result == known(found.beta[-1], found.ratio[-1]) == pytest.approx(1.0, abs=2e-3)
    assert abs(found.ratio[-1] - 1.0) < 1e-3
    assert found.kind == ("absorbing" if side == "right" else "input")


@pytest.mark.parametrize(
    ("beta", "ratio", "digits"),
    # another pass would change β by 2·(ratio − 1)·β: by 1.4e-3, 1.4e-3, 0.14, 2.4e-5, and by nothing
    [(0.7138123, 1.001, 0.714), (0.7138123, 0.999, 0.714), (71.38123, 1.001, 71.4), (1.20345678, 0.99999, 1.20346),
     (0.7138123, 1.0, 0.713812)],
)  # fmt: skip
def test_a_factor_has_the_digits_that_are_known(beta, ratio, digits) -> None:
    assert known(beta, ratio) == digits


class Sprung(Viscous):
    """Dashpots and springs, without a word on how the dashpots are alone."""

    def support(self, edge, medium, waves, supports) -> None:
        super().support(edge, medium, waves, supports)
        supports.add(edge.nodes, 0, stiffness=1e6 * edge.diameters)


def test_a_type_whose_springs_stay_beside_its_dashpots_is_refused(long_bar) -> None:
    case = long_bar()
    sprung = replace(case, boundary={**case.boundary, "right": Sprung(type="viscous")})

    with pytest.raises(CaseError, match=r"boundary\.right\.type: \"viscous\" still has springs .* dashpots_alone\(\)"):
        calibrate(sprung, "right")


@pytest.mark.parametrize(("side", "passes"), [("right", 6), ("left", 5)])
def test_the_ratio_iteration_halves_the_error_each_pass(long_bar, side: str, passes: int) -> None:
    found = calibrate(long_bar(), side, start=0.5, method="ratio", tolerance=2e-2)
    beta = np.array(found.beta)
    errors = 1.0 - beta

    # with β0 = 1, absorbing: β → 2β/(1 + β), so the error is divided by 1 + β; input: β → (1 + β)/2. Both answers
    # are within 1e-3 of the relation's, see above, so β is within 1e-3 and the errors before are, too
    divided = 1.0 + beta[:-1] if side == "right" else 2.0
    np.testing.assert_allclose(errors[1:], errors[:-1] / divided, atol=2e-3)
    # an answer within 0.02 asks for an error below 0.04: 1/2, 1/3, 1/5, 1/9, 1/17, 1/33, or 1/2, 1/4 … 1/32
    assert len(beta) == passes


def test_the_homogenised_factor_needs_no_run(long_bar) -> None:
    found = calibrate(long_bar(), "right", method="homogenised")

    # (c_eff/c)·H/ΣD of touching equal disks; a solve with one unknown
    assert found.result == pytest.approx(1.0, rel=1e-12)
    assert (found.beta, found.outgoing, found.steps) == ([], [], 0)


def test_the_homogenised_factor_knows_the_packings_own_speed(long_bar) -> None:
    moduli = {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9, "s_wave_speed": 250.0}
    case = long_bar({"material": moduli, "motion.held": ["x"], "boundary.left": SHEAR})

    # c_s = 500 m/s where the dashpots assume 250; β0 = 2
    assert calibrate(case, "right", motion="s", method="homogenised").result == pytest.approx(2.0, rel=1e-12)


def test_a_strip_is_as_long_as_an_echo_needs(long_bar) -> None:
    found = calibrate(long_bar(), "right", tolerance=1.0)

    # 17.5 m of 40 m, both rows: y is held, so the free sides do nothing
    assert found.particles == 2 * int(0.35 * LENGTH / 0.5)
    assert "a strip of 17.5 m, the scene has 40 m" in found.shortened


@pytest.mark.parametrize("full", [False, True])
def test_of_identical_rows_one_is_stepped(long_bar, full) -> None:
    found, expected = (calibrate(long_bar({"reduce.rows": rows}), "right", full=full) for rows in (True, False))

    (saved,) = set(found.shortened) - set(expected.shortened)
    assert saved.startswith("rows: 2 identical rows are stepped as one")
    assert (found.beta, found.outgoing) == (expected.beta, expected.outgoing)  # a mean of equal peaks
    assert (found.particles, found.steps) == (expected.particles, expected.steps)


def test_a_strip_may_be_longer_than_the_scene(bar) -> None:
    found = calibrate(bar({"wave.pulse.period": 0.05}), "right", tolerance=1.0)

    assert found.particles == 2 * 35
    assert "a strip of 17.5 m, the scene has 10 m" in found.shortened


def test_where_the_sides_matter_the_strip_is_one_brick_wide_and_periodic(long_bar) -> None:
    for changes in ({"motion.held": []}, {"boundary.top": {"type": "fixed"}}):
        found = calibrate(long_bar(changes), "right", tolerance=1.0)
        assert found.particles == 35
        assert "one brick wide and periodic sideways" in found.shortened


def test_the_whole_scene_is_used_when_asked_for(long_bar) -> None:
    found = calibrate(long_bar(), "right", start=0.5, full=True)

    assert found.particles == 160
    assert not any("strip" in sentence for sentence in found.shortened)
    assert found.result == pytest.approx(1.0, abs=2e-3)


def test_a_scene_too_short_to_keep_echoes_away_is_not_used_whole(bar) -> None:
    with pytest.raises(CaseError, match=r"--full: the scene is 10 m long, echoes need 17\.5 m"):
        calibrate(bar({"wave.pulse.period": 0.05}), "right", full=True)


@pytest.mark.parametrize(
    ("driven", "at_rest"),
    [
        ({"type": "velocity", "wave_s": "pulse"}, {"type": "fixed"}),
        (
            {"type": "viscous_input", "wave_s": "pulse", "beta_s": 0.3, "half_mass": True},
            {"type": "viscous", "beta_s": 0.3, "half_mass": True},
        ),
    ],
)
def test_other_sides_keep_their_supports_but_not_their_waves(long_bar, driven: dict, at_rest: dict) -> None:
    passes = [
        calibrate(long_bar({"boundary.top": top, "motion.held": ["y", "rotation"]}), "right", full=True, tolerance=2.0)
        for top in (driven, at_rest)
    ]

    # a fixed side also lets rotations stand still, so these are held in both
    assert passes[0].outgoing == passes[1].outgoing


@pytest.mark.parametrize(
    ("side", "kind", "plain"), [("right", "viscoelastic", "viscous"), ("left", "viscoelastic_input", "viscous_input")]
)
def test_viscoelastic_sides_are_calibrated_without_their_springs(long_bar, side: str, kind: str, plain: str) -> None:
    dashpots = {"beta_p": 0.7} | ({"wave_p": "pulse"} if side == "left" else {})
    springs = {"distance": 1.0, "alpha_n": 5.0}
    found, expected = (
        calibrate(long_bar({f"boundary.{side}": table}), side)
        for table in ({"type": kind, **dashpots, **springs}, {"type": plain, **dashpots})
    )

    assert (found.beta, found.outgoing, found.kind) == (expected.beta, expected.outgoing, expected.kind)
    assert found.shortened == [*expected.shortened, "viscoelastic sides without their springs"]


@pytest.mark.parametrize("full", [False, True])
def test_free_field_sides_are_calibrated_without_their_column(long_bar, full: bool) -> None:
    found, expected = (
        calibrate(long_bar({"boundary.right": {"type": kind, "beta_p": 0.7}}), "right", full=full)
        for kind in ("free_field", "viscous")
    )

    assert (found.beta, found.outgoing, found.kind) == (expected.beta, expected.outgoing, "absorbing")
    assert found.shortened == [*expected.shortened, "free-field sides without their column"]


def test_holes_loads_static_stage_and_law_are_left_out_of_a_calibration(long_bar) -> None:
    busy = {
        "material": {"density": 2500.0, "p_wave_speed": 1000.0, "law": "linearpbond", "pb_ten": 1.0, "fric": 0.3},
        "static": {"boundary": {"right": {"type": "fixed"}}},
        "load": [
            {"name": "weight", "acceleration": [9.81, 0.0]},
            {"name": "tap", "force": [1e6, 0.0], "position": [5.0, 0.5], "wave": "tapping"},
        ],
        "wave.tapping": {"type": "constant", "amplitude": 1.0},
        "hole": [{"name": "niche", "type": "circle", "centre": [3.0, 1.0], "radius": 0.7}],
    }
    plain = {"material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.3}}
    for full in (False, True):
        found, expected = (calibrate(long_bar(changes), "right", start=0.5, full=full) for changes in (busy, plain))
        assert (found.beta, found.outgoing) == (expected.beta, expected.outgoing)
        assert found.shortened == [*expected.shortened, "no holes", "no static stage", "no loads", "the elastic law"]


def test_half_masses_stay_in_a_calibration(long_bar) -> None:
    half, whole = (calibrate(long_bar({"boundary.right.half_mass": triggers}), "right") for triggers in (True, False))

    # with steps near the limit a half mass leaves no error in the end, a whole one shifts the peak
    assert half.ratio[0] != whole.ratio[0]


def test_the_pulse_is_as_strong_as_the_cases_own_wave(long_bar) -> None:
    assert calibrate(long_bar({"wave.pulse.amplitude": -0.25}), "right", tolerance=1.0).incident == 0.25


def test_a_case_without_a_usable_wave_gets_a_pulse_of_one_metre_per_second(long_bar) -> None:
    step = {"wave": {"pulse": {"type": "constant", "amplitude": 0.5}}}

    assert calibrate(long_bar(step), "right", tolerance=1.0).incident == 1.0


def test_s_waves_are_taken_where_p_motion_is_held_or_only_s_waves_come(long_bar) -> None:
    for held in (["x"], []):
        found = calibrate(long_bar({"motion.held": held, "boundary.left": SHEAR}), "right")
        assert (found.motion, found.factor) == ("s", "beta_s")
        # touching equal disks once more; rotations disperse S waves a little more than P
        assert found.result == pytest.approx(1.0, abs=5e-3)


def test_each_pass_is_reported(long_bar) -> None:
    seen = []
    found = calibrate(long_bar(), "right", start=0.5, report=lambda so_far: seen.append(len(so_far.beta)))

    assert seen == list(range(1, len(found.beta) + 1))


def test_the_cases_own_factor_is_where_it_starts(long_bar) -> None:
    assert calibrate(long_bar({"boundary.right.beta_p": 0.7}), "right").beta[0] == 0.7


@pytest.mark.parametrize(("side", "has"), [("top", "free"), ("bottom", "fixed")])
def test_a_side_without_dashpots_is_refused_and_told_which_have_some(long_bar, side: str, has: str) -> None:
    with pytest.raises(CaseError, match=rf"boundary\.{side}: is {has}, .*here: left, right"):
        calibrate(long_bar({"boundary.bottom": {"type": "fixed"}}), side)


def test_waves_whose_motion_is_held_are_refused(long_bar) -> None:
    with pytest.raises(CaseError, match=r"motion\.held: holds y, the motion of S waves at the side right"):
        calibrate(long_bar(), "right", motion="s")


def test_a_factor_of_zero_cannot_be_a_start(long_bar) -> None:
    with pytest.raises(CaseError, match=r"boundary\.right\.beta_p: is 0, must be above 0"):
        calibrate(long_bar(), "right", start=0.0)


def test_a_calibration_that_does_not_settle_fails_with_its_last_pass(long_bar, monkeypatch) -> None:
    monkeypatch.setattr(module, "MOST_PASSES", 2)
    with pytest.raises(RunError, match=r"right did not converge in 2 passes: M_out/M_in = 1\.\d+ at beta_p = 0\.\d+"):
        calibrate(long_bar(), "right", start=0.5, method="ratio")


def test_the_passes_are_written_down(long_bar, tmp_path) -> None:
    found = calibrate(long_bar(), "right", start=0.5)
    found.write(tmp_path / "calibration.h5")

    with h5py.File(tmp_path / "calibration.h5") as file:
        assert file["beta"][:].tolist() == found.beta
        assert file["outgoing"][:].tolist() == found.outgoing
        assert file["ratio"][:].tolist() == found.ratio
        assert text_of(file["outgoing"].attrs["unit"]) == "m/s"
        about = {key: text_of(value) if isinstance(value, bytes) else value for key, value in file.attrs.items()}
    assert (about["boundary"], about["wave"], about["kind"], about["method"]) == (
        "right",
        "p",
        "absorbing",
        "impedance",
    )
    assert (about["incident"], about["result"]) == (0.5, found.result)
    assert about["case"] == found.case.text


@pytest.mark.parametrize("tolerance", [float("nan"), 0.0])
def test_a_tolerance_must_be_a_number(long_bar, tolerance: float) -> None:
    with pytest.raises(CaseError, match="--tolerance"):
        calibrate(long_bar(), "right", tolerance=tolerance)


@pytest.mark.parametrize("start", [float("nan"), float("inf")])
def test_a_start_must_be_a_number(long_bar, start: float) -> None:
    with pytest.raises(CaseError, match="to start a calibration"):
        calibrate(long_bar(), "right", start=start)


@pytest.mark.parametrize(("side", "start"), [("right", 1e-6), ("left", 1e6)])
def test_a_start_far_off_leads_back_without_negative_factors(long_bar, side: str, start: float) -> None:
    found = calibrate(long_bar(), side, start=start)

    assert min(found.beta) > 0.0
    assert found.result == pytest.approx(1.0, abs=2.5e-3)  # with half a unit of its last digit
