"""Steps of damped disks beside the same arithmetic in numpy, particle by particle."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.damping import fitted
from dembound.disks.contacts.layout import contact_rows
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.disks.stepping import damped_ground
from dembound.kernels.elastic import contact_forces
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

STEPS, STEP = 40, 1e-4
GRAINS = {"pattern": "B", "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
BODY = {"boundary": {"right": {"type": "viscous"}}, "wave": {}, "monitor": [], "motion.held": []}


def stepped(scene, layers, layer: np.ndarray, first: np.ndarray) -> tuple[np.ndarray, float]:
    """Displacements (3, n) after all steps from velocities (3, n), and energy taken by damping, without sides.

    The mechanisms of both ends take half of the forces of contacts, which have one stiffness in all layers.
    """
    assembly, ends = scene.assembly, np.sort(layer[scene.assembly.pairs], axis=1)
    kinds = []
    for pair in np.unique(ends, axis=0):
        chosen = (ends == pair).all(axis=1)
        some = replace(assembly, pairs=assembly.pairs[chosen], contact_type=assembly.contact_type[chosen])
        e, g = np.moveaxis(damped_ground.factors_of(layers, STEP)[pair], 1, 0).reshape(2, -1, 1, 1)
        kinds.append([contact_rows(some, scene.ground), e, 0.5 * g, np.zeros((len(e), *first.shape))])
    inertia = np.stack([scene.mass, scene.mass, scene.inertia])
    u, v, taken = np.zeros_like(first), first.copy(), 0.0
    for _ in range(STEPS):
        total, lost = np.zeros_like(u), np.zeros_like(u)
        for kind in kinds:
            rows, e, g, p = kind
            f = np.zeros_like(u)
            contact_forces(u, rows, f)
            r = p + g * f
            kind[3] = e * r + g * f
            total += f
            lost += r.sum(axis=0)
        now = (v + STEP * (total - lost) / inertia) * scene.moves
        taken += 0.5 * STEP * float(np.sum(lost * (v + now)))
        u, v = u + STEP * now, now
    return u, taken


@pytest.mark.parametrize(
    ("size", "held"),
    [([4.0, 4.0], []), ([32.0, 8.0], []), ([32.0, 8.0], ["y"])],
    ids=["one by one", "rows of copies", "held along y"],
)
def test_a_damped_body_moves_as_its_arithmetic_says(bar, monkeypatch, size: list[float], held: list[str]) -> None:
    """Two layers of unlike damping, one disk after the other, are as mixed as layers can be."""
    changes = {
        **BODY,
        "boundary": {},
        "packing": GRAINS | {"size": size},
        "material.quality_factor": 5.0,
        "motion.held": held,
    }
    scene = build(bar(changes))
    soft, stiff = fitted(5.0, (1.0, 50.0), 10.0, 3), fitted(40.0, (1.0, 50.0), 10.0, 2)
    layers = [soft, stiff, None]
    layer = np.random.default_rng(1).integers(0, len(layers), scene.count)
    monkeypatch.setattr(damped_ground, "layers_of", lambda scene, nodes: (layers, layer[nodes].astype(np.uint8)))
    simulation = Simulation(scene, STEP)
    first = np.random.default_rng(2).normal(0.0, 1e-3, (3, scene.count)) * scene.moves
    simulation.state.velocity = first
    simulation.run(STEPS)
    expected, taken = stepped(scene, layers, layer, first)

    # each sum of some fifty products is rounded by 1e-15 of its terms, in every step
    assert np.abs(simulation.state.displacement - expected).max() < STEPS * 1e-14 * np.abs(expected).max()
    assert simulation.state.work[0, 1] == pytest.approx(taken, rel=1e-10)
    (part,) = simulation.system.parts
    assert part.memories.saved_arrays()["memory"].any(axis=(0, 2)).tolist() == [True, "y" not in held, True]


@pytest.mark.parametrize("extent", [[4.0, 4.0], [32.0, 8.0]], ids=["one by one", "rows of copies"])
def test_small_memories_become_zero_at_every_256th_step(bar, extent: list[float]) -> None:
    scene = build(bar({**BODY, "boundary": {}, "packing": GRAINS | {"size": extent}, "material.quality_factor": 5.0}))
    simulation = Simulation(scene, STEP)
    (part,) = simulation.system.parts
    memory = part.memories.arrays.memory
    left = []
    for steps, size in ((1, 1e-250), (255, 1e-250), (1, 1e-250), (256, 1e-180)):  # steps 0, 255, 256 and 512 are last
        memory[:] = size
        simulation.advance(steps)
        left.append(bool(memory.any()))

    assert left == [False, True, False, True]


@pytest.mark.parametrize("boundary", ["outside", "free_field"])
def test_the_ledger_closes(bar, boundary: str) -> None:
    layer = [{"thickness": 4.2, "quality_factor": 50.0}, {}]
    sides = {side: {"type": boundary} for side in ("left", "right")}
    sides |= {"bottom": {"type": "viscous" if boundary == "free_field" else boundary}}
    more = {"outside.element": 2.0} if boundary == "outside" else {}
    changes = {**BODY, "boundary": sides, "packing": GRAINS | {"size": [16.0, 8.0]}, "material.quality_factor": 5.0}
    scene = build(bar(changes | more | {"layer": layer}))
    simulation = Simulation(scene, choose_step(scene)[0])
    ledger = Ledger(simulation, 50)
    simulation.track(ledger)
    simulation.state.velocity = np.random.default_rng(2).normal(0.0, 1e-3, (3, scene.count)) * scene.moves
    simulation.run(301)
    entries = ledger.entries

    assert max(abs(entry.error) for entry in entries) < 1e-11 * entries[0].kinetic
    assert entries[-1].damping > 0.1 * entries[0].kinetic
