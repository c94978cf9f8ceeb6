"""What the command material prints of bodies."""

import json

import pytest
import tomli_w
from small_cases import GRAINS, SOIL

TARGETS = {"density": 2630.0, "young": 62e9, "poisson": 0.24, "fric": 0.5, "law": "linearpbond", "pb_ten": 1e7}


def test_a_body_has_the_moduli_asked_for(dembound, tmp_path) -> None:
    (tmp_path / "body.toml").write_text(tomli_w.dumps(GRAINS | {"material": TARGETS}))
    (found,) = json.loads(dembound("material", "body.toml", "--json").out)
    solid, sheet = found["moduli"]["strain"], found["moduli"]["stress"]
    assert (solid["young"], solid["poisson"]) == pytest.approx((62e9, 0.24))
    assert sheet["young"] == pytest.approx(62e9 / (1.0 - 0.24**2))
    assert sheet["poisson"] == pytest.approx(0.24 / (1.0 - 0.24))
    assert found["speeds"]["isotropic"]["s"] == pytest.approx((solid["shear"] / 2630.0) ** 0.5)
    low, high = (pick(found["speeds"][way]["p"] for way in ("x", "y", "45")) for pick in (min, max))
    assert 0.0 < high / low - 1.0 <= found["anisotropy"]["p"]
    crack = found["first_crack"]
    assert crack["compression"]["stress"] < -crack["tension"]["stress"] < 0.0


def test_each_layer_has_its_own(dembound, tmp_path) -> None:
    (tmp_path / "soil.toml").write_text(tomli_w.dumps(SOIL))
    found = json.loads(dembound("material", "soil.toml", "--json").out)
    assert [each["layer"] for each in found] == ["clay", "sand", "rock"]
    assert [each["speeds"]["y"]["s"] for each in found] == pytest.approx([200.0, 350.0, 700.0])
    assert [each["speeds"]["lattice"]["s"] for each in found] == pytest.approx([200.0, 350.0, 700.0])
    assert found[0]["first_crack"] == {"compression": None, "tension": None}
