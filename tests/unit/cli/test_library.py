"""The commands library and respond."""

import numpy as np
from small_cases import PUSHED, small

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
    assert dembound("plot", "results/r").code == 0
    assert dembound("signals", "results/r", "--show", "hodograph").code == 0
    assert "bar" not in dembound("rerun", "results/r", "--name", "direct").err
    assert " 0.000 " in dembound("compare", "results/direct", "results/r").out

    for pair, problem in (
        ("a", "--load-factor: is a, must be two monitors, A,B; here: a, b, far"),
        ("a,far", "--load-factor: the disks of a and far have neither contact nor bond"),
    ):
        answer = dembound("respond", "results/bar_library", "r.txt", "--load-factor", pair)
        assert (answer.code, answer.err.strip()) == (2, problem)
