"""Lanes compute in compiled code what their Python lines compute, on processors of all kinds, and without compiling."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.lane_access import (
    combine,
    combine_more,
    load,
    note_some,
    nth,
    store,
    store_some,
    where_equal,
)
from dembound.kernels.compiler.lanes import (
    LANES,
    at_most,
    bits,
    byte_of,
    choose,
    lane,
    magnitude,
    root,
    splat,
    with_sign,
)
from dembound.kernels.compiler.limits import factors_of
from dembound.kernels.compiler.start_strain import began_with
from dembound.pairwise import limit_of

OPTIONS = {name: value for name, value in FAST.items() if name != "cache"}


def computed(x, y):  # type: ignore[no-untyped-def]
    """Arithmetic, also in place; choices; magnitudes, roots and signs; single lanes."""
    z = 2.0 * x + y * x - y / x
    z += 1.0
    z -= y
    z *= 0.5
    chosen = choose(at_most(x, y), choose(bits(np.uint8(0b01101001)), x, 7.0), 0.0)
    return z - 3.0, chosen, with_sign(root(magnitude(x)), y), splat(lane(x, U(3)) + lane(y, U(LANES - 1)))


def test_compiled_lanes_are_what_python_says() -> None:
    compute, width = njit(**OPTIONS)(computed), LANES + 3

    @njit(**OPTIONS)
    def compiled(a, b, result):  # type: ignore[no-untyped-def]
        first, second, third, fourth = compute(load(a, U(1)), load(b, U(0)))
        store(result, U(2), first)
        store(result, U(2 + width), second)
        store(result, U(2 + 2 * width), third)
        store(result, U(2 + 3 * width), fourth)

    a, b = np.random.default_rng(0).uniform(-2.0, 2.0, (2, LANES + 1))
    found, expected = np.full((2, 4 * width), np.nan)
    compiled(a, b, found)
    for row, values in enumerate(computed(load(a, 1), load(b, 0))):
        store(expected, 2 + row * width, values)

    # a fused multiply-add rounds once where Python rounds twice
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-14)
    assert np.isnan(found.reshape(4, width)[:, [0, 1, -1]]).all()


def eight(slots, values, table, numbers, limits, other, numbers_other):  # type: ignore[no-untyped-def]
    """Values at eight indices, a column of eight rows, limits, bytes; some of each written elsewhere."""
    at = load(slots, U(1))
    rows = load(slots, at)
    first = load(values, at) + table[rows, U(2)] - limit_of(limits, rows) + factors_of(limits, at)
    first += splat(factors_of(1.0, at)) + began_with(table, at, U(1)) + began_with(0.0, at, U(1))
    first += splat(began_with(table, U(1), U(2)) + began_with(table[:0], U(1), U(2))) + began_with(table[:0], at, U(1))
    chosen = np.uint8(byte_of(where_equal(numbers, at, np.uint8(2))) | np.uint8(3))
    store_some(other, at, first, chosen)
    store_some(other, U(LANES + 5), first, chosen)
    note_some(numbers_other, at, np.uint8(0b01010101), np.uint8(0b10100010), chosen)
    note_some(numbers_other, U(LANES + 5), np.uint8(0b01010101), np.uint8(0b10100010), chosen)
    return float(nth(at, U(2))) + float(nth(U(4), U(2)))


def test_eight_indices_are_what_python_says() -> None:
    rng, count = np.random.default_rng(1), LANES + 4
    slots = rng.permutation(count).astype(np.uint32)
    values, limits = rng.uniform(1.0, 2.0, (2, count))
    given = slots, values, rng.uniform(1.0, 2.0, (count, 3)), rng.integers(0, 3, count).astype(np.uint8), limits
    found, expected = (
        [np.full(3 * LANES, np.nan), np.full(3 * LANES, 9, dtype=np.uint8)] for _ in range(2)
    )  # fmt: skip
    assert njit(**OPTIONS)(eight)(*given, *found) == eight(*given, *expected)
    np.testing.assert_array_equal(found[0], expected[0])
    np.testing.assert_array_equal(found[1], expected[1])
    assert np.isnan(found[0]).sum() > LANES  # unchosen lanes are left


@pytest.mark.parametrize("function", [combine, combine_more])
def test_compiled_products_with_a_matrix_are_what_python_says(function: Callable) -> None:
    @njit(**OPTIONS)
    def compiled(points, matrix, given, found):  # type: ignore[no-untyped-def]
        function(points, matrix, given, U(3), found, U(1), U(LANES + 2))
        function(points, matrix, found, U(1), found, U(1), U(LANES + 2))  # in place

    count, rng = 5, np.random.default_rng(0)
    matrix, given, found = (rng.uniform(-2.0, 2.0, size) for size in (count**2, 60, 60))
    points, expected = tuple(np.zeros(count).tolist()), found.copy()
    function(points, matrix, given, 3, expected, 1, LANES + 2)
    once = expected - (found if function is combine_more else 0.0)
    function(points, matrix, expected, 1, expected, 1, LANES + 2)
    compiled(points, matrix, given, found)

    # sums of up to five products of two numbers up to 2, twice
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13)
    for k in range(LANES):
        rows = matrix.reshape(count, count) @ given[3 + k :: LANES + 2][:count]
        np.testing.assert_allclose(once[1 + k :: LANES + 2][:count], rows, rtol=0.0, atol=1e-13)


SCENE = """
import numpy as np
from dembound.api import case
from dembound.disks.scene import build
from dembound.kernels.elastic import contact_forces
from dembound.motion.simulation import Simulation

side = {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}
scene = build(case(
    packing={"pattern": "A", "size": [9.0, 1.5], "radius": 0.25},
    material={"density": 2500.0, "p_wave_speed": 1000.0},
    boundary={"left": side},
    wave={"pulse": {"type": "cosine", "amplitude": 0.5, "period": 0.005}},
    run={"duration": 0.01},
))
assert not scene.layout.is_plain
"""

MOTION = """
from grid_scene import GridScene
from dembound.continuum.part import GridBody
from dembound.continuum.medium import Medium
from dembound.continuum.axis import Around
from dembound.continuum.mesh import Mesh

simulation = Simulation(scene, 1e-4)
simulation.run(3)
of_disks = simulation.state.velocity

mesh = Mesh.uniform(order=4, element=(3.0, 2.0), cells=(3, 3), layer=Around(1, 1, 1, 0))
body = GridBody(mesh=mesh, medium=Medium.isotropic(2500.0, 1000.0, 600.0))
simulation = Simulation(GridScene(body), 1e-4)
noise = np.random.default_rng(0).standard_normal((3, body.count)) * ~mesh.held
noise[2] = 0.0
simulation.state.velocity = noise
simulation.run(3)
result = np.hstack([of_disks / np.abs(of_disks).max(), simulation.state.velocity])
"""


def here(code: str) -> np.ndarray:
    """The result of some code for that scene."""
    scope: dict[str, Any] = {}
    exec(SCENE + code, scope)
    return scope["result"]


def elsewhere(code: str, folder: Path, **environment: str) -> np.ndarray:
    """The result of the code in a separate process."""
    path, importable = folder / "result.npy", {"PYTHONPATH": os.pathsep.join(sys.path)}
    subprocess.run(
        [sys.executable, "-W", "ignore", "-c", f"{SCENE}{code}np.save({str(path)!r}, result)"],
        env=os.environ | importable | {"NUMBA_CACHE_DIR": str(folder / "cache")} | environment,
        check=True,
    )
    return np.load(path)


def test_kernels_run_without_being_compiled(tmp_path) -> None:
    """Disks and a continuum at speeds of 1; some ten sums a step, which fused multiply-adds round otherwise."""
    np.testing.assert_allclose(elsewhere(MOTION, tmp_path, NUMBA_DISABLE_JIT="1"), here(MOTION), rtol=0.0, atol=1e-13)
