"""The command line: its files, messages and exit codes."""

import csv
import json
import re
import runpy
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from unittest.mock import ANY

import h5py
import numba
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image
from small_cases import small

from dembound import cli, starting
from dembound.boundaries import SIDES
from dembound.cli.app import ORDER, Side
from dembound.kinds import load
from dembound.machine import Memory
from dembound.version import __version__


def cells(line: str) -> list[str]:
    """The cells of a line of a printed table that are not empty."""
    return re.split(r"\s{2,}", line.strip())


def refused(answer, said: str, code: int = 2) -> None:
    """A command has ended with a code and this message, and has printed nothing else."""
    assert (answer.code, answer.out) == (code, "")
    assert said in answer.err


def files(folder: Path) -> set[str]:
    """All files below a folder."""
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


BLOW_UP = {"boundary.left": {"type": "velocity", "wave_p": "pulse"}, "run.duration": 0.05}


def test_the_module_is_the_command_which_tells_its_version_and_commands(monkeypatch, capsys, dembound) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    # .ci/run starts commands as processes of their own
    monkeypatch.setattr(sys, "argv", ["dembound", "--version"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_module("dembound", run_name="__main__")
    assert not ended.value.code
    assert capsys.readouterr().out == f"dembound {__version__}\n"

    told = dembound("--help")
    assert told.code == 0
    rows = re.findall(r"^│ (\w*) +\S.*│$", told.out.partition("─ Commands ─")[2], flags=re.MULTILINE)
    assert tuple(rows) == ORDER  # one line each
    assert tuple(Side) == SIDES


HEAVY = {"h5py", "matplotlib", "meshio", "numba", "numpy", "pyvista", "scipy", "vtkmodules"}
"""Packages that take long to import; pydantic is not among them, as typer imports it as well."""

FIGURES = {"matplotlib", "meshio", "pyvista", "vtkmodules"}
SIGNALS = {"scipy.optimize", "scipy.signal", "scipy.stats"}


COMMANDS = (
    (["--help"], HEAVY),
    (["run", "--help"], HEAVY),
    (["cases"], HEAVY),
    (["new", "--list"], HEAVY),
    (["new", "first.toml"], HEAVY - {"numpy"}),
    (["schema"], HEAVY - {"numpy"}),
)
"""One after the other in one process, each with what has not been imported until its end."""


def test_commands_import_only_what_they_use(tmp_path) -> None:
    check = (["check", "first.toml"], FIGURES | SIGNALS | {"h5py", "dembound.kinds.bar.kind"})
    steps = [*COMMANDS, check]
    program = f"""
import sys
from pathlib import Path
from dembound.cli import main
for number, words in enumerate({[words for words, _ in steps]}):
    sys.argv = ["dembound", *words]
    try:
        main()
    except SystemExit as end:
        assert not end.code
    Path(str(number)).write_text(" ".join(sys.modules))
"""
    subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, check=True)
    for number, (words, not_yet) in enumerate(steps):
        found = set((tmp_path / str(number)).read_text().split())
        assert "dembound.cli.app" in found
        assert not found & not_yet, words


def test_a_new_case_is_of_the_kind_that_its_name_says(dembound, tmp_path) -> None:
    listed = dembound("new", "--list")
    assert [line.split()[0] for line in listed.out.splitlines()] == starting.names()
    assert files(tmp_path) == set()
    for words, said in (
        (["--from", "rock", "a.toml"], '--from: is "rock", must be one of long_bar, '),
        (["."], "FILE: is the folder ., must be a file in it, such as case.toml"),
        (["--from", "quickstart"], "quickstart is one of `dembound cases`; to copy it: dembound cases copy quickstart"),
    ):
        refused(dembound("new", *words), said)
        assert files(tmp_path) == set()

    assert dembound("new", "rock_bar.toml").code == 0
    assert dembound("new", "tunnel").code == 0
    assert dembound("new", "excavation", "--from", "lamb").code == 0
    assert dembound("new", "other").code == 0
    starts = {"tunnel": "tunnel", "rock_bar": "rock_bar", "excavation": "lamb", "other": starting.DEFAULT}
    for file, start in starts.items():
        assert load(tmp_path / f"{file}.toml").title == starting.titles()[start]
    assert dembound("check", "rock_bar.toml") == (0, ANY, "")  # nothing to be warned of


def test_editors_find_the_schema_beside_a_new_case(dembound, tmp_path) -> None:
    (tmp_path / "mine").mkdir()
    dembound("new", "mine/first.toml")
    assert files(tmp_path) == {"mine/first.toml", "mine/dembound.schema.json"}
    assert (tmp_path / "mine" / "first.toml").read_text().startswith("#:schema ./dembound.schema.json\n")
    schema = (tmp_path / "mine" / "dembound.schema.json").read_text()
    assert dembound("schema").out == schema

    (tmp_path / "mine" / "dembound.schema.json").write_text(schema.replace("duration", "old"))  # an earlier version's
    dembound("new", "mine/second.toml")
    assert (tmp_path / "mine" / "dembound.schema.json").read_text() == schema


def test_new_overwrites_nothing(dembound, tmp_path) -> None:
    (tmp_path / "mine.toml").write_text("precious")
    answer = dembound("new", "mine.toml")

    assert answer == (2, "", "mine.toml: exists already, give another name\n")
    assert (tmp_path / "mine.toml").read_text() == "precious"

    (tmp_path / "dembound.schema.json").write_text("precious")
    answer = dembound("new", "other.toml")
    said = "dembound.schema.json: exists and is not a schema of dembound; move it, or give --no-schema\n"
    assert answer == (2, "", said)
    assert dembound("new", "--no-schema", "other.toml").code == 0
    assert (tmp_path / "dembound.schema.json").read_text() == "precious"


def test_shipped_cases_are_listed_and_copied(dembound, tmp_path) -> None:
    listed = dembound("cases")
    assert listed.code == 0
    assert {"quickstart", "zhou2018/tunnel"} <= {line.split()[0] for line in listed.out.splitlines()}
    assert files(tmp_path) == set()
    assert dembound("cases", "copy", "spall") == (0, "wrote spall.toml\nwrote spall_pulse.txt\n", "")
    assert dembound("cases", "copy", "spall").code == 2
    assert dembound("cases", "copy", "zhou2018/tunnel", "there").code == 0
    assert files(tmp_path) == {"spall.toml", "spall_pulse.txt", "there/tunnel.toml"}


def test_all_mistakes_are_told_at_once_and_nothing_is_written(dembound, written, tmp_path) -> None:
    good, path = written("good"), written()
    right = path.read_text()
    text = right.replace("density = 2500.0", "density = -1.0").replace('"viscous"', '"vicious"')
    path.write_text(text + "\n[outptu]\n")
    before = files(tmp_path)
    answer = dembound("run", good, path)  # the first is not run either
    refused(answer, "")
    lines = answer.err.splitlines()
    assert len(lines) == 3
    assert all(line.startswith(f"{path}: ") for line in lines)
    for part in ("material.density", "boundary.right.type", "outptu"):
        assert any(part in line for line in lines)
    assert dembound("run", "nowhere.toml") == (2, "", "nowhere.toml: no such file\n")
    for setting in ("beta", " =1", "..=1", "boundary.right.beta_p=-1", "boundary.right.beat_p=1"):
        assert dembound("run", good, "--set", setting).code == 2
    answer = dembound("run", good, "--threads", numba.get_num_threads() + 1)
    assert (answer.code, answer.err[:11]) == (2, "--threads: ")
    assert files(tmp_path) == before


def test_check_prints_facts_and_warnings_and_writes_nothing(dembound, spalling, written, tmp_path) -> None:
    path = written()
    (tmp_path / "rod.toml").write_text(spalling().text, encoding="utf-8")
    before = files(tmp_path)
    answer = dembound("check", path)

    assert answer.code == 0
    assert "particles" in answer.out
    assert "bar: warning: wave.pulse: has " in answer.err
    assert dembound("exact", "rod.toml").err == "rod.toml: is the case of a bar, this command is for disks\n"
    assert dembound("dispersion", path).err == "bar: is the case of disks, this command is for bars\n"
    assert files(tmp_path) == before


def test_a_run_tells_its_warnings_what_happened_and_is_named(dembound, written, tmp_path) -> None:
    breaking = {
        "material.law": "linearpbond",
        "material.pb_ten": 1e6,
        "boundary.left": {"type": "velocity", "wave_p": "pulse"},
        "wave.pulse.amplitude": -5.0,
        "load": [{"name": "weight", "acceleration": [5.0, 0.0]}],
    }
    path = written(changes=breaking)
    answer = dembound("run", path, "--set", "boundary.right.beta_p=0.5", "--set", "title=soft end", "--name", "soft")

    assert answer.code == 0
    found = json.loads((tmp_path / "results" / "soft" / "summary.json").read_text())
    assert found["boundaries"]["right"]["beta_p"] == 0.5
    assert found["title"] == "soft end"
    # where kernels are compiled meanwhile, a line of progress may stand between the warnings
    warned = [line for line in answer.err.splitlines() if "particle-steps/s" not in line]
    assert warned == [f"soft: warning: {warning}" for warning in found["warnings"]]


def test_cases_are_run_one_after_the_other_and_differences_told(dembound, written, monkeypatch, tmp_path) -> None:
    monkeypatch.setattr(cli.results.out, "width", 80)
    moved = {"monitor": [{"name": "middle", "position": [6.0, 0.5]}]}
    ran = dembound("run", written("one"), written("two"), written("other", moved), "--output", "kept")
    assert ran.code == 0
    answer = dembound("compare", "kept/one", "kept/two", "kept/other")

    assert answer.code == 0
    assert [cells(line)[:2] for line in answer.out.splitlines()[3:5]] == [["two", "middle"], ["other", "middle"]]
    places = "(5.75, 0.25) m in other, (4.75, 0.25) m in the reference"
    assert answer.out.replace("\n", " ").endswith(f"middle: the places compared are 1 m apart: {places} ")

    # damaged records end with 5
    record = tmp_path / "kept" / "one" / "run.h5"
    record.write_bytes(record.read_bytes()[:20_000])
    for words in (["plot"], ["plot", "--energy"], ["gauge"], ["compare", "kept/two"]):
        answer = dembound(*words, "kept/one")
        assert answer.code == 5
        (line,) = answer.err.splitlines()
        assert "run.h5: is truncated" in line


def test_a_run_that_blows_up_ends_with_3_and_says_where(dembound, written, tmp_path, unstable) -> None:
    with unstable():
        answer = dembound("run", written(changes=BLOW_UP))

    assert answer.code == 3
    assert re.search(r"without bound: at t = [\d.]+ s near \([\d.]+, [\d.]+\) m", answer.err)
    assert [path.name for path in (tmp_path / "results").iterdir()] == ["bar.partial"]


def test_a_packing_that_cannot_be_made_ends_with_4(dembound, written, monkeypatch) -> None:
    from dembound.packings import bed  # a bed that may take no steps never comes to rest

    monkeypatch.setattr(bed, "MAX_STEPS", 1)
    unpacked = {"pattern": "B", "size": [5.0, 5.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [5.0, 5.0], "seed": 9}
    refused(dembound("run", written(changes={"packing": unpacked, "monitor": []})), "did not come to rest", 4)


def test_a_case_larger_than_the_machine_is_refused_with_both_numbers(dembound, written, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("dembound.motion.memory.memory_here", lambda: Memory(8e9, 6e9))
    large = written("large", {"packing.size": [1e4, 1e4]})
    for name in ("check", "run", "packing"):
        answer = dembound(name, large)
        assert answer.code == 2
        sizes = r"need about [\d.e+]+ GB of memory, this machine has 8 GB, 6 GB of it free\n"
        assert re.fullmatch(rf"(large: )?packing\.size: \S+ disks {sizes}", answer.err)
    assert files(tmp_path) == {"large.toml"}


COMMENTED = """\
#:schema ./dembound.schema.json
# A short bar.
packing = {pattern = "A", size = [20.0, 1.0], radius = 0.5}   # equal disks
material = {density = 2500.0, p_wave_speed = 1000.0}
motion.held = ["y"]

[boundary.left]
type = "viscous_input"
wave_p = "pulse"

[boundary.right]          # absorbs
type = "viscous"
beta_p = 0.5              # to be calibrated

[wave.pulse]
type = "cosine"
amplitude = 1.0           # m/s
period = 0.05

[run]
duration = 0.1
"""


def test_a_calibration_writes_the_case_with_its_factor_beside_it(dembound, tmp_path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "bar.toml").write_text(COMMENTED)
    answer = dembound("calibrate", "mine/bar.toml", "--boundary", "right")

    assert answer.code == 0
    folder = "results/bar_calibration_right_p_impedance"
    left = {f"{folder}/{name}" for name in ("calibration.h5", "convergence.png", "summary.json")}
    assert files(tmp_path) == {*left, "mine/bar.toml", "mine/bar_calibrated.toml"}
    with h5py.File(tmp_path / folder / "calibration.h5") as file:
        beta = float(file.attrs["result"])
    text = (tmp_path / "mine" / "bar_calibrated.toml").read_text()
    assert text == COMMENTED.replace("beta_p = 0.5 ", f"beta_p = {beta} ")

    # the next side in the case that was left; then all sides at once, of the same case
    assert dembound("calibrate", "mine/bar_calibrated.toml", "-b", "left", "--method", "homogenised").code == 0
    both = (tmp_path / "mine" / "bar_calibrated.toml").read_text()
    assert both == text.replace('wave_p = "pulse"\n', 'wave_p = "pulse"\nbeta_p = 1.0\n', 1)
    assert dembound("calibrate", "mine/bar.toml", "--all", "--method", "homogenised").code == 0
    assert (tmp_path / "mine" / "bar_calibrated.toml").read_text() == both.replace(f"beta_p = {beta} ", "beta_p = 1.0 ")
    assert (tmp_path / "mine" / "bar.toml").read_text() == COMMENTED


def test_a_calibration_replaces_no_other_case(dembound, tmp_path) -> None:
    (tmp_path / "bar.toml").write_text(COMMENTED)
    options = ("bar.toml", "-b", "right", "--method", "homogenised")
    for other in (COMMENTED.replace("0.1\n", "0.2\n"), COMMENTED.replace("# equal", "# my"), "no TOML = ="):
        (tmp_path / "bar_calibrated.toml").write_text(other)
        said = "bar_calibrated.toml: exists already and differs from the case by more than boundary."
        refused(dembound("calibrate", *options), said)
        assert (tmp_path / "bar_calibrated.toml").read_text() == other
        assert files(tmp_path) == {"bar.toml", "bar_calibrated.toml"}  # before anything is computed
    assert dembound("calibrate", *options, "--calibrated", "new.toml", "--set", "run.duration=0.3").code == 0
    changed = COMMENTED.replace("beta_p = 0.5 ", "beta_p = 1.0 ").replace("duration = 0.1", "duration = 0.3")
    assert (tmp_path / "new.toml").read_text() == changed


def test_all_sides_are_calibrated_at_once_and_leave_one_case(dembound, written, tmp_path) -> None:
    path = written(changes={"wave.pulse.period": 0.05, "boundary.right.beta_p": 0.5})
    assert dembound("calibrate", path) == (2, "", "--boundary: is missing; name a side, or give --all\n")
    answer = dembound("calibrate", path, "--all", "-b", "left", "--wave", "p")
    assert answer.code == 2
    assert [line.split(":")[0] for line in answer.err.splitlines()] == ["--boundary", "--wave"]
    answer = dembound("calibrate", path, "--boundary", "top")
    assert answer == (2, "", "boundary.top: is free, only sides with dashpots can be calibrated; here: left, right\n")
    assert not (tmp_path / "results").exists()

    answer = dembound("calibrate", path, "--all", "--tolerance", "1e-2")
    assert answer.code == 0
    folder = tmp_path / "results" / "bar_calibration"
    records = {"left_p/calibration.h5", "right_p/calibration.h5"}
    assert files(folder) == {*records, "summary.json", "convergence.png"}
    found = json.loads((folder / "summary.json").read_text())["result"]
    sides = load(tmp_path / "bar_calibrated.toml").boundary
    assert found == {f"boundary.{side}.beta_p": sides[side].beta_p for side in ("left", "right")}
    assert dembound("plot", folder / "left_p", folder / "right_p", "-o", "passes.png").code == 0
    assert (tmp_path / "passes.png").read_bytes().startswith(PNG)


PNG = b"\x89PNG"


def test_runs_are_drawn_and_compared(dembound, small_run, other_run, spalled_run, cracked_run, tmp_path) -> None:
    for name, words in (
        ("energy", [cracked_run, "--energy"]),
        ("scene", [small_run, "--field", "velocity", "--snapshot", "-1"]),
        ("forces", [cracked_run, "--field", "forces", "--snapshot", "-1"]),
        ("damage", [spalled_run, "--field", "damage", "--snapshot", "-1"]),
    ):
        assert dembound("plot", *words, "-o", f"{name}.PNG") == (0, f"wrote {name}.PNG\n", "")
        assert (tmp_path / f"{name}.PNG").read_bytes().startswith(PNG)
    answer = dembound("compare", spalled_run, spalled_run, "--quantity", "stress")
    assert answer.code == 0
    assert answer.out.split()[-5:-2] == ["x", "0", "0"]

    answer = dembound("plot", small_run, "-o", "plot.png", "--table", "plot.csv", "--monitor", "back")
    assert (answer.code, answer.out) == (0, "wrote plot.png\nwrote plot.csv\n")
    heads, *rows = csv.reader((tmp_path / "plot.csv").open(encoding="utf-8"))
    assert heads == ["time (ms)", "back, small: velocity along x (m/s)"]
    with h5py.File(small_run) as file:
        back = file["histories/back"]
        expected = np.column_stack([1e3 * back["time"][:], back["velocity"][:, 0]])
    # ten digits are written
    np.testing.assert_allclose(np.array(rows, dtype=float), expected, rtol=1e-9)


def test_what_cannot_be_drawn_is_bad_input(dembound, written, spalled_run, small_run, other_run, tmp_path) -> None:
    (tmp_path / "passes").mkdir()
    (tmp_path / "passes" / "calibration.h5").touch()
    written()
    before = files(tmp_path)
    both = "RESULTS: holds runs of bars and runs of disks, which cannot be drawn in one picture; name one kind\n"
    of_monitors = ("--quantity", "velocity", "--component", "x", "--monitor", "gauge")
    alone = "".join(f"{option}: is not allowed together with --field\n" for option in ("--energy", *of_monitors[::2]))
    for arguments, said in (
        (["plot", "nowhere"], "nowhere: contains no results"),
        (["plot", "bar.toml"], "bar.toml: cannot be read as a record of results"),
        (["plot", small_run, "passes"], "cannot be drawn in one picture"),
        (["plot", spalled_run, small_run], both),
        (["plot", small_run, other_run, "--energy"], "--energy: shows one run"),
        (["plot", "passes", "--boundary", "left"], "--boundary: is for runs, not for calibrations\n"),
        (["plot", small_run, "--snapshot", "0"], "--snapshot: goes with --field"),
        (["plot", spalled_run, "--field", "damage", "--energy", *of_monitors], alone),
        (["plot", small_run, "--field", "velocity", "--table", "a.csv"], "--table: is of lines, a field has none"),
        (["compare", small_run, small_run, "--quantity", "stress"], "has no stress of its monitors"),
        (["plot", spalled_run, "--output", "picture"], "--output: is picture, must end in .png\n"),
        *(
            ([*words, "--output", "picture.pdf"], "--output: is picture.pdf, must end in .png\n")
            for words in (["gauge", spalled_run], ["packing", "missing.toml"], ["dispersion"])
        ),
    ):
        refused(dembound(*arguments), said, 5 if arguments[1] == "bar.toml" else 2)
    assert files(tmp_path) == before


def test_pages_and_movies_are_written(dembound, small_run, other_run, spalled_run, tmp_path) -> None:
    answer = dembound("report", other_run, "-o", "page.html")
    assert answer.code == 0
    assert f"{other_run}: has no snapshots" in answer.err
    assert re.fullmatch(r"wrote page\.html \(0\.\d MB\)\n", answer.out)
    assert (tmp_path / "page.html").read_text(encoding="utf-8").startswith("<!doctype html>")
    options = ("--every", "6", "--size", "200", "--exaggerate", "50", "--fps", "5", "--monitor", "gauge")
    answer = dembound("movie", spalled_run, "-o", "bar.gif", "--field", "velocity", *options)
    assert (answer.code, answer.err) == (0, "")
    assert re.fullmatch(r"wrote bar\.gif \(3 frames, 0\.\d MB\)\n", answer.out)
    with Image.open(tmp_path / "bar.gif") as picture:
        assert (picture.size[0], picture.n_frames, picture.info["duration"]) == (200, 3, 200)
    for arguments, said in (
        (("report", small_run, "-o", "page.pdf"), "--output: is page.pdf, must end in .html\n"),
        (("movie", small_run, "-o", "m.png"), "--output: is m.png, must end in .gif, or have no ending: a "),
    ):
        refused(dembound(*arguments), said)
    assert dembound("report", small_run, "-o", "nowhere/page.html").code == 5


def test_bricks_are_told_of_and_kept_where_the_command_says_until_they_are_cleared(
    dembound, written, tmp_path, monkeypatch
) -> None:
    monkeypatch.setenv("DEMBOUND_CACHE", str(tmp_path / "bricks"))
    dense = {"pattern": "B", "size": [2.0, 2.0], "radius": 0.1, "radius_ratio": 1.5, "brick": [2.0, 2.0]}
    path = written(changes={"packing": dense, "monitor": [], "boundary.right": {"type": "free"}})
    told = dembound("check", path).err.splitlines()
    assert re.fullmatch(r"packing a brick of \d+ disks", told[0])
    assert dembound("check", path).err.splitlines() == told[1:]
    assert len(list((tmp_path / "bricks").iterdir())) == 1

    assert dembound("cache").out == f"{tmp_path / 'bricks'}\n"
    assert "deleted 1 brick" in dembound("cache", "--clear").out
    assert not list((tmp_path / "bricks").iterdir())


def test_what_cannot_be_written_is_named_and_nothing_deleted_that_no_run_has_written(
    dembound, written, small_run, tmp_path
) -> None:
    path = written()
    (tmp_path / "file").write_text("")
    for arguments in (["new", "nowhere/case.toml"], ["run", path, "--output", "file"]):
        answer = dembound(*arguments)
        assert answer.code == 5
        assert len(answer.err.splitlines()) == 1
    for arguments in (["plot", small_run, "-o", "nowhere/plot.png"], ["dispersion", "--table", "nowhere/table.csv"]):
        assert dembound(*arguments) == (5, "", "nowhere: there is no such folder\n")
    (tmp_path / "bar").mkdir()
    (tmp_path / "bar" / "notes.txt").write_text("precious")
    answer = dembound("run", path, "--output", ".")
    assert answer.code == 2
    assert answer.err.startswith("bar: exists and holds no run")
    assert (tmp_path / "bar" / "notes.txt").read_text() == "precious"


@pytest.fixture
def titles(monkeypatch) -> list[str]:
    """All that figures are given as their titles, in this order; none is drawn."""
    given: list[str] = []
    monkeypatch.setattr(Figure, "suptitle", lambda _, title, **rest: given.append(title))
    return given


def test_dispersion_is_told_drawn_and_written(dembound, titles, tmp_path) -> None:
    said = "--horizon: is 0, must be 1 to 1000\n--spacing: is -1, must be 1e-30 to 1e+30 m\n"
    assert dembound("dispersion", "--horizon", 0, "--spacing", -1) == (2, "", said)
    said = "--set: changes a case, and none is given\n"
    assert dembound("dispersion", "--set", "run.time_step=1e-6") == (2, "", said)
    assert not files(tmp_path)
    asked = ("--horizon", 1, "--horizon", 3, "--time-step", 2e-6, "--table", "table.csv", "--title", "figure 1")
    answer = dembound("dispersion", *asked)

    assert (answer.code, titles[-1]) == (0, "figure 1")
    first, second = [line for line in answer.out.splitlines() if "2e-06" in line]
    assert "unstable" in first  # cΔt/Δx = 1.1052
    assert "24.9" in second  # spacings per wavelength, below the 28.6 of short steps
    assert answer.out.splitlines()[-2:] == ["wrote dispersion.png", "wrote table.csv"]
    assert files(tmp_path) == {"dispersion.png", "table.csv"}


def test_what_sides_send_back_is_printed_drawn_and_written(dembound, written, tmp_path) -> None:
    path = written("small.toml")
    top = ["--set", 'boundary.top={type="viscous",beta_s=0.5}', "--side", "top"]
    asked = ["--angle", 0, "--angle", 30, "--frequency", 5, "--table", "table.csv"]
    answer = dembound("boundary", path, "--side", "right", *top, *asked)

    assert answer.code == 0
    wrote = [f"wrote {name}" for side in ("right", "top") for name in (f"boundary_{side}.png", f"table_{side}.csv")]
    assert [line for line in answer.out.splitlines() if line.startswith("wrote")] == wrote
    # S: (1 − β)/(1 + β) = 1/3 of the amplitude for β = 0.5; tan(qa/4) = 1 % for a whole last mass
    assert "returns 11.1 % of the energy, 33.4 % of the amplitude; with matched β 0.00992 %" in answer.out
    quick = dembound("boundary", path, *top, "--angle", 0, "--frequency", 5, "--quick")
    assert "returns 11.1 % of the energy, 33.3 % of the amplitude; with matched β 0 %" in quick.out
    springs = '{type = "viscoelastic", distance = 100}'
    several = ["--type", "viscous", "--type", springs, "--frequency", 5, "--frequency", 50, "--table", "types.csv"]
    compared = dembound("boundary", path, "--side", "right", *several)
    assert compared.code == 0
    rows = [cells(line)[0] for line in compared.out.splitlines() if " P 0°" in line]
    assert rows == ["viscous", "viscoelastic, distance 100"]
    assert compared.out.splitlines()[-2:] == ["wrote boundary.png", "wrote types.csv"]
    assert "--quick: is not possible with --type" in dembound("boundary", path, *several, "--quick").err


def test_stability_is_told_drawn_and_written_and_what_is_not_stable_ends_with_3(dembound, written, tmp_path) -> None:
    answer = dembound("stability", written(), "--steps", 500, "--table", "table.csv", "-o", "noise.png")

    assert answer.code == 0
    (row,) = (cells(line) for line in answer.out.splitlines() if line.strip().startswith("elastic"))
    name, limit, measured, own, *_, verdict = " ".join(row).split()
    assert (name, verdict) == ("elastic", "stable")
    assert float(limit) > 0.0
    assert float(measured) == pytest.approx(1.0, abs=1e-3)
    assert float(own) == pytest.approx(0.9, abs=1e-3)
    assert files(tmp_path) == {"bar.toml", "noise.png", "table.csv"}
    assert "elastic: noise grows at 1.0005" in answer.err

    answer = dembound("stability", written("bar", {"run.time_step": 1e-3}), "--steps", 200)
    assert answer.code == 3
    assert "UNSTABLE" in answer.out
    assert answer.err.splitlines()[-1].startswith("elastic: not stable at the case's own step of 0.001 s; the largest")


STANDS = {
    "packing": {"pattern": "A", "size": [2.0, 1.5], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "contact_share": 1.0, "fric": 0.5, "law": "linearpbond"},
    "motion": {"held": ["rotation"]},
    "load": [{"name": "weight", "acceleration": [1.0, -9.81]}],
    "static": {"boundary": {"bottom": {"type": "fixed"}}},
    "run": {"duration": 0.1},
}
"""Three rows of disks that slide on each other at 0.5 g along x."""


def test_strength_is_told_and_written_and_what_falls_ends_with_3(dembound, tmp_path) -> None:
    path = tmp_path / "rows.toml"
    path.write_text(small(STANDS).text)
    answer = dembound("stability", path, "--strength", "--tolerance", 0.5)

    assert answer.code == 0
    *_, factor, right, left, wrote = answer.out.splitlines()
    assert (wrote, files(tmp_path)) == ("wrote strength.csv", {"rows.toml", "strength.csv"})
    for line, name, true in (
        (factor, "factor of safety", 0.5 * 9.81),
        (right, "yield acceleration to the right", 0.5 - 1.0 / 9.81),
        (left, "yield acceleration to the left", 0.5 + 1.0 / 9.81),
    ):
        stands, fails = re.fullmatch(rf"{name}: \S+(?: g)? \((\S+) stands, (\S+) fails\)", line).groups()
        assert float(stands) < true < float(fails)
    head, *rows = csv.reader((tmp_path / "strength.csv").open(encoding="utf-8"))
    table = [cells(line) for line in answer.out.splitlines() if line.startswith(("factor of safety ", "yield"))]
    assert len(rows) == len([row for row in table if len(row) == 8])
    assert {row[head.index("stands")] for row in rows} == {"yes", "no"}

    answer = dembound("stability", path, "--strength", "--tolerance", 0.5, "--set", "material.fric=0.05")
    assert answer.code == 3
    assert answer.err.splitlines()[-1].endswith("does not stand under its weight")
    assert "no yield acceleration: the body does not stand at full strength" in answer.out


PLACED = ("gauge.txt", "--position", 0.6, "--length", 0.99)


def test_a_gauge_tells_what_its_history_and_options_allow(dembound, felt, titles, tmp_path) -> None:
    time, stress = felt()
    np.savetxt("gauge.txt", np.column_stack([time, 1e6 * stress]))
    np.savetxt("end.txt", np.column_stack([time, np.interp(time, [0.0, 1e-4, 2e-4, 3e-4], [0.0, 10.0, 4.0, 8.0])]))

    alone = dembound("gauge", *PLACED)
    assert alone.code == 0
    speed, attenuation = [cells(line) for line in alone.out.splitlines() if "peaks" in line]
    # as good as the lines through the peaks are: 0.04 % and 1 %
    assert float(speed[1]) == pytest.approx(2740.0, rel=4.2e-4)
    assert float(attenuation[1]) == pytest.approx(0.52, rel=0.01)
    assert "strength" not in alone.out

    known = ("--wave-speed", 2740, "--attenuation", 0.52, "--density", 2620)
    drawn = ("-o", "gauge.png", "--title", "figure 1")
    full = dembound("gauge", *PLACED, *known, "--spall", 0.9, "--free-end", "end.txt", *drawn)
    assert full.code == 0
    assert titles[-1] == "figure 1"
    rows = [line.split() for line in full.out.splitlines() if "strength" in line]
    assert [row[0] for row in rows] == ["nominal", "attenuated", "pull-back"]
    assert "21.54" in full.out  # ½ · 2620 · 2740 · 6 Pa
    assert full.out.splitlines()[-1] == "wrote gauge.png"
    assert (tmp_path / "gauge.png").read_bytes().startswith(PNG)


def test_the_starter_of_a_bar_tells_its_strength_and_no_speed(dembound) -> None:
    dembound("new", "--from", "rock_bar", "bar.toml")
    few = ("--set", "output.pictures=false", "--set", "output.snapshots=1")
    assert dembound("run", "bar.toml", *few).code == 0
    told = dembound("gauge", "results/bar", "--free-end", "end", "--spall", 0.907)
    assert (told.code, told.err) == (0, "")
    rows = [cells(line) for line in told.out.splitlines()[3:9]]
    assert rows[5][:2] == ["strength of the bar (MPa)", "10"]
    # it breaks at 10 MPa from 0.905 to 0.909 m, by bonds of up to 3 mm: all that is told is known to some 5 mm, over
    # which the tension beside the end changes by 12 MPa · 2 · 5 mm/(2740 m/s · 80 µs)
    known = 12.0 * 2.0 * 0.005 / (2740.0 * 80e-6)
    assert float(rows[2][1]) == pytest.approx(10.0, abs=known)
    assert float(rows[4][1]) == pytest.approx(10.0, abs=known)


@pytest.fixture
def rod(spalling, tmp_path) -> Callable[..., None]:
    """Writes rod.toml, a small bar, with keys changed."""
    return lambda changes=None: (tmp_path / "rod.toml").write_text(spalling(changes).text, encoding="utf-8")


def test_a_chart_is_printed_drawn_resumed_and_replaced(dembound, rod, tmp_path) -> None:
    rod()
    folder = tmp_path / "results" / "rod_chart"
    assert dembound("chart", "rod.toml", "--vary", "bar.spacing=0.3").code == 2
    assert not (tmp_path / "results").exists()

    vary = ["--vary", "bar.spacing=0.05,0.025,0.03", "--vary", "run.courant=0.9,3.0", "--repeats", 1]
    done = dembound("chart", "rod.toml", *vary)
    assert done.code == 0
    assert "rod: spacing 0.03 m, courant 0.9: left out, bar.spacing: is 0.03, must divide" in done.err
    assert "rod: spacing 0.05 m, courant 3: failed, run.courant: is 3" in done.err
    assert {path.name for path in folder.iterdir()} == {"chart.h5", "chart.csv", "chart.png"}

    before = (folder / "chart.csv").read_text(encoding="utf-8")
    again = dembound("chart", "rod.toml", *vary, "--resume")
    assert again.code == 0
    assert (folder / "chart.csv").read_text(encoding="utf-8") == before  # with the costs measured before

    # another takes its place, and other files stay; it is the table of the case, beside its finest run at 0.525 m,
    # which has nodes at 0.5 and 0.525 m
    rod({"chart": {"vary": {"bar.spacing": [0.05, 0.025]}, "repeats": 1, "reference": "finest"}})
    (folder / "thesis.tex").touch()
    (folder / "chart.h5.log").touch()  # of a process that was killed
    second = dembound("chart", "rod.toml", "--title", "Mine")
    said = f"{folder.relative_to(tmp_path)}: replacing the chart of before, whose runs --resume would keep"
    assert second.err.splitlines()[0] == said
    assert {path.name for path in folder.iterdir()} == {"chart.h5", "chart.csv", "chart.png", "thesis.tex"}
    assert "velocity beside the finest run, spacing 0.025 m" in second.out


def test_markup_in_titles_and_names_is_text(dembound, written, tmp_path) -> None:
    path = written("[bold]", {"title": "[/bold] $x^{$ :smile:"})
    assert "[bold]: [/bold] $x^{$ :smile:" in dembound("check", path).out
    told = dembound("run", path).out
    assert f": results in {Path('results') / '[bold]'}\n" in told
    assert dembound("plot", "results/[bold]", "--title", "[/bold] $x^{$", "-o", "[p].png").out == "wrote [p].png\n"


def test_odd_values_are_bad_input_in_one_line(dembound, written, tmp_path) -> None:
    path = written()
    odd = tmp_path / "a\nb.toml"
    odd.write_text(path.read_text())
    for arguments, said in (
        ([path, "--set", 'title="a\\u001b[2J"'], r'bar: title: is "a\x1b[2J", must be one line without control char'),
        ([path, "--set", f"a{'.a' * 2000}=1"], f"{'a.' * 20}…: has 2000 dots, must have at most 30"),
        ([path, "--set", "packing.radius=1e-9"], "bar: packing.size: holds "),
        ([path, "--name", "a\x1bb"], r"--name: is 'a\x1bb', must have no control characters"),
        ([odd], r"a\nb.toml: has a name with control characters or bytes that are not text, rename it"),
    ):
        answer = dembound("run", *arguments)
        assert answer.code == 2
        (line,) = answer.err.splitlines()
        assert said in line
        assert "\x1b" not in line


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["boundary", "viscous", "--angle", "nan"], "--angle: is nan"),
        (["gauge", "any.csv", "--band", "5", "inf"], "--band: is inf"),
    ],
)
def test_options_that_are_no_finite_number_are_refused_before_anything_else(dembound, arguments, said) -> None:
    answer = dembound(*arguments)
    assert (answer.code, answer.err) == (2, f"{said}, must be a finite number\n")
