"""A page holds all that it shows, is complete without scripts, and says what results lack."""

import base64
import hashlib
import json
import re
import shutil

import h5py
import numpy as np
import pytest
from pages import Page

from dembound.errors import HIDDEN, CaseError, RecordError
from dembound.report import page as page_module
from dembound.report.page import write_report
from dembound.results.results import Results


@pytest.fixture(scope="module")
def two(pushed_runs, tmp_path_factory) -> Page:
    """The page of both runs of disks."""
    path, said = tmp_path_factory.mktemp("page") / "two.html", []
    write_report(pushed_runs, path, said.append)
    assert said == []
    return Page(path)


def copied(record, folder):
    """A copy of the results of a record."""
    shutil.copytree(record.parent, folder)
    return folder / record.name


def test_nothing_is_loaded_and_the_policy_allows_the_own_script_and_style_alone(two):
    """By their hashes, for which neither events in attributes nor styles in attributes are allowed."""
    sources = [value for _, attributes in two.tags for key, value in attributes.items() if key in ("src", "href")]
    assert sources
    assert all(value.startswith(("data:image/webp;base64,", "#")) for value in sources)
    assert "url(http" not in two.source
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)", two.source)
    (policy,) = (each["content"] for each in two.all("meta") if "default-src" in each.get("content", ""))
    assert policy.startswith("default-src 'none'")
    for tag, name in (("script", "script-src"), ("style", "style-src")):
        (text,) = re.findall(f"<{tag}>(.*?)</{tag}>", two.source, flags=re.DOTALL)
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert f"{name} 'sha256-{digest}'" in policy
    assert "unsafe" not in policy
    assert not [key for _, attributes in two.tags for key in attributes if key == "style" or key.startswith("on")]
    (script,) = re.findall("<script>(.*?)</script>", two.source, flags=re.DOTALL)
    assert not re.search(r"style:|\.cssText|setAttribute\(.style|innerHTML|\bon[a-z]+\s*=|\beval\b|Function\(", script)


def test_texts_of_users_are_no_markup(two, pushed_runs):
    assert len(two.all("script")) == 2  # the values and their script
    results = Results(pushed_runs[0].parent)
    title = results.attributes["title"]
    assert "<script>" in title
    assert title in two.said("p")
    assert results.case.strip() in two.said("pre")


def joules(energy, unit="J/m"):
    """An energy from 1 mJ/m to below 1 MJ/m, or none."""
    if energy == 0.0:
        return f"0 {unit}"
    assert 1e-3 <= energy < 1e6
    scale, prefix = (1e-3, "m") if energy < 1.0 else (1.0, "") if energy < 1e3 else (1e3, "k")
    return f"{energy / scale:.4g} {prefix}{unit}"


def test_runs_stand_side_by_side(two, pushed_runs):
    assert two.row("boundary.right.beta_p") == ["matched", "0.5"]
    summaries = [Results(record.parent).summary for record in pushed_runs]
    assert two.row("duration") == [f"{each['steps']:,} steps of {each['time_step']:.5g} s" for each in summaries]
    assert two.row("supplied in all") == [joules(each["energy"]["supplied"]) for each in summaries]
    ledger = summaries[1]["energy"]
    left = sum(ledger[name] for name in ("kinetic", "contact", "bond", "stepping")) / ledger["supplied"]
    assert two.row("left in the body, of all that was supplied")[1] == f"{100.0 * left:.3g} %"


def test_charts_have_the_lines_of_the_pictures(two, pushed_runs):
    live = two.live()
    front = live["chart-0"]["panels"][0]
    assert [line["name"] for line in front["lines"]] == ["whole", "half"]
    for line, record in zip(front["lines"], pushed_runs, strict=True):
        with h5py.File(record) as file:
            time, velocity = file["histories/front/time"][:], file["histories/front/velocity"][:, 0]
        np.testing.assert_allclose(line["x"], 1e3 * time, rtol=1e-5)  # in ms, with six digits
        np.testing.assert_allclose(line["y"], velocity, rtol=1e-5, atol=1e-30)
    frames = live["frames-1"]
    with h5py.File(pushed_runs[1]) as file:
        times = [group.attrs["time"] for group in file["snapshots"].values()]
    assert frames["captions"] == [f"t = {time:.4g} s" for time in times]


def test_a_bar_has_its_stresses_and_its_picture_over_place_and_time(spalled_results, tmp_path, monkeypatch):
    monkeypatch.setattr(page_module, "MOST_FRAMES", 3)
    write_report([spalled_results], tmp_path / "bar.html")
    page = Page(tmp_path / "bar.html")
    assert len(page.live()["frames-0"]["uris"]) == 3
    assert page.row("body") == ["bar of 1 m, 41 nodes"]
    assert page.row("supplied in all") == [joules(Results(spalled_results.parent).summary["energy"]["supplied"], "J")]


def test_what_results_lack_is_said_in_one_line_each_and_the_rest_is_there(blind_run, tmp_path):
    said = []
    for name in ("page.html", "again.html"):
        said.clear()
        write_report([blind_run], tmp_path / name, said.append)
    assert said == [
        f"{blind_run}: has no snapshots, run with output.snapshots above 0",
        f"{blind_run}: has no monitors to show",
    ]
    page = Page(tmp_path / "page.html")
    assert page.source == Page(tmp_path / "again.html").source  # the same of the same
    assert [line for line in page.said("li") if line in said] == said
    assert len(page.all("img")) == 1  # the energy
    assert page.row("supplied in all")


def test_a_run_that_is_not_complete_has_what_it_recorded(small_run, tmp_path):
    """Text that reorders itself is shown as escapes."""
    record, said = copied(small_run, tmp_path / "hidden"), []
    with h5py.File(record, "a") as file:
        file.attrs["title"] = "harm\u202eless"
        file.attrs["case"] = f"# one\u2066 line\n{file.attrs['case']}"
    write_report([record], tmp_path / "page.html", said.append)
    assert said == [
        f"{record}: has no entries in its energy ledger",
        f"{record.parent}: has no summary, the run is not complete; tables lack it",
    ]
    page = Page(tmp_path / "page.html")
    assert page.row("end") == ["the run is not complete"]
    assert "frames-0" in page.live()
    assert not HIDDEN.search(page.source)
    assert "harm\\u202eless" in page.source
    assert "# one\\u2066 line\n" in page.source


def test_an_estimate_some_snapshots_and_an_exact_motion_beside_the_run(two, pushed_runs, tmp_path, monkeypatch):
    monkeypatch.setattr(page_module, "MOST_FRAMES", 2)
    record = copied(pushed_runs[0], tmp_path / "estimated")
    summary = json.loads((record.parent / "summary.json").read_text())
    shares = {"of": {"rock": {"value": 0.0123, "upper": 0.02}}, "by": {"sides": 0.0123}}
    estimate = {"monitors": {"front": {"velocity": shares}}, "causes": {}, "notes": [], "not_estimated": []}
    (record.parent / "summary.json").write_text(json.dumps(summary | {"error_estimate": estimate}))
    exact, said = tmp_path / "exact.h5", []
    with h5py.File(record, "r+") as run, h5py.File(exact, "w") as file:
        file.attrs["name"], file.attrs["size"] = "front_exact", run.attrs["size"]
        for history in run["histories"].values():
            history["velocity"][:, 1] = 0.0  # so that only that along x is drawn
        run.copy("histories", file)
        times = [group.attrs["time"] for group in run["snapshots"].values()]
    write_report([record, exact], tmp_path / "page.html", said.append)
    page = Page(tmp_path / "page.html")
    assert said == []
    assert page.row("front, velocity")[0] == "of the rock 1.2 %, at most 2 % (sides 1.2 %)"
    assert "Estimated errors" in page.said("h3")
    assert "Estimated errors" not in two.said("h3")
    assert page.live()["frames-0"]["captions"] == [f"t = {times[index]:.4g} s" for index in (0, 2)]
    assert page.row("body") == ["10 m × 2.5 m, 100 disks", "exact motion at monitors"]
    names = [[line["name"] for line in panel["lines"]] for panel in page.live()["chart-0"]["panels"]]
    assert names == [["whole", "front_exact"]] * 2


def test_every_damaged_file_is_one_line(pushed_runs, spalled_results, tmp_path):
    damaged = tmp_path / "damaged.h5"
    damaged.write_bytes(pushed_runs[0].read_bytes()[:5000])
    other = tmp_path / "calibration.h5"
    shutil.copy(pushed_runs[0], other)
    missing = tmp_path / "nowhere" / "run.h5"
    with pytest.raises(CaseError) as raised:
        write_report([damaged, pushed_runs[0], other, missing], tmp_path / "page.html")
    lines = str(raised.value).splitlines()
    assert [line.split(": ")[0] for line in lines] == [str(damaged), str(other), str(missing)]
    assert raised.value.exit_code == 2  # not only damaged ones
    with pytest.raises(RecordError):
        write_report([damaged], tmp_path / "page.html")
    with pytest.raises(CaseError, match="RESULTS: holds runs of bars and of disks"):
        write_report([pushed_runs[0], spalled_results], tmp_path / "page.html")
    assert not (tmp_path / "page.html").exists()
