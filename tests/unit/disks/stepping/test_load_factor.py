"""Limits of pairs, and the load factor of a run."""

import json

import numpy as np
import pytest
from small_cases import PUSHED, SPALLING, small

from dembound.disks.stepping.load_factor import load_factor_in_words
from dembound.errors import CaseError
from dembound.laws.law import Limits
from dembound.laws.linearpbond import LIMITS, limit_lines
from dembound.running import plan, resume_case, run_case

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


STATIC = PUSHED | {
    "material": PUSHED["material"] | {"fric": 0.4, "pb_ten": 1.5e6, "pb_coh": 1e6, "pb_fa": 30.0},
    "boundary": {"left": {"type": "viscous_input", "wave_p": "push", "wave_s": "shake"}, "right": {"type": "viscous"}},
    "static": {"stress": [-1e6, -0.8e6, 0.0]},
    "output": {"load_factor": True, "contacts": True, "snapshots": 100, "pictures": False},
}


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


def test_without_limits_there_is_no_factor(tmp_path):
    case = small(PUSHED, "free", {"material.contact_share": 0.0, "output.load_factor": True, "output.pictures": False})
    summary = json.loads((run_case(case, tmp_path) / "summary.json").read_text())
    assert summary["load_factor"] == {"factor": None}
    assert load_factor_in_words(summary["load_factor"]) == "the elastic law holds under any multiple of the waves"


WEIGHT = {"load": [{"name": "weight", "acceleration": [0.0, -9.81]}]}
SETTLE = r"output.load_factor: needs a \[static\] stage, .* under load\[1, weight\]"


@pytest.mark.parametrize(
    ("tables", "changes", "problem"),
    [
        (PUSHED, {"material.pb_ten": 1e6}, 'pb_ten: is only allowed with law = "linearpbond" or output.load_factor'),
        (PUSHED, {"output.load_factor": True, "material.law": "linearpbond"}, "output.load_factor: is of linear laws"),
        (PUSHED, {"output.load_factor": True, "material.damp": 0.2}, "output.load_factor: needs material.damp = 0"),
        (PUSHED, {"output.load_factor": True, **WEIGHT}, SETTLE),
        (SPALLING, {"output.load_factor": True}, "load_factor: is for disks, not for bars"),
    ],
)
def test_where_there_is_no_factor_it_is_refused(tables, changes, problem):
    with pytest.raises(CaseError, match=problem):
        small(tables, "refused", changes)


def test_bonds_that_do_not_break_have_no_limit(tmp_path):
    """Of bonds alone; in all 20 columns of disks none breaks, and in 2 the first one is farther inside."""
    bonds = QUIET | {"material.contact_share": 0.0}
    found = {}
    for depth in (0, 2, 20):
        case = small(STATIC, f"kept{depth}", bonds | {f"boundary.{side}.intact": depth for side in ("left", "right")})
        summary = json.loads((run_case(case, tmp_path) / "summary.json").read_text())
        found[depth] = summary["load_factor"]
    assert found[20] == {"factor": None}
    assert found[2]["factor"] >= found[0]["factor"]
    assert 1.0 < found[2]["position"][0] < 9.0


QUIET = {"output.contacts": False, "output.snapshots": 0}


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> dict:
    """The summary of a run."""
    return json.loads(
        (run_case(small(STATIC, "whole", QUIET), tmp_path_factory.mktemp("whole")) / "summary.json").read_text()
    )


def test_a_resumed_run_has_the_same_factor(whole, tmp_path):
    resumed = resume_case(run_case(small(STATIC, "part", QUIET | {"run.duration": 0.006}), tmp_path), until=0.01)
    assert json.loads((resumed / "summary.json").read_text())["load_factor"] == whole["load_factor"]
    first, second = whole["load_factor"]["particles"]
    assert first != second
