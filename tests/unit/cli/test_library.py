"""The commands library and respond."""

import numpy as np
import tomli_w
from small_cases import PUSHED, small

from dembound.casefile.reader import parsed

SIDES = {"left": "push", "right": "pull"}

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


def test_a_record_is_warned_of_as_in_the_run_of_its_case_and_silent_inputs_are_not(dembound, tmp_path):
    both = STRONG | {
        "material": PUSHED["material"],
        "boundary": {side: {"type": "viscous_input", "wave_p": name} for side, name in SIDES.items()},
        "wave": {name: PUSHED["wave"]["push"] for name in SIDES.values()},
        "output": {},
    }
    (tmp_path / "bar.toml").write_text(small(both, "bar").text)
    assert dembound("library", "bar.toml", "--spacing", "0.0001", "--duration", "0.1").code == 0
    times = np.arange(0.0, 0.1, 1e-4)
    slow = np.sin(2.0 * np.pi * 200.0 * times) * np.sin(np.pi * times / 0.1)
    wrong = {
        "units": ("t (s), v (cm/sec)", slow, "header says cm/sec"),
        "fast": ("", np.sin(2.0 * np.pi * 3e3 * times), "particle"),
    }
    for name, (header, values, words) in wrong.items():
        np.savetxt(f"{name}.txt", np.column_stack([times, values])[:-1], header=header, footer="0.1 0", comments="# ")
        text = (tmp_path / f"{name}.txt").read_text()
        (tmp_path / f"{name}.txt").write_text(text.replace("# 0.1 0", "0.1 0"))
        of_run = both | {"wave": {"pull": PUSHED["wave"]["push"], "push": {"type": "file", "path": f"{name}.txt"}}}
        of_run |= {"run": {"duration": 0.1}}
        (tmp_path / f"{name}.toml").write_text(tomli_w.dumps(parsed(small(PUSHED, name).text) | of_run))
        lines = dembound("check", f"{name}.toml").err.splitlines()
        expected = {line for line in lines if " wave.push: " in line}
        answer = dembound("respond", "results/bar_library", f"push={name}.txt")
        assert answer.code == 0
        assert expected <= set(answer.err.splitlines())
        assert " wave.pull: " not in answer.err
        assert any(words in line for line in expected), (name, expected)
    assert " wave.pull: " not in dembound("rerun", "results/fast", "--name", "again").err
