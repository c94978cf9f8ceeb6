"""Records with all usual mistakes give wave speed, attenuation and strength of the bar, or are refused."""

from dataclasses import replace

import pytest
from gauge_records import DECAY, RECORDS, SPALL, SPEED, exact_nominal

from dembound.errors import CaseError
from dembound.gauge.spalling import evaluate

FEW = ("noise of 3 %", "drift of 3 %, 8 bits", "ringing of 5 % at 150 kHz")
GIVEN = [
    pytest.param(record, marks=() if record.name in FEW else pytest.mark.slow, id=record.name)
    for record in RECORDS
    if not record.refused
]
"""Records that must give estimates, all with ``-m slow``."""


@pytest.mark.parametrize("record", GIVEN)
def test_a_weak_pulse_gives_speed_and_attenuation(record, tmp_path):
    found = evaluate(record.gauge(tmp_path / "weak.txt"))
    # by its whole shape a passage is timed to σ/√(Σ ġ²): at 3 % of noise, which leaves peaks down to an eighth, to half
    # a sample of 723 in 2L/c; and its height to σ/√(Σ g²)/a, 4 % of the last one. 0.5 % and 5 % are three times that
    assert found.speed.value == pytest.approx(SPEED, rel=0.005)
    assert found.attenuation.value == pytest.approx(DECAY, rel=0.05)


@pytest.mark.parametrize("record", [each for each in GIVEN if "%" in each.id])
def test_a_strong_pulse_gives_the_strength(record, tmp_path):
    gauge = replace(record.gauge(tmp_path / "strong.txt", 200e-6), unit="Pa")
    found = evaluate(gauge, spall=SPALL, speed=SPEED, coefficient=DECAY)
    # noise of 3 % makes a largest value uncertain by 8 %, which is reported
    off, error = abs(found.strength.nominal - exact_nominal()), found.strength.nominal_error
    assert off < max(0.03 * exact_nominal(), 2.0 * error)


@pytest.mark.parametrize("record", [each for each in RECORDS if each.refused], ids=lambda record: record.name)
def test_a_record_that_cannot_give_them_is_refused(record, tmp_path):
    with pytest.raises(CaseError, match=record.refused):
        evaluate(record.gauge(tmp_path / "weak.txt"))
