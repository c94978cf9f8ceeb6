"""The ledger closes where contacts open, close, slide and break: what remains is of rotating normals.

With forces at whole steps a contact that closes takes, and one that opens gives, up to ½k_n ab, with the overlap a and
the gap b on either side; the first push takes a twentieth more. All of it is counted contact by contact, from overlaps
alone, while the kinetic energy is that of the motion: a force that does other work than is counted leaves an error.
"""

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

UNACCOUNTED = 0.005
"""Largest error over the supplied energy, also after 200,000 steps."""

SHORTLY = 1e-4
"""Largest energy error after some thousand steps: a first push counted by half only would leave 0.2 to 1 %."""

BROKEN = {"pb_ten": 1e5, "pb_coh": 1e5}


def run(
    lab, pattern: str, steps: int, *, done: int | None = None, noise: float = 0.0, size=(5.0, 2.5), **words
) -> tuple[Simulation, Ledger]:
    """A body whose disks begin with random velocities, and the twenty entries of its ledger.

    done : steps after which it is returned, of these; None: all.
    """
    if pattern != "A":
        words["brick"] = (2.5, 2.5)
    words["material"] = {"law": "linearpbond", "fric": 0.5, "elastic_start": False} | words.get("material", {})
    scene = build(lab.case(pattern, size, held=(), **words))
    simulation = Simulation(scene, choose_step(scene)[0])
    thrown = np.random.default_rng(5).standard_normal((3, scene.count)) * scene.free[:, None]
    simulation.state.velocity = noise * thrown * np.array([[1.0], [1.0], [1.0 / lab.diameter]])
    ledger = Ledger(simulation, steps // 20, last=steps - 1)
    simulation.track(ledger)
    simulation.run(steps if done is None else done)
    return simulation, ledger


def kicked_row(lab, steps: int, share: float = 1.0, done: int | None = None, **material) -> tuple[Simulation, Ledger]:
    """A row of 12 disks of 1 m, pushed aslant at one end for 10 ms: it vibrates, turns, and its contacts clap."""
    push = {"force": [2e6 * share, 1e6 * share], "region": [0.0, 0.0, 3.6, 0.6], "wave": "pulse"}
    wave = {"type": "cosine", "amplitude": 1.0, "period": 0.01}
    return run(lab, "A", steps, done=done, size=(12.0, 1.0), radius=0.5, load=[push], wave=wave, material=material)


def unaccounted(ledger: Ledger) -> float:
    """Largest error over the supplied energy."""
    return max(abs(entry.error) for entry in ledger.entries) / ledger.entries[-1].supplied


@pytest.mark.parametrize("geometry", ["updated", "reference"])
def test_a_kicked_row_accounts_for_all_its_energy(lab, geometry):
    """Known failure: 12 % were missing after 5.5 s, 14,000 steps."""
    _, ledger = kicked_row(lab, 5000, geometry=geometry)
    last = ledger.entries[-1]
    assert last.closing > 0.01 * last.supplied
    # with normals that do not turn only rounding is left, of 5,000 steps
    assert unaccounted(ledger) < (SHORTLY if geometry == "updated" else 5000 * np.finfo(float).eps)


@pytest.mark.parametrize(
    ("pattern", "noise", "material", "geometry"), [("B", 0.3, BROKEN, "updated"), ("C", 0.1, {}, "reference")]
)
def test_bodies_and_debris_account_for_all_their_energy(lab, pattern, noise, material, geometry):
    _, ledger = run(lab, pattern, 1500, noise=noise, material={"geometry": geometry} | material)
    assert unaccounted(ledger) < SHORTLY
    for column in ("friction", "crack"):  # they never give energy
        assert np.all(np.diff([getattr(entry, column) for entry in ledger.entries]) >= 0.0)
    last = ledger.entries[-1]
    assert (last.crack > 0.0) == bool(material)
    assert last.closing != 0.0


def test_energy_from_nowhere_is_not_taken_for_that_of_contacts(lab):
    """All disks of a row whose contacts clap move 2 % faster from one step to the next: 4 % of the kinetic energy."""
    simulation, ledger = kicked_row(lab, 2000, done=1000)
    before = simulation.state.velocity
    simulation.state.velocity = 1.02 * before
    added = 0.5 * float(np.sum(lab.inertia(simulation.scene) * before**2)) * (1.02**2 - 1.0)
    simulation.run(2000)
    # the work ½F·(v⁻ + v⁺)Δt of the step changes too, by 2 % of what a step turns over
    assert ledger.entries[-1].error == pytest.approx(added, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("share", "material"),
    [(1.0, {}), (1.0, {"fric": 0.0}), (1.0, {"fric": 1.0}), (0.1, {}), (1.0, {"geometry": "reference"})],
)
def test_a_kicked_row_does_so_for_long(lab, share, material):
    assert unaccounted(kicked_row(lab, 200_000, share, **material)[1]) < UNACCOUNTED


@pytest.mark.slow
@pytest.mark.parametrize("geometry", ["updated", "reference"])
@pytest.mark.parametrize("material", [{}, BROKEN], ids=["whole", "pile"])
@pytest.mark.parametrize("pattern", ["A", "B", "C"])
def test_bodies_and_piles_do_so_for_long(lab, pattern, material, geometry):
    """A free body in noise, and a pile of debris that falls in a box under its weight."""
    words = {}
    if material:
        words["boundary"] = {"bottom": "fixed", "left": "roller", "right": "roller"}
        words["load"] = [{"acceleration": [0.0, -9.81]}]
    noise = 1.0 if material else 0.1
    _, ledger = run(lab, pattern, 200_000, noise=noise, material={"geometry": geometry} | material, **words)
    assert unaccounted(ledger) < UNACCOUNTED
