"""The law that disks begin with, and the forces that are steady under it."""

import numpy as np
import pytest
from disk_systems import AT_ONCE, BONDED, ELASTIC, SIDES, STEP, WITH_HISTORY, begun, locked_in_forces
from small_cases import small

from dembound.disks.scene import build
from dembound.disks.stepping.system import DiskSystem
from dembound.kinds.disks.kind import Disks
from dembound.kinds.disks.warnings import disk_warnings
from dembound.motion.simulation import Simulation


@pytest.mark.parametrize("law", ["elastic", "linearpbond"])
@pytest.mark.parametrize("side", ["fixed", "roller"])
def test_a_body_whose_support_is_taken_away_falls_freely(law: str, side: str) -> None:
    """Its centre falls by ½gt² while waves run in it; with its reactions it hangs where it was."""
    kept, fallen = (
        small(
            {
                "packing": {"pattern": "A", "size": [1.5, 1.5], "radius": 0.25},
                "material": {"law": law, "density": 2000.0, "p_wave_speed": 300.0, "fric": 0.5},
                "load": [{"name": "gravity", "acceleration": [0.0, -9.81]}],
                "static": {"boundary": {"bottom": {"type": side, "reactions": reactions}}},
                "run": {"duration": 0.1},
                "output": {"pictures": False},
            }
        )
        for reactions in ("kept", "none")
    )
    moved = []
    for case in (kept, fallen):
        scene, steps, step = build(case), 50, 1e-4
        begun = Disks().begin(scene, step, lambda *_: None)
        run = Simulation(scene, step, system=begun.system, datum=begun.datum)
        run.advance(steps)
        moved.append(np.average((run.state.displacement - run.state.datum)[:2], axis=1, weights=scene.mass))
    np.testing.assert_allclose(moved[0], 0.0, atol=1e-15)
    time = steps * step  # leapfrog after half a kick: g Δt² (1/2 + 3/2 + … + (n − 1/2))
    np.testing.assert_allclose(moved[1], [0.0, -0.5 * 9.81 * time**2], atol=1e-4 * 9.81 * time**2)
    hangs = [[line for line in disk_warnings(build(case), step) if "hold a side" in line] for case in (kept, fallen)]
    assert [len(lines) for lines in hangs] == [1, 0]
    assert hangs[0][0].startswith("static.boundary.bottom: bears load.gravity along y, as no side does in the run")


@pytest.mark.parametrize("at_once", [False, True])
@pytest.mark.parametrize("boundary", SIDES.values(), ids=SIDES)
def test_what_is_locked_in_pushes_a_body_as_built_under_either_law(loose, boundary: dict, at_once: bool) -> None:
    body = loose(**WITH_HISTORY, **(AT_ONCE if at_once else {}), boundary=boundary)
    system = DiskSystem(body, STEP)
    state = begun(system)

    # beside a free field it also comes across the seam, of which the elastic law does not know
    if at_once or boundary:
        assert state.laws == [(BONDED, 0)]
        assert not system.steady.any()  # the pairs push with it themselves
    else:
        assert state.laws == [(ELASTIC, 0)]
        assert np.array_equal(system.steady, locked_in_forces(body))
        assert np.abs(system.steady).max() > 1e5
    assert {part.law_name for part in system.parts} == {state.laws[0][0]}
    assert system.balance is None
    assert not any(part.stops_at_breaks for part in system.parts)
