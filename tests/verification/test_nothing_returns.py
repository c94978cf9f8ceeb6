"""From the sides of an extended scene nothing returns to a monitor within the run, and the scene is not much too large.

The scene is compared with the one extended for a run half as long again. Up to its own duration both must move alike
but for the precursors of the fastest waves, 1e-9 of an impulse, and less of a smooth pulse (`motion.paths.Front`).
A scene extended for 0.7 of the duration must differ from it: within 30 % of the run the first echo, which is a small
part of the wave at first, grows far above that.
"""

import numpy as np
import pytest

from dembound.accuracy.judge import extended
from dembound.bar.scene import build_bar
from dembound.casefile.bar import BarCase
from dembound.disks.scene import build
from dembound.kinds import with_changes
from dembound.motion.simulation import Simulation
from dembound.running import plan

ALIKE = 1e-9
"""Largest difference over the largest velocity."""

SPLINE = {"type": "cubic_spline", "amplitude": 1.0, "period": 0.01}


def velocities(case, duration):
    """(k, p, 2) m/s of the monitors up to a time, at the steps of the case."""
    scene = build_bar(case) if isinstance(case, BarCase) else build(case)
    nodes = [scene.monitors[monitor.name] for monitor in case.monitor]
    simulation = Simulation(scene, case.run.time_step, nodes)
    return simulation.advance(round(duration / case.run.time_step))[:, :, 3:5]


def with_step(case):
    """The case with the step that it has anyway, so that runs of any duration share it."""
    return with_changes(case, {"run.time_step": plan(case).time_step})


def for_run_of(case, duration):
    return extended(with_changes(case, {"run.duration": duration})).case


def assert_nothing_returns(case, too_soon=0.7):
    case, duration = with_step(case), case.run.duration
    own, later, sooner = (velocities(for_run_of(case, share * duration), duration) for share in (1.0, 1.5, too_soon))
    largest = np.abs(later).max()
    assert largest > 0.0
    assert np.abs(own - later).max() < ALIKE * largest
    assert np.abs(sooner - later).max() > 1e3 * ALIKE * largest
    return own, later, largest


def monitored(case, *places):
    return with_changes(case, {"monitor": [{"name": f"m{k}", "position": place} for k, place in enumerate(places)]})


@pytest.fixture
def lamb(lab):
    def make(pattern, size, far, **words):
        load = {"force": [0.0, -1e5], "position": [0.25, size[1]], "wave": "pulse"}
        boundary = {"left": "symmetry", "right": far, "bottom": far}
        case = lab.case(pattern, size, held=(), wave=SPLINE, load=[load], boundary=boundary, duration=0.05, **words)
        return monitored(case, [3.0, size[1]], [5.0, 4.0])

    return make


def test_a_blow_on_a_half_space(lamb):
    assert_nothing_returns(lamb("A", (10.0, 10.0), "fixed"))
    assert_nothing_returns(lamb("B", (10.0, 10.0), "viscous"), too_soon=0.4)  # sides move by bricks of 10 m


def test_waves_of_rotation_that_outrun_p_waves(lab):
    # contacts twice as stiff in shear, y held: long waves run at 1000 m/s, the fastest short ones at 1395 m/s; in a
    # scene for 1000 m/s the difference is 4e-4
    stiff = {"fric": 0.5, "kratio": 0.5, "pb_kratio": 0.5}
    load = {"force": [1e5, 0.0], "position": [5.25, 0.25], "wave": "pulse"}
    far = {"top": "fixed", "right": "fixed"}
    wave = {**SPLINE, "period": 0.002}
    case = lab.case("A", (10.0, 10.0), material=stiff, wave=wave, load=[load], boundary=far, duration=0.04)
    assert_nothing_returns(monitored(case, [5.25, 4.0]))


def test_waves_scattered_by_a_hole_beside_a_free_field(lab):
    boundary = {"left": "free_field", "right": "free_field", "bottom": {"type": "viscous_input", "wave_s": "pulse"}}
    case = lab.case("A", (12.0, 10.0), held=(), wave=lab.pulse(0.01), boundary=boundary, duration=0.04)
    hole = {"name": "tunnel", "type": "circle", "centre": [4.0, 5.0], "radius": 1.6}
    case = monitored(with_changes(case, {"hole": [hole]}), [6.0, 5.0], [4.0, 10.0])
    own, _, largest = assert_nothing_returns(case)

    assert np.abs(own).max() == pytest.approx(largest, rel=1e-6)
    wider = for_run_of(with_step(case), 0.04)
    assert wider.packing.extent[0] > 12.0
    assert wider.packing.extent[1] == 10.0  # a deeper base would send another wave


def test_a_rock_bar(rock):
    method, table = {"type": "peridynamics", "horizon": 3}, {"right": {"type": "viscous"}}
    load = {"pressure": 1e6, "side": "left"}
    wave = rock.triangle(5e-5)
    case = rock.scene(method, spacing=5e-3, load=load, wave=wave, boundary=table).case
    case = with_changes(case, {"run.duration": 1e-3, "monitor": [{"name": "end", "position": 0.9}]})
    assert_nothing_returns(case)
