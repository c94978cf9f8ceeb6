"""Dashpots of unbonded contacts alone: intact ground moves as without them, broken ground is damped and stable."""

import numpy as np
import pytest

from dembound.disks.stability import OPENING, step_limit
from dembound.kernels.contacts import INTACT

BRITTLE = {"law": "linearpbond", "fric": 0.5, "pb_ten": 4e5, "pb_coh": 6e5}
RATIOS = {"dp_nratio": 0.2, "dp_sratio": 0.2}
SIDES = {"left": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}, "right": "viscous"}
STEPS, STEP = 250, 4e-5


def run(lab, size: tuple[float, float], amplitude: float = 2.0, **material):
    """A run of bonded grains under pulses, which break some bonds, and its ledger."""
    words = {"held": (), "boundary": SIDES, "wave": lab.pulse(0.01) | {"amplitude": amplitude}, "brick": (4.0, 4.0)}
    simulation = lab.simulation(lab.scene("B", size, **words, material=BRITTLE | material), step=STEP)
    ledger = lab.ledger(simulation, 50)
    simulation.run(STEPS)
    return simulation, ledger.entries[-1]


@pytest.mark.parametrize("size", [(40.0, 4.0), (8.0, 4.0)], ids=["rows of copies", "one by one"])
def test_they_act_where_bonds_are_broken_only(lab, size):
    """Before a bond breaks the bits are those of ground without dashpots, which also begins under the elastic law."""
    quiet = [run(lab, size, 0.01, **given)[0] for given in ({}, RATIOS)]
    assert np.array_equal(quiet[0].state.velocity, quiet[1].state.velocity)
    assert quiet[1].system.scene.case.begins_elastic
    simulation, last = run(lab, size, **RATIOS)
    (contacts,) = simulation.system.contacts.values()
    intact = contacts.of("state") == INTACT
    drag = contacts.drag.any(axis=1)
    assert not drag[intact].any()
    assert np.count_nonzero(drag) > 5
    assert last.damping > 1e-3 * last.supplied
    assert abs(last.error) < 3e-4 * last.supplied
    everywhere = run(lab, size, **RATIOS, dp_on="all")[1]
    assert everywhere.damping > 1.1 * last.damping


def matrices(lab, scene, whole: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """M⁻¹ᐟ²KM⁻¹ᐟ² of a lattice in which the pairs `whole` have their bonds, and that of dashpots of all others."""
    n, root = scene.count, 1.0 / np.sqrt(lab.inertia(scene)).ravel()
    stiffness, viscosity = np.zeros((2, 3 * n, 3 * n))
    material, moduli, radius = scene.case.material, scene.ground.moduli, lab.diameter / 2.0
    kn, ks = moduli.emod, moduli.emod / moduli.kratio
    bond = np.array([moduli.pb_emod, moduli.pb_emod / moduli.pb_kratio, moduli.pb_emod * radius**2 / 3.0])
    for (i, j), is_whole in zip(scene.assembly.pairs, whole, strict=True):
        x, y = (scene.positions[j] - scene.positions[i]) / np.hypot(*(scene.positions[j] - scene.positions[i]))
        reduced = scene.mass[i] * scene.mass[j] / (scene.mass[i] + scene.mass[j])
        normal, shear, turn = np.zeros((3, 3 * n))
        normal[[i, j, n + i, n + j]] = -x, x, -y, y
        shear[[i, j, n + i, n + j, 2 * n + i, 2 * n + j]] = y, -y, -x, x, -radius, -radius
        turn[[2 * n + i, 2 * n + j]] = -1.0, 1.0
        springs = np.array([kn, ks, 0.0]) + (bond if is_whole else 0.0)
        stiffness += sum(k * np.outer(way, way) for k, way in zip(springs, (normal, shear, turn), strict=True))
        if not is_whole:
            viscosity += 2.0 * material.dp_nratio * np.sqrt(reduced * kn) * np.outer(normal, normal)
            viscosity += 2.0 * material.dp_sratio * np.sqrt(reduced * ks) * np.outer(shear, shear)
    return root[:, None] * stiffness * root, root[:, None] * viscosity * root


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("ratios", [{"dp_nratio": 0.2}, RATIOS, {"dp_nratio": 0.5, "dp_sratio": 0.5}])
def test_the_step_is_stable_whatever_has_broken_and_longer_than_with_dashpots_everywhere(lab, share, ratios):
    """K/OPENING + 2C/Δt is at most 4/Δt² for any bonds that are broken, by their matrices, and for loose disks.

    Those may lie on six others, where all disks turn alike or move to and fro: 24k_s/m and (6k_n + 2k_s)/m.
    """
    material = BRITTLE | {"contact_share": share, "kratio": 2.0, "pb_kratio": 2.0} | ratios
    scene = lab.scene("A", (2.5, 2.5), held=(), material=material)
    step, rng = step_limit(scene), np.random.default_rng(0)
    worst = 0.0
    for broken in (0.0, 0.05, 0.3, 0.6, 1.0):
        whole = rng.random(len(scene.assembly.pairs)) >= broken
        stiffness, viscosity = matrices(lab, scene, whole)
        worst = max(worst, np.linalg.eigvalsh(stiffness / OPENING + 2.0 / step * viscosity)[-1] * step**2)
    assert 1.0 < worst <= 4.0 * (1.0 + 1e-4)  # rounding of the iteration for the eigenvalue
    mass, moduli, given = scene.mass.min(), scene.ground.moduli, scene.case.material
    normal, shear = (
        k / OPENING + 2.0 / step * 2.0 * ratio * np.sqrt(0.5 * mass * k)
        for k, ratio in ((moduli.emod, given.dp_nratio), (moduli.emod / moduli.kratio, given.dp_sratio))
    )
    assert max(24.0 * shear, 6.0 * normal + 2.0 * shear) / mass * step**2 <= 4.0 * (1.0 + 1e-12)
    everywhere = lab.scene("A", (2.5, 2.5), held=(), material=material | {"dp_on": "all"})
    assert step >= step_limit(everywhere)
    if ratios == {"dp_nratio": 0.2}:
        assert step == step_limit(scene, viscous=False)
