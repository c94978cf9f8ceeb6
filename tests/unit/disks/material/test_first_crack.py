"""The first crack of a packing, against closed forms of the square lattice and the balance of a random brick."""

import numpy as np
import pytest

from dembound.casefile.disks.material import Material
from dembound.disks.material.at_rest import pair_forces
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.constants import strength_of
from dembound.disks.material.first_crack import FirstCrack, first_crack
from dembound.disks.material.sliding import strains_of
from dembound.disks.material.targets import moduli_of
from dembound.laws.linearpbond import BOND_LIMITS, limit_lines
from dembound.packings.brick import Brick
from dembound.packings.square import Square

MATERIAL = {"density": 2500.0, "p_wave_speed": 1000.0, "contact_share": 0.75, "fric": 0.5}


def cracks(brick: Brick, **keys: object) -> list[FirstCrack | None]:
    """Of a material in compression and in tension."""
    material = Material(**MATERIAL, **keys)
    return [first_crack(make_packed_material(brick, material, ()), material, sign) for sign in (-1.0, 1.0)]


def test_bonds_of_a_lattice_carry_their_share_or_all_where_contacts_open() -> None:
    lattice = Square(size=(0.5, 0.5), radius=0.25).pack(1.25e9)
    for law, share in (("elastic", 0.25), ("linearpbond", 1.0)):
        pressed, pulled = cracks(lattice, law=law, pb_ten=1e6)
        assert pressed is None  # rows across do not move
        assert (pulled.stress, pulled.limit) == (pytest.approx(1e6 / share), "tension")
    # with a friction angle bonds that are pulled yield in shear, at σ tan φ = c
    _, pulled = cracks(lattice, law="linearpbond", pb_ten=1e7, pb_coh=1e6, pb_fa=45.0)
    assert (pulled.stress, pulled.limit) == (pytest.approx(1e6), "shear")
    assert cracks(lattice) == [None, None]


def test_random_packings_crack_earlier_where_contacts_open_and_in_proportion_to_strength(random_brick: Brick) -> None:
    elastic, loose = (cracks(random_brick, law=law, pb_ten=1e6, pb_coh=1e6) for law in ("elastic", "linearpbond"))
    stronger = cracks(random_brick, law="linearpbond", pb_ten=2e6, pb_coh=2e6)
    for k, sign in enumerate((-1.0, 1.0)):
        assert np.sign(loose[k].stress) == sign
        assert stronger[k].stress == pytest.approx(2.0 * loose[k].stress, rel=1e-9)
        assert stronger[k].young == loose[k].young < elastic[k].young
    own = make_packed_material(random_brick, Material(**MATERIAL), ()).material_tensor
    sheet = moduli_of(own, "y", by_waves=False)
    assert elastic[0][2:] == elastic[1][2:] == pytest.approx((sheet.young("stress"), sheet.poisson("stress")), rel=1e-6)
    assert loose[1].stress < 0.6 * elastic[1].stress
    assert abs(loose[0].stress) > loose[1].stress


@pytest.mark.parametrize(
    ("strength", "limit"), [({"pb_ten": 1e6}, "tension"), ({"pb_coh": 1e6, "pb_fa": 30.0}, "shear")]
)
def test_the_first_bond_breaks_at_the_limits_of_the_law(random_brick: Brick, strength: dict, limit: str) -> None:
    """Bending of bonds included, by the forces of the endless packing."""
    material = Material(**MATERIAL, law="linearpbond", **strength)
    made = make_packed_material(random_brick, material, ())
    springs = np.stack([made.stiffness.normal, made.stiffness.shear, made.stiffness.bending])
    strains = strains_of(pair_forces(made) @ [0.0, 1.0, 0.0], springs)
    slopes, most = limit_lines(made.contact_constants, strength_of(material))
    reached = (np.einsum("pls,sp->pl", slopes, strains)[:, BOND_LIMITS:] / most[:, BOND_LIMITS:]).max()

    pulled = cracks(random_brick, **strength)[1]
    assert (pulled.stress, pulled.limit) == (pytest.approx(1.0 / reached, rel=1e-9), limit)
