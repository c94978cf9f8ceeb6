"""The step of a bar, given in any way, beside the exact limit of its method."""

from dataclasses import replace

import numpy as np
import pytest
from small_cases import problems_in

from dembound.bar.body import is_stable, largest_stable_step
from dembound.bar.fracture import Spall, breaks_at_ends, cracked_since, spalls
from dembound.bar.scene import build_bar
from dembound.bar.stability import choose_step, shortened_in_words
from dembound.kernels.bar_cracks import OPENING
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Fracture, Rod

CENTRAL = {"method": {"type": "finite_difference"}}
UNIT = 0.025 / 1000.0
"""Δx/c of the spalling bar, s; 1 is the largest Courant number of central differences with half masses at free ends."""


PATCH = {"method": {"type": "patch", "horizon": 3}}


@pytest.mark.parametrize(
    ("run", "method", "problem"),
    [
        ({"courant": 1.001}, CENTRAL, "run.courant: is 1.001, must not be above 1, the stability limit"),
        ({"time_step": 1.001 * UNIT}, CENTRAL, "run.time_step: is 2.5025e-05 s, must not be above the stability limit"),
        # with three spacings alone it could be nearly twice as long; a step must serve all stages of the method
        ({"courant": 1.9}, PATCH, "run.courant: is 1.9, must not be above 1, "),
    ],
)
def test_a_bars_step_above_its_limit_is_refused_in_the_words_of_the_case(spalling, run, method, problem) -> None:
    scene = build_bar(spalling({**method, "run": {"duration": 1.5e-3, **run}}))
    (said,) = problems_in(lambda: choose_step(scene))
    assert said.startswith(problem)


def test_a_step_is_the_limit_that_of_its_courant_number_or_a_share_of_the_limit(spalling) -> None:
    step, limit = choose_step(build_bar(spalling({**CENTRAL, "bar.spacing": 1.0 / 41.0})))
    assert step == pytest.approx(1e-3 / 41.0, rel=1e-15)
    assert limit == pytest.approx(step, rel=1e-12)
    assert choose_step(build_bar(spalling({"run.courant": 1.9})))[0] == pytest.approx(1.9 * UNIT, rel=1e-15)
    step, limit = choose_step(build_bar(spalling({**CENTRAL, "run": {"duration": 1e-3, "safety": 0.75}})))
    assert step == 0.75 * limit


def blow(**wave: object) -> dict[str, object]:
    """A load on the left end node."""
    return {"load": [{"name": "blow", "pressure": 1e6, "wave": "it"}], "wave": {"it": {"amplitude": 1.0, **wave}}}


AT_ONCE = CENTRAL | blow(type="constant")
STEP = CENTRAL | blow(type="constant", start=0.5 * UNIT)
ODD = blow(type="triangle", rise=5.0 * UNIT, fall=10.0 * UNIT)
BOTH = blow(type="constant", start=0.5 * UNIT)
BOTH["load"] = [{"name": side, "side": side, "pressure": 1e6, "wave": "it"} for side in ("left", "right")]
SUDDENLY = (
    "run.courant: is 1, shortened to 0.99, 0.99 of the stability limit: at the limit so sudden loads leave swings"
)

ALIKE = [{"name": "a", "length": 0.5}, {"name": "b", "length": 0.5, "spacing": 0.0125, "wave_speed": 500.0}]
TOUCHING = [ALIKE[0], ALIKE[1] | {"interface": "contact"}]
UNLIKE = [ALIKE[0], ALIKE[1] | {"wave_speed": 500.1}]
PERIDYNAMIC = {"method": {"type": "peridynamics", "horizon": 3}}


@pytest.mark.parametrize(
    ("changes", "run", "line"),
    [
        (CENTRAL, {"courant": 1.0}, ""),
        (PATCH, {"safety": 1.0}, ""),
        (CENTRAL | {"bar.range": TOUCHING}, {"courant": 1.0}, "run.courant: is 1, shortened to 0.99, 0.99 of the stab"),
        (CENTRAL | {"bar.range": TOUCHING}, {"courant": 0.99}, ""),
        (CENTRAL | {"bar.range": UNLIKE}, {"courant": 1.0}, "run.courant: is 1, shortened to 0.990"),
        (PERIDYNAMIC, {"safety": 1.0}, "run.safety: is 1, shortened to 0.99"),
        (STEP, {"courant": 1.0}, SUDDENLY),
        # at a whole step a jump has its mean, which is d'Alembert's solution
        (AT_ONCE, {"courant": 1.0}, ""),
        # from its corners S = F/4 (1/5 + 1/5 + 1/10 − 1/10), by which springs swing by 0.2 F on the way of 40 cells
        (CENTRAL | ODD, {"courant": 1.0, "duration": 35 * UNIT}, ""),
        (CENTRAL | ODD, {"courant": 1.0, "duration": 70 * UNIT}, SUDDENLY),
        # equal pressures on both ends of an odd number of cells add up in the mode, of an even one they cancel
        (CENTRAL | {"bar.spacing": 1.0 / 39.0} | BOTH, {"courant": 1.0}, SUDDENLY),
        (CENTRAL | BOTH, {"courant": 1.0}, ""),
    ],
)
def test_only_waves_that_are_exact_may_have_a_step_at_the_limit(spalling, changes, run, line) -> None:
    scene = build_bar(spalling({**changes, "run": {"duration": 1.5e-3, **run}}))
    step, limit = choose_step(scene)
    said = shortened_in_words(scene, step)
    assert said.startswith(line)
    assert bool(said) == bool(line)
    assert (step == 0.99 * limit) == bool(line) or run == {"courant": 0.99}


ROUNDING = 1e-13
"""Rounding of the largest of 20 eigenvalues: either way of finding it rounds some 20 sums of 20 terms."""


def chain(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Random bonds of 20 nodes, most of them there: bands, dense stiffness matrix and masses."""
    rng = np.random.default_rng(seed)
    n, reach = 20, 1 + seed % 4
    bands, dense = np.zeros((reach + 1, n)), np.zeros((n, n))
    for d in range(1, reach + 1):
        for i in range(n - d):
            k = rng.uniform(0.0, 1e9) * (rng.uniform() < 0.8)
            dense[np.ix_((i, i + d), (i, i + d))] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
            bands[d, i] = -k
    bands[0] = np.diag(dense)
    return bands, dense, rng.uniform(1.0, 10.0, n)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("held", [[], [0, 19], [3, 4, 11]], ids=str)
def test_the_limit_is_that_of_the_largest_eigenvalue(seed: int, held: list[int]) -> None:
    bands, dense, mass = chain(seed)
    nodes, before = np.array(held, dtype=np.int64), (bands.copy(), mass.copy())
    free = np.setdiff1d(np.arange(len(mass)), nodes)
    root = np.sqrt(mass[free])
    limit = 2.0 / np.sqrt(np.linalg.eigvalsh(dense[np.ix_(free, free)] / np.outer(root, root))[-1])

    assert largest_stable_step(bands, mass, nodes) == pytest.approx(limit, rel=ROUNDING)
    assert is_stable(limit * (1.0 - 2.0 * ROUNDING), bands, mass, nodes)
    assert not is_stable(limit * (1.0 + 2.0 * ROUNDING), bands, mass, nodes)
    assert np.array_equal(bands, before[0])
    assert np.array_equal(mass, before[1])


COUNT, SPACING, SECONDS = 41, 0.25, 1e-3
ROD = Rod.uniform(COUNT, SPACING, section=1.0, modulus=1e9, critical_stretch=1e-3)
PLACES = SPACING * np.arange(COUNT)
ENDS = {"left": PLACES[0], "right": PLACES[-1]}


@pytest.fixture
def bonds() -> Bonds:
    """Peridynamics with m = 3 all over."""
    made = Bonds(ROD, 3, complement=False)
    made.add_zone(0, COUNT)
    return made


@pytest.fixture
def tough() -> Bonds:
    """Bonds with a fracture energy."""
    made = Bonds(Rod((replace(ROD.ranges[0], fracture=Fracture(1e4)),)), 3, complement=False)
    made.add_zone(0, COUNT)
    return made


def cut(bonds: Bonds, plane: int, step: int, lengths: tuple[int, ...] = (1, 2, 3)) -> None:
    """Break the bonds of these lengths that cross a plane."""
    for p in lengths:
        across = np.arange(max(0, plane - p + 1), min(plane, COUNT - 1 - p) + 1)
        whole = across[bonds.bond[p - 1, across] > 0.0]
        bonds.bond[p - 1, whole] = 0.0
        bonds.bond_broken[p - 1, whole] = step


def opened(bonds: Bonds, plane: int, step: int) -> None:
    """Let all bonds across a plane begin to open in a step and break three steps later, as the kernel would."""
    bundle = bonds.opening.bundle
    for p in (1, 2, 3):
        for i in range(max(0, plane - p + 1), min(plane, COUNT - 1 - p) + 1):
            q = bundle.listed[0]
            bundle.row[q], bundle.first[q], bundle.began[q] = p - 1, i, step
            bundle.limit[q], bundle.apart[q], bundle.furthest[q] = 1e-3, 1e-2, 1e-2
            bundle.listed[0] += 1
            bonds.bond[p - 1, i], bonds.bond_broken[p - 1, i] = 0.0, step + 3


def test_a_cut_cracks_the_nodes_that_lose_three_tenths(bonds) -> None:
    assert np.array_equal(cracked_since(bonds), np.full(COUNT, -1))
    assert spalls(bonds, PLACES, SECONDS) == []
    cut(bonds, 20, step=7)
    since = cracked_since(bonds)

    # of 5 parts of a family 2.5 are beyond the cut, then 1.5, exactly three tenths, then 0.5
    assert np.flatnonzero(since >= 0).tolist() == [19, 20, 21, 22]
    assert np.all(since[19:23] == 7)
    place = (PLACES[19], PLACES[22])
    assert spalls(bonds, PLACES, SECONDS) == [Spall(7 * SECONDS, place, place)]


def test_a_spall_begins_when_the_first_node_has_lost_enough_with_those_of_that_step_alone(bonds) -> None:
    cut(bonds, 20, step=5, lengths=(1,))  # a fifth of the families of 20 and 21
    cut(bonds, 20, step=8, lengths=(2,))  # another fifth of theirs, and one of 19 and 22
    cut(bonds, 20, step=11, lengths=(3,))
    before = cracked_since(bonds)
    assert before[[19, 20, 21, 22]].tolist() == [11, 8, 8, 11]
    cut(bonds, 21, step=14)
    after = cracked_since(bonds)

    # 23 is beside the second cut as 22 was beside the first; the crack is not younger by it
    assert np.array_equal(after[before >= 0], before[before >= 0])
    assert np.flatnonzero((after >= 0) & (before < 0)).tolist() == [23]
    assert after[23] == 14
    (spall,) = spalls(bonds, PLACES, SECONDS)
    assert spall.time == pytest.approx(8 * SECONDS)
    assert (spall.start, spall.end) == ((PLACES[20], PLACES[21]), (PLACES[19], PLACES[23]))


@pytest.mark.parametrize(
    ("plane", "off", "nodes"), [(0, "left", (0, 0)), (20, None, (19, 22)), (39, "right", (40, 40))]
)
def test_a_bar_comes_off_an_end_where_its_node_is_the_first_to_crack(bonds, plane: int, off, nodes) -> None:
    cut(bonds, plane, step=3)
    (spall,) = spalls(bonds, PLACES, SECONDS)

    # the end node has lost all, the next one half a volume of three
    assert spall.end == (PLACES[nodes[0]], PLACES[nodes[1]])
    assert breaks_at_ends([spall], ENDS) == ({off: spall} if off else {})
    assert breaks_at_ends([spall], {}) == {}


def test_with_a_fracture_energy_a_spall_is_an_open_plane(tough) -> None:
    assert spalls(tough, PLACES, SECONDS) == []
    opened(tough, 20, step=5)
    place = (PLACES[20], PLACES[21])
    assert spalls(tough, PLACES, SECONDS) == [Spall(8 * SECONDS, place, place, 5 * SECONDS)]
    assert spalls(tough, PLACES, SECONDS)[0].describe()["began"] == 5e-3
    tough.bond[2, 18], tough.bond_broken[2, 18] = 1.0, OPENING  # one that still crosses it
    assert spalls(tough, PLACES, SECONDS) == []
