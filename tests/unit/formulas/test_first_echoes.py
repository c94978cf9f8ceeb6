"""Times of echoes at monitors, computed by hand."""

from dembound.motion.kind import echoes
from dembound.running import plan

LONG = {
    "packing.size": [100.0, 1.0],
    "boundary.left": {"type": "velocity", "wave_p": "pulse"},
    "run.duration": 0.4,
    "monitor": [{"name": "near", "position": [20.25, 0.75]}, {"name": "far", "position": [90.25, 0.75]}],
}
BLOW = {"name": "blow", "force": [1e5, 0.0], "position": [30.25, 30.25], "wave": "pulse"}
COLUMN = {
    "packing.size": [60.0, 60.0],
    "motion.held": [],
    "boundary": {"left": {"type": "free_field"}, "right": {"type": "free_field"}, "bottom": {"type": "viscous"}},
    "monitor": [{"name": "P", "position": [40.25, 30.25]}],
    "load": [BLOW],
    "run.duration": 0.2,
}


def lines(case):
    return dict(echoes(plan(case)))


def test_the_first_monitor_that_an_echo_comes_to_is_named(bar) -> None:
    # 100 m there and 9.75 m back at 1000 m/s, a little earlier by what runs ahead on a lattice
    assert lines(bar(LONG)) == {"echoes": "right (viscous) may reflect to far from 0.11 s on"}
    assert lines(bar({**LONG, "run.duration": 0.1})) == {}
    assert lines(bar({**LONG, "monitor": []})) == {}
    layer = {"type": "velocity", "wave_p": "pulse"}
    assert lines(bar({**LONG, "boundary": {"left": layer}})) == {}  # a free end is no artificial side


def test_columns_send_back_the_waves_of_local_sources_only(bar) -> None:
    # over the right side 29.75 + 19.75 m, over the left one 30.25 + 40.25 m, over the bottom 30.25 m twice, 10 m apart
    found = lines(bar(COLUMN))["echoes"].split("; ")
    assert [text.split(" from ")[0] for text in found] == [
        f"{side} ({kind}) may reflect to P"
        for side, kind in (("left", "free_field"), ("right", "free_field"), ("bottom", "viscous"))
    ]
    times = [float(text.split(" from ")[1].split(" s")[0]) for text in found]
    for time, way in zip(times, (70.5, 49.5, 61.3), strict=True):
        assert 0.9 * way < 1000.0 * time <= way
    from_below = {"boundary.bottom": {"type": "viscous_input", "wave_s": "pulse"}, "load": []}
    assert lines(bar({**COLUMN, **from_below})) == {}
