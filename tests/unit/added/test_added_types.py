"""Registered types of another package work everywhere."""

import json
import math
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

HERE = Path(__file__).parent
REGISTERED = {
    "laws": ["Linear", "Namesake", "Brittle", "Rubber", "Forgetful"],
    "methods": ["Cone"],
    "boundaries": ["OtherInput", "LateInput"],
    "packings": ["Hexagonal"],
    "waves": ["Gauss", "Nameless"],
    "holes": ["Diamond", "Absent", "Stranger"],
}
"""Types of added_types.py, in which there is no `Absent`; each is registered under its own name."""


def registered(site: Path, name: str, module: str, groups: dict[str, list[str]]) -> str:
    """A folder with a package that registers types of a module."""
    info = site / f"{name}-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    lines = []
    for group, names in groups.items():
        lines += [f"[dembound.{group}]", *(f"{number} = {module}:{each}" for number, each in enumerate(names))]
    (info / "entry_points.txt").write_text("\n".join(lines))
    return str(site)


@pytest.fixture(scope="module")
def python(tmp_path_factory) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs Python in this folder beside a package that registers added_types.py.

    With `tips` another registers the law of added_pair_law.py, whose functions have all kernels compiled for it.
    """
    site = tmp_path_factory.mktemp("site")
    types = registered(site / "types", "added", "added_types", REGISTERED)
    law = registered(site / "law", "added_law", "added_pair_law", {"laws": ["Tips"]})

    def run(*arguments: str, tips: bool = False, **variables: str) -> subprocess.CompletedProcess[str]:
        path = [types, *([law] if tips else []), str(HERE), *filter(None, [os.environ.get("PYTHONPATH")])]
        done = subprocess.run(
            [sys.executable, *arguments],
            env={**os.environ, "PYTHONPATH": os.pathsep.join(path)} | variables,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return done

    return run


@pytest.fixture(scope="module")
def found(python) -> dict[str, Any]:
    """Results of use_them.py."""
    return json.loads(python("-P", "-c", "import use_them").stdout)  # -P: not from the working folder


@pytest.fixture(scope="module", params=["1", pytest.param("0", marks=pytest.mark.slow)], ids=["python", "compiled"])
def moved(python, request) -> dict[str, Any]:
    """Results of use_kernels.py, whose kernels take 45 s to compile."""
    return json.loads(python("-P", "-c", "import use_kernels", tips=True, NUMBA_DISABLE_JIT=request.param).stdout)


def test_a_law_without_moments_closes_its_books(found) -> None:
    # rounding of 200 steps; with the constants of parallel bonds the energy of bending would be missing
    assert found["linear"]["law"] == [["linear", 0]]
    assert found["linear"]["bending"] == 0.0 < found["linear"]["rotation"]
    assert found["linear"]["error"] < 1e-12


def test_a_law_with_kernel_functions_of_its_own_bounces_as_it_says(moved) -> None:
    """Two disks at ±v touch for √π Γ(⁴⁄₃)/Γ(⅚) a/v, with the largest overlap a: ⅓qa³ = ½(m/2)(2v)²."""
    steps, step, speeds, law = moved["tips"]
    speed, mass, tip = 1e-3, 625.0, 1e9
    deepest = (3.0 * mass * speed**2 / tip) ** (1.0 / 3.0)
    lasts = math.sqrt(math.pi) * math.gamma(4.0 / 3.0) / math.gamma(5.0 / 6.0) * deepest / speed

    assert law == [["tips", 0]]
    assert steps * step == pytest.approx(lasts, abs=1.5 * step)  # the first and the last step are cut
    assert speeds == pytest.approx([-speed, speed], rel=1e-4)  # steps of 1/170 of the impact


def test_a_method_with_another_micromodulus_disperses_as_its_bonds_do(moved) -> None:
    # simulated waves against the formula of the case's own lattice, and not that of L's bonds
    np.testing.assert_allclose(moved["frequencies"], moved["formula"], rtol=1e-9)
    assert abs(moved["frequencies"][1] / moved["usual"][1] - 1.0) > 0.05
    limit, endless = moved["limit"]
    # the case's bar is stable up to the limit of its lattice, a little more for its soft ends
    assert endless * (1.0 - 1e-9) < limit < 1.01 * endless
    assert moved["cells"] > 2.0


def test_a_driven_side_is_calibrated_and_quiet_while_others_are(found) -> None:
    kind, beta, ratio = found["calibrated side"]
    assert kind == "absorbing"
    assert beta == pytest.approx(1.0, abs=0.02)  # equal disks side by side, but for the dispersion of the lattice
    assert ratio == pytest.approx(1.0, abs=0.01)  # with the matched factor, as it returns less of this short pulse
    assert found["let in"] == "input"
    assert "OtherInput" in found["types"]


def test_a_packing_of_its_own_brick(found) -> None:
    stiffness = np.array(found["hexagonal steps"]["stiffness"])
    # ten disks wide and six bricks of two rows high; the hexagonal lattice is isotropic
    assert found["hexagonal steps"]["count"] == 120
    assert found["hexagonal steps"]["error"] < 1e-12
    np.testing.assert_allclose(stiffness[0, 0], stiffness[1, 1], rtol=1e-12)
    assert found["not whole"] == [
        "packing.size: 5 m is not a whole number of bricks of 0.8660254038 m; 4.330127019 or 5.196152423 would be"
    ]


def test_a_packing_has_half_cells_on_its_regular_sides(found) -> None:
    # ten disks of 0.25 m to a row, six bricks of 0.866 m high: of every side one row, that of the other beside it
    # reaches past the corner
    for side, first, height in (("bottom", 0.125, np.sqrt(0.75) / 4.0), ("top", 0.375, 5.75 * np.sqrt(0.75))):
        positions, fraction = found["half cells"][side]
        np.testing.assert_allclose(positions, [(first + 0.5 * i, height) for i in range(10)], rtol=1e-6)
        assert fraction == [0.5] * 10
    assert found["no half cells"] == [
        "boundary.right.half_mass: needs a side of disks in one row; pattern hexagonal has such bottom and top"
    ]


def test_messages_know_what_was_added(found) -> None:
    assert '"other_input"' in found["unknown"][0]
    assert found["across"] == ["boundary.left.wave_s: drives y, which motion.held holds for every particle"]


def test_what_cannot_be_used_is_said_and_left_out(found) -> None:
    absent, stranger, nameless, namesake, forgetful = found["warnings"]
    assert absent.startswith("dembound.holes: 1 (added_types:Absent) cannot be imported:")
    assert stranger == "dembound.holes: 2 (added_types:Stranger) is not derived from Hole"
    assert nameless.startswith("dembound.waves: 1 (added_types:Nameless) lacks _displacement_shape, _velocity_shape, ")
    assert namesake == 'dembound.laws: 1 (added_types:Namesake) is called "elastic", which is taken'
    said = 'dembound.laws: "forgetful" names "forgetful" as its linear law, which must be a linear law without history'
    assert forgetful == said


def test_the_command_line_says_it_without_python(python, found) -> None:
    said = python("-m", "dembound", "schema").stderr.splitlines()  # a command that uses the types
    assert said == [f"warning: {warning}" for warning in found["warnings"]]


def test_a_side_whose_wave_comes_too_late_is_not_calibrated(found) -> None:
    assert found["late"].startswith("calibration of left: the pulse is not past its peak after ")
    assert found["late"].endswith('"late_input" transmits its waves late or not at all')


def test_a_law_that_breaks_is_its_own_linear_law_where_nothing_breaks(found) -> None:
    assert found["shortened"][-1] == "the linear law"


def test_a_law_that_is_not_linear_is_refused_where_that_is_assumed(found) -> None:
    no_name = ['material.law: is "rubber", which is not linear, and names no linear law of its stiffness']
    unknown = ['material.law: is "rubber", which is not linear; errors are known only for linear laws']
    rubber = found["rubber"]
    assert rubber["calibrate"] == rubber["boundary"] == rubber["stability"] == no_name
    assert rubber["estimate"] == rubber["advise"] == unknown
    (line,) = found["rubber"]["library"]
    assert line.startswith('material.law: is "rubber", which is not linear; a library adds up motion, so "')
