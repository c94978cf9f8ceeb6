"""The load factor of one elastic run is the one that bisection finds with runs under the law with history."""

import json

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.running import run_case

SETTLED = 1e-6
"""Force ratio of the settled body."""

TABLES = PUSHED | {
    "boundary": {"left": {"type": "viscous_input", "wave_p": "push", "wave_s": "shake"}, "right": {"type": "viscous"}},
    "static": {"stress": [-1e6, -0.8e6, 0.0], "ratio": SETTLED},
    "reduce": {"settled": True},
    "run": {"duration": 0.03, "time_step": 2e-4},
    "output": {"snapshots": 0, "energy_interval": 5e-3, "pictures": False},
}

MATERIALS = {
    "slides": {"fric": 0.3, "pb_ten": 1e8, "pb_coh": 1e8},
    "opens": {"fric": 0.0, "pb_ten": 1e8, "pb_coh": 1e8},
    "breaks in tension": {"fric": 9.0, "pb_ten": 1e5, "pb_coh": 1e8},
    "breaks in shear": {"fric": 9.0, "pb_ten": 1e8, "pb_coh": 2e4, "pb_fa": 20.0},
}


def record(rng: np.random.Generator, path) -> None:
    """Noise below 150 Hz or so, 0.1 m/s at most, in 31 lines 1 ms apart."""
    count = 31
    band = np.exp(-((np.fft.rfftfreq(count, 1e-3) / 150.0) ** 2))
    values = np.fft.irfft(band * np.fft.rfft(rng.standard_normal(count)), count)
    values *= np.sin(np.pi * np.arange(count) / (count - 1))
    values[[0, -1]] = 0.0
    np.savetxt(path, np.column_stack([1e-3 * np.arange(count), 0.1 * values / np.abs(values).max()]))


def waves(folder, scale: float) -> dict:
    return {name: {"type": "file", "path": str(folder / f"{name}.txt"), "scale": scale} for name in ("push", "shake")}


@pytest.mark.parametrize(
    ("number", "limit"),
    [pytest.param(k, each, marks=[pytest.mark.slow] if k else []) for k, each in enumerate(MATERIALS)],
)
def test_the_full_law_begins_at_the_load_factor(tmp_path, number, limit):
    rng = np.random.default_rng(number)
    for name in ("push", "shake"):
        record(rng, tmp_path / f"{name}.txt")
    material = TABLES["material"] | MATERIALS[limit]
    changes = {"wave": waves(tmp_path, 1.0), "output.load_factor": True, "material": material}
    summary = json.loads((run_case(small(TABLES, "elastic", changes), tmp_path) / "summary.json").read_text())
    factor = summary["load_factor"]["factor"]
    assert summary["load_factor"]["limit"] == limit

    def holds(scale: float) -> bool:
        full = {"wave": waves(tmp_path, scale), "material": material | {"law": "linearpbond", "geometry": "reference"}}
        found = json.loads((run_case(small(TABLES, "full", full), tmp_path) / "summary.json").read_text())
        assert found["laws"][0]["law"] == "elastic"
        return len(found["laws"]) == 1

    # both bodies settle to the ratio, each on its own way, so forces at rest, and the room left, differ by some of it
    near = 20.0 * SETTLED
    assert holds(factor * (1.0 - near))
    assert not holds(factor * (1.0 + near))
