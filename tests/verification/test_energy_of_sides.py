"""Energies that come in through each side and that it absorbs add up to the work from outside, exactly."""

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.motion.energy import Ledger

PULSE = {"type": "cosine", "amplitude": 0.5, "period": 0.02}
IN = {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}
GRIP = {"type": "velocity", "wave_s": "pulse"}
FIELD = {side: "free_field" for side in ("left", "right")}
EPS = np.finfo(float).eps
STEPS = 400


def ledger_of(lab, scene, start=None, steps: int = STEPS, time_step: float | None = None) -> Ledger:
    """The ledger of some steps, an entry every twenty."""
    simulation = lab.simulation(scene, start, time_step, side_stride=1)
    ledger = lab.ledger(simulation, 20)
    simulation.run(steps + 1)
    return ledger


def closes(ledger: Ledger) -> None:
    """To the rounding of sums of so many steps, each by ε of the largest of what is added and subtracted."""
    size = np.abs(ledger.side_columns).sum(axis=1).max()
    assert size > 1.0
    net = (ledger.side_columns @ (1.0, -1.0, -1.0)).sum(axis=1)  # came in − absorbed − stored
    outside = [entry.outside for entry in ledger.entries]
    np.testing.assert_allclose(net, outside, rtol=0.0, atol=STEPS * EPS * size)


@pytest.mark.parametrize(
    ("boundary", "damp"),
    [
        ({"left": IN, "bottom": "viscous", "right": "fixed"}, 0.2),
        ({"bottom": {"type": "viscoelastic_input", "wave_p": "pulse", "distance": 3.0}, "top": "symmetry"}, 0.0),
        ({"bottom": GRIP, "left": {"type": "viscoelastic", "distance": 5.0}, "top": "roller"}, 0.2),
        ({"bottom": IN} | FIELD, 0.0),
    ],
)
def test_sides_are_all_of_the_outside(lab, boundary, damp):
    scene = lab.scene("B", (20.0, 10.0), held=(), boundary=boundary, wave=PULSE, material={"damp": damp})
    ledger = ledger_of(lab, scene)
    closes(ledger)
    assert not any(entry.loads for entry in ledger.entries)
    assert (ledger.side_columns[:, :, 1] >= -1e-3 * np.abs(ledger.side_columns).max()).all()


def test_sides_are_all_of_the_outside_of_settled_ground(lab):
    """Springs are stretched from where the ground rests."""
    scene = lab.scene(
        "B",
        (10.0, 10.0),
        held=(),
        boundary={
            "left": {"type": "viscoelastic", "distance": 5.0},
            "bottom": {"type": "viscoelastic_input", "wave_p": "pulse", "distance": 9.0},
        },
        wave=PULSE,
        load=[{"acceleration": [0.0, -9.81]}],
        static={"boundary": {"left": {"type": "roller"}, "bottom": {"type": "fixed"}}},
    )
    ledger = ledger_of(lab, scene, settle(scene).start)
    closes(ledger)
    stored = ledger.side_columns[:, :, 2]
    assert (stored >= 0.0).all()
    assert (stored[0] == 0.0).all()
    assert stored.max() > 0.0
    assert max(abs(entry.error) for entry in ledger.entries) < 1e-9 * stored.max()


def test_loads_are_the_rest(lab):
    """A pulse of a load with Σ F·v Δt done by hand, at the velocities at whole steps."""
    load = [{"position": [5.0, 5.0], "force": [1e6, 0.0], "wave": "pulse"}]
    scene = lab.scene(
        "B", (10.0, 10.0), held=(), boundary={"left": {"type": "viscoelastic", "distance": 5.0}}, wave=PULSE, load=load
    )
    simulation = lab.simulation(scene, probes=np.unique(scene.supports.node[scene.supports.drive_row]), side_stride=1)
    ledger, step = lab.ledger(simulation, 100), simulation.time_step
    record = simulation.advance(101)
    force = 1e6 * scene.case.wave["pulse"].velocity(step * np.arange(101))
    power = force * record[:, 0, 3]
    done = step * (power[:-1].sum() + 0.5 * force[-1] * (record[-1, 0, 3]))
    # the last half step is at the velocity before it, not at the mean: a Δt/2 of the mean velocity's change
    assert ledger.entries[-1].loads == pytest.approx(done, rel=0.01)
    assert ledger.side_columns[-1, 0, 1] > 0.0
    assert ledger.entries[-1].loads > ledger.side_columns[-1, 0, 1]


@pytest.mark.parametrize("beta", [0.5, 3.0])
def test_a_mismatched_end_absorbs_all_but_the_reflected_part(lab, rock, beta):
    """R = (1 − β)/(1 + β) of the velocity returns, so R² of the energy, which the matched left end then absorbs."""
    scene = rock.scene(
        {"type": "finite_difference"},
        boundary={"left": {"type": "viscous_input", "wave_p": "pulse"}, "right": {"type": "viscous", "beta_p": beta}},
        wave=rock.triangle(1e-4),
    )
    step = rock.step(scene, 1.0)
    ledger = ledger_of(lab, scene, steps=int(3.0 / rock.speed / step), time_step=step)
    left, right = ledger.side_columns[-1]
    back = ((1.0 - beta) / (1.0 + beta)) ** 2
    assert right[1] / left[0] == pytest.approx(1.0 - back, rel=1e-9)
    assert left[1] / left[0] == pytest.approx(back, rel=1e-9)
