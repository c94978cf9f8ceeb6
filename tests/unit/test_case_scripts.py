"""Scripts beside the cases name what they lack before they run anything."""

import os
import subprocess
from pathlib import Path

import pytest

CASES = Path(__file__).parents[2] / "cases"


@pytest.mark.skipif(os.name == "nt", reason="the scripts are for bash")
@pytest.mark.parametrize(
    ("script", "lacking", "said"),
    [
        ("zhou2018/section4.sh", "skfem", "needs the Python package scikit-fem"),
        ("zhou2018/section4.sh", "dembound", "needs the Python package dembound"),
        ("lu2016/run.sh", "dembound", ""),
    ],
)
def test_what_is_lacking_is_named_before_anything_runs(script: str, lacking: str, said: str, tmp_path) -> None:
    commands = tmp_path / "commands"
    commands.mkdir()
    for name, text in {
        "python3": f'case "$2" in *{lacking}*) exit 1;; esac',
        "dembound": f'touch "{tmp_path}/ran"',
    }.items():
        (commands / name).write_text(f"#!/bin/sh\n{text}\n")
        (commands / name).chmod(0o755)
    ended = subprocess.run(
        ["bash", CASES / script, tmp_path / "results"],
        env=os.environ | {"PATH": f"{commands}{os.pathsep}{os.environ['PATH']}"},
        capture_output=True,
        text=True,
    )

    assert ended.returncode == 1
    assert said in ended.stderr
    assert {path.name for path in tmp_path.iterdir()} == {"commands"}
