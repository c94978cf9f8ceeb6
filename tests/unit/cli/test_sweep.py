"""The command sweep."""

import csv
import json
from pathlib import Path

import pytest

from dembound.cli.sweep import _in_words
from dembound.interrupts import Stopped
from dembound.studies.sweep import study
from dembound.studies.sweep.perform import Outcome
from dembound.studies.sweep.study import Standing


@pytest.fixture
def rod(spalling, tmp_path):
    """Writes the small rock bar as rod.toml, with keys changed."""

    def write(**changes) -> None:
        text = spalling({"output.pictures": False, "output.snapshots": 0, **changes}).text
        (tmp_path / "rod.toml").write_text(text, encoding="utf-8")

    return write


@pytest.fixture
def swept(monkeypatch):
    """Has members done at once, in this process; returns all that were done."""
    done = []

    def sweep(members, options, folder, report):
        folder.mkdir(parents=True, exist_ok=True)
        done.append((members, options))
        values = [{"monitors.gauge.peak_velocity": float(number)} for number, _ in enumerate(members)]
        return [Outcome(member.name, values=each) for member, each in zip(members, values, strict=True)]

    monkeypatch.setattr(study, "sweep", sweep)
    return done


def test_a_sweep_leaves_a_table_and_lists_what_failed(dembound, rod) -> None:
    rod()
    vary = ["--vary", "load.hit.pressure=1e6,2e6", "--vary", "run.courant=0.9,3.0", "-p", 1]
    first = dembound("sweep", "rod.toml", *vary)
    assert first.code == 3
    assert "rod: pressure=1e+06" not in first.out
    assert "load.hit.pressure=1e+06,courant=3: failed, run.courant: is 3" in first.err
    folder = Path("results/rod_sweep")
    with (folder / "sweep.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["run.courant"] for row in rows] == ["0.9", "3.0"] * 2
    assert [row["state"] == "done" for row in rows] == [True, False] * 2
    peaks = [float(row["monitors.gauge.peak_velocity"]) for row in rows[::2]]
    assert peaks[1] == pytest.approx(2.0 * peaks[0], rel=1e-9)  # neither breaks
    assert {"sweep.png", "sweep.h5", "statistics.csv", "members", "outcomes"} <= {
        path.name for path in folder.iterdir()
    }
    member = folder / "members" / rows[0]["member"]
    warnings = json.loads((member / "summary.json").read_text(encoding="utf-8"))["warnings"]
    assert warnings
    assert {f"rod: warning: {text} (2 of 4 members)" for text in warnings} <= set(first.err.splitlines())

    rod(sweep={"vary": {"load.hit.pressure": [1e6, 2e6], "run.courant": [0.9]}})
    before = (member / "run.h5").stat().st_mtime_ns
    second = dembound("sweep", "rod.toml")  # the same members, by the table: nothing is left to do
    assert second.code == 0
    assert "failed" not in second.err
    assert (member / "run.h5").stat().st_mtime_ns == before
    named = dembound("report", "results/rod_sweep")
    said = f"{folder}: is a sweep, not results of a single run; name runs in {folder / 'members'}\n"
    assert (named.code, named.err) == (2, said)


def test_options_are_those_of_the_table_unless_given(dembound, rod, swept) -> None:
    rod(sweep={"vary": {"bar.density": [2400.0, 2600.0], "run.courant": [0.8, 0.9]}, "together": True, "processes": 3})
    assert dembound("sweep", "rod.toml").code == 0
    assert dembound("sweep", "rod.toml", "--product", "-p", 1, "--anew").code == 0
    (first, table), (second, given) = swept
    assert [member.name for member in first] == ["density=2400,courant=0.8", "density=2600,courant=0.9"]
    assert len(second) == 4
    assert (table.processes, table.anew, table.action) == (3, False, "run")
    assert (given.processes, given.anew) == (1, True)
    done = dembound(
        "sweep", "rod.toml", "--action", "calibrate", "--method", "homogenised", "--vary", "run.courant=0.7"
    )
    assert done.code == 0
    assert (swept[-1][1].action, swept[-1][1].method) == ("calibrate", "homogenised")


def test_means_over_seeds_are_printed(dembound, written, swept) -> None:
    dense = {"pattern": "B", "size": [10, 4], "radius": 0.25, "radius_ratio": 1.5, "brick": [5, 4]}
    path = written(changes={"packing": dense})
    done = dembound("sweep", path, "--vary", "run.safety=0.5,0.9", "--vary", "packing.seed=1:2")
    lines = [line.split() for line in done.out.splitlines() if line.lstrip().startswith("safety")]
    assert [line[1] for line in lines] == ["0.5", "0.9"]
    assert [line[3:5] for line in lines] == [["2", "0.5"], ["2", "2.5"]]  # n and mean of 0, 1 and of 2, 3


def test_long_tables_are_cut_and_invalid_members_left_out(dembound, rod, swept) -> None:
    rod()
    done = dembound("sweep", "rod.toml", "--vary", "bar.density=2001:2050")
    assert "10 more rows are in statistics.csv\nrod: 50 of 50 members done\n" in done.out
    assert "density 2040 " in done.out
    assert "density 2041 " not in done.out
    done = dembound("sweep", "rod.toml", "--vary", "bar.spacing=0.025,0.03")
    assert done.code == 0
    assert "rod: spacing=0.03: left out, bar.spacing: is 0.03, must divide" in done.err
    assert len(swept[-1][0]) == 1


def test_each_warning_of_members_is_printed_once_with_their_number(dembound, rod, monkeypatch) -> None:
    own = [["1.5 cells, short", "1e-3 cells, short"], ["2 cells, short", "long"], [f"w{n}" for n in range(9)]]

    def sweep(members, options, folder, report):
        folder.mkdir(parents=True, exist_ok=True)
        return [Outcome(member.name, warnings=each) for member, each in zip(members, own, strict=True)]

    monkeypatch.setattr(study, "sweep", sweep)
    rod()
    done = dembound("sweep", "rod.toml", "--vary", "bar.density=2400:2402")
    lines = [
        "1.5 cells, short (2 of 3 members)",
        "long (1 of 3 members)",
        *(f"w{number} (1 of 3 members)" for number in range(8)),
    ]
    expected = [*(f"rod: warning: {line}" for line in lines), "rod: 1 more warnings are in summary.json of the members"]
    assert done.err.splitlines() == expected


def test_sweeps_of_nothing_are_bad_input(dembound, rod) -> None:
    rod()
    for options, said in (
        ([], "--vary: is missing; give keys and values, or a table [sweep.vary] in the case"),
        (["--vary", "run.courant"], "--vary: is run.courant, must be KEY=VALUE"),
        (["--vary", "run.curant=1.0"], "run.curant: unknown key"),
        (["--vary", "bar.density=9:1"], "--vary: bar.density: 9:1 is a range without a number"),
        (["--vary", "run.courant=0.5,0.9", "--vary", "bar.density=1e3", "--together"], "--together: keys must have"),
        (["--vary", "run.courant=0.5", "--method", "ratio"], "--method: is for --action calibrate"),
        (["--scheduler", "tcp://x:1", "-p", "2"], "--processes: is for this machine, not allowed together with --sch"),
    ):
        done = dembound("sweep", "rod.toml", *options)
        assert done.code == 2
        assert said in done.err
    assert not Path("results").exists()


def test_a_signal_ends_it_with_its_exit_code(dembound, rod, monkeypatch) -> None:
    def stopped(*_):
        raise Stopped(15)

    monkeypatch.setattr(study, "sweep", stopped)
    rod()
    done = dembound("sweep", "rod.toml", "--vary", "run.courant=0.5")
    assert (done.code, done.err) == (143, "rod: stopped; the same command continues what is left\n")


def test_the_line_says_how_far_a_sweep_is() -> None:
    assert _in_words(Standing(40, 0, 0, 2, 0), 5.0) == "0 of 40 members done, 2 under way"
    # 10 of 20 that are new took 100 s
    assert (
        _in_words(Standing(40, 29, 1, 2, 20), 100.0) == "29 of 40 members done, 1 failed, 2 under way, about 100 s left"
    )
    assert _in_words(Standing(40, 10, 0, 2, 0), 3600.0).endswith("about 3 h left")
    assert _in_words(Standing(40, 40, 0, 0, 40), 1.0) == "40 of 40 members done"
