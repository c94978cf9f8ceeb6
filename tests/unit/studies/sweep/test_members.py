"""Members of a sweep: combinations, names, keys and groups."""

import pytest
from small_cases import GRAINS, small

from dembound.errors import CaseError
from dembound.results.folder import problem_of
from dembound.studies.sweep.members import LONGEST, members_of, variations


def names(case, vary, together=False):
    members, _ = members_of(case, variations(vary, together), "run", "impedance")
    return [member.name for member in members]


def test_all_combinations_are_members_the_last_key_first_or_values_together(bar) -> None:
    vary = {"run.safety": [0.5, 0.9], "run.duration": [0.01, 0.02]}
    assert names(bar(), vary) == [f"safety={s},duration={d}" for s in (0.5, 0.9) for d in (0.01, 0.02)]
    assert names(bar(), vary, together=True) == ["safety=0.5,duration=0.01", "safety=0.9,duration=0.02"]
    with pytest.raises(CaseError, match=r"--together: .* run.safety 2 values, run.duration 1 value"):
        variations(vary | {"run.duration": [0.01]}, together=True)
    with pytest.raises(CaseError, match="--vary: is missing"):
        variations({}, False)
    # invalid ones are left out and equal ones count once
    members, left_out = members_of(bar(), variations({"run.safety": [0.5, 2.0, 0.5]}, False), "run", "impedance")
    assert [member.name for member in members] == ["safety=0.5"]
    assert [line.split(":")[0] for line in left_out] == ["safety=2"]


def test_names_are_those_of_folders_and_differ(bar) -> None:
    sides = [{"type": "free"}, {"type": "viscous", "beta_p": 0.5}, {"type": "viscous", "beta_p": 0.5 + 1e-9}]
    found = names(bar(), {"boundary.right": sides})
    assert found[:2] == ["boundary.right=free", "boundary.right=viscous-(beta_p-0.5)"]
    assert found[2].startswith("boundary.right=viscous-(beta_p-0.5)-")  # the same to six digits
    assert not [name for name in found if problem_of(name)]
    (long,) = names(bar(), {"title": ["a/b:" * 30]})
    assert problem_of(long) == ""
    assert len(long) <= LONGEST + 9


def test_keys_depend_on_results_alone(bar) -> None:
    changes = variations({"run.safety": [0.5]}, False)

    def key(case, action="run", method="impedance"):
        ((member,), _) = members_of(case, changes, action, method)
        return member.key

    same = key(bar({"title": "another", "sweep": {"processes": 7, "vary": {"run.safety": [0.5]}}}), method="ratio")
    assert key(bar()) == same  # the method is one of calibrations
    others = [key(bar({"run.duration": 0.011})), key(bar(), "calibrate"), key(bar(), "calibrate", "ratio")]
    assert len({key(bar()), *others}) == 4


def test_groups_are_the_changes_without_seeds() -> None:
    random = small(GRAINS)
    members, _ = members_of(random, variations({"packing.seed": [1, 2], "run.safety": [0.5]}, False), "run", "ratio")
    assert [member.group for member in members] == [{"run.safety": 0.5}] * 2
