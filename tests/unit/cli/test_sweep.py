"""The commands sweep, library and respond."""

import csv
from pathlib import Path

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.studies.sweep import study
from dembound.studies.sweep.perform import Outcome


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
    assert "load.hit.pressure=1e+06,courant=3: failed, run.courant: is 3" in first.err
    folder = Path("results/rod_sweep")
    with (folder / "sweep.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["run.courant"] for row in rows] == ["0.9", "3.0"] * 2
    assert [row["state"] == "done" for row in rows] == [True, False] * 2
    peaks = [float(row["monitors.gauge.peak_velocity"]) for row in rows[::2]]
    assert peaks[1] == pytest.approx(2.0 * peaks[0], rel=1e-9)  # neither breaks
    member = folder / "members" / rows[0]["member"]

    rod(sweep={"vary": {"load.hit.pressure": [1e6, 2e6], "run.courant": [0.9]}})
    before = (member / "run.h5").stat().st_mtime_ns
    second = dembound("sweep", "rod.toml")  # the same members, by the table: nothing is left to do
    assert second.code == 0
    assert "failed" not in second.err
    assert (member / "run.h5").stat().st_mtime_ns == before


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


def test_sweeps_of_nothing_are_bad_input(dembound, rod) -> None:
    rod()
    for options, said in (
        ([], "--vary: is missing; give keys and values, or a table [sweep.vary] in the case"),
        (["--vary", "run.courant"], "--vary: is run.courant, must be KEY=VALUE"),
        (["--vary", "run.courant=0.5,0.9", "--vary", "bar.density=1e3", "--together"], "--together: keys must have"),
        (["--scheduler", "tcp://x:1", "-p", "2"], "--processes: is for this machine, not allowed together with --sch"),
    ):
        done = dembound("sweep", "rod.toml", *options)
        assert done.code == 2
        assert said in done.err
    assert not Path("results").exists()


STRONG = PUSHED | {
    "packing": PUSHED["packing"] | {"size": [5.0, 1.0]},
    "material": PUSHED["material"] | {"fric": 0.5, "pb_ten": 1e6, "pb_coh": 1e6, "contact_share": 0.0},
    "boundary": {"left": {"type": "viscous_input", "wave_p": "push"}, "right": {"type": "viscous"}},
    "monitor": [{"name": name, "position": [x, 0.25]} for name, x in (("a", 2.25), ("b", 2.75), ("far", 4.75))],
    "output": {"load_factor": True},
}


def test_a_library_responds_to_records(dembound, tmp_path):
    (tmp_path / "bar.toml").write_text(small(STRONG, "bar").text)
    answer = dembound("library", "bar.toml", "--spacing", "0.001")
    assert answer.code == 0
    assert answer.out.startswith("bar: library of push, 0.01 s, time step 0.0002")
    np.savetxt("r.txt", [(0.0, 0.0), (0.001, -0.2), (0.002, 0.0)])

    answer = dembound("respond", "results/bar_library", "r.txt", "--load-factor", "a,b")
    assert answer.code == 0, answer.err
    first, second = answer.out.splitlines()
    assert first == "r: histories in results/r"
    assert second.startswith("r: load factor ")
    assert second.endswith("; of 1 contact between monitors alone, not of all contacts")
    assert "a,b breaks in tension at t = 0.00" in second
    assert "bar" not in dembound("rerun", "results/r", "--name", "direct").err
    assert "< 0.0001" in dembound("compare", "results/direct", "results/r").out
