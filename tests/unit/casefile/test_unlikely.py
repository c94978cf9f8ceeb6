"""Waves that are used for two quantities, and histories that jump at their ends."""

import numpy as np
import pytest

from dembound.casefile.unlikely import wave_use_warnings

BLOW = {"name": "blow", "force": [1.0, 0.0], "position": [5.0, 0.5]}


def test_a_wave_that_is_a_velocity_and_a_factor_is_warned_of(bar) -> None:
    own = {"wave.blow": {"type": "cosine", "amplitude": 1.0, "period": 0.01}}
    assert list(wave_use_warnings(bar({**own, "load": [{**BLOW, "wave": "blow"}]}))) == []
    (said,) = wave_use_warnings(bar({**own, "load": [{**BLOW, "wave": "pulse"}]}))
    assert "the velocity at boundary.left.wave_p and the factor of load.blow" in said


@pytest.mark.parametrize(
    ("velocities", "said"),
    [
        ([0.0, 1.0, 0.0], None),
        ([0.019, 1.0, -0.019], None),
        ([0.5, 1.0, 0.0], "begins at 0.5 m/s, 50 % of its peak, at 0.002 s, a jump"),
        ([0.0, 1.0, -0.25], "ends at -0.25 m/s, 25 % of its peak, at 0.004 s, a jump"),
        ([1.0, 1.0, 1.0], "begins at 1 m/s, 100 % of its peak, at 0.002 s and ends at 1 m/s"),
    ],
)
def test_a_history_that_jumps_at_its_ends_is_warned_of(bar, tmp_path, velocities: list, said: str | None) -> None:
    path = tmp_path / "wave.txt"
    np.savetxt(path, np.transpose([[0.0, 0.001, 0.002], velocities]))
    wave = {"type": "file", "path": str(path), "start": 0.002}
    found = list(wave_use_warnings(bar({"wave.pulse": wave, "run.duration": 0.01})))
    assert len(found) == (said is not None)
    assert said is None or said in found[0]
    if velocities[0] == 0.0:  # an end after the run is none of it
        assert list(wave_use_warnings(bar({"wave.pulse": wave, "run.duration": 0.004}))) == []
