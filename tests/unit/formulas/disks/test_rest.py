"""Errors by the rest of a static stage, as forces over that of a wave, and where there is none."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.disks.scene import DiskScene, build
from dembound.formulas.disks.rest import CHANCE, CHANCE_LATTICE, CHANCE_STRESSED, _way, causes_of_rest
from dembound.formulas.history import History
from dembound.holes import Circle
from dembound.motion.paths import Source
from dembound.table import EVERYWHERE

STATIC: dict[str, Any] = {"elastic": False, "ratio": 1e-7, "mean_residual": 3e-3, "cracks": 0}
STATIC |= {"before": None, "column": None}
PEAK = 2e-3


GRAINS = {"pattern": "B", "size": [10.0, 2.5], "radius": 0.25, "brick": [5.0, 2.5], "radius_ratio": 1.5, "seed": 1}


def scene(packing: dict[str, Any] = PUSHED["packing"], share: float = 0.5, **static: float) -> DiskScene:
    weight = {"name": "weight", "acceleration": [0.0, -9.81]}
    boundary = {"left": {"type": "periodic"}, "right": {"type": "periodic"}, "bottom": {"type": "viscous"}}
    held = {"boundary": {"bottom": {"type": "fixed"}}, **static}
    changes = {"boundary": boundary, "wave": {}, "load": [weight], "static": held, "packing": packing}
    return build(small(PUSHED, changes={**changes, "material.law": "linearpbond", "material.contact_share": share}))


def motions(peak: float) -> dict[str, History]:
    """A monitor that moves along y, and turns faster, which does not count."""
    velocity = np.array([[0.0, 0.0, 0.0], [0.0, -peak, 7.0], [0.0, 0.5 * peak, 0.0]])
    return {"front": History.of(np.zeros(2), np.arange(3.0), velocity, velocity)}


@pytest.mark.parametrize("static", [{}, {"k0": 0.5}])
def test_the_error_is_the_force_of_rest_over_that_of_the_wave(static: dict[str, float]) -> None:
    """S waves are the slower ones: without friction bonds alone bear shear, half of all, and C66 is half of that."""
    body = scene(**static)
    (cause,) = causes_of_rest(body, motions(PEAK), STATIC).found
    slow = 1000.0 * np.sqrt(0.25)
    force = 3e-3 + CHANCE_LATTICE * 3e-3 / 1e-7  # left, and by chance, of the mean contact force 3e4 N
    assert cause.parts["front"]["velocity"] == pytest.approx(force / (2500.0 * slow * 0.5 * PEAK), rel=1e-3)
    assert cause.parts["front"]["displacement"] == pytest.approx(0.3 * cause.parts["front"]["velocity"])


def test_chance_is_larger_in_random_packings_and_least_beside_a_stress_at_rest() -> None:
    """Over a mean contact force of 3e4 N, with nothing left but chance."""
    settled = STATIC | {"mean_residual": 3e-13, "ratio": 1e-17}
    found = []
    for static in ({}, {"k0": 0.5}):
        (cause,) = causes_of_rest(scene(GRAINS, **static), motions(PEAK), settled).found
        found.append(cause.parts["front"]["velocity"])
    assert found[0] / found[1] == pytest.approx(CHANCE / CHANCE_STRESSED)


def test_nothing_is_said_without_sliding_and_nothing_is_known_with_breaks() -> None:
    body, moved = scene(), motions(PEAK)
    assert causes_of_rest(body, moved, STATIC | {"elastic": True}).found == []
    for broken in ({"cracks": 3}, {"column": STATIC | {"cracks": 3}}, {"before": STATIC | {"cracks": 3}}):
        (cause,) = causes_of_rest(body, moved, STATIC | broken).found
        assert cause.how == "unknown"
        assert cause.words.startswith("3 bonds broke while")
    cave = Circle(type="circle", name="cave", centre=(5.0, 1.2), radius=0.6)
    (cause,) = causes_of_rest(replace(body, case=replace(body.case, hole=(cave,))), moved, STATIC).unknown
    assert "hole" in cause.words
    (cause,) = causes_of_rest(scene(share=0.6), moved, STATIC).unknown
    assert "that they bear more than bonds" in cause.words
    assert np.isnan(causes_of_rest(body, motions(0.0), STATIC).found[0].parts["front"]["velocity"])


def test_a_wave_on_all_sides_runs_through_the_scene() -> None:
    size, there = (3.0, 4.0), np.array([1.0, 1.0])
    assert _way(Source(EVERYWHERE, 0.0, 1.0, 500.0), there, size) == 5.0
    assert _way(Source((2.0, 1.0, 2.0, 1.0), 0.0, 1.0, 500.0), there, size) == 1.0
