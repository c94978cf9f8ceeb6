"""Records with all usual mistakes give wave speed, attenuation and strength of the bar, or are refused."""

from dataclasses import replace

import pytest
from gauge_records import DECAY, RECORDS, SPALL, SPEED, exact_nominal

from dembound.errors import CaseError
from dembound.gauge.spalling import evaluate

GIVEN = [record for record in RECORDS if not record.refused]
"""Records that must give estimates."""


@pytest.mark.parametrize("record", GIVEN, ids=lambda record: record.name)
def test_a_weak_pulse_gives_speed_and_attenuation(record, tmp_path):
    found = evaluate(record.gauge(tmp_path / "weak.txt"))
    # by its whole shape a passage is timed to σ/√(Σ ġ²): at 3 % of noise, which leaves peaks down to an eighth, to half
    # a sample of 723 in 2L/c; and its height to σ/√(Σ g²)/a, 4 % of the last one. 0.5 % and 5 % are three times that
    assert found.speed.value == pytest.approx(SPEED, rel=0.005)
    assert found.attenuation.value == pytest.approx(DECAY, rel=0.05)
    # and the errors are those that are told, but for the share of samples on a crest in records without noise
    assert abs(found.speed.value - SPEED) < 4.0 * found.speed.error + 2e-4 * SPEED
    assert not found.warnings


@pytest.mark.parametrize("record", GIVEN, ids=lambda record: record.name)
def test_a_strong_pulse_gives_the_strength(record, tmp_path):
    gauge = replace(record.gauge(tmp_path / "strong.txt", 200e-6), unit="Pa")
    found = evaluate(gauge, spall=SPALL, speed=SPEED, coefficient=DECAY)
    strength = found.strength.nominal / record.crest
    if found.warnings:  # noise of 3 % raises a largest value: it is told, and how much
        assert record.name == "noise of 3 %"
        assert "% of the wave and makes the strength too large" in found.warnings[0]
    else:
        assert strength == pytest.approx(exact_nominal(), rel=0.03)


@pytest.mark.parametrize("record", [each for each in RECORDS if each.refused], ids=lambda record: record.name)
def test_a_record_that_cannot_give_them_is_refused(record, tmp_path):
    with pytest.raises(CaseError, match=record.refused):
        evaluate(record.gauge(tmp_path / "weak.txt"))


def test_a_wrong_place_of_the_gauge_is_seen(tmp_path):
    gauge = GIVEN[1].gauge(tmp_path / "weak.txt")
    # 2(L − x_g) is 780 mm, so 10 mm change the first passages' speed by 2.6 %; 1.2 % are allowed, ten times
    # the error of crests known to half a sample of 285
    assert "check --position and --length" in evaluate(replace(gauge, position=0.59)).warnings[0]
    with pytest.raises(CaseError, match="check --position and --length"):
        evaluate(replace(gauge, position=0.4))
    assert "has --scale the wrong sign?" in evaluate(replace(gauge, stress=-gauge.stress)).warnings[0]
