"""The command test on a lattice that is pulled until one row of bonds tears; what the command material prints."""

import csv
import json
from pathlib import Path
from types import SimpleNamespace

import pytest
import tomli_w
from small_cases import GRAINS, PUSHED, small

from dembound.kinds import loads
from dembound.running import run_case
from dembound.studies.laboratory import strengths, study
from dembound.studies.sweep.perform import MEMBERS, Outcome
from dembound.studies.sweep.tables import statistic

STRENGTH, MODULUS = 5e5, 2e9
BONDS = {"emod": 0.0, "pb_emod": MODULUS, "pb_ten": STRENGTH, "pb_coh": 2.0 * STRENGTH}
MATERIAL = {"density": 2500.0, "law": "linearpbond", **BONDS}
LATTICE = {name: table for name, table in PUSHED.items() if name != "monitor"} | {
    "packing": {"pattern": "A", "size": [4.0, 8.0], "radius": 0.25},
    "material": MATERIAL,
}


@pytest.fixture
def done(monkeypatch):
    """Runs members at once, in this process; returns all that were run."""
    members = []

    def sweep(requested, options, folder, report):
        for member in requested:
            run_case(member.case, folder / MEMBERS)
        members.extend(requested)
        return [Outcome(member.name, member.name) for member in requested]

    monkeypatch.setattr(study, "sweep", sweep)
    return members


def test_a_lattice_breaks_at_the_strength_of_its_bonds(dembound, done) -> None:
    Path("rock.toml").write_text(small(LATTICE).text, encoding="utf-8")
    ucs = {"statistics": [{"quantity": "strength", "mean": 10.0 * STRENGTH}], "material": MATERIAL | {"damp": 0.7}}
    Path("results/rock_ucs").mkdir(parents=True)
    Path("results/rock_ucs/test.json").write_text(json.dumps(ucs), encoding="utf-8")

    found = dembound("test", "tension", "rock.toml", "--seeds", 1)

    assert found.code == 0
    assert "rock: compressive over tensile strength 10" in found.out  # within what is printed
    folder = Path("results/rock_tension")
    (row,) = csv.DictReader((folder / "test.csv").open(encoding="utf-8"))
    strength, young, poisson = (float(row[name]) for name in ("strength", "young", "poisson"))
    assert strength == pytest.approx(STRENGTH, rel=0.01)  # η = 1, all columns pull alike
    assert young == pytest.approx(MODULUS, rel=1e-3)
    assert abs(poisson) < 1e-6
    assert float(row["tension_cracks"]) > 0.0 == float(row["shear_cracks"])
    summary = json.loads((folder / "test.json").read_text(encoding="utf-8"))
    assert summary["homogenised"]["young"] == pytest.approx(MODULUS)
    assert summary["ratios"][0]["value"] == pytest.approx(10.0 * STRENGTH / strength)


def test_strengths_asked_for_are_written_with_the_comments_of_the_case(dembound, monkeypatch) -> None:
    text = "# my rock\n" + small(LATTICE).text.replace("pb_ten = 500000.0", "pb_ten = 5e5  # to be found")
    Path("rock.toml").write_text(text, encoding="utf-8")
    tested, states = [], ["too few disks"]

    def performed(sample, specimens, options, folder, report):  # tension is 0.3 of pb_ten, compression 4 times as much
        strength = sample.case.material.pb_ten * {"tension": 0.3, "ucs": 1.2}[sample.test]
        tested.append(folder)
        return SimpleNamespace(states=states, curves={}, statistics=[statistic({}, "strength", [strength])])

    monkeypatch.setattr(strengths, "perform", performed)
    command = ("material", "rock.toml", "--ucs", "80e6", "--tension", "20e6", "--seeds", 1, "--damp", 0.1)
    assert "too few disks" in dembound(*command).err
    states[:] = ["done"]
    found = dembound(*command)

    assert found.code == 0
    assert "ucs 80 MPa over 1 seeds" in found.out
    written = Path("rock_strengths.toml").read_text(encoding="utf-8")
    assert written.startswith("# my rock\n")
    assert "  # to be found" in written
    material = loads(written).material
    assert material.pb_ten == pytest.approx(20e6 / 0.3, rel=1e-3)
    assert tested[-1].name == f"tension_{material.pb_ten:.4g}_{material.pb_coh:.4g}"  # what is written was tested


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
