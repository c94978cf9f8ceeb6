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

from dembound.formulas.disks.near_disks import BETWEEN, CREEP, DARK, LIT, LONGEST, OF_WAVES, SHORT

HERE = Path(__file__).parent
REGISTERED = {
    "laws": ["Linear", "Namesake", "Brittle", "Tips", "Rubber", "Forgetful", "Graded"],
    "methods": ["Cone"],
    "boundaries": ["OtherInput", "LateInput", "Mattress", "Quilt", "Heather", "Shock", "Pads"],
    "packings": ["Hexagonal", "Unsaid", "Drawn"],
    "waves": ["Gauss", "Nameless"],
    "holes": ["Diamond", "Absent", "Stranger"],
}
"""Types of added_types.py, in which there is no `Absent`; each is registered under its own name."""


@pytest.fixture(scope="module")
def python(tmp_path_factory) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs Python in this folder beside a package that registers added_types.py."""
    site = tmp_path_factory.mktemp("site")
    info = site / "added-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: added\nVersion: 1.0\n")
    lines = []
    for group, names in REGISTERED.items():
        lines += [f"[dembound.{group}]", *(f"{number} = added_types:{name}" for number, name in enumerate(names))]
    (info / "entry_points.txt").write_text("\n".join(lines))
    path = os.pathsep.join([str(site), str(HERE), *filter(None, [os.environ.get("PYTHONPATH")])])

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
    """Results of use_them.py."""
    return json.loads(python("-P", "-c", "import use_them").stdout)  # -P: not from the working folder


def test_a_law_without_moments_closes_its_books(found) -> None:
    # rounding of 200 steps; with the constants of parallel bonds the energy of bending would be missing
    assert found["linear"]["law"] == [["linear", 0]]
    assert found["linear"]["bending"] == 0.0 < found["linear"]["rotation"]
    assert found["linear"]["error"] < 1e-12


def test_a_law_with_kernel_functions_of_its_own_bounces_as_it_says(found) -> None:
    """Two disks at ±v touch for √π Γ(⁴⁄₃)/Γ(⅚) a/v, with the largest overlap a: ⅓qa³ = ½(m/2)(2v)²."""
    steps, step, speeds, law = found["tips"]
    speed, mass, tip = 1e-3, 625.0, 1e9
    deepest = (3.0 * mass * speed**2 / tip) ** (1.0 / 3.0)
    lasts = math.sqrt(math.pi) * math.gamma(4.0 / 3.0) / math.gamma(5.0 / 6.0) * deepest / speed

    assert law == [["tips", 0]]
    assert steps * step == pytest.approx(lasts, abs=1.5 * step)  # the first and the last step are cut
    assert speeds == pytest.approx([-speed, speed], rel=1e-4)  # steps of 1/400 of the impact


def test_a_method_with_another_micromodulus_disperses_as_its_bonds_do(found) -> None:
    # simulated waves against the formula of the case's own lattice, and not that of L's bonds
    np.testing.assert_allclose(found["frequencies"], found["formula"], rtol=1e-9)
    assert abs(found["frequencies"][1] / found["usual"][1] - 1.0) > 0.05
    limit, endless = found["limit"]
    # the case's bar is stable up to the limit of its lattice, a little more for its soft ends
    assert endless * (1.0 - 1e-9) < limit < 1.01 * endless
    assert found["cells"] > 2.0


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


def test_a_side_with_springs_of_its_own_is_estimated_as_one_of_this_package(found) -> None:
    """Dashpots and springs as of "viscoelastic": the same factor, companions as stiff per length, the same errors."""
    quilt, known = found["sides"]["quilt"], found["sides"]["viscoelastic"]
    assert found["calibrated"]["quilt"] == found["calibrated"]["viscoelastic"]
    np.testing.assert_allclose(found["held"]["quilt"][1], found["held"]["quilt"][0], rtol=1e-12)
    assert quilt["unknown"] == known["unknown"] == []
    of_disks = {f"{name}{kinks}" for name in ("grid", "time step") for kinks in ("", " at kinks")}
    assert quilt["causes"].keys() == known["causes"].keys() == of_disks | {"left side", "places", "sides"}
    for cause, errors in known["causes"].items():
        assert quilt["causes"][cause]["middle"] == pytest.approx(errors["middle"], rel=1e-9), cause


def test_coefficients_per_disk_are_those_per_metre_on_other_disks(found) -> None:
    """As those of a type with methods for larger disks."""
    np.testing.assert_allclose(found["held"]["mattress"][1], found["held"]["mattress"][0], rtol=1e-12)
    assert found["calibrated"]["mattress"] == found["calibrated"]["viscoelastic"]


def test_springs_that_differ_along_a_side_are_refused(found) -> None:
    said = (
        'boundary.right.type: "heather" has springs, which are not known for disks of another size; a type with '
        "springs other than in proportion to edge.widths needs the method equal_supports()"
    )
    assert found["held"]["heather"] == [[said]]


def test_dampers_without_factors_have_half_cells_on_larger_disks(found) -> None:
    """ρc_s D on each disk is what "viscous" has with β_S = 1: the same companion, and the same part of whole cells."""
    (damping, table, weight), (known, viscous, of_viscous) = found["shock"], found["like shock"]
    assert table["half_mass"]
    assert viscous["half_mass"]
    assert damping[1] == pytest.approx(known[1], rel=1e-9)
    assert weight == pytest.approx(of_viscous, rel=1e-9)
    assert 0.1 < weight < 0.5  # cells a third as large


def test_what_acts_on_single_disks_is_refused_where_it_is_not_known_on_larger_ones(found) -> None:
    said = 'boundary.right.type: "pads" has dampers, which are not known for disks of another size; a type with dampers'
    (line,) = found["pads"]
    assert line.startswith(said)


def test_the_sides_of_another_lattice_are_estimated_from_square_companions(found) -> None:
    """Within 15 % of what a run with far sides gives, at the uneven edge 20 %; on a square lattice 2 to 5 %.

    Companions under the material of the case, whose square lattice is softer, would be off by 19 to 33 %.
    """
    sides = found["hexagonal"]["causes"]["sides"]
    for monitor, added in found["far sides"].items():
        assert sides[monitor] == pytest.approx(added, rel=0.2 if monitor == "right" else 0.15), monitor
    # rows along the top, every second disk along the right side
    uneven = "edge: how single disks at an uneven edge move otherwise than those around, at right"
    assert found["hexagonal"]["unknown"] == [uneven]


def test_a_lattice_only_stands_for_the_ground_and_other_packings_are_the_ground(found) -> None:
    (may_change, radius), (may_not, _), (_, graded) = found["larger"]
    assert may_change
    assert radius == 0.125
    assert graded is None  # under a law by which smaller disks make a softer ground
    assert not may_not


def test_walls_in_a_lattice_without_planes_between_disks_are_half_a_disk_off(found) -> None:
    """One disk along the smaller half of a rectangle: 0.2 by its corners, half of half a disk of one; random: 0.75.

    A hole of another shape is as a round one of two disks, on the mean of all directions. The waves are short.
    """
    assert found["walls"] == pytest.approx(
        [BETWEEN * np.hypot(0.2, 0.25), OF_WAVES * LONGEST * 0.75, SHORT * (LIT + 0.5 * (DARK + CREEP * SHORT)) / 2.0]
    )


def test_only_rows_and_columns_of_disks_keep_waves_plane_between_free_sides(found) -> None:
    assert found["plane"] == [True, False]


def test_a_random_packing_has_the_draws_of_one_of_this_package(found) -> None:
    draw, seed = found["drawn"]
    assert draw["share"] == seed["share"] > 0.0
    assert draw["words"] == seed["words"] == "from runs with 2 seeds: how each differs from their mean"


def test_sizes_of_disks_are_charted_by_their_meaning(found) -> None:
    assert found["charted"] == [{}, {"packing.radius": 0.5}]


def test_a_law_that_breaks_is_its_own_linear_law_where_nothing_breaks(found) -> None:
    assert found["twin"] == "linear"
    assert found["shortened"][-1] == "the linear law"


def test_a_law_that_is_not_linear_is_refused_where_that_is_assumed(found) -> None:
    no_name = ['material.law: is "rubber", which is not linear, and names no linear law of its stiffness']
    unknown = ['material.law: is "rubber", which is not linear; errors are known only for linear laws']
    rubber = found["rubber"]
    assert rubber["calibrate"] == rubber["boundary"] == rubber["stability"] == no_name
    assert rubber["estimate"] == rubber["advise"] == unknown
    (line,) = found["rubber"]["library"]
    assert line.startswith('material.law: is "rubber", which is not linear; a library adds up motion, so "')


def test_mirrors_of_lattices_without_neighbours_straight_across_are_warned_of(found) -> None:
    """Random packings are mirrored disk by disk."""
    (line,), of_random = found["mirrors"]
    assert of_random == []
    assert line.startswith("boundary.bottom: the disks of pattern hexagonal have no neighbours straight across this ")


def test_sides_are_described_with_their_own_numbers(found) -> None:
    shock, mattress = found["described"]
    assert shock == "shock, damper = 500000"
    assert mattress.endswith(", stiffness = 2.5e+07")
