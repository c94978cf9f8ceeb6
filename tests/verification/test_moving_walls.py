"""A heap that moving walls push: the energy ledger closes, and no bit depends on when disks near walls are listed."""

import hashlib

import numpy as np
import pytest
from small_cases import small

from dembound.disks.scene import build
from dembound.disks.stepping import walls
from dembound.disks.stepping.walls import WallPart
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.running import plan

HEAP = {
    "packing": {"pattern": "A", "size": [8.0, 3.2], "radius": 0.2},
    "material": {"density": 2200.0, "law": "linearpbond", "emod": 2e7, "pb_emod": 0.0, "fric": 0.4, "dp_nratio": 0.2},
    "wall": [
        {"name": "valley", "points": [[-9.0, 3.0], [-4.0, 0.0], [6.0, -0.01], [9.0, -3.0], [30.0, -3.5]], "fric": 0.5},
        {"name": "ram", "points": [[-0.1, 0.1], [-0.1, 6.0]], "fric": 0.3, "dp_nratio": 0.1, "wave_x": "push"},
        {"name": "lift", "points": [[2.0, -0.2], [3.0, -0.2]], "fric": 0.3, "velocity": [0.2, 1.0], "until": 0.4},
    ],
    "wave": {"push": {"type": "cosine", "amplitude": 2.0, "period": 0.6}},
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "run": {"duration": 1.0},
    "output": {"pictures": False},
}
"""Unbonded disks between a ram, a plate that comes up through the floor, and a slope that they fall down."""


def begun() -> Simulation:
    """The simulation of the heap."""
    planned = plan(small(HEAP))
    run = Simulation(planned.scene, planned.time_step)
    run.track(*planned.kind.trackers(run))
    return run


def test_the_ledger_of_disks_on_moving_walls_is_exact(lab) -> None:
    """Of disks that touch flat walls alone: a ram that rubs along one, and one that is lifted and falls back."""
    moving = [
        {"points": [[-1.0, 0.0], [1.0, 0.0]], "fric": 0.3, "velocity": [1.0, 0.5], "until": 0.3, "dp_nratio": 0.2},
        {"points": [[-0.26, -0.5], [-0.26, 1.0]], "fric": 0.5, "velocity": [2.0, -0.5], "until": 0.5},
        {"points": [[4.0, -1.0], [4.0, 3.0]], "fric": 0.2},
    ]
    material = {"law": "linearpbond", "emod": 1e8, "pb_emod": 0.0, "fric": 0.5}
    scene = lab.disks([[0.0, 0.25], [3.0, 2.0]], [0.25, 0.2], held=(), material=material, wall=moving,
                      load=[{"acceleration": [1.0, -9.81]}])  # fmt: skip
    run = lab.simulation(scene)
    ledger = lab.ledger(run, 7)
    run.run(round(0.6 / run.time_step))
    last = ledger.entries[-1]
    assert run.system.work_of_walls == pytest.approx(last.outside, rel=1e-9)
    assert min(last.outside, last.friction, last.damping) > 1e-3 * last.supplied
    assert max(abs(entry.error) for entry in ledger.entries) < 1e-9 * last.supplied  # rounding of sums over 2,000 steps


def test_that_of_a_heap_is_as_of_other_heaps() -> None:
    """To the turn of contacts between disks in a step: 2e-4 here, and less with stiffer disks and shorter steps."""
    run = begun()
    ledger = Ledger(run, 20)
    run.track(ledger)
    run.run(1200)
    last = ledger.entries[-1]
    assert last.outside > 0.1 * last.supplied
    assert last.outside == pytest.approx(run.system.work_of_walls, rel=1e-9)
    assert last.friction > 0.1 * last.supplied
    assert last.damping > 1e-3 * last.supplied
    assert max(abs(entry.error) for entry in ledger.entries) < 4e-4 * last.supplied
    assert min(run.state.displacement[1] + run.scene.positions[:, 1]) < -1.0  # some fall on the lower floor
    assert (run.state.displacement[1] + run.scene.positions[:, 1]).min() > -3.5


BONDED = {"law": "linearpbond", "fric": 0.5, "pb_ten": 1e9, "pb_coh": 1e9}
FREE = {side: {"type": "free_field"} for side in ("left", "right")}


def test_a_wall_moves_as_the_free_field_at_its_place_and_the_ledger_has_its_work(lab) -> None:
    """That is the column's, to the bit, and as the incident wave and that from the surface to 2 % of both.

    The wave of 40 m is known to half a disk of 0.5 m at the entry and at the surface, 2π/160 of its peak each. A plate
    on the ground, which moves as 4 m below, is pushed by the surface, which moves later.
    """
    high, low = {"points": [[20.0, 0.0], [21.0, 20.0]], "moves": "incident"}, {"at": [0.0, 5.9], "moves": "incident"}
    case = lab.case("A", (2.0, 10.0), held=("x",), material=BONDED, wave={"type": "cosine", "amplitude": 0.5,
                    "period": 0.04}, boundary=FREE | {"bottom": {"type": "viscous_input", "wave_p": "pulse"}},
                    wall=[high | {"at": [0.0, 9.75]}, low | {"points": [[-1.0, 10.0], [3.0, 10.0]]}])  # fmt: skip
    scene = build(case)
    run = lab.simulation(scene)
    ledger, row = lab.ledger(run, 20), scene.assembly.positions[: scene.column_count, 1]
    top, two = np.flatnonzero(row > 9.7), [np.flatnonzero(np.abs(row - y) < 0.01) for y in (5.75, 6.25)]
    later, moved = Simulation(scene, run.time_step), []
    for steps in (400, 401, 900):
        run.run(steps)
        column = run.state.displacement[1, : scene.column_count]
        path = run.system.walls.place(steps)
        assert path[0] == pytest.approx([0.0, column[top].mean()], abs=1e-15)
        assert path[1, 1] == pytest.approx(0.7 * column[two[0]].mean() + 0.3 * column[two[1]].mean(), abs=1e-15)
        moved.append(path[0, 1])
        if steps == 400:
            later.state.take(run.state.arrays())
    later.run(900)
    assert np.array_equal(later.state.displacement, run.state.displacement)
    assert np.array_equal(later.system.walls.place(900), run.system.walls.place(900))
    wave, times = case.wave["pulse"], run.time_step * np.array([400, 401, 900])
    ways = np.array([[9.75], [10.25]]) / lab.speed
    assert moved == pytest.approx(wave.displacement(times - ways).sum(axis=0), abs=0.02 * wave.displacement(1.0))
    last = ledger.entries[-1]
    assert abs(run.system.work_of_walls) > 0.01 * last.supplied
    assert max(abs(entry.error) for entry in ledger.entries) < 1e-6 * last.supplied


def outcome(steps: int, every: int) -> tuple[str, int]:
    """A digest of motion, energies and forces on walls, and how often disks near walls were listed.

    every : steps after which they are listed in any case; 0: only when they must be.
    """
    listed, list_disks = 0, WallPart._list

    def counted(self, *words):
        nonlocal listed
        listed += 1
        list_disks(self, *words)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(WallPart, "_list", counted)
        run = begun()
        part = run.system.walls
        for step in [*range(every, steps, every or steps), steps] if every else [steps]:
            run.run(step)
            if every:
                part._list(run.state.u, run.state.step, part.law().slot, part.law().kept)
    motion = np.ascontiguousarray([run.state.displacement, run.state.velocity])
    rest = np.array([*run.state.work[0], *part.stored(run.state.u), part.supplied])
    digest = hashlib.sha256(motion.tobytes() + rest.tobytes() + part.samples(np.arange(steps - 100, steps)).tobytes())
    return digest.hexdigest(), listed


def test_listings_change_no_bit(monkeypatch) -> None:
    usual, count = outcome(700, 0)
    for every, skin in ((1, 1.0), (7, 1.0), (0, 0.2), (0, 4.0)):
        monkeypatch.setattr(walls, "SKIN", skin)
        found, other = outcome(700, every)
        assert found == usual, (every, skin)
        assert other > count or (every, skin) == (0, 4.0)
    assert count > 2
