"""Copies of a random brick send back as much of a pulse as follows from the coupling of waves in one brick.

An S pulse runs up a periodic column of copies from a continuum below, which has only what comes back. The run ends when
the front comes back from the free top; until then the pulse has been in all of the column but half its own length, on
the average. Bragg's frequency is 1.42/T with the period T of the pulse, where the energy has a twentieth of its largest
density, or 2/T, the first zero of its spectrum, where nothing comes back but what ties leave.
"""

import numpy as np
import pytest

from dembound.disks.material.packing_waves import couplings, sent_back
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.disks.surroundings.near_fields import signals_of
from dembound.kinds import with_changes
from dembound.motion.simulation import Simulation

COPIES, BRICK = 16, (5.0, 10.0)
SIDES = {"left": "periodic", "right": "periodic", "bottom": {"type": "outside", "wave_s": "pulse"}}


def column(lab, seed: int, period: float) -> DiskScene:
    """Copies of a brick 20 diameters high."""
    wave = {"type": "cosine", "amplitude": 1.0, "period": period}
    words = {"held": (), "material": {"fric": 0.5}, "boundary": SIDES, "wave": wave}
    case = lab.case("B", (BRICK[0], COPIES * BRICK[1]), brick=BRICK, seed=seed, **words)
    return build(with_changes(case, {"outside.element": 4.0}))


def returned(scene: DiskScene) -> tuple[float, float]:
    """RMS of the velocity that comes back below, over that of the pulse: measured, and sent back by copies."""
    outside, pulse = scene.outside, scene.case.wave["pulse"]
    places, speed = outside.body.mesh.positions[:, 1], min(scene.ground.wave_speeds(1))
    height, step = float(scene.size[1]), choose_step(scene)[0]
    beside = outside.first + np.flatnonzero(np.isclose(places, places.max()))
    record = Simulation(scene, step, beside).advance(int(2.0 * height / speed / step))
    energy = float(np.sum(record[:, :, 3:5].mean(axis=1) ** 2))
    behind = height - 0.5 * speed * pulse.duration()
    expected = sent_back(scene.ground, signals_of(scene.case), (BRICK[0], behind), [1]).share
    return np.sqrt(energy / np.sum(pulse.velocity(step * np.arange(len(record))) ** 2)), expected


def test_it_is_what_coupled_waves_send_back(lab) -> None:
    """Reflections of copies, and of ties and shorter waves, add up; the latter are those of the other pulse."""
    seed = 1
    ((_, first),) = couplings(column(lab, seed, 0.1).ground, {1: 1})
    bragg = first.frequency
    (strong, expected), (weak, nothing) = (returned(column(lab, seed, times / bragg)) for times in (1.42, 2.0))

    assert nothing < 1e-6
    assert weak < 0.6 * strong
    assert strong**2 == pytest.approx(expected**2 + weak**2, abs=2.0 * weak**2)
