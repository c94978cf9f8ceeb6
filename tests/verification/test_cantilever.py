"""A row of bonded disks, built in at one end, bends and stretches like a beam.

The bond is a beam's section of height 2R̄, A = 2R̄ and J = 2R̄³/3, and between two centres D apart its springs are those
of a beam with E = Ē_c and G = Ē_c/pb_kratio. Statics gives the forces in every bond of the row, so that deflections are
sums. Under a force P at the tip of a row of length L from centre to centre

    θ = PL²/(2EJ)    u = PL³/(3EJ)·(1 − D²/4L²) + PL/(GA):

the rotation of a Timoshenko beam, and its deflection but for D²/4L², as the row bends in its bonds' middles alone.
"""

import numpy as np
import pytest

from dembound.disks.rest.stage import settle

DISKS, RADIUS = 12, 0.25
EMOD, PB_EMOD, PB_KRATIO = 2e9, 1e9, 2.5
LENGTH = (DISKS - 1) * 2.0 * RADIUS
AREA, INERTIA = 2.0 * RADIUS, 2.0 * RADIUS**3 / 3.0
RATIO = 1e-8
TILT = 1e-4


def tip(lab, law: str, force: tuple[float, float]) -> np.ndarray:
    """Displacement and rotation (3,) of the last disk under a force (N) on it."""
    scene = lab.scene(
        "A",
        (2.0 * RADIUS * DISKS, 2.0 * RADIUS),
        held=(),
        material={"emod": EMOD, "pb_emod": PB_EMOD, "pb_kratio": PB_KRATIO, "law": law},
        load=[{"force": force, "position": (LENGTH + RADIUS, RADIUS)}],
        static={"ratio": RATIO, "boundary": {"left": {"type": "fixed"}}},
    )
    return settle(scene).start.displacement[:, lab.row(scene)[-1]]


# The mean force left on a disk is RATIO times that in a bond, P here. Even if all DISKS of them acted at the tip, they
# would move it by DISKS·RATIO of what P does; moments left are forces at arms of about R, which move it less.
# Turning by an angle φ changes forces and arms by φ²/2.
TOLERANCE = 2.0 * DISKS * RATIO + TILT**2


@pytest.mark.parametrize("law", ["elastic", "linearpbond"])
def test_a_force_across_bends_and_shears_it(lab, law):
    force = TILT * 2.0 * PB_EMOD * INERTIA / LENGTH**2
    _, deflection, rotation = tip(lab, law, (0.0, force))

    bent = force * LENGTH**3 / (3.0 * PB_EMOD * INERTIA) * (1.0 - 0.25 * (2.0 * RADIUS / LENGTH) ** 2)
    sheared = force * LENGTH / (PB_EMOD / PB_KRATIO * AREA)
    assert rotation == pytest.approx(TILT, rel=TOLERANCE)
    assert deflection == pytest.approx(bent + sheared, rel=TOLERANCE)


@pytest.mark.parametrize(
    ("law", "force", "modulus"),
    [
        ("elastic", 1e5, EMOD + PB_EMOD),
        ("linearpbond", -1e5, EMOD + PB_EMOD),
        ("linearpbond", 1e5, PB_EMOD),  # contacts do not pull
    ],
)
def test_a_force_along_is_carried_by_bonds_and_by_contacts_that_close(lab, law, force, modulus):
    # a contact has k_n = E_c, that of a section of height D
    stretch, deflection, rotation = tip(lab, law, (force, 0.0))
    assert stretch == pytest.approx(force * LENGTH / (modulus * AREA), rel=TOLERANCE)
    assert (deflection, rotation) == (0.0, 0.0)
