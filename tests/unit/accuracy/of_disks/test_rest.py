"""Errors by the rest of a static stage, as forces over that of a wave, and where there is none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.accuracy.history import History
from dembound.accuracy.of_disks.rest import CHANCE, CHANCE_STRESSED, causes_of_rest
from dembound.disks.scene import DiskScene, build

STATIC: dict[str, Any] = {"elastic": False, "ratio": 1e-7, "mean_residual": 3e-3, "cracks": 0}
STATIC |= {"before": None, "column": None}
PEAK = 2e-3


def scene(**static: float) -> DiskScene:
    weight = {"name": "weight", "acceleration": [0.0, -9.81]}
    boundary = {"left": {"type": "periodic"}, "right": {"type": "periodic"}, "bottom": {"type": "viscous"}}
    held = {"boundary": {"bottom": {"type": "fixed"}}, **static}
    changes = {"boundary": boundary, "wave": {}, "load": [weight], "static": held}
    return build(small(PUSHED, changes={**changes, "material.law": "linearpbond"}))  # type: ignore[arg-type]


def motions(peak: float) -> dict[str, History]:
    """A monitor that moves along y, and turns faster, which does not count."""
    velocity = np.array([[0.0, 0.0, 0.0], [0.0, -peak, 7.0], [0.0, 0.5 * peak, 0.0]])
    return {"front": History.of(np.zeros(2), np.arange(3.0), velocity, velocity)}


@pytest.mark.parametrize(("static", "chance"), [({}, CHANCE), ({"k0": 0.5}, CHANCE_STRESSED)])
def test_the_error_is_the_force_of_rest_over_that_of_the_wave(static: dict[str, float], chance: float) -> None:
    """S waves are the slower ones: without friction bonds alone bear shear, half of all, and C66 is half of that."""
    body = scene(**static)
    (cause,) = causes_of_rest(body, motions(PEAK), STATIC).found
    slow = 1000.0 * np.sqrt(0.25)
    force = 3e-3 + chance * 3e-3 / 1e-7  # left, and by chance, of the mean contact force 3e4 N
    assert cause.parts["front"]["velocity"] == pytest.approx(force / (2500.0 * slow * 0.5 * PEAK), rel=1e-3)
    assert cause.parts["front"]["displacement"] == cause.parts["front"]["velocity"]


def test_nothing_is_said_without_sliding_and_nothing_is_known_with_breaks() -> None:
    body, moved = scene(), motions(PEAK)
    assert causes_of_rest(body, moved, STATIC | {"elastic": True}).found == []
    for broken in ({"cracks": 3}, {"column": STATIC | {"cracks": 3}}, {"before": STATIC | {"cracks": 3}}):
        (cause,) = causes_of_rest(body, moved, STATIC | broken).found
        assert cause.how == "unknown"
        assert cause.words.startswith("3 bonds broke while")
    (cause,) = causes_of_rest(body, moved, STATIC | {"before": STATIC | {"elastic": True}}).unknown
    assert "excavation" in cause.words
    assert np.isnan(causes_of_rest(body, motions(0.0), STATIC).found[0].parts["front"]["velocity"])
