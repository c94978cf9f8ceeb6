"""Mistakes in [damping] and material.quality_factor."""

import pytest

from dembound.disks.surroundings.frequencies import BAND, band_of, mechanisms_of
from dembound.errors import CaseError

Q = {"material.quality_factor": 20.0}
HISTORY = {"material.law": "linearpbond", "material.fric": 0.5}
RAYLEIGH = {"damping.type": "rayleigh"}
OUTSIDE = {"boundary.right": {"type": "outside"}, "motion.held": []}
STILL = {"boundary": {}, "wave": {}}


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"damping.band": [1.0, 10.0]}, "damping: is of no use without material.quality_factor"),
        (Q | {"damping.band": [10.0, 1.0]}, r"damping.band: is \[10, 1\], must be two frequencies above 0"),
        (Q | RAYLEIGH | {"damping.mechanisms": 3}, 'damping.mechanisms: is only allowed with type = "quality"'),
        (Q | RAYLEIGH | OUTSIDE, 'damping.type: is "rayleigh", which ground beyond boundary.right cannot have; take'),
        (Q | {"material.damp": 0.1}, "quality_factor: is not allowed together with damp"),
        (Q | HISTORY, 'quality_factor: .* bonds break under law = "linearpbond"; give law = "elastic"'),
    ],
)
def test_each_mistake_names_what_works(bar, changes: dict, line: str) -> None:
    with pytest.raises(CaseError, match=line):
        bar(changes)


def test_a_layer_may_be_damped_alone_and_waves_at_an_angle_are_refused(bar) -> None:
    grains = {"pattern": "A", "radius": 0.25, "size": [8.0, 8.0]}
    layers = {"packing": grains, "layer": [{"thickness": 4.0, "quality_factor": 20.0}, {}], "damping.mechanisms": 2}
    assert bar(layers).is_damped
    sides = {side: {"type": "outside"} for side in ("left", "right", "bottom", "top")}
    inclined = {"boundary": sides, "incident": {"type": "sv", "angle": 10.0, "wave": "pulse"}, "motion.held": []}
    with pytest.raises(CaseError, match=r"incident.angle: is 10, must be 0 in damped ground"):
        bar(layers | inclined)
    straight = inclined | {"incident": {"type": "sv", "angle": 0.0, "wave": "pulse"}}
    with pytest.raises(CaseError, match="incident: needs one quality_factor in all layers"):
        bar(layers | straight)
    bar(Q | straight)


def test_the_band_is_that_of_the_waves(bar) -> None:
    low, high = band_of(bar())

    assert high / low == pytest.approx(BAND[1] / BAND[0], rel=5e-3)  # three digits
    assert band_of(bar({"wave.pulse.period": 2.0 * bar().wave["pulse"].period}))[1] == pytest.approx(
        0.5 * high, rel=0.01
    )
    assert band_of(bar({**STILL, "monitor": []})) == BAND


def test_speeds_hold_at_the_middle_of_the_band_unless_a_frequency_is_given(bar) -> None:
    for changes, frequency in (({}, 3.16), ({"damping.frequency": 2.0}, 2.0)):
        found = mechanisms_of(bar(Q | {"damping.band": [1.0, 10.0]} | changes), 20.0)
        assert found.frequency == frequency
        assert found.band == (1.0, 10.0)
