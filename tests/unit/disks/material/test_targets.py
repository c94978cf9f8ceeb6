"""Elastic constants asked of a body are those of the packing, whatever they are and along whichever direction."""

import numpy as np
import pytest

from dembound.casefile.disks.material import Material
from dembound.disks.material import packed_material, targets
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.homogenise import homogenise
from dembound.disks.material.packing_waves import phase_speeds
from dembound.errors import CaseError
from dembound.packings.brick import Brick
from dembound.packings.square import Square

SPEEDS = {"p_wave_speed": 5000.0, "s_wave_speed": 2900.0}
YOUNG = {"young": 62e9, "poisson": 0.24}
MET = 1e-9
"""Relative error asked for; each solve has some 1e-13."""


@pytest.fixture
def solves(monkeypatch) -> list[int]:
    """The number of solves so far, of a search that knows nothing."""
    count = [0]

    def counted(*given: object):
        count[0] += 1
        return homogenise(*given)

    monkeypatch.setattr(packed_material, "homogenise", counted)
    monkeypatch.setattr(targets, "_FOUND", {})
    return count


def found(tensor: np.ndarray, along: str) -> tuple[float, ...]:
    """E and ν of the solid, of the mean over directions or of a sample pulled along an axis, from strains."""
    if along == "isotropic":  # the mean over turns of the body, by many of them
        turns = []
        for angle in np.pi * np.arange(8) / 8.0:
            c, s = np.cos(angle), np.sin(angle)
            turn = np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])
            turns.append(turn.T @ tensor[:3, :3] @ turn)
        tensor = np.mean(turns, axis=0)
    axis = along == "y"
    strain = np.linalg.solve(tensor[:3, :3], np.eye(3)[int(axis)])
    young, poisson = 1.0 / strain[int(axis)], -strain[1 - int(axis)] / strain[int(axis)]  # of the sheet
    return young * (1.0 + 2.0 * poisson) / (1.0 + poisson) ** 2, poisson / (1.0 + poisson)  # of the solid


@pytest.mark.parametrize(
    "keys",
    [
        *({**SPEEDS, "along": along} for along in ("isotropic", "x")),
        {**YOUNG, "along": "y", "poisson": -0.1},
        {**YOUNG, "poisson": 0.37, "fric": 0.0, "contact_share": 0.2},
        {"bulk": 40e9, "shear": 25e9},
    ],
)
def test_the_packing_has_what_is_asked_for_after_few_solves(random_brick: Brick, solves: list[int], keys: dict) -> None:
    material = Material(density=2630.0, **{"fric": 0.5, **keys})
    made = make_packed_material(random_brick, material, ())
    assert solves[0] <= 6
    assert made.moduli.kratio == made.moduli.pb_kratio
    assert made.moduli.pb_emod / made.moduli.emod == pytest.approx(1.0 / material.contact_share - 1.0)
    tensor = homogenise(made.brick, made.stiffness, ()).tensor  # not what the search remembers
    np.testing.assert_allclose(made.tensor, tensor, rtol=0.0, atol=MET * tensor.max())
    if "young" in keys:
        assert found(tensor, material.along) == pytest.approx((62e9, keys["poisson"]), rel=MET)
    elif "bulk" in keys:
        young, poisson = found(tensor, "isotropic")
        assert young / (3.0 - 6.0 * poisson) == pytest.approx(40e9, rel=MET)
        assert young / (2.0 + 2.0 * poisson) == pytest.approx(25e9, rel=MET)
    elif material.along == "isotropic":
        speeds = phase_speeds(made, np.pi * np.arange(8) / 8.0)
        assert (speeds**2).mean(axis=0).sum() == pytest.approx(5000.0**2 + 2900.0**2, rel=0.01)  # of two bodies' waves
        young, poisson = found(tensor, "isotropic")
        assert young / (2.0 + 2.0 * poisson) == pytest.approx(2630.0 * 2900.0**2, rel=MET)
    else:
        assert made.wave_speeds("xy".index(material.along)) == pytest.approx((5000.0, 2900.0), rel=MET)


@pytest.mark.parametrize(("fric", "share"), [(0.5, 1.0), (0.0, 0.5)])
def test_on_a_lattice_the_ratio_is_the_closed_form(fric: float, share: float) -> None:
    """c_p² = k_n/ρ and c_s² = k_s/2ρ along rows; without friction only the bonds' half has shear springs."""
    lattice = Square(size=(0.5, 0.5), radius=0.25).pack(1.25e9)
    made = make_packed_material(lattice, Material(density=2500.0, fric=fric, along="y", **SPEEDS), ())
    assert made.moduli.kratio == pytest.approx(share * 0.5 * (5000.0 / 2900.0) ** 2, rel=MET)
    assert made.moduli.emod == pytest.approx(0.5 * 2500.0 * 5000.0**2, rel=MET)
    assert made.given_speeds == (None, None)  # dashpots use those of the packing


@pytest.mark.parametrize(
    ("keys", "held", "said"),
    [
        ({**YOUNG, "poisson": 0.45}, (), r"^ground.poisson: asks for Poisson.s ratio .* = 0.45, but"),
        ({**SPEEDS, "s_wave_speed": 4900.0}, (), "^ground.s_wave_speed: asks for c_p/c_s = 1.02, but this"),
        (SPEEDS, ("y",), "^ground.s_wave_speed: with p_wave_speed is asked of"),
    ],
)
def test_what_cannot_be_is_refused_with_a_way_out(
    random_brick: Brick, solves: list[int], keys: dict, held: tuple[str, ...], said: str
) -> None:
    with pytest.raises(CaseError, match=said) as caught:
        make_packed_material(random_brick, Material(density=2630.0, fric=0.5, **keys), held, place="ground")
    assert "give" in str(caught.value)
    assert solves[0] <= 10
