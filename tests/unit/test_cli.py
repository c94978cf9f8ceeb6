"""The command line: what it writes, what it says, and the code it ends with."""

import csv
import inspect
import json
import re
import runpy
import subprocess
import sys
import warnings
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import ANY

import h5py
import numba
import numpy as np
import pytest
import tomli_w
from matplotlib.figure import Figure
from PIL import Image
from rich.text import Text

from dembound import cli, starting
from dembound.boundaries import SIDES
from dembound.casefile.bar import BarCase
from dembound.cli.app import Side
from dembound.cli.progress import Lines, progress_of
from dembound.kinds import load
from dembound.machine import Memory
from dembound.motion.simulation import Simulation
from dembound.plot import style
from dembound.running import plan
from dembound.version import __version__


def cells(line: str) -> list[str]:
    """The cells of a line of a printed table that are not empty."""
    return re.split(r"\s{2,}", line.strip())


def files(folder: Path) -> set[str]:
    """All files below a folder."""
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


BLOW_UP = {"boundary.left": {"type": "velocity", "wave_p": "pulse"}, "run.duration": 0.05}


def test_the_module_is_the_command(monkeypatch, capsys) -> None:
    # test_view.py and .ci/run start commands as processes of their own
    monkeypatch.setattr(sys, "argv", ["dembound", "--version"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_module("dembound", run_name="__main__")

    assert not ended.value.code
    assert capsys.readouterr().out == f"dembound {__version__}\n"


def test_version_and_help_end_well(dembound) -> None:
    assert dembound("--version") == (0, f"dembound {__version__}\n", "")
    told = dembound("--help")
    assert told.code == 0
    commands = "new cases schema check run calibrate plot report movie dispersion stability gauge"
    for command in commands.split():
        assert command in told.out


HEAVY = {"h5py", "matplotlib", "meshio", "numba", "numpy", "pyvista", "scipy", "vtkmodules"}
"""Packages that take long to import; pydantic is not among them, as typer imports it as well."""

FIGURES = {"matplotlib", "meshio", "pyvista", "vtkmodules"}
SIGNALS = {"scipy.optimize", "scipy.signal", "scipy.stats"}


def imported(case: Path, *arguments: str) -> set[str]:
    """The modules that a command imports in a process of its own; CASE stands for the path of a case."""
    report = "import sys; print('\\n'.join(sys.modules), file=sys.__stdout__)"
    program = f"import atexit; atexit.register(lambda: exec({report!r})); from dembound.cli import main; main()"
    words = [str(case) if word == "CASE" else word for word in arguments]
    done = subprocess.run(
        [sys.executable, "-c", program, *words], cwd=case.parent, capture_output=True, text=True, check=True
    )
    return set(done.stdout.splitlines())


@pytest.mark.parametrize(
    ("arguments", "unused"),
    [
        (("--help",), HEAVY),
        (("run", "--help"), HEAVY),
        (("cases",), HEAVY),
        (("new", "--list"), HEAVY),
        (("new", "made.toml"), HEAVY - {"numpy"}),
        (("schema",), HEAVY - {"numpy"}),
        (("check", "CASE"), FIGURES | SIGNALS | {"h5py", "dembound.bar.kind"}),
    ],
)
def test_commands_import_only_what_they_use(written, arguments, unused) -> None:
    found = imported(written(), *arguments)
    assert "dembound.cli.app" in found
    assert not found & unused


def test_a_bar_does_not_need_disks(tmp_path) -> None:
    case = tmp_path / "bar.toml"
    case.write_text(starting.starting_point("rock_bar"))
    found = imported(case, "check", "CASE")
    assert "dembound.bar.kind" in found
    assert not found & (FIGURES | SIGNALS | {"h5py", "dembound.disks.kind"})


def test_completion_imports_nothing_large(written, monkeypatch) -> None:
    monkeypatch.setenv("_DEMBOUND_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", "dembound new --from ")
    monkeypatch.setenv("COMP_CWORD", "3")
    found = imported(written())
    assert starting.DEFAULT in found  # as a completion
    assert not found & HEAVY


def test_the_options_name_all_sides() -> None:
    assert tuple(Side) == SIDES


def test_helps_wrap_at_80_columns(dembound, command, monkeypatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    for name, each in command.commands.items():
        told = dembound(name, "--help").out
        # no type or list of choices is cut
        assert not re.findall(r"<[^>\n]*\n", told)
        # line breaks of all but a first paragraph would stay
        assert not [text for text in inspect.cleandoc(each.help).split("\n\n")[1:] if "\n" in text]
    assert "\n" not in command.epilog


def test_no_words_of_helps_are_taken_as_markup(command) -> None:
    """Such as "[reduce]", which would not be shown."""
    for name, each in command.commands.items():
        for words in [each.help, *(getattr(parameter, "help", None) for parameter in each.params)]:
            assert Text.from_markup(words or "").plain == (words or ""), name


def test_unknown_commands_and_options_are_bad_input(dembound) -> None:
    assert dembound("fly").code == 2
    assert dembound("run", "--fast").code == 2
    assert dembound("calibrate", "bar.toml", "--boundary", "up").code == 2


def test_a_new_case_can_be_checked_as_it_stands(dembound, tmp_path) -> None:
    assert dembound("new", "first.toml").code == 0

    assert load(tmp_path / "first.toml").name == "first"
    assert dembound("check", "first.toml").code == 0


def test_starting_points_are_listed_and_written_by_name(dembound, tmp_path) -> None:
    listed = dembound("new", "--list")
    assert [line.split()[0] for line in listed.out.splitlines()] == starting.names()
    assert files(tmp_path) == set()

    assert dembound("new", "--from", "rock_bar", "first.toml").code == 0
    assert isinstance(load(tmp_path / "first.toml"), BarCase)
    assert dembound("check", "first.toml") == (0, ANY, "")  # nothing to be warned of
    refused = dembound("new", "--from", "rock", "second.toml")
    assert refused.code == 2
    assert refused.err.startswith('--from: is "rock", must be one of long_bar, ')


def test_a_new_case_is_of_the_kind_that_its_name_says(dembound, tmp_path) -> None:
    assert (
        dembound("new", "tunnel").out.splitlines()[-1].startswith("wrote tunnel.toml from the starting point tunnel;")
    )
    assert dembound("new", "rock_bar.toml").code == 0
    assert dembound("new", "mine", "--from", "lamb").code == 0
    assert dembound("new", "excavation", "--from", "lamb").code == 0
    assert dembound("new", "other").code == 0
    for file, start in {
        "tunnel": "tunnel",
        "rock_bar": "rock_bar",
        "mine": "lamb",
        "excavation": "lamb",
        "other": starting.DEFAULT,
    }.items():
        assert load(tmp_path / f"{file}.toml").title == starting.titles()[start]
    assert dembound("new", "tunnel") == (2, "", "tunnel.toml: exists already, give another name\n")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["case.txt"], "FILE: is case.txt, must end in .toml, such as case.toml"),
        (["."], "FILE: is the folder ., must be a file in it, such as case.toml"),
        (["--from", "quickstart"], "quickstart is one of `dembound cases`; to copy it: dembound cases copy quickstart"),
    ],
)
def test_other_targets_of_new_are_answered(dembound, tmp_path, words, said) -> None:
    answer = dembound("new", *words)
    assert answer.code == 2
    assert answer.err.splitlines()[-1] == said
    assert files(tmp_path) == set()


def test_editors_find_the_schema_beside_a_new_case(dembound, tmp_path) -> None:
    (tmp_path / "mine").mkdir()
    dembound("new", "mine/first.toml")
    assert files(tmp_path) == {"mine/first.toml", "mine/dembound.schema.json"}
    assert (tmp_path / "mine" / "first.toml").read_text().startswith("#:schema ./dembound.schema.json\n")
    schema = (tmp_path / "mine" / "dembound.schema.json").read_text()
    assert dembound("schema").out == schema
    assert dembound("schema", "--output", "own.json").code == 0
    assert (tmp_path / "own.json").read_text() == schema

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
    assert files(tmp_path) == {"mine.toml", "other.toml", "dembound.schema.json"}
    assert (tmp_path / "dembound.schema.json").read_text() == "precious"


def test_shipped_cases_are_listed_and_copied(dembound, tmp_path) -> None:
    listed = dembound("cases")
    assert listed.code == 0
    names = [line.split()[0] for line in listed.out.splitlines()]
    assert {"quickstart", "zhou2018/tunnel"} <= set(names)
    assert files(tmp_path) == set()

    assert dembound("cases", "copy", "spall") == (0, "wrote spall.toml\nwrote spall_pulse.txt\n", "")
    assert dembound("check", "spall.toml").code == 0
    assert dembound("cases", "copy", "spall").code == 2
    assert dembound("cases", "copy", "zhou2018/tunnel", "there").code == 0
    assert files(tmp_path) == {"spall.toml", "spall_pulse.txt", "there/tunnel.toml"}


@pytest.mark.parametrize(
    ("typed", "offered"),
    [("dembound new --from ro", "rock_bar"), ("dembound cases copy zh", "zhou2018"), ("dembound calib", "calibrate")],
)
def test_the_shell_completes_commands_and_names(dembound, monkeypatch, typed: str, offered: str) -> None:
    monkeypatch.setenv("_DEMBOUND_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", typed)
    monkeypatch.setenv("COMP_CWORD", str(len(typed.split()) - 1))
    assert offered in dembound().out.split()


def test_all_mistakes_are_told_at_once_and_nothing_is_written(dembound, written, tmp_path) -> None:
    path = written()
    text = path.read_text().replace("density = 2500.0", "density = -1.0").replace('"viscous"', '"vicious"')
    path.write_text(text + "\n[outptu]\n")
    before = files(tmp_path)
    answer = dembound("run", path)

    assert answer.code == 2
    assert answer.out == ""
    lines = answer.err.splitlines()
    assert len(lines) == 3
    assert all(line.startswith(f"{path}: ") for line in lines)
    for part in ("material.density", "boundary.right.type", "outptu"):
        assert any(part in line for line in lines)
    assert files(tmp_path) == before


def test_a_missing_case_is_named(dembound) -> None:
    assert dembound("run", "nowhere.toml") == (2, "", "nowhere.toml: no such file\n")


def test_check_prints_facts_and_warnings_and_writes_nothing(dembound, written, tmp_path) -> None:
    path = written()
    before = files(tmp_path)
    answer = dembound("check", path)

    assert answer.code == 0
    assert "particles" in answer.out
    assert "right side" in answer.out
    assert "bar: warning: wave.pulse: has " in answer.err
    assert files(tmp_path) == before


def test_two_cases_are_run_one_after_the_other(dembound, written, tmp_path) -> None:
    answer = dembound("run", written("one"), written("two"), "--output", "kept")

    assert answer.code == 0
    saved = "rows: 2 identical rows are stepped as one, 20 of 40 disks"
    assert answer.out.splitlines() == [
        line for name in ("one", "two") for line in (f"{name}: {saved}", f"{name}: results in kept/{name}")
    ]
    for name in ("one", "two"):
        assert json.loads((tmp_path / "kept" / name / "summary.json").read_text())["name"] == name


def test_a_run_ends_by_telling_what_happened(dembound, written, tmp_path) -> None:
    breaking = {
        "material.law": "linearpbond",
        "material.pb_ten": 1e6,
        "boundary.left": {"type": "velocity", "wave_p": "pulse"},
        "wave.pulse.amplitude": -5.0,
    }
    answer = dembound("run", written(changes=breaking))

    found = json.loads((tmp_path / "results" / "bar" / "summary.json").read_text())
    told, _ = answer.out.splitlines()
    laws, cracks, energy = told.removeprefix("bar: ").split("; ")
    assert laws == f"elastic law to {found['laws'][1]['from']:.3g} s, then linearpbond"
    count = found["cracks"]["tension"]
    assert count > 0
    assert cracks.split(", one draw")[0] == f"{count} bonds broke ({count} tension, 0 shear)"
    assert energy == f"energy closes to {100.0 * found['energy']['relative_error']:.2g} %"


def test_a_mistake_in_the_last_case_keeps_the_first_from_running(dembound, written, tmp_path) -> None:
    good, bad = written("good"), written("bad")
    bad.write_text(bad.read_text().replace("density", "densitty"))

    assert dembound("run", good, bad).code == 2
    assert not (tmp_path / "results").exists()


def test_what_was_probably_not_meant_is_warned_of(dembound, written, tmp_path) -> None:
    weight = {"load": [{"name": "weight", "acceleration": [5.0, 0.0]}]}
    answer = dembound("run", written(changes=weight))

    assert answer.code == 0
    assert answer.err.startswith("bar: warning: load.weight: is steady, and without [static] acts suddenly")
    found = json.loads((tmp_path / "results" / "bar" / "summary.json").read_text())["warnings"]
    assert answer.err.splitlines() == [f"bar: warning: {warning}" for warning in found]


@dataclass
class Clock:
    """A clock that is set by hand."""

    time: float

    def __call__(self) -> float:
        return self.time


def test_off_a_terminal_a_run_says_every_ten_seconds_how_far_it_is(bar, capsys) -> None:
    planned = plan(bar())
    simulation = Simulation(planned.scene, planned.time_step)
    clock = Clock(100.0)
    lines = Lines("bar", clock)
    lines.warned("wave.pulse: is odd")
    for now, steps, compiled in ((100.0, 1, 0.0), (109.9, 9, 0.0), (112.0, 11, 2.0), (121.9, 5, 0.0)):
        clock.time = now
        simulation.clock.seconds["compile"] += compiled
        simulation.advance(steps)
        lines.running(simulation, 1234)
    clock.time = 122.0
    lines.running(simulation, 1234)

    # the first step only starts the clock; 20 steps of 40 disks in 12 s, 2 of them spent on compiling, then 5 in 10 s
    assert capsys.readouterr().err.splitlines() == [
        "bar: warning: wave.pulse: is odd",
        f"bar: 21 of 1,234 steps, {21 * planned.time_step:.4g} s simulated, 8e-05 M particle-steps/s",
        f"bar: 26 of 1,234 steps, {26 * planned.time_step:.4g} s simulated, 2e-05 M particle-steps/s",
    ]


def test_off_a_terminal_the_static_stage_says_so_too(capsys) -> None:
    clock = Clock(0.0)
    lines = Lines("bar", clock)
    for now, steps in ((9.0, 100), (10.0, 1200), (11.0, 1300), (21.0, 2400)):
        clock.time = now
        lines.settling(steps, 1e-3 / now)

    assert capsys.readouterr().err.splitlines() == [
        "bar: settling for 10 s, 1,200 steps, force ratio 1.0e-04",
        "bar: settling for 21 s, 2,400 steps, force ratio 4.8e-05",
    ]


def test_on_a_terminal_warnings_stand_above_the_bar(bar, monkeypatch, capsys) -> None:
    planned = plan(bar())
    simulation = Simulation(planned.scene, planned.time_step)
    monkeypatch.setattr(cli.progress.err, "_force_terminal", True)
    with progress_of("bar") as shown:
        shown.settling(100, 1e-3)
        shown.warned("wave.pulse: is odd")
        shown.running(simulation, 10)

    assert "bar: warning: wave.pulse: is odd\n" in capsys.readouterr().err


def test_differences_are_told_with_what_they_are_parts_of(dembound, written, monkeypatch) -> None:
    monkeypatch.setattr(cli.results.out, "width", 80)
    moved = {"monitor": [{"name": "middle", "position": [6.0, 0.5]}]}
    dembound("run", written("one"), written("two"), written("other", moved))
    answer = dembound("compare", "results/one", "results/two", "results/other")

    assert answer.code == 0
    for head in ("RMS (%)", "largest (%)", "end (m/s)", "reference"):
        assert head in answer.out
    assert [cells(line)[:2] for line in answer.out.splitlines()[4:6]] == [["two", "middle"], ["other", "middle"]]
    places = "(5.75, 0.25) m in other, (4.75, 0.25) m in the reference"
    assert answer.out.replace("\n", " ").endswith(f"middle: the places compared are 1 m apart: {places} ")
    assert "in two" not in answer.out


def test_an_exact_motion_that_there_is_none_of_leaves_nothing(dembound, written, tmp_path) -> None:
    assert dembound("exact", written()).code == 2
    assert not (tmp_path / "results").exists()


def test_two_cases_of_one_name_are_refused(dembound, written, tmp_path) -> None:
    path = written()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "bar.toml").write_text(path.read_text())
    answer = dembound("run", path, tmp_path / "other" / "bar.toml")

    assert answer.code == 2
    assert "same name" in answer.err


def test_a_run_that_blows_up_ends_with_3_and_says_where(dembound, written, tmp_path, unstable) -> None:
    with unstable():
        answer = dembound("run", written(changes=BLOW_UP))

    assert answer.code == 3
    assert "grew without bound: at t = " in answer.err
    assert [path.name for path in (tmp_path / "results").iterdir()] == ["bar.partial"]


def test_a_packing_that_cannot_be_made_ends_with_4(dembound, written, monkeypatch) -> None:
    from dembound.packings import bed  # a bed that may take no steps never comes to rest

    monkeypatch.setattr(bed, "MAX_STEPS", 1)
    unpacked = {"pattern": "B", "size": [5.0, 5.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [5.0, 5.0], "seed": 9}
    answer = dembound("run", written(changes={"packing": unpacked, "monitor": []}))

    assert answer.code == 4
    assert "did not come to rest" in answer.err


def test_keys_can_be_set_and_results_named(dembound, written, tmp_path) -> None:
    path = written()
    answer = dembound("run", path, "--set", "boundary.right.beta_p=0.5", "--set", "title=soft end", "--name", "soft")

    assert answer.code == 0
    found = json.loads((tmp_path / "results" / "soft" / "summary.json").read_text())
    assert found["boundaries"]["right"]["beta_p"] == 0.5
    assert found["title"] == "soft end"


@pytest.mark.parametrize("setting", ["beta", " =1", "..=1", "boundary.right.beta_p=-1", "boundary.right.beat_p=1"])
def test_bad_settings_are_bad_input(dembound, written, tmp_path, setting: str) -> None:
    assert dembound("run", written(), "--set", setting).code == 2
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize("name", ["check", "run", "packing"])
def test_a_case_larger_than_the_machine_is_refused_with_both_numbers(
    dembound, written, tmp_path, name, monkeypatch
) -> None:
    monkeypatch.setattr("dembound.motion.ram.memory_here", lambda: Memory(8e9, 6e9))
    large = written("large", {"packing.size": [1e4, 1e4]})
    answer = dembound(name, large)

    assert answer.code == 2
    sizes = r"need about [\d.e+]+ GB of memory, this machine has 8 GB, 6 GB of it free\n"
    assert re.fullmatch(rf"(large: )?packing\.size: \S+ disks {sizes}", answer.err)
    assert files(tmp_path) == {"large.toml"}


def test_more_threads_than_cores_are_refused(dembound, written) -> None:
    answer = dembound("run", written(), "--threads", numba.get_num_threads() + 1)

    assert answer.code == 2
    assert answer.err.startswith("--threads: ")


COMMENTED = """\
#:schema ./dembound.schema.json
# A short bar.

[packing]                 # equal disks
pattern = "A"
size = [20.0, 1.0]
radius = 0.5

[material]
density = 2500.0
p_wave_speed = 1000.0

[motion]
held = ["y"]

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
    assert len(str(beta)) <= 7
    assert f"β_P = {beta:g}\n" in answer.out
    passes = [line for line in answer.out.splitlines() if line.startswith("pass ")]
    assert passes[0].startswith("pass  1: β_P = 0.500000, M_out = ")
    assert len(passes) == 2
    assert dembound("check", "mine/bar_calibrated.toml").code == 0

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
        answer = dembound("calibrate", *options)
        assert answer.code == 2
        assert "bar_calibrated.toml: exists already and differs from the case by more than boundary." in answer.err
        assert (tmp_path / "bar_calibrated.toml").read_text() == other
        assert files(tmp_path) == {"bar.toml", "bar_calibrated.toml"}  # before anything is computed
    assert dembound("calibrate", *options, "--calibrated", "new.toml", "--set", "run.duration=0.3").code == 0
    changed = COMMENTED.replace("beta_p = 0.5 ", "beta_p = 1.0 ").replace("duration = 0.1", "duration = 0.3")
    assert (tmp_path / "new.toml").read_text() == changed
    assert dembound("calibrate", *options, "--name", "other").code == 0
    assert (tmp_path / "other_calibrated.toml").is_file()


def test_a_homogenised_calibration_has_no_passes_to_show(dembound, written, tmp_path) -> None:
    answer = dembound("calibrate", written(), "-b", "right", "--method", "homogenised")

    assert answer.code == 0
    assert "pass " not in answer.out
    assert not list((tmp_path / "results").rglob("convergence.png"))


def test_all_sides_are_calibrated_at_once_and_leave_one_case(dembound, written, tmp_path) -> None:
    path = written(changes={"wave.pulse.period": 0.05, "boundary.right.beta_p": 0.5})
    answer = dembound("calibrate", path, "--all", "--tolerance", "1e-2")

    assert answer.code == 0
    folder = tmp_path / "results" / "bar_calibration"
    records = {"left_p/calibration.h5", "right_p/calibration.h5"}
    assert files(folder) == {*records, "summary.json", "convergence.png"}
    found = json.loads((folder / "summary.json").read_text())["result"]
    sides = load(tmp_path / "bar_calibrated.toml").boundary
    assert found == {f"boundary.{side}.beta_p": sides[side].beta_p for side in ("left", "right")}
    rows = [line for line in answer.out.splitlines() if line.startswith("│ boundary.")]
    assert [row.split()[1] for row in rows] == list(found)
    assert "right, pass  1: β_P = 0.500000" in answer.out
    assert dembound("plot", folder / "left_p", folder / "right_p").code == 0

    # once more, from what it left: the names stay as they are
    again = dembound("calibrate", "bar_calibrated.toml", "--all", "--method", "homogenised")
    assert again.code == 0
    assert files(folder) == {*records, "summary.json"}
    assert {path.name for path in tmp_path.glob("*.toml")} == {"bar.toml", "bar_calibrated.toml"}


def test_one_side_or_all_of_them_are_calibrated(dembound, written, tmp_path) -> None:
    path = written()
    assert dembound("calibrate", path) == (2, "", "--boundary: is missing; name a side, or give --all\n")
    answer = dembound("calibrate", path, "--all", "-b", "left", "--wave", "p")
    assert answer.code == 2
    assert [line.split(":")[0] for line in answer.err.splitlines()] == ["--boundary", "--wave"]
    assert not (tmp_path / "results").exists()


def test_calibrating_a_side_without_dashpots_is_bad_input(dembound, written, tmp_path) -> None:
    path = written()
    path.with_name(f"{path.stem}_calibrated.toml").write_text("# another case, whose side is not looked for first")
    answer = dembound("calibrate", path, "--boundary", "top")

    assert answer.code == 2
    assert answer.err == "boundary.top: is free, only viscous sides can be calibrated; here: left, right\n"
    assert not (tmp_path / "results").exists()


def test_histories_sides_and_calibrations_are_drawn(dembound, written, tmp_path) -> None:
    dembound("run", written("one"), written("two"))
    dembound("calibrate", written("one", {"wave.pulse.period": 0.05}), "-b", "right", "-o", "calibrated")
    (passes,) = (tmp_path / "calibrated").rglob("calibration.h5")

    assert dembound("plot", "results/one", "results/two/run.h5", "-o", "histories.png").code == 0
    assert dembound("plot", "results/one", "-o", "displacement.png", "--quantity", "displacement").code == 0
    assert dembound("plot", "results/one", "-o", "side.png", "--boundary", "right").code == 0
    assert dembound("plot", "results/one", "-o", "energy.png", "--energy").code == 0
    assert dembound("plot", "results/one", "-o", "scene.png", "--field", "velocity", "--snapshot", "-1").code == 0
    assert dembound("plot", passes.parent, "-o", "passes.png").code == 0
    for name in ("histories", "displacement", "side", "energy", "scene", "passes"):
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")


def test_what_cannot_be_drawn_is_bad_input(dembound, written, tmp_path) -> None:
    dembound("run", written())
    (tmp_path / "passes").mkdir()
    (tmp_path / "passes" / "calibration.h5").touch()
    periodic = {"boundary.bottom": {"type": "periodic"}, "boundary.top": {"type": "periodic"}}
    dembound("run", written("periodic", periodic))
    for arguments, said in (
        (["nowhere"], "nowhere: contains no results"),
        (["bar.toml"], "bar.toml: cannot be read as a record of results"),
        (["results/bar", "--quantity", "force"], "--quantity"),
        (["results/bar", "passes"], "cannot be drawn in one picture"),
        (["results/periodic", "--boundary", "top"], "has no particles of side top"),
        (["results/bar", "results/periodic", "--energy"], "--energy: shows one run"),
        (["results/bar", "results/periodic", "--field", "peak"], "--field: shows one run"),
        (["passes", "--field", "peak"], "--field: is for runs, not for calibrations"),
        (["results/bar", "--field", "stress_xx"], "holds no stress"),
        (["results/bar", "--snapshot", "0"], "--snapshot: goes with --field"),
    ):
        answer = dembound("plot", *arguments)
        assert answer.code == (5 if arguments == ["bar.toml"] else 2)
        assert said in answer.err
    assert not (tmp_path / "plot.png").exists()


def test_a_bar_leaves_pictures_and_what_paraview_shows(dembound, tmp_path) -> None:
    dembound("new", "--from", "rock_bar", "rod.toml")
    short = ("--set", "run.duration=5e-5", "--set", "bar.spacing=0.01", "--set", "output.snapshots=3")
    assert dembound("run", "rod.toml", *short).code == 0

    histories = {"histories.png", "histories_stress.png"}
    shown = {f"paraview/{name}" for name in ("bar.pvd", "view.py")}
    shown |= {f"paraview/bar_{number:04d}.vtu" for number in range(3)}
    assert (
        files(tmp_path / "results" / "rod")
        == {"run.h5", "checkpoint.npz", "summary.json", "scene.png", *histories} | shown
    )


def test_a_table_has_what_is_drawn(dembound, small_run, tmp_path) -> None:
    answer = dembound("plot", small_run, "-o", "plot.png", "--table", "plot.csv", "--monitor", "back")
    assert (answer.code, answer.out) == (0, "wrote plot.png\nwrote plot.csv\n")
    heads, *rows = csv.reader((tmp_path / "plot.csv").open(encoding="utf-8"))
    assert heads == ["time (ms)", "back, small: velocity along x (m/s)"]
    with h5py.File(small_run) as file:
        back = file["histories/back"]
        expected = np.column_stack([1e3 * back["time"][:], back["velocity"][:, 0]])
    # ten digits are written
    np.testing.assert_allclose(np.array(rows, dtype=float), expected, rtol=1e-9)


def test_bars_are_drawn_and_compared(dembound, spalled_run, tmp_path) -> None:
    for name, options in (
        ("stress", ["--field", "stress"]),
        ("damage", ["--field", "damage", "--snapshot", "-1"]),
        ("gauge", ["--quantity", "stress"]),
        ("both", ["--component", "both", "--quantity", "acceleration"]),
        ("energy", ["--energy"]),
    ):
        assert dembound("plot", spalled_run, "-o", f"{name}.png", *options).code == 0
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    answer = dembound("compare", spalled_run, spalled_run, "--quantity", "stress")
    assert answer.code == 0
    assert "0.000" in answer.out


def test_options_of_another_picture_are_bad_input(dembound, spalled_run, small_run, tmp_path) -> None:
    (tmp_path / "passes").mkdir()
    (tmp_path / "passes" / "calibration.h5").touch()
    for arguments, said in (
        (
            [spalled_run, "--field", "damage", "--energy", "--monitor", "gauge"],
            "--energy: is not allowed together with --field\n--monitor: is not allowed together with --field\n",
        ),
        ([small_run, "--energy", "--quantity", "velocity"], "--quantity: is not allowed together with --energy\n"),
        ([small_run, "--energy", "--boundary", "left"], "--boundary: is not allowed together with --energy\n"),
        (
            [small_run, "--boundary", "left", "--monitor", "front"],
            "--monitor: is not allowed together with --boundary\n",
        ),
        (["passes", "--boundary", "left"], "--boundary: is for runs, not for calibrations\n"),
        (
            [spalled_run, small_run],
            "RESULTS: holds runs of bars and runs of disks, which cannot be drawn in one picture; name one kind\n",
        ),
    ):
        assert dembound("plot", *arguments) == (2, "", said)
    assert files(tmp_path) == {"passes/calibration.h5"}


def test_pictures_are_png_files(dembound, spalled_run, tmp_path) -> None:
    for command in (
        ("plot", spalled_run, "--output"),
        ("packing", "missing.toml", "--output"),
        ("dispersion", "--output"),
        ("gauge", spalled_run, "--output"),
        ("view", spalled_run, "--output"),
    ):
        for name in ("picture.pdf", "picture"):
            assert dembound(*command, name) == (2, "", f"{command[-1]}: is {name}, must end in .png\n")
    assert dembound("plot", spalled_run, "-o", "picture.PNG").code == 0
    assert files(tmp_path) == {"picture.PNG"}


def test_what_bars_and_disks_do_not_have_is_bad_input(dembound, spalled_run, small_run, tmp_path) -> None:
    for arguments, said in (
        (["plot", spalled_run, "--field", "peak"], "field: is peak, must be one of stress, damage, "),
        (["plot", spalled_run, "--boundary", "left"], "each end of which is one node"),
        (["plot", spalled_run, "--field", "forces"], "field: is forces, must be one of stress, damage, "),
        (["plot", small_run, "--field", "damage"], "field: is damage, must be one of velocity, "),
        (["plot", small_run, "--field", "forces"], "holds no contacts; runs with output.contacts = true do"),
        (["plot", small_run, "--field", "velocity", "--table", "a.csv"], "--table: is of lines, a field has none"),
        (["plot", small_run, "--field", "velocity", "--component", "x"], "--component: is not allowed together with"),
        (["plot", small_run, "--quantity", "stress"], "has no stress of its monitors"),
        (["compare", small_run, small_run, "--quantity", "stress"], "has no stress of its monitors"),
        (["view", spalled_run], "is a bar, view shows disks"),
        (["view", small_run, "--field", "stress"], "--field"),
    ):
        answer = dembound(*arguments)
        assert answer.code == 2
        assert said in answer.err
    assert not files(tmp_path)


def test_pages_and_movies_are_written(dembound, small_run, spalled_run, other_run, tmp_path) -> None:
    answer = dembound("report", small_run, "-o", "page.html")
    assert answer.code == 0
    assert re.fullmatch(r"wrote page\.html \(0\.\d MB\)\n", answer.out)
    assert answer.err.splitlines()[-1].endswith("has no summary, the run is not complete; tables lack it")
    assert (tmp_path / "page.html").read_text(encoding="utf-8").startswith("<!doctype html>")
    options = ("--every", "6", "--size", "200", "--exaggerate", "50", "--fps", "5", "--monitor", "gauge")
    answer = dembound("movie", spalled_run, "-o", "bar.gif", "--field", "velocity", *options)
    assert (answer.code, answer.err) == (0, "")
    assert re.fullmatch(r"wrote bar\.gif \(3 frames, 0\.\d MB\)\n", answer.out)
    with Image.open(tmp_path / "bar.gif") as picture:
        assert (picture.size[0], picture.n_frames, picture.info["duration"]) == (200, 3, 200)
    for arguments, said in (
        (("report", small_run, "-o", "page.pdf"), "--output: is page.pdf, must end in .html\n"),
        (("report", small_run, spalled_run), "RESULTS: holds runs of bars and of disks, which have no page in common"),
        (("report", "nowhere"), "nowhere: contains no results"),
        (("movie", small_run, "-o", "m.png"), "--output: is m.png, must end in .gif, or have no ending: a "),
        (("movie", other_run), "has no snapshots, run with output.snapshots above 0\n"),
        (("movie", small_run, "--field", "forces"), "field: is forces, must be one of velocity, displacement, "),
    ):
        answer = dembound(*arguments)
        assert (answer.code, answer.out) == (2, "")
        assert said in answer.err
        assert answer.err.count("\n") == 1
    assert dembound("report", small_run, "-o", "nowhere/page.html").code == 5


def test_force_chains_are_drawn_of_contacts(dembound, cracked_run, tmp_path) -> None:
    answer = dembound("plot", cracked_run, "--field", "forces", "--snapshot", "-1", "-o", "forces.png")
    assert answer == (0, "wrote forces.png\n", "")
    assert files(tmp_path) == {"forces.png"}


def test_bricks_are_kept_where_the_command_says_until_they_are_cleared(
    dembound, written, tmp_path, monkeypatch
) -> None:
    monkeypatch.setenv("DEMBOUND_CACHE", str(tmp_path / "bricks"))
    dense = {"pattern": "B", "size": [5.0, 5.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [5.0, 5.0]}
    dembound("check", written(changes={"packing": dense, "monitor": []}))
    assert len(list((tmp_path / "bricks").iterdir())) == 1

    assert dembound("cache").out == f"{tmp_path / 'bricks'}\n"
    assert "deleted 1 brick" in dembound("cache", "--clear").out
    assert not list((tmp_path / "bricks").iterdir())


def test_nothing_is_deleted_that_no_run_has_written(dembound, written, tmp_path) -> None:
    path = written()
    (tmp_path / "bar").mkdir()
    (tmp_path / "bar" / "notes.txt").write_text("precious")
    answer = dembound("run", path, "--output", ".")

    assert answer.code == 2
    assert answer.err.startswith("bar: exists and holds no run")
    assert (tmp_path / "bar" / "notes.txt").read_text() == "precious"


def test_a_step_that_is_too_long_shows_before_the_first_case_is_run(dembound, written, tmp_path) -> None:
    assert dembound("run", written("good"), written("bad", {"run.time_step": 5e-3})).code == 2
    assert not (tmp_path / "results").exists()


def test_what_cannot_be_written_is_named(dembound, written, tmp_path) -> None:
    path = written()
    (tmp_path / "file").write_text("")
    dembound("run", path)
    for arguments in (
        ["new", "nowhere/case.toml"],
        ["run", path, "--output", "file"],
    ):
        answer = dembound(*arguments)
        assert answer.code == 5
        assert len(answer.err.splitlines()) == 1
    for arguments in (
        ["plot", "results/bar", "-o", "nowhere/plot.png"],
        ["dispersion", "--table", "nowhere/table.csv"],
    ):
        assert dembound(*arguments) == (5, "", "nowhere: there is no such folder\n")


def test_dispersion_is_told_drawn_and_written(dembound, tmp_path) -> None:
    answer = dembound("dispersion", "--horizon", 1, "--horizon", 3, "--time-step", 2e-6, "--table", "table.csv")

    assert answer.code == 0
    first, second = [line for line in answer.out.splitlines() if "2e-06" in line]
    assert "unstable" in first  # cΔt/Δx = 1.1052
    assert "24.9" in second  # spacings per wavelength, below the 28.6 of short steps
    assert answer.out.splitlines()[-2:] == ["wrote dispersion.png", "wrote table.csv"]
    assert files(tmp_path) == {"dispersion.png", "table.csv"}


def test_what_sides_send_back_is_printed_drawn_and_written(dembound, written, tmp_path) -> None:
    path = written("small.toml")
    sides = ["--set", 'boundary.top={type="viscous",beta_s=0.5}', "--side", "right", "--side", "top"]
    answer = dembound("boundary", path, *sides, "--angle", 0, "--angle", 30, "--frequency", 5, "--table", "table.csv")

    assert answer.code == 0
    assert [line for line in answer.out.splitlines() if line.startswith("wrote")] == [
        "wrote boundary_right.png",
        "wrote table_right.csv",
        "wrote boundary_top.png",
        "wrote table_top.csv",
    ]
    # S: (1 − β)/(1 + β) = 1/3 of the amplitude for β = 0.5; tan(qa/4) = 1 % for a whole last mass
    assert "returns 11.1 % of the energy, 33.4 % of the amplitude; with matched β 0.00992 %" in answer.out
    assert "30°" not in answer.out  # as y is held
    assert "copies of the brick" not in answer.out
    quick = dembound("boundary", path, *sides, "--angle", 0, "--frequency", 5, "--quick")
    assert "returns 11.1 % of the energy, 33.3 % of the amplitude; with matched β 0 %" in quick.out
    short = dembound("boundary", path, "--side", "right", "--angle", 0, "--frequency", 990)
    assert "copies of the brick send back" in short.out
    assert dembound("boundary", path, "--side", "left", "--set", 'boundary.left={type="periodic"}').code == 2


def test_stability_is_told_drawn_and_written(dembound, written, tmp_path) -> None:
    answer = dembound("stability", written(), "--steps", 500, "--table", "table.csv", "-o", "noise.png")

    assert answer.code == 0
    (row,) = (cells(line) for line in answer.out.splitlines() if line.strip().startswith("elastic"))
    name, limit, measured, own, *_, verdict = " ".join(row).split()
    assert (name, verdict) == ("elastic", "stable")
    assert float(limit) > 0.0
    assert float(measured) == pytest.approx(1.0, abs=1e-3)
    assert float(own) == pytest.approx(0.9, abs=1e-3)
    assert "no loads and waves" in answer.out
    assert answer.out.splitlines()[-2:] == ["wrote noise.png", "wrote table.csv"]
    assert files(tmp_path) == {"bar.toml", "noise.png", "table.csv"}
    assert "elastic: noise grows at 1.0005" in answer.err


def test_a_step_that_is_not_stable_ends_with_3(dembound, written, tmp_path) -> None:
    answer = dembound("stability", written("bar", {"run.time_step": 1e-3}), "--steps", 500)

    assert answer.code == 3
    assert "UNSTABLE" in answer.out
    assert answer.err.splitlines()[-1].startswith("elastic: not stable at the case's own step of 0.001 s; the largest")
    assert "stability.png" in files(tmp_path)


def test_a_picture_may_be_given_a_title(dembound, felt, monkeypatch) -> None:
    time, stress = felt()
    np.savetxt("gauge.txt", np.column_stack([time, 1e6 * stress]))
    titles = []

    class Canvas:
        """Writes nothing, but notes the title."""

        def __init__(self, figure: Figure) -> None:
            self.figure = figure

        def print_png(self, path: Path, **_: object) -> None:
            path.touch()
            titles.append(self.figure.get_suptitle())

    monkeypatch.setattr(style, "FigureCanvasAgg", Canvas)
    for arguments in (["dispersion"], ["gauge", "gauge.txt", "--position", 0.6, "--length", 0.99, "-o", "gauge.png"]):
        assert dembound(*arguments).code == 0
        assert dembound(*arguments, "--title", "figure 1").code == 0
        own, given = titles[-2:]
        assert own != given == "figure 1"


def test_bars_of_cases_are_told_and_simulated(dembound, tmp_path) -> None:
    tables = {
        "bar": {"length": 0.5, "spacing": 0.005, "density": 2620.0, "wave_speed": 2500.0, "strength": 1e7},
        "method": {"type": "patch", "horizon": 3},
        "run": {"duration": 1e-4},
    }
    (tmp_path / "bar.toml").write_text(tomli_w.dumps(tables))
    answer = dembound("dispersion", "bar.toml", "bar.toml", "--set", "run.time_step=1e-6", "--check")

    assert answer.code == 0
    first, second = [line for line in answer.out.splitlines() if "simulated" in line]
    assert first.startswith("horizon 1, Δx = 5 mm, Δt = 1 µs: 12 simulated frequencies differ by at most ")
    assert second.startswith("horizon 3, Δx = 5 mm, Δt = 1 µs: 12 simulated frequencies differ by at most ")
    for arguments, said in (
        (["bar.toml", "--horizon", 3], "--horizon: is given by the case, change it with --set\n"),
        (["--set", "run.time_step=1e-6"], "--set: changes a case, and none is given\n"),
    ):
        assert dembound("dispersion", *arguments) == (2, "", said)


def test_lattices_that_make_no_sense_are_bad_input(dembound, tmp_path) -> None:
    answer = dembound("dispersion", "--horizon", 0, "--spacing", -1)

    assert answer.code == 2
    assert answer.err == "--horizon: is 0, must be 1 to 1000\n--spacing: is -1, must be 1e-30 to 1e+30 m\n"
    assert not files(tmp_path)


def test_a_gauge_tells_what_its_history_and_options_allow(dembound, felt, tmp_path) -> None:
    time, stress = felt()
    np.savetxt("gauge.txt", np.column_stack([time, 1e6 * stress]))
    np.savetxt("end.txt", np.column_stack([time, np.interp(time, [0.0, 1e-4, 2e-4, 3e-4], [0.0, 10.0, 4.0, 8.0])]))
    bar = ("--position", 0.6, "--length", 0.99)

    alone = dembound("gauge", "gauge.txt", *bar)
    assert alone.code == 0
    speed, attenuation = [cells(line) for line in alone.out.splitlines() if "peaks" in line]
    # as good as the lines through the peaks are: 0.04 % and 1 %
    assert float(speed[1]) == pytest.approx(2740.0, rel=4.2e-4)
    assert float(attenuation[1]) == pytest.approx(0.52, rel=0.01)
    assert "strength" not in alone.out

    some = dembound("gauge", "gauge.txt", *bar, "--peaks", 3)
    assert (some.err, "times of 3 peaks" in some.out) == ("", True)
    count = int(re.search(r"of (\d+) peaks", speed[-1]).group(1))
    many = dembound("gauge", "gauge.txt", *bar, "--peaks", count + 1)
    assert many.err == f"--peaks: asks for {count + 1} tension peaks, there are {count}\n"
    assert many.out == alone.out

    known = ("--wave-speed", 2740, "--attenuation", 0.52, "--density", 2620)
    full = dembound("gauge", "gauge.txt", *bar, *known, "--spall", 0.9, "--free-end", "end.txt", "-o", "gauge.png")
    assert full.code == 0
    rows = [line.split() for line in full.out.splitlines() if "strength" in line]
    assert [row[0] for row in rows] == ["nominal", "attenuated", "pull-back"]
    assert "21.54" in full.out  # ½ · 2620 · 2740 · 6 Pa
    assert full.out.splitlines()[-1] == "wrote gauge.png"
    assert (tmp_path / "gauge.png").read_bytes().startswith(b"\x89PNG")


def test_gauges_that_tell_nothing_are_bad_input(dembound, written) -> None:
    Path("gauge.txt").write_text("0 1\n1 -2\n2 1\n")
    dembound("run", written())
    for arguments, said in (
        (
            ["gauge.txt"],
            "--position: is missing, must be the gauge's place (m) from the loaded end\n"
            "--length: is missing, must be that of the bar (m)\n",
        ),
        (
            ["gauge.txt", "--position", 2, "--length", 1],
            "--position: is 2 m, must be above 0 and below the length, 1 m\n",
        ),
        (["absent.txt"], 'no file "absent.txt"\n'),
        (["results/bar"], "results/bar/run.h5: contains no history of stress between the ends of a bar\n"),
    ):
        assert dembound("gauge", *arguments) == (2, "", said)


def test_options_of_gauges_that_make_no_sense_are_bad_input(dembound, felt, tmp_path) -> None:
    np.savetxt("gauge.txt", np.column_stack(felt()))
    for options, said in (
        (["--position", 0.6, "--length", -1], "--length: is -1 m, must be finite and above 0\n"),
        (["--position", 0.6, "--length", 0.99, "--scale", "nan"], "--scale: is nan, must be finite and not 0\n"),
        (
            ["--position", 0.6, "--length", 0.99, "--attenuation", "nan", "--wave-speed", 0, "--spall", 1],
            "--spall: is 1 m, must be above 0 and below the length, 0.99 m\n"
            "--wave-speed: is 0 m/s, must be finite and above 0\n"
            "--attenuation: is nan 1/m, must be finite and not below 0\n",
        ),
        (
            ["--position", 0.6, "--length", 0.99, "--spall", 0.9, "--pulse-end", 0],
            "--pulse-end: is 0 s, must be after 0.000259 s, when the pulse is half risen\n",
        ),
    ):
        assert dembound("gauge", "gauge.txt", *options, "-o", "gauge.png") == (2, "", said)
    assert files(tmp_path) == {"gauge.txt"}


def test_the_starter_of_a_bar_tells_its_strength_and_no_speed(dembound) -> None:
    dembound("new", "--from", "rock_bar", "bar.toml")
    few = ("--set", "output.pictures=false", "--set", "output.snapshots=1")
    assert dembound("run", "bar.toml", *few).code == 0
    told = dembound("gauge", "results/bar", "--free-end", "end", "--spall", 0.907)
    assert (told.code, told.err) == (0, "")
    rows = [cells(line)[:2] for line in told.out.splitlines()[3:9]]
    assert [name.removesuffix(" strength (MPa)") for name, _ in rows[2:5]] == ["nominal", "attenuated", "pull-back"]
    assert rows[5] == ["strength of the bar (MPa)", "10"]
    assert [value for _, value in rows[:2]] == ["2740", "0"]
    # it breaks at 10 MPa from 0.905 to 0.909 m, by bonds of up to 3 mm: all that is told is known to some 5 mm, over
    # which the tension beside the end changes by 12 MPa · 2 · 5 mm/(2740 m/s · 80 µs)
    known = 12.0 * 2.0 * 0.005 / (2740.0 * 80e-6)
    assert float(rows[2][1]) == pytest.approx(10.0, abs=known)
    assert float(rows[4][1]) == pytest.approx(10.0, abs=known)

    asked = dembound("gauge", "results/bar", "--estimate")  # the pulse is not yet back at the gauge
    assert (asked.code, asked.out) == (2, "")
    assert asked.err.startswith(
        "--wave-speed: needs two tension peaks to be estimated, 0 found in the record: it ends "
    )


def test_runs_on_bars_are_read_by_gauge_where_one_end_is_loaded(dembound, spalling) -> None:
    two = [{"name": "gauge", "position": 0.4}, {"name": "end", "position": 1.0}]
    load = {"name": "hit", "pressure": 12e6, "nodes": 3, "wave": "hit"}
    for name, changes in (
        ("one", {"monitor": two, "run.duration": 5e-3}),
        ("blind", {"monitor": []}),
        ("both", {"monitor": two, "load": [load, load | {"name": "back", "side": "right"}]}),
        ("none", {"monitor": two, "load": []}),
    ):
        few = {"output.pictures": False, "output.snapshots": 1}
        Path(f"{name}.toml").write_text(spalling(few | changes).text)
        assert dembound("run", f"{name}.toml").code == 0
    told = dembound("gauge", "results/one", "--free-end", "end", "--attenuation", 0.1)  # one is between the ends
    assert (told.code, told.err) == (0, "")
    assert "pull-back strength" in told.out
    speed, attenuation = [cells(line) for line in told.out.splitlines()[3:5]]
    assert (speed[1], speed[2]) == ("1000", "results")
    assert (attenuation[1], attenuation[2]) == ("0.1", "given, results have 0")
    refused = "/run.h5: has a bar loaded at {}, must be loaded at the left or the right\n"
    for arguments, said in (
        (["results/one", "--monitor", "far"], "--monitor: is far, must be between the bar's ends, which is gauge\n"),
        (["results/one", "--monitor", "end"], "--monitor: is end, must be between the bar's ends, which is gauge\n"),
        (
            ["results/one", "--free-end", "end.txt"],
            "--free-end: is end.txt, must be a monitor at the end opposite the load, which is end\n",
        ),
        (["results/blind"], "results/blind/run.h5: contains no history of stress between the ends of a bar\n"),
        (["results/both", "--monitor", "gauge"], f"results/both{refused.format('both ends')}"),
        (["results/none", "--monitor", "gauge"], f"results/none{refused.format('neither end')}"),
        (["results"], "results: contains no results, must be a folder with run.h5 or calibration.h5\n"),
    ):
        assert dembound("gauge", *arguments) == (5 if arguments == ["results"] else 2, "", said)


DENSE = {"pattern": "B", "size": [2.0, 2.0], "radius": 0.1, "radius_ratio": 1.5, "brick": [2.0, 2.0]}


def test_a_brick_that_is_packed_is_told_of_and_a_cached_one_is_not(dembound, written, tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("DEMBOUND_CACHE", str(tmp_path / "bricks"))
    path = written(changes={"packing": DENSE, "monitor": [], "boundary.right": {"type": "free"}})
    told = dembound("check", path).err.splitlines()

    assert re.fullmatch(r"packing a brick of \d+ disks", told[0])
    assert dembound("check", path).err.splitlines() == told[1:]


def test_commands_for_one_kind_of_body_name_the_file_of_another(dembound, spalling, written) -> None:
    Path("rod.toml").write_text(spalling().text, encoding="utf-8")

    assert dembound("exact", "rod.toml").err == "rod.toml: is the case of a bar, this command is for disks\n"
    assert dembound("dispersion", written()).err == "bar: is the case of disks, this command is for bars\n"


def test_a_chart_is_printed_drawn_and_resumed(dembound, spalling, tmp_path) -> None:
    (tmp_path / "rod.toml").write_text(spalling().text, encoding="utf-8")
    vary = ["--vary", "bar.spacing=0.05,0.025,0.03", "--vary", "run.courant=0.9,3.0", "--repeats", 1]
    done = dembound("chart", "rod.toml", *vary)
    assert done.code == 0
    assert "rod: spacing 0.03 m, courant 0.9: left out, bar.spacing: is 0.03, must divide" in done.err
    assert "rod: spacing 0.05 m, courant 3: failed, run.courant: is 3" in done.err
    assert "rod: velocity beside exact (d'Alembert), up to the first spall at 1.267 ms" in done.out
    assert "cheapest within 1 % and within 0.1 %: none; most accurate: spacing 0.025 m, courant 0.9 (" in done.out
    folder = tmp_path / "results" / "rod_chart"
    assert {path.name for path in folder.iterdir()} == {"chart.h5", "chart.csv", "chart.png"}

    before = (folder / "chart.csv").read_text(encoding="utf-8")
    again = dembound("chart", "rod.toml", *vary, "--resume")
    assert again.code == 0
    assert (folder / "chart.csv").read_text(encoding="utf-8") == before  # with the costs measured before
    assert "replacing" not in done.err + again.err


def test_a_second_chart_replaces_the_first_and_keeps_other_files(dembound, spalling, tmp_path) -> None:
    (tmp_path / "rod.toml").write_text(spalling().text, encoding="utf-8")
    folder, vary = Path("results") / "rod_chart", ["--vary", "bar.spacing=0.05,0.025", "--repeats", 1]
    dembound("chart", "rod.toml", *vary)
    (folder / "thesis.tex").touch()
    (folder / "chart.h5.log").touch()  # of a process that was killed
    second = dembound("chart", "rod.toml", *vary, "--title", "Mine")
    assert second.err.splitlines()[0] == f"{folder}: replacing the chart of before, whose runs --resume would keep"
    assert {path.name for path in folder.iterdir()} == {"chart.h5", "chart.csv", "chart.png", "thesis.tex"}


def test_choices_whose_monitors_are_elsewhere_are_marked(dembound, spalling, tmp_path) -> None:
    (tmp_path / "rod.toml").write_text(spalling().text, encoding="utf-8")
    vary = ["--vary", "bar.spacing=0.05,0.025", "--repeats", 1]
    done = dembound("chart", "rod.toml", *vary, "--reference", "finest")  # at 0.525 m: nodes at 0.5 and 0.525 m
    assert re.search(r"spacing 0\.05 m.* \*† *\n", done.out)
    assert "† monitors record elsewhere than in the reference, up to 0.025 m away\n" in done.out
    assert "†" not in dembound("chart", "rod.toml", *vary, "--reference", "finer").out


def test_rounding_errors_are_printed_as_none(dembound, spalling, tmp_path) -> None:
    exact = {"method": {"type": "finite_difference"}, "load.1.nodes": 1, "bar.strength": 1e9}
    (tmp_path / "rod.toml").write_text(spalling(exact).text, encoding="utf-8")
    done = dembound("chart", "rod.toml", "--vary", "run.courant=1.0,0.9", "--repeats", 1)
    assert re.search(r"\n courant 1 +0 +0 ", done.out)
    assert "cheapest within 1 % and within 0.1 %: courant 1 (0 %, " in done.out


def test_a_case_may_have_its_chart(dembound, spalling, tmp_path) -> None:
    table = {"vary": {"bar.spacing": [0.05, 0.025]}, "repeats": 1, "reference": "finest"}
    (tmp_path / "rod.toml").write_text(spalling({"chart": table}).text, encoding="utf-8")
    assert "velocity beside the finest run, spacing 0.025 m" in dembound("chart", "rod.toml").out


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--vary", "run.courant"], "--vary: is run.courant, must be KEY=VALUE"),
        (["--vary", "run.curant=1.0"], "run.curant: unknown key"),
        (["--monitor", "nowhere"], "--monitor: is nowhere, must be one of gauge"),
        (["--quantity", "stress", "--component", "x"], "--quantity: stress is that along a bar"),
        (["--reference", "extended", "--vary", "bar.spacing=0.05", "--repeats", "1"], "--reference: no side"),
    ],
)
def test_charts_of_nothing_are_bad_input(dembound, spalling, tmp_path, options, said) -> None:
    (tmp_path / "rod.toml").write_text(spalling().text, encoding="utf-8")
    done = dembound("chart", "rod.toml", *options)
    assert done.code == 2
    assert said in done.err


def test_charts_leave_nothing_after_bad_input_and_fail_with_3(dembound, spalling, tmp_path) -> None:
    (tmp_path / "rod.toml").write_text(spalling().text, encoding="utf-8")
    assert dembound("chart", "rod.toml", "--vary", "bar.spacing=0.3").code == 2
    assert not (tmp_path / "results").exists()
    done = dembound("chart", "rod.toml", "--vary", "run.courant=3.0")
    assert (done.code, "courant 3: run.courant: is 3" in done.err) == (3, True)


def test_markup_in_titles_and_names_is_text(dembound, written, tmp_path) -> None:
    path = written("[bold]", {"title": "[/bold] $x^{$ :smile:"})
    assert "[bold]: [/bold] $x^{$ :smile:" in dembound("check", path).out
    assert dembound("run", path).out.splitlines()[-1].endswith(f"results in {Path('results') / '[bold]'}")
    assert dembound("plot", "results/[bold]", "--title", "[/bold] $x^{$", "-o", "[p].png").out == "wrote [p].png\n"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--set", 'title="a\\u001b[2J"'], r'bar: title: is "a\x1b[2J", must be one line without control characters'),
        (["--set", f"title={'[' * 500}{']' * 500}"], "--set title: is nested more than 30 deep, deeper than any case"),
        (["--set", f"a{'.a' * 2000}=1"], f"{'a.' * 20}…: has 2000 dots, must have at most 30"),
        (["--set", f"run.duration={'9' * 5000}"], "--set run.duration: has a number of more than 4000 digits"),
        (["--set", "packing.radius=1e-9"], "bar: packing.size: holds "),
        (["--set", "run.duration=\udcff"], "has characters that are not text in UTF-8"),
        (["--name", "a\x1bb"], r"--name: is 'a\x1bb', must have no control characters"),
    ],
)
def test_odd_values_are_bad_input_in_one_line(dembound, written, arguments: list[str], said: str) -> None:
    answer = dembound("run", written(), *arguments)

    assert answer.code == 2
    (line,) = answer.err.splitlines()
    assert said in line
    assert "\x1b" not in line


def test_a_file_of_an_odd_name_is_refused(dembound, written, tmp_path) -> None:
    (tmp_path / "a\nb.toml").write_text(written().read_text())
    answer = dembound("check", tmp_path / "a\nb.toml")

    assert answer.code == 2
    assert answer.err.endswith(
        r"a\nb.toml: has a name with control characters or bytes that are not text, rename it" + "\n"
    )


def test_a_damaged_record_ends_with_5(dembound, written, tmp_path) -> None:
    dembound("run", written())
    record = tmp_path / "results" / "bar" / "run.h5"
    whole = record.read_bytes()

    for damaged in (whole[:20_000], b"", bytes(len(whole)), b"0 1\n2 3\n"):
        record.write_bytes(damaged)
        for command in (["plot"], ["plot", "--energy"], ["gauge"], ["view", "-o", "v.png"], ["compare", "results/bar"]):
            answer = dembound(*command, "results/bar")
            assert answer.code == 5
            assert len(answer.err.splitlines()) == 1
            said = "is truncated" if len(damaged) == 20_000 else "cannot be read as a record of results"
            assert f"run.h5: {said}" in answer.err


def test_warnings_of_python_are_not_shown(dembound, written, monkeypatch) -> None:
    from dembound import check

    monkeypatch.setattr(sys, "warnoptions", [])
    planned = check.plan

    def warns(case):
        warnings.warn("overflow encountered in divide", RuntimeWarning, stacklevel=1)
        return planned(case)

    monkeypatch.setattr(check, "plan", warns)
    answer = dembound("check", written())

    assert answer.code == 0
    assert "overflow" not in answer.err
