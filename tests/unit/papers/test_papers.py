"""Figures of papers: what they are asked for, and how they are drawn."""

import pytest

from dembound import shipped
from dembound.errors import CaseError
from dembound.papers import PAPERS, Work


@pytest.mark.parametrize("name", PAPERS)
def test_a_paper_is_a_group_of_cases_and_lists_its_figures(name, dembound) -> None:
    assert name in shipped.groups()
    listed = dembound("paper", name)
    assert listed.code == 0
    assert all(figure.title in listed.out and figure.chinese in listed.out for figure in PAPERS[name].figures.values())


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["zhou"], "PAPER: is zhou, must be one of zhou2018, lu2016"),
        (["zhou2018", "--figure", "4"], "--figure: is 4, must be one of 2, 3, 6,"),
        (
            ["zhou2018", "--figure", "16", "--radius-ratio", "3"],
            "--radius-ratio: figure 16 has no packing of pattern B",
        ),
        (["lu2016", "--figure", "5", "--set", "run.duration=1"], "--set: figure 5 has no case"),
        (["lu2016", "--figure", "6", "--set", "run.durations=1"], "run.durations"),
    ],
)
def test_what_cannot_be_drawn_is_told_in_one_line(arguments, said, dembound) -> None:
    answer = dembound("paper", *arguments)
    assert answer.code == 2
    assert said in answer.err


def test_a_figure_leaves_its_picture_and_its_numbers_beside_the_printed_ones(dembound, tmp_path) -> None:
    assert dembound("paper", "lu2016", "--figure", "6", "--output", tmp_path / "out").code == 0
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"figure_6.png", "figure_6.md"}
    assert "| crest p_m (MPa) | 8.90 | 8.9 |" in (tmp_path / "out" / "figure_6.md").read_text()


def test_ratios_and_changes_of_the_user_reach_the_cases_of_a_figure(tmp_path) -> None:
    from dembound.papers.zhou2018 import patterns

    work = Work("zhou2018", tmp_path, {"wave.pulse.period": 0.25}, (1.2, 1.8))
    assert [name for name, *_ in patterns(work)] == ["A", "B, λ = 1.2", "B, λ = 1.8", "C"]
    _, case, changes = patterns(work)[2]
    made = work.disks(case, {key.replace("__", "."): value for key, value in changes.items()}, "bar")
    assert (made.packing.radius_ratio, made.wave["pulse"].duration()) == (1.8, 0.25)
    with pytest.raises(CaseError, match=r"radius_ratio"):
        work.disks(case, {"packing.radius_ratio": 0.5}, "bar")
