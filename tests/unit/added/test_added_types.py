"""What another package adds works everywhere, by being registered and by nothing else."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

HERE = Path(__file__).parent
REGISTERED = {
    "laws": "Linear",
    "methods": "Cone",
    "boundaries": "OtherInput",
    "packings": "Hexagonal",
    "waves": "Gauss",
    "holes": "Diamond",
}


@pytest.fixture(scope="module")
def python(tmp_path_factory) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs Python beside a package that registers added_types.py."""
    site = tmp_path_factory.mktemp("site")
    shutil.copy(HERE / "added_types.py", site)
    info = site / "added-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: added\nVersion: 1.0\n")
    groups = [f"[dembound.{group}]\nx = added_types:{name}\n" for group, name in REGISTERED.items()]
    groups[-1] += "y = added_types:Absent\nz = added_types:Stranger\n"
    groups[2] += "y = added_types:LateInput\n"
    groups[0] += "y = added_types:Namesake\n"
    groups[4] += "y = added_types:Nameless\n"
    (info / "entry_points.txt").write_text("".join(groups))
    path = os.pathsep.join([str(site), *filter(None, [os.environ.get("PYTHONPATH")])])

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        done = subprocess.run(
            [sys.executable, *arguments],
            env={**os.environ, "PYTHONPATH": path},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return done

    return run


@pytest.fixture(scope="module")
def found(python) -> dict[str, Any]:
    """What the cases of use_them.py come to."""
    return json.loads(python(str(HERE / "use_them.py")).stdout)


def test_a_law_without_moments_closes_its_books(found) -> None:
    # rounding of 200 steps; with the constants of parallel bonds the energy of bending would be missing
    assert found["linear"]["law"] == [["linear", 0]]
    assert found["linear"]["bending"] == 0.0 < found["linear"]["rotation"]
    assert found["linear"]["error"] < 1e-12


def test_a_method_with_another_micromodulus_disperses_as_its_bonds_do(found) -> None:
    # simulated waves against the formula of the case's own lattice, and not that of L's bonds
    np.testing.assert_allclose(found["frequencies"], found["formula"], rtol=1e-9)
    assert abs(found["frequencies"][1] / found["usual"][1] - 1.0) > 0.05
    limit, endless = found["limit"]
    # the case's bar is stable up to the limit of its lattice, a little more for its soft ends
    assert endless * (1.0 - 1e-9) < limit < 1.01 * endless
    assert found["cells"] > 2.0


def test_a_driven_side_is_calibrated_and_quiet_while_others_are(found) -> None:
    kind, beta, ratio = found["calibrated"]
    assert kind == "absorbing"
    assert beta == pytest.approx(1.0, abs=0.02)  # equal disks side by side, but for the dispersion of the lattice
    assert ratio == pytest.approx(1.0, abs=1e-3)
    assert found["let in"] == "input"
    assert "OtherInput" in found["types"]


def test_a_packing_of_its_own_brick(found) -> None:
    stiffness = np.array(found["hexagonal"]["stiffness"])
    # ten disks wide and six bricks of two rows high; the hexagonal lattice is isotropic
    assert found["hexagonal"]["count"] == 120
    assert found["hexagonal"]["error"] < 1e-12
    np.testing.assert_allclose(stiffness[0, 0], stiffness[1, 1], rtol=1e-12)
    assert found["counted"]["count"] == 48
    np.testing.assert_allclose(found["counted"]["extent"], [4.0, 3 * np.sqrt(0.75)], rtol=1e-12)
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
    absent, stranger, nameless, namesake = found["warnings"]
    assert absent.startswith("dembound.holes: y (added_types:Absent) cannot be imported:")
    assert stranger == "dembound.holes: z (added_types:Stranger) is not derived from Hole"
    assert nameless.startswith("dembound.waves: y (added_types:Nameless) lacks _displacement_shape, _velocity_shape, ")
    assert namesake == 'dembound.laws: y (added_types:Namesake) is called "elastic", which is taken'


def test_the_command_line_says_it_without_python(python, found) -> None:
    said = python("-m", "dembound", "schema").stderr.splitlines()  # a command that uses the types
    assert said == [f"warning: {warning}" for warning in found["warnings"]]


def test_a_side_whose_wave_comes_too_late_is_not_calibrated(found) -> None:
    assert found["late"].startswith("calibration of left: the pulse is not past its peak after ")
    assert found["late"].endswith('"late_input" transmits its waves late or not at all')
