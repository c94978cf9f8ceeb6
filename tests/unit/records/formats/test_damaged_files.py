"""Damaged files of ground motion are read or refused in one line, whatever the damage."""

import random
import warnings
from pathlib import Path

import numpy as np

from dembound.errors import CaseError
from dembound.records.formats import read_record

SAMPLES = sorted((Path(__file__).parents[1] / "samples").glob("sample*"))
CHANGES = 400
TEXTS = [b"", b"\0", b"nan", b"inf", b"1e999", b"99999999999999999999", b"-999", b"*" * 9, b"\xff", b","]


def damaged(content: bytes, draw: random.Random) -> bytes:
    """A content with one to three changes of bytes, words, lines or its length."""
    for _ in range(draw.randint(1, 3)):
        at = draw.randrange(len(content) + 1)
        lines = content.split(b"\n")
        line = draw.randrange(len(lines))
        match draw.randrange(7):
            case 0:
                content = content[:at] + bytes([draw.randrange(256)]) + content[at + 1 :]
            case 1:
                content = content[:at] + content[at + draw.randint(1, 40) :]
            case 2:
                content = content[: at + draw.randint(1, 40)] + content[at:]
            case 3:
                content = b"\n".join(lines[:line] + lines[line + 1 :])
            case 4:
                content = b"\n".join(lines[: line + 1] + lines[line:])
            case 5:
                content = content[:at]
            case 6:
                words = lines[line].split(b" ")
                words[draw.randrange(len(words))] = draw.choice(TEXTS)
                content = b"\n".join([*lines[:line], b" ".join(words), *lines[line + 1 :]])
    return content


def test_only_one_line_errors_come_of_damage(tmp_path):
    draw, path, problems = random.Random(5), tmp_path / "record", []
    contents = [sample.read_bytes() for sample in SAMPLES]
    for number in range(CHANGES):
        content = damaged(contents[number % len(contents)], draw)
        path.write_bytes(content)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                record = read_record(path)
        except CaseError as error:
            problems.append(error.problems)
            continue
        for channel in record.channels:
            assert np.isfinite(channel.values).all()
            assert len(channel.values) > 2
            assert channel.time_step > 0.0
            assert np.isfinite([channel.time_step, channel.begin, channel.stated_peak or 0.0]).all()
    assert {len(lines) for lines in problems} == {1}
    assert 0.2 * CHANGES < len(problems) < 0.9 * CHANGES
