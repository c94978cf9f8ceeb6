"""The energy ledger closes under the elastic law, and where contacts open, slide and break.

A pulse enters a block of random disks through a viscous side, is reflected by free ones and leaves through another.
"""

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation


def ledger_of(lab, material: dict, amplitude: float = 0.5) -> Ledger:
    """The books of some 400 steps, an entry every twenty."""
    case = lab.case(
        "B",
        (40.0, 10.0),
        held=(),
        material=material,
        boundary={"left": {"type": "viscous_input", "wave_p": "pulse"}, "bottom": "viscous"},
        wave={"type": "cosine", "amplitude": amplitude, "period": 0.02},
        confining_stress=2e6,
    )
    scene = build(case)
    simulation = Simulation(scene, choose_step(scene)[0])
    ledger = Ledger(simulation, 20)
    simulation.track(ledger)
    simulation.run(400)
    return ledger


def error(ledger: Ledger) -> float:
    """Largest error over the largest work from outside."""
    return max(abs(entry.error) for entry in ledger.entries) / max(abs(entry.outside) for entry in ledger.entries)


@pytest.mark.parametrize("damp", [0.0, 0.3])
def test_elastic_books_close(lab, damp):
    """To rounding: 400 steps of sums, each rounded by ε of the total."""
    ledger = ledger_of(lab, {"damp": damp})
    assert error(ledger) < 400 * np.finfo(float).eps
    last = ledger.entries[-1]
    assert last.kinetic > 0.0 and last.contact > 0.0 and last.bond > 0.0  # noqa: PT018
    assert (last.damping > 0.0) == (damp > 0.0)
    assert last.friction == last.crack == 0.0


def test_books_of_settled_ground_begin_where_it_rests(lab):
    """The way that ground sank in its static stage is no work of the run's: its weight then does none without a motion.

    Counted from the ground as built, that way would bring in more than 1 % of the wave's energy.
    """
    scene = lab.scene(
        "B",
        (10.0, 10.0),
        held=(),
        boundary={"left": "roller", "right": "roller", "bottom": {"type": "viscous_input", "wave_p": "pulse"}},
        wave={"type": "cosine", "amplitude": 0.5, "period": 0.02},
        load=[{"acceleration": [0.0, -9.81]}],
        static={"boundary": {"left": {"type": "roller"}, "right": {"type": "roller"}, "bottom": {"type": "fixed"}}},
    )
    simulation = lab.settled(scene, settle(scene).start)
    ledger = Ledger(simulation, 20)
    simulation.track(ledger)
    simulation.run(400)
    rest = ledger.entries[0]
    assert (rest.kinetic, rest.load, rest.balance, rest.error) == (0.0,) * 4
    # the weight's work is below that of the wave, and so is what the ground has stored at rest: rounding as above
    assert error(ledger) < 400 * np.finfo(float).eps


def test_books_of_contacts_that_open_close(lab):
    """What opening and closing take is counted, so that with normals that do not turn hardly anything is left.

    Uncounted, each would misjudge the work by ½k(Δu_n)², with strains v/c per step and disk some 1e-7 of the energy of
    the disks concerned, up to 200 times.
    """
    ledger = ledger_of(lab, {"law": "linearpbond", "fric": 0.5, "geometry": "reference"})
    assert ledger.entries[-1].friction > 0.0
    assert ledger.entries[-1].closing != 0.0
    assert error(ledger) < 1e-4 * 200 * 1e-7


def test_breaking_bonds_leave_more(lab):
    """Broken bodies clap: contacts meet at speeds of the order of v itself, and open and close all along."""
    material = {"law": "linearpbond", "fric": 0.5, "pb_ten": 1e5, "pb_coh": 1e5}
    ledger = ledger_of(lab, material)
    last = ledger.entries[-1]
    assert last.crack > 0.1 * last.kinetic
    assert error(ledger) < 1e-3
