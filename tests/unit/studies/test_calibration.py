"""Calibration: what is modelled, how one factor and all of a case are found, what is refused."""

import h5py
import pytest

from dembound.errors import CaseError
from dembound.results.reader import text_of
from dembound.studies import calibration as module
from dembound.studies.all_sides import calibrate_all, changes_of, factors_of, summary_of
from dembound.studies.asked import Calibrating
from dembound.studies.calibration import calibrate, known

LENGTH = 1000.0 * 0.05
"""Length cT of the pulse in m; the strip needs 0.35 of it."""


SHEAR = {"type": "viscous_input", "wave_s": "pulse"}
SPRINGS, SPRUNG = {"distance": 1.0, "alpha_n": 5.0}, "viscoelastic sides without their springs"


@pytest.fixture
def long_bar(bar):
    """Makes cases: 40 m of the bar, a pulse of 140 steps, longer than the strip."""

    def make(changes: dict | None = None):
        return bar({"packing.size": [40.0, 1.0], "wave.pulse.period": 0.05, **(changes or {})})

    return make


@pytest.mark.parametrize(("side", "answer"), [("right", 2.0 / 1.5), ("left", 2.0 * 0.5 / 1.5)])
def test_the_impedance_relation_finds_the_factor_in_one_step(long_bar, tmp_path, side: str, answer: float) -> None:
    seen: list[int] = []
    found = calibrate(long_bar(), side, Calibrating(start=0.5), report=lambda so_far: seen.append(len(so_far.beta)))

    # equal disks: β0 = 1 but for the end mass, whose |R| = qa/4 = 2π·0.5/50/4 shifts phases, not peaks: of order R²
    # = 2e-4. A step of T/140 misses the crest by up to (π/280)² = 1e-4.
    assert found.ratio[0] == pytest.approx(answer, abs=1e-3)
    assert found.beta[0] == 0.5
    assert seen == [1, 2]
    assert found.result == known(found.beta[-1], found.ratio[-1]) == pytest.approx(1.0, abs=2e-3)
    assert abs(found.ratio[-1] - 1.0) < 1e-3
    assert found.kind == ("absorbing" if side == "right" else "input")

    found.write(tmp_path / "calibration.h5")
    with h5py.File(tmp_path / "calibration.h5") as file:
        for name in ("beta", "outgoing", "ratio"):
            assert file[name][:].tolist() == getattr(found, name)
        assert text_of(file["outgoing"].attrs["unit"]) == "m/s"
        about = {key: text_of(value) if isinstance(value, bytes) else value for key, value in file.attrs.items()}
    assert [about[key] for key in ("boundary", "wave", "kind", "method")] == [side, "p", found.kind, "impedance"]
    assert (about["incident"], about["result"], about["case"]) == (0.5, found.result, found.case.text)


@pytest.mark.parametrize(
    ("beta", "ratio", "digits"),
    # another pass would change β by 2·(ratio − 1)·β: by 1.4e-3, 1.4e-3, 0.14, 2.4e-5, and by nothing
    [(0.7138123, 1.001, 0.714), (0.7138123, 0.999, 0.714), (71.38123, 1.001, 71.4), (1.20345678, 0.99999, 1.20346),
     (0.7138123, 1.0, 0.713812)],
)  # fmt: skip
def test_a_factor_has_the_digits_that_are_known(beta, ratio, digits) -> None:
    assert known(beta, ratio) == digits


def test_other_sides_keep_their_supports_but_not_their_waves(long_bar) -> None:
    absorbing = {"beta_s": 0.3, "half_mass": True}
    driven = {"type": "viscous_input", "wave_s": "pulse", **absorbing}
    sides = driven, {"type": "viscous", **absorbing}
    cases = [long_bar({"boundary.top": top, "motion.held": ["y", "rotation"]}) for top in sides]
    own, at_rest = (calibrate(case, "right", Calibrating(full=True, tolerance=2.0)) for case in cases)
    assert own.outgoing == at_rest.outgoing


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
    how = Calibrating(start=0.5, full=True)
    found, expected = (calibrate(long_bar(changes), "right", how) for changes in (busy, plain))
    assert (found.beta, found.outgoing) == (expected.beta, expected.outgoing)
    assert found.shortened == [*expected.shortened, "no holes", "no static stage", "no loads", "the elastic law"]


def test_the_homogenised_factor_needs_no_run(long_bar) -> None:
    found = calibrate(long_bar(), "right", Calibrating(method="homogenised"))
    # (c_eff/c)·H/ΣD of touching equal disks; a solve with one unknown
    assert found.result == pytest.approx(1.0, rel=1e-12)
    assert (found.beta, found.outgoing, found.steps) == ([], [], 0)

    moduli = {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9, "s_wave_speed": 250.0}
    case = long_bar({"material": moduli, "motion.held": ["x"], "boundary.left": SHEAR})
    # c_s = 500 m/s where the dashpots assume 250; β0 = 2
    assert calibrate(case, "right", Calibrating(method="homogenised"), motion="s").result == pytest.approx(
        2.0, rel=1e-12
    )


def test_a_strip_is_as_long_as_an_echo_needs_and_one_brick_wide_where_sides_matter(long_bar) -> None:
    found = calibrate(long_bar(), "right", Calibrating(tolerance=1.0))
    # 17.5 m of 40 m, both rows: y is held, so the free sides do nothing
    assert found.particles == 2 * int(0.35 * LENGTH / 0.5)
    assert "a strip of 17.5 m, the scene has 40 m" in found.shortened

    # a bar that is free to bend keeps its sides for P waves, not for S waves, which would bend it; 18 disks are 0.35 of
    # the length of these, at the 500 m/s of touching disks, whose rotations take part
    shear = {"boundary.left": SHEAR}
    for changes, particles in (({}, 2 * 35), (shear, 18), ({"boundary.top": {"type": "fixed"}}, 35)):
        found = calibrate(long_bar({"motion.held": [], **changes}), "right", Calibrating(tolerance=1.0))
        assert found.particles == particles
        assert ("one brick wide and periodic sideways" in found.shortened) == (particles < 70)


def test_factors_are_those_of_the_scenes_own_side_where_the_strip_has_other_disks(long_bar) -> None:
    """Of equal βΣD/H the first pass has equal dashpots; fixed long sides show other disks than periodic ones."""
    packing = {"pattern": "B", "size": [32.0, 8.0], "radius": 0.4, "radius_ratio": 2.0, "brick": [8.0, 8.0], "seed": 7}
    own, tiled = (
        long_bar({"packing": packing, "motion.held": [], "boundary.top": side, "boundary.bottom": side})
        for side in ({"type": "fixed"}, {"type": "periodic"})
    )
    found, other = (calibrate(case, "right", Calibrating(tolerance=1.0)) for case in (own, tiled))
    matched = calibrate(own, "right", Calibrating(method="homogenised")).result
    assert found.beta[0] == pytest.approx(matched, rel=1e-4)  # which has five digits
    assert abs(other.beta[0] / found.beta[0] - 1.0) > 0.01
    assert found.outgoing[0] == pytest.approx(other.outgoing[0], rel=1e-12)


@pytest.mark.parametrize(("shares", "kept"), [((0.02, 0.01), True), ((0.01, 0.02), False)])
def test_the_matched_factor_is_kept_where_it_returns_less(long_bar, monkeypatch, shares, kept: bool) -> None:
    asked = []
    monkeypatch.setattr(module, "returned", lambda *given: asked.append(given[-1]) or list(shares))
    found = calibrate(long_bar(), "right", Calibrating(start=0.5, tolerance=1e-4))
    ((own, matched),) = asked
    assert matched == calibrate(long_bar(), "right", Calibrating(method="homogenised")).result
    assert own == known(found.beta[1], found.ratio[1]) != matched
    assert found.result == (matched if kept else own)
    assert found.beta[-1] == pytest.approx(found.result, abs=1e-4)
    words = f"returned: {100 * shares[0]:g} % with {own:g}, {100 * shares[1]:g} % with the matched {matched:g}"
    assert found.compared == words + (", which is kept" if kept else "")


@pytest.mark.parametrize(
    ("side", "table", "plain", "without"),
    [
        ("left", {"type": "viscoelastic_input", **SPRINGS}, "viscous_input", SPRUNG),
        ("right", {"type": "free_field"}, "viscous", "free-field sides without their column"),
    ],
)
def test_sides_are_calibrated_by_their_dashpots_from_the_cases_own_factor(
    long_bar, side, table, plain, without
) -> None:
    dashpots = {"beta_p": 0.7} | ({"wave_p": "pulse"} if side == "left" else {})
    found, expected = (
        calibrate(long_bar({f"boundary.{side}": each | dashpots}), side) for each in (table, {"type": plain})
    )
    assert found.beta[0] == 0.7
    assert (found.beta, found.outgoing, found.kind) == (expected.beta, expected.outgoing, expected.kind)
    assert found.shortened == [*expected.shortened, without]


@pytest.mark.parametrize(
    ("side", "options", "said"),
    [
        ("right", {"how": Calibrating(tolerance=float("nan"))}, "--tolerance"),
        ("right", {"how": Calibrating(start=float("inf"))}, "to start a calibration"),
        ("right", {"how": Calibrating(start=0.0)}, r"boundary\.right\.beta_p: is 0, must be above 0"),
        ("right", {"motion": "s"}, r"motion\.held: holds y, the motion of S waves at the side right"),
        ("top", {}, r"boundary\.top: is free, .*here: left, right"),
    ],
)
def test_what_cannot_be_calibrated_is_refused(long_bar, side: str, options: dict, said: str) -> None:
    with pytest.raises(CaseError, match=said):
        calibrate(long_bar({"boundary.bottom": {"type": "fixed"}}), side, **options)


DASHPOTS = {
    "motion.held": [],
    "boundary.right": {"type": "viscoelastic", "distance": 20.0},
    "boundary.top": {"type": "viscous", "beta_s": 0.8},
}


def test_sides_with_dashpots_have_a_factor_for_each_wave_that_can_move_them(bar) -> None:
    both = [(side, motion) for side in ("left", "right", "top") for motion in ("p", "s")]
    assert factors_of(bar(DASHPOTS)) == both
    # y is what P waves move at the top, S waves at the left and the right
    assert factors_of(bar(DASHPOTS | {"motion.held": ["y"]})) == [("left", "p"), ("right", "p"), ("top", "s")]
    assert factors_of(bar(DASHPOTS | {"motion.held": ["rotation"]})) == both
    grip = {"boundary.left": {"type": "velocity", "wave_p": "pulse"}, "boundary.right": {"type": "fixed"}}
    with pytest.raises(CaseError, match="boundary: has no side with dashpots"):
        factors_of(bar(grip))


def test_each_factor_is_the_one_that_is_found_alone(bar) -> None:
    how, case = Calibrating(tolerance=1e-2), bar(DASHPOTS | {"boundary.right.beta_p": 0.7})
    passes = []
    found = calibrate_all(case, how, report=lambda each: passes.append((each.side, each.motion)))

    assert [(each.side, each.motion) for each in found] == factors_of(case)
    alone = {(side, motion): calibrate(case, side, how, motion=motion) for side, motion in factors_of(case)}
    assert changes_of(found) == {f"boundary.{s}.beta_{m}": each.result for (s, m), each in alone.items()}
    assert len(passes) == sum(len(each.beta) for each in found)

    summary = summary_of(found)
    assert summary["result"] == changes_of(found)
    assert [each["boundary"] for each in summary["calibrations"]] == [side for side, _ in factors_of(case)]
    assert summary["method"] == found[0].method
