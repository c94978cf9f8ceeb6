"""Limits of pairs, and the load factor of a run."""

import json

import h5py
import numpy as np
import pytest
from small_cases import PUSHED, SPALLING, small

from dembound.accuracy.runner import measure
from dembound.disks.kind import Disks
from dembound.disks.stepping.load_factor import LIMITS, LOAD_FACTOR, limit_in_words, limit_lines, load_factor_in_words
from dembound.errors import CaseError
from dembound.kernels.tables import Limits
from dembound.running import Progress, plan, resume_case, run_case

STRENGTH = Limits(friction=0.4, tension=3e6, cohesion=2e6, tan_fa=0.5, geometry=2)

AREA, SECTION = 1 / 0.5, 1.5 / 0.25**2  # 1/A and R̄/J
CLOSED = [0.3, 0.4, 0.5, 0.501, 0.0, 1e9, 5e8, 2e9, 1e9, 4e7, AREA, SECTION]


def reached(constants, limits, stretch, shear, turn):
    """Numbers of the limits at which a pair is, in the terms of PFC's law."""
    overlap, (kn, ks, bn, bs, bb) = constants[3] - constants[2], constants[5:10]
    normal = kn * (overlap - stretch)
    stress, bending = bn * stretch * constants[10], bb * turn * constants[11]
    return [
        normal,
        limits.friction * normal - ks * shear,
        limits.friction * normal + ks * shear,
        limits.tension - stress - bending,
        limits.tension - stress + bending,
        limits.cohesion - stress * limits.tan_fa - bs * shear * constants[10],
        limits.cohesion - stress * limits.tan_fa + bs * shear * constants[10],
    ]


def test_lines_are_the_limits_of_the_law():
    slopes, allowed = limit_lines(np.array([CLOSED]), STRENGTH)
    assert slopes.shape == (1, len(LIMITS), 3)
    for strain in np.random.default_rng(2).standard_normal((5, 3)) * 1e-3:
        room = allowed[0] - slopes[0] @ strain
        np.testing.assert_allclose(room, reached(CLOSED, STRENGTH, *strain), rtol=1e-12)


def test_pairs_have_only_the_limits_of_what_they_have():
    gap = [*CLOSED[:3], 0.49, *CLOSED[4:]]
    bare = [*CLOSED[:5], 1e9, 5e8, 0.0, 0.0, 0.0, AREA, SECTION]
    bonds = [*CLOSED[:5], 0.0, 0.0, *CLOSED[7:]]
    slopes, allowed = limit_lines(np.array([gap, bare, bonds]), STRENGTH)
    np.testing.assert_array_equal(
        np.isfinite(allowed),
        [[True, False, False, *[True] * 4], [*[True] * 3, *[False] * 4], [False, False, False, *[True] * 4]],
    )
    # the gap of 10 mm closes at a stretch of −10 mm
    assert allowed[0, 0] / slopes[0, 0, 0] == pytest.approx(-0.01)
    assert slopes[0, 0, 0] < 0.0
    assert [limit_in_words(0, np.array(each)) for each in (gap, bare)] == ["closes", "opens"]


STATIC = PUSHED | {
    "material": PUSHED["material"] | {"fric": 0.4, "pb_ten": 1.5e6, "pb_coh": 1e6, "pb_fa": 30.0},
    "boundary": {"left": {"type": "viscous_input", "wave_p": "push", "wave_s": "shake"}, "right": {"type": "viscous"}},
    "static": {"stress": [-1e6, -0.8e6, 0.0]},
    "output": {"load_factor": True, "contacts": True, "snapshots": 100, "pictures": False},
}


def test_the_factor_is_that_of_recorded_forces(tmp_path):
    """The least factor by contact and bond forces of all snapshots, of the contacts alone that open or slide."""
    case = small(STATIC | {"material": STATIC["material"] | {"pb_ten": 1e9, "pb_coh": 1e9}}, "forces")
    folder = run_case(case, tmp_path)
    found = json.loads((folder / "summary.json").read_text())["load_factor"]
    with h5py.File(folder / "run.h5") as file:
        snapshots = [file["snapshots"][name] for name in sorted(file["snapshots"])]
        assert len(snapshots) == file.attrs["steps"]  # one after every step
        columns = [{name: each[:] for name, each in shot["contacts"].items()} for shot in snapshots]
        times = [shot.attrs["time"] for shot in snapshots]
    settled = -1.0  # in a square lattice half of the stress, times the spacing, is carried by the contacts
    lengths = np.abs(columns[0]["vector"])
    along_x = lengths[:, 0] > lengths[:, 1]
    start = np.where(along_x, 0.5 * 1e6, 0.5 * 0.8e6) * 0.5 * settled  # N/m, the other half by the bonds
    assert found["limit"] in ("opens", "slides")
    least, when = np.inf, 0.0
    for time, forces in zip(times, columns, strict=True):
        normal = 0.5 * forces["normal_force"] - start  # added by the waves
        shear = 0.5 * forces["shear_force"]
        # (μN)(f) = |S|(f), with N = −(start + f·normal)
        grows = 0.4 * normal + np.abs(shear)
        factors = np.where(grows > 0.0, -0.4 * start / np.where(grows > 0.0, grows, 1.0), np.inf)
        if factors.min() < least:
            least, when = float(factors.min()), float(time)
    assert found["factor"] == pytest.approx(least, rel=0.02)  # stages reach their stress within 1 %
    assert found["time"] == pytest.approx(when)


def test_a_resumed_run_has_the_same_factor(tmp_path):
    changes = {"output.contacts": False, "output.snapshots": 0}
    whole = json.loads((run_case(small(STATIC, "whole", changes), tmp_path) / "summary.json").read_text())
    case = small(STATIC, "part", changes | {"run.duration": 0.006})
    resumed = resume_case(run_case(case, tmp_path), until=0.01)
    assert json.loads((resumed / "summary.json").read_text())["load_factor"] == whole["load_factor"]
    x, y = whole["load_factor"]["position"]
    first, second = whole["load_factor"]["particles"]
    assert first != second
    assert 0.0 < x < 10.0
    assert 0.0 < y < 2.5


def test_a_body_beyond_its_limits_at_rest_has_the_factor_zero(tmp_path):
    """Contacts open under a pull of 0.5 MPa along y, and bonds of 0.1 MPa do not hold either."""
    material = STATIC["material"] | {"pb_ten": 1e5, "pb_coh": 1e5}
    changes = {"material": material, "static.stress": [-1e6, 5e5, 0.0], "output.contacts": False, "output.snapshots": 0}
    torn = small(STATIC, "torn", changes)
    folder = run_case(torn, tmp_path)
    first = 2.0 * plan(torn).time_step  # the wave begins at 0: in the second step something moves
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["load_factor"]["factor"] == 0.0
    assert summary["load_factor"]["time"] == pytest.approx(first, abs=1e-9)
    assert any(
        line.startswith('material.law: is "elastic", but the elastic law holds under no waves')
        for line in summary["warnings"]
    )


def test_the_factor_of_a_choice_is_found_as_in_a_run(tmp_path):
    changes = {"output.contacts": False, "output.snapshots": 0}
    case = small(STATIC, "charted", changes)
    summary = json.loads((run_case(case, tmp_path) / "summary.json").read_text())
    factor = summary["load_factor"]["factor"]
    assert measure(case, Progress())[0].findings[LOAD_FACTOR] == (factor, "1")
    x, y = summary["load_factor"]["position"]
    assert LOAD_FACTOR in measure(case, Progress(), inside=(x - 0.1, y - 0.1, x + 0.1, y + 0.1))[0].findings
    assert LOAD_FACTOR not in measure(case, Progress(), inside=(x + 0.1, y + 0.1, x + 0.2, y + 0.2))[0].findings
    assert any("holds up to" in line for line in summary["warnings"]) is (factor < 1.0)


def test_without_limits_there_is_no_factor(tmp_path):
    case = small(PUSHED, "free", {"material.contact_share": 0.0, "output.load_factor": True, "output.pictures": False})
    summary = json.loads((run_case(case, tmp_path) / "summary.json").read_text())
    assert summary["load_factor"] == {"factor": None}
    assert load_factor_in_words(summary["load_factor"]) == "the elastic law holds under any multiple of the waves"
    plain = small(PUSHED, "plain", {"output.pictures": False})
    assert json.loads((run_case(plain, tmp_path) / "summary.json").read_text())["load_factor"] is None


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"material.pb_ten": 1e6}, r'material.pb_ten: is only allowed with law = "linearpbond" or output.load_factor'),
        ({"output.load_factor": True, "material.law": "linearpbond"}, "output.load_factor: is of linear laws"),
        ({"output.load_factor": True, "material.damp": 0.2}, "output.load_factor: needs material.damp = 0"),
        (
            {"output.load_factor": True, "load": [{"name": "weight", "acceleration": [0.0, -9.81]}]},
            r"output.load_factor: needs a \[static\] stage, .* under load\[1, weight\]",
        ),
    ],
)
def test_where_there_is_no_factor_it_is_refused(changes, problem):
    with pytest.raises(CaseError, match=problem):
        small(PUSHED, "refused", changes)


def test_bars_have_no_load_factor():
    with pytest.raises(CaseError, match="load_factor: is for disks, not for bars"):
        small(SPALLING, "bar", {"output.load_factor": True})


def test_rows_that_move_identically_are_all_compared():
    tables = PUSHED | {"boundary": {"left": {"type": "velocity", "wave_p": "push"}, "right": {"type": "viscous"}}}
    one, whole = (small(tables, "rows", {"output.load_factor": asked}) for asked in (False, True))
    assert Disks().reduced(Disks().build(one)).scene.disk_count < 100
    assert Disks().reduced(Disks().build(whole)).scene.disk_count == 100
