"""The energy ledger closes under the elastic law, and begins where settled ground rests."""

import numpy as np

from dembound.disks.rest.stage import settle


def test_elastic_books_close(lab):
    """To rounding: 400 steps of sums, each rounded by ε of the total.

    A pulse enters a block of random disks through a viscous side, is reflected by free ones and leaves through another.
    """
    scene = lab.scene(
        "B",
        (40.0, 10.0),
        held=(),
        material={"damp": 0.3},
        boundary={"left": {"type": "viscous_input", "wave_p": "pulse"}, "bottom": "viscous"},
        wave=lab.pulse(0.02),
        confining_stress=2e6,
    )
    simulation = lab.simulation(scene)
    ledger = lab.ledger(simulation, 20)
    simulation.run(400)
    most, last = max(abs(entry.outside) for entry in ledger.entries), ledger.entries[-1]
    assert max(abs(entry.error) for entry in ledger.entries) < 400 * np.finfo(float).eps * most
    assert last.kinetic > 0.0 and last.contact > 0.0 and last.bond > 0.0  # noqa: PT018
    assert last.damping > 0.0
    assert last.friction == last.crack == 0.0


def test_books_of_settled_ground_begin_where_it_rests(lab):
    """A P wave lifts ground: what its weight takes the settled reactions give, which do not count as given.

    The sum of what boundaries and weight bring in then stays below zero. Counted from the ground as built, the way that
    it sank in the static stage would be work of the run's, many times the wave's energy.
    """
    scene = lab.scene(
        "B",
        (20.0, 20.0),
        held=(),
        material={"law": "linearpbond", "fric": 0.5},
        boundary={"left": "roller", "right": "roller", "bottom": {"type": "viscous_input", "wave_p": "pulse"}},
        wave={"type": "cosine", "amplitude": 0.02, "period": 0.05},
        load=[{"acceleration": [0.0, -9.81]}],
        static={"boundary": {"left": {"type": "roller"}, "right": {"type": "roller"}, "bottom": {"type": "fixed"}}},
    )
    simulation = lab.simulation(scene, settle(scene).start)
    ledger = lab.ledger(simulation, 20)
    simulation.run(int(0.1 / simulation.time_step))
    rest = ledger.entries[0]
    given = max(entry.outside for entry in ledger.entries)
    assert (rest.load, rest.balance) == (0.0, 0.0)
    assert rest.kinetic < 1e-12 * given
    assert max(entry.outside + entry.load for entry in ledger.entries) < 0.1 * given
    assert max(abs(entry.error) for entry in ledger.entries) < 1e-3 * given
