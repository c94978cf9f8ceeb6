"""Waves that reach a side: kinds and angles."""

import math

import numpy as np
import pytest
from small_cases import GRAINS, SURROUNDED, small

from dembound.continuum.sizing import Signal
from dembound.disks.reflection.arrivals import arrivals_of, over_spectrum
from dembound.disks.scene import ground_of
from dembound.waves import FileWave

POINT = {"name": "blow", "position": [2.0, 4.0], "force": [0.0, -1e3], "wave": "pulse"}


def test_driven_sides_send_waves_along_the_normal_and_loads_spread_them() -> None:
    case = small(GRAINS | {"load": [POINT]})
    ground = ground_of(case)
    assert [(each.name, each.kinds) for each in arrivals_of(case, "top", ground)][:2] == [
        ("wave pulse along the normal", ("p",)),
        ("wave pulse along the normal", ("s",)),
    ]
    (spreading,) = arrivals_of(case, "right", ground)
    assert spreading.name == "waves from load blow"
    assert spreading.kinds == ("p", "s")
    # the side is 6 m from the load, which is at its upper end: angles from 0 to atan(4/6)
    assert spreading.angles.max() == pytest.approx(math.degrees(math.atan2(4.0, 6.0)))
    assert spreading.angles.min() == pytest.approx(0.0)
    assert spreading.shares.sum() == pytest.approx(1.0)
    # cos θ / r of waves that spread in the plane: cos² θ at the same distance of the side
    np.testing.assert_allclose(
        spreading.shares / spreading.shares.max(), np.cos(np.radians(spreading.angles)) ** 2, rtol=1e-12
    )


@pytest.mark.parametrize(("side", "angle"), [("bottom", 20.0), ("top", 20.0), ("left", 70.0), ("right", 70.0)])
def test_an_incident_wave_meets_upright_sides_at_the_complement_of_its_angle(side: str, angle: float) -> None:
    case = small(SURROUNDED | {"incident": {"type": "sv", "angle": -20.0, "wave": "pulse"}, "wave": GRAINS["wave"]})
    (only,) = arrivals_of(case, side, ground_of(case))
    assert only.kinds == ("s",)
    assert only.angles.tolist() == [angle]


def test_a_load_on_the_side_does_not_reach_it_and_without_sources_all_directions_do() -> None:
    case = small(GRAINS | {"load": [POINT | {"position": [8.0, 2.0]}]})
    (only,) = arrivals_of(case, "right", ground_of(case))
    assert only.name == "waves from all directions"
    np.testing.assert_allclose(only.shares / only.shares[0], np.cos(np.radians(only.angles)))


def test_shares_are_weighted_with_the_spectrum_of_the_wave() -> None:
    """Two tones of amplitudes 2 and 1 have 4/5 and 1/5 of the energy; of a force √f times as large amplitudes.

    The tones last 100 and 1000 periods, so that 1/(2π²·100) = 5e-4 or somewhat more of the energy is far from them.
    """
    times = np.arange(20_001) * 0.005
    values = 2.0 * np.sin(2.0 * np.pi * times) + np.sin(20.0 * np.pi * times)
    text = "\n".join(f"{time:.3f} {value!r}" for time, value in zip(times, values.tolist(), strict=True))
    tones = FileWave.model_validate({"type": "file", "path": "tones.txt"}, context={"files": {"tones.txt": text}})
    shares = np.array([[0.1, 0.3, 0.2], [0.6, 0.3, np.nan]])
    found = over_spectrum(shares, np.array([1.0, 10.0]), Signal(tones, is_force=False))
    np.testing.assert_allclose(found, [0.2, 0.3, 0.2], rtol=5e-3)
    of_force = over_spectrum(shares, np.array([1.0, 10.0]), Signal(tones, is_force=True))
    np.testing.assert_allclose(of_force, [(4.0 * 0.1 + 10.0 * 0.6) / 14.0, 0.3, 0.2], rtol=5e-3)
    # halfway between two frequencies in log f the mean of both shares, beyond them that of the nearer one
    np.testing.assert_allclose(
        over_spectrum(np.array([[0.0], [1.0]]), np.array([0.1, 10.0]), Signal(tones, is_force=False)), 0.6, rtol=1e-2
    )
    np.testing.assert_allclose(over_spectrum(shares, np.array([1.0, 10.0]), None), [0.35, 0.3, 0.2])
    assert np.isnan(over_spectrum(np.full((2, 1), np.nan), np.array([1.0, 10.0]), None)).all()
