"""The compiled step of a bar against the same equations written down plainly, with a dense stiffness matrix."""

from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from dembound.kernels import bar, tables
from dembound.kernels.common import DONE, TRIGGERED
from dembound.kernels.loop import advance
from dembound.laws.peridynamic import families, micromodulus
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Rod

EPS = np.finfo(float).eps
COUNT, STEPS = 60, 41
STEP = 0.1
SUPPORTED = np.array([0, 1, 7, 30, 59])
ROD = Rod.uniform(COUNT, spacing=0.5, section=2.0, modulus=1.0, critical_stretch=np.inf)
(PART,) = ROD.ranges
MASS = ROD.mass
"""Of 1 inside, so that the fastest waves stay far below the limit of the step."""
WEAK = Rod.uniform(COUNT, spacing=0.5, section=2.0, modulus=1.0, critical_stretch=0.55)
"""Bonds that reach their limit here and there while random motion stretches them by some tenths."""

ROUNDING = 8.0 * EPS * STEPS**2
"""Each step rounds velocities and displacements, of about 1, by a few ε; those add up to STEPS²/2 of them."""


def laid(rod: Rod, horizon: int, *zones: tuple[int, int], **words) -> Bonds:
    bonds = Bonds(rod, horizon, **words)
    for zone in zones:
        bonds.add_zone(*zone)
    return bonds


LAYOUTS = {
    "finite differences": lambda rod: Bonds(rod, 0),
    "peridynamics": lambda rod: laid(rod, 3, (0, COUNT), complement=False),
    "one spacing": lambda rod: laid(rod, 1, (0, COUNT), complement=False),
    "corrected ends": lambda rod: laid(rod, 5, (0, COUNT)),
    "before a switch": lambda rod: Bonds(rod, 3),
    "a zone": lambda rod: laid(rod, 3, (20, 40)),
    "zones": lambda rod: laid(rod, 2, (3, 9), (12, 20), (50, 60)),
    "a zone without complement": lambda rod: laid(rod, 3, (20, 40), complement=False),
}


def damaged(bonds: Bonds) -> Bonds:
    """With some springs and bonds broken earlier."""
    bonds.spring[[5, 33]] = 0.0
    bonds.bond[:, 26:28] = 0.0
    return bonds


@pytest.fixture(params=LAYOUTS.values(), ids=LAYOUTS.keys())
def layout(request):
    """Lays the bonds of a method on a rod."""
    return request.param


def matrix(bonds: Bonds) -> np.ndarray:
    """The stiffness matrix (n, n), N/m."""
    bands = bonds.stiffness()
    lower = sum(np.diag(band[: COUNT - d], -d) for d, band in enumerate(bands))
    return lower + np.tril(lower, -1).T


def energy(bonds: Bonds, u: np.ndarray, before: np.ndarray, v: np.ndarray) -> float:
    """½ v⁺ᵀM v⁺ + ½ u⁺ᵀK u: what central differences conserve, at displacements u⁺ and u a step before."""
    return 0.5 * float(np.sum(MASS * v**2) + u @ matrix(bonds) @ before)


def shaken(seed: int = 3) -> tuple[np.ndarray, np.ndarray]:
    """Random displacements and velocities (3, n) along x."""
    u, v = np.zeros((2, 3, COUNT))
    u[0], v[0] = np.random.default_rng(seed).uniform(-0.1, 0.1, (2, COUNT))
    return u, v


@dataclass
class Outside:
    """Dashpots, springs and drives of the supported nodes, random ones; the last is moved as prescribed."""

    nodes: np.ndarray = field(default_factory=lambda: SUPPORTED)

    def __post_init__(self) -> None:
        rng = np.random.default_rng(7)
        k = len(self.nodes)
        self.damping, self.stiffness = rng.uniform(0.0, 2.0, (2, k))
        self.drive = rng.uniform(-0.1, 0.1, (STEPS, k))
        self.prescribed = np.arange(k) == 4

    def table(self, drag: np.ndarray) -> tables.Supports:
        """The same for the kernel; on the other components nothing acts. drag (n,) is what attenuation adds."""

        def along_x(values: np.ndarray) -> np.ndarray:
            return np.stack([values, *np.zeros((2, *values.shape))], axis=-1)

        k = len(self.nodes)
        inertia = MASS[self.nodes] / STEP
        half = 0.5 * (self.damping + drag[self.nodes])
        mobility = ~self.prescribed / (inertia + half)
        return tables.Supports(
            self.nodes,
            np.repeat(inertia[:, None], 3, axis=1),
            along_x(mobility * (inertia - half)),
            along_x(mobility),
            along_x(self.stiffness * ~self.prescribed),
            along_x(self.prescribed.astype(float)),
            along_x(self.drive),
            np.full(k, -1),
            np.zeros((k, 3)),
        )


NOTHING = Outside(np.zeros(0, dtype=np.int64))


class Run:
    """A bar in the kernel's hands: state, log, and what it returned."""

    def __init__(self, bonds: Bonds, u: np.ndarray, v: np.ndarray, outside: Outside = NOTHING, a: float = 0.0) -> None:
        self.bonds, self.u, self.v, self.outside = bonds, u, v, outside
        self.drag = 2.0 * a / STEP * MASS
        bonds.rod = Rod(tuple(replace(part, drag_rate=2.0 * a / STEP) for part in bonds.rod.ranges))
        self.arrays = bonds.arrays(outside.nodes, STEP)
        self.work, self.top_speed = np.zeros((2, 7)), np.zeros(COUNT)
        self.record = np.zeros((STEPS, COUNT, 7))

    def advance(self, steps: int = STEPS, number: int = 0) -> tuple[int, int]:
        mobility = STEP / MASS
        mobility[self.outside.nodes] = 0.0
        body = tables.Body(mobility, mobility, np.array([1.0, 0.0, 0.0]), np.zeros((3, 0)), 0.0, STEP)
        supports = self.outside.table(self.drag)
        supports = supports._replace(drive=supports.drive[number : number + steps])
        nobody = np.zeros(0, dtype=np.int64)
        peaks, supplied = np.zeros((0, 3, 2)), np.zeros(1)
        log = tables.Log(np.arange(COUNT), self.record[number:], nobody, peaks, self.top_speed, self.work, supplied)
        u_next = np.zeros_like(self.u)
        return advance(self.u, u_next, self.v, number, (self.arrays,), (), None, body, supports, log)


def plain_run(bonds: Bonds, u: np.ndarray, v: np.ndarray, outside: Outside = NOTHING, a: float = 0.0):
    """Displacements and velocities (STEPS + 1, n), these half a step behind, pair by pair and node by node."""
    u, v = u[0].copy(), v[0].copy()
    places, speeds = [u], [v]
    line = {node: s for s, node in enumerate(outside.nodes)}
    for step in range(STEPS):
        force = -matrix(bonds) @ u
        after = np.empty(COUNT)
        for i in range(COUNT):
            total, C = force[i], 2.0 * a / STEP * MASS[i]
            if i in line:
                s = line[i]
                total += outside.drive[step, s] - outside.stiffness[s] * u[i]
                C += outside.damping[s]
            # m (v⁺ − v)/Δt = F − C (v⁺ + v)/2
            after[i] = ((MASS[i] / STEP - 0.5 * C) * v[i] + total) / (MASS[i] / STEP + 0.5 * C)
            if i in line and outside.prescribed[line[i]]:
                after[i] = outside.drive[step, line[i]]
        v, u = after, u + STEP * after
        places.append(u)
        speeds.append(v)
    return np.array(places), np.array(speeds)


def test_forces_are_those_of_the_stiffness_matrix(layout) -> None:
    bonds = damaged(layout(ROD))
    u = shaken()[0][0]
    arrays = bonds.arrays(SUPPORTED, STEP)
    of_ranges = np.full(COUNT, np.nan)
    reached = bar.forces(u, arrays, of_ranges)

    expected = -matrix(bonds) @ u
    # up to twelve terms of springs of 4 N/m and elongations below 0.2 m
    tolerance = 12 * EPS
    assert reached == 0
    plain = np.concatenate([np.zeros(0, dtype=int), *(np.arange(a, b) for a, b in arrays.plain)])
    assert np.array_equal(np.isnan(of_ranges), np.isin(np.arange(COUNT), plain))
    np.testing.assert_allclose(np.delete(of_ranges, plain), np.delete(expected, plain), rtol=0.0, atol=tolerance)


@pytest.mark.parametrize("horizon", [1, 2, 3, 5, 8])
def test_forces_of_a_peridynamic_bar_are_those_of_the_law(horizon: int) -> None:
    family = families(COUNT, horizon)
    first, second = family.pairs.T
    u = shaken()[0][0]
    stretch = (u[second] - u[first]) / (PART.spacing * family.apart)
    volumes = ROD.volumes[first] * ROD.volumes[second] * family.factor
    pull = micromodulus(PART.modulus, horizon * PART.spacing, PART.section) * stretch * volumes
    expected = np.bincount(first, pull, COUNT) - np.bincount(second, pull, COUNT)

    bonds = laid(ROD, horizon, (0, COUNT), complement=False)
    arrays = bonds.arrays(np.zeros(0, dtype=np.int64), STEP)
    force = np.empty(COUNT)
    bar.forces(u, arrays, force)

    # each bond's force, below c_m V² w, is rounded by some ε in its factors, and by one in every sum of 2m of them,
    # which together are below 2E·A (2m − 1)/m² ≤ 2EA
    tolerance = (8.0 + 2.0 * horizon) * EPS * 2.0 * PART.modulus * PART.section
    np.testing.assert_allclose(force, expected, rtol=0.0, atol=tolerance)
    assert np.abs(expected).max() > 0.01


def test_what_is_at_its_limit_is_counted(layout) -> None:
    bonds = layout(WEAK)
    u = 0.5 * 0.55 * (1.0 + 1e-9) * np.arange(COUNT)
    arrays = bonds.arrays(np.arange(COUNT) if bonds.horizon == 0 else np.zeros(0, dtype=np.int64), STEP)
    reached = bar.forces(u, arrays, np.empty(COUNT))

    # every bond, and every spring beside a node that is not plain, once for each range beside it
    mixed = [k for a, b, *_ in arrays.mixed for k in range(max(a - 1, 0), min(b, COUNT - 1))]
    assert reached == np.count_nonzero(bonds.bond) + np.count_nonzero(bonds.spring[mixed])
    assert bar.forces(0.999 * u, arrays, np.empty(COUNT)) == 0


@pytest.mark.parametrize("a", [0.0, 0.02], ids=["", "attenuated"])
@pytest.mark.parametrize("outside", [NOTHING, Outside()], ids=["free", "supported"])
def test_step_is_the_same_as_written_down_plainly(layout, outside: Outside, a: float) -> None:
    u, v = shaken()
    places, speeds = plain_run(damaged(layout(ROD)), u, v, outside, a)
    run = Run(damaged(layout(ROD)), u, v, outside, a)
    # odd numbers of steps, after which displacements stand in the other array
    for number, steps in ((0, 7), (7, 1), (8, 33)):
        assert run.advance(steps, number) == (steps, DONE)

    np.testing.assert_allclose(run.u[0], places[-1], rtol=0.0, atol=ROUNDING)
    np.testing.assert_allclose(run.v[0], speeds[-1], rtol=0.0, atol=ROUNDING)
    assert not run.u[1:].any()
    np.testing.assert_allclose(run.record[..., 0], places[:-1], rtol=0.0, atol=ROUNDING)
    np.testing.assert_allclose(run.record[..., 3], 0.5 * (speeds[:-1] + speeds[1:]), rtol=0.0, atol=ROUNDING)
    np.testing.assert_allclose(run.top_speed, np.abs(speeds[1:]).max(axis=0), rtol=0.0, atol=ROUNDING)
    assert not run.record[..., [1, 2, 4, 5]].any()


@pytest.mark.parametrize("a", [0.0, 0.02], ids=["", "attenuated"])
@pytest.mark.parametrize("outside", [NOTHING, Outside()], ids=["free", "supported"])
def test_books_close_while_bonds_break(layout, outside: Outside, a: float) -> None:
    u, v = shaken()
    run = Run(layout(WEAK), u, 15.0 * v, outside, a)
    run.arrays.triggers[:] = False
    run.arrays = all_mixed(run.arrays)
    before = energy(run.bonds, u[0], u[0] - STEP * run.v[0], run.v[0])
    run.advance()
    gained = energy(run.bonds, run.u[0], run.u[0] - STEP * run.v[0], run.v[0]) - before
    outside_work, damping, friction, crack, law_switch, turning, closing = run.work[0]

    broken = np.concatenate([run.bonds.spring_broken, run.bonds.bond_broken.ravel()])
    assert len(np.unique(broken)) > 5
    assert crack != 0.0
    assert (damping > 0.0) == (a > 0.0)
    assert (outside_work != 0.0) == (outside is not NOTHING)
    assert friction == law_switch == turning == closing == 0.0
    # sums of a few hundred terms a step, all together less than the work done either way
    scale = before + np.abs(run.work[0]).sum()
    assert gained == pytest.approx(outside_work - damping - crack, abs=STEPS * COUNT * EPS * scale)


def all_mixed(arrays: tables.BarBonds) -> tables.BarBonds:
    """The same arrays with no node that is plain."""
    runs = np.array(sorted([*arrays.mixed.tolist(), *([a, b, 1] for a, b in arrays.plain)]))
    return arrays._replace(plain=arrays.plain[:0], mixed=runs, mixed_keep=np.full(len(runs), arrays.mixed_keep[0]))


def flying(bonds: Bonds, plane: int) -> Run:
    """Two halves that fly apart from a plane at 1 m/s; what crosses it is far too soft to hold them."""
    bonds.spring *= 1e-9
    bonds.bond *= 1e-9
    v = np.zeros((3, COUNT))
    v[0, plane + 1 :] = 1.0
    run = Run(bonds, np.zeros((3, COUNT)), v)
    run.arrays = all_mixed(run.arrays)
    return run


def test_bonds_break_in_the_step_that_reaches_their_limit() -> None:
    rod = Rod.uniform(COUNT, spacing=0.5, section=2.0, modulus=1.0, critical_stretch=2.69)
    run = flying(laid(rod, 3, (0, COUNT), complement=False), 20)
    whole = run.bonds.bond.copy()
    for number, steps in ((0, 20), (20, 21)):
        assert run.advance(steps, number) == (steps, DONE)

    # 0.1 m a step: 1.345 m are reached after 14 steps, 2.69 and 4.035 m after 27 and 41; the last is not done
    for row, step in ((0, 14), (1, 27)):
        across = slice(20 - row, 21)
        assert np.all(run.bonds.bond_broken[row, across] == step)
        assert not run.bonds.bond[row, across].any()
    assert np.count_nonzero(run.bonds.bond_broken >= 0) == 1 + 2
    # ½ k e⁻ e; 1e-9 of stiffness changes velocities by less than that
    lost = 0.5 * whole[0, 20] * 1.3 * 1.4 + 0.5 * whole[1, 19:21].sum() * 2.6 * 2.7
    assert run.work[:, 3].tolist() == pytest.approx([lost, lost], rel=1e-6)


def test_what_is_broken_does_not_heal() -> None:
    rod = Rod.uniform(COUNT, spacing=0.5, section=2.0, modulus=1.0, critical_stretch=0.5)
    run = flying(laid(rod, 3, (0, COUNT), complement=False), 20)
    whole = run.bonds.bond > 0.0
    run.advance(20)
    broken = run.bonds.bond_broken.copy()
    run.v *= -1.0
    run.advance(21, 20)

    assert (broken >= 0).sum() == 1 + 2 + 3
    assert np.array_equal(run.bonds.bond_broken, broken)
    assert np.array_equal(run.bonds.bond > 0.0, whole & (broken < 0))


@pytest.mark.parametrize("plain", [True, False])
def test_springs_that_ask_stop_the_kernel_before_the_step(plain: bool) -> None:
    rod = Rod.uniform(COUNT, spacing=0.5, section=2.0, modulus=1.0, critical_stretch=0.5)
    u, v = np.zeros((2, 3, COUNT))
    v[0] = 0.02 * np.arange(COUNT)
    run = Run(Bonds(rod, 3, trigger_ratio=0.1), u, v)
    if not plain:
        run.arrays = all_mixed(run.arrays)
    done, why = run.advance()

    # 0.002 m a step against 0.1 · 0.5 · 0.5 m, but where the ends' waves have come
    assert (done, why) == (13, TRIGGERED)
    assert run.bonds.triggered(run.u[0]).size > 0
    assert np.all(run.bonds.spring_broken == -1)
    # it asks again at once
    assert run.advance(10, done) == (0, TRIGGERED)


def test_an_unbreakable_bar_never_asks(layout) -> None:
    u, v = shaken()

    assert Run(layout(ROD), u, 1e6 * v).advance() == (STEPS, DONE)


def test_force_through_a_plane_is_what_pulls_at_either_side(layout) -> None:
    bonds = damaged(layout(ROD))
    u = shaken()[0][0]
    arrays = bonds.arrays(SUPPORTED, STEP)
    force, stress = -matrix(bonds) @ u, np.empty(COUNT)
    bar.stresses(u, arrays, stress)

    through = np.array([bar.plane_force(k, u, arrays) for k in range(COUNT - 1)])
    # sums of up to 60 forces below 4 N
    np.testing.assert_allclose(through, np.cumsum(force)[:-1], rtol=0.0, atol=COUNT * 4 * EPS)
    np.testing.assert_allclose(through, -np.cumsum(force[::-1])[-2::-1], rtol=0.0, atol=COUNT * 4 * EPS)
    # of nodes the mean of both planes, over a section of 2 m²
    np.testing.assert_allclose(stress[1:-1], 0.25 * (through[1:] + through[:-1]), rtol=0.0, atol=4 * EPS)
    assert stress[[0, -1]].tolist() == [0.5 * through[0], 0.5 * through[-1]]


def test_stress_on_record_is_that_of_the_step(layout) -> None:
    u, v = shaken()
    run = Run(layout(ROD), u, v)
    run.advance()

    for step in (0, 1, STEPS - 1):
        expected = np.empty(COUNT)
        bar.stresses(np.ascontiguousarray(run.record[step, :, 0]), run.arrays, expected)
        assert np.array_equal(run.record[step, :, 6], expected)


def test_energy_stored_is_half_of_the_form(layout) -> None:
    bonds = damaged(layout(ROD))
    u = shaken()[0][0]
    springs, peridynamic = bar.stored(u, bonds.arrays(SUPPORTED, STEP))

    assert springs == pytest.approx(0.5 * np.sum(bonds.spring * np.diff(u) ** 2), rel=COUNT * EPS)
    # terms of either sign may be larger than their sum
    assert springs + peridynamic == pytest.approx(0.5 * u @ matrix(bonds) @ u, rel=10 * COUNT * EPS)


@pytest.mark.parametrize("a", [0.001, 0.05])
def test_attenuation_leaves_a_rigid_motion_its_share_in_every_step(layout, a: float) -> None:
    u, v = np.zeros((2, 3, COUNT))
    v[0] = 1.0
    run = Run(layout(ROD), u, v, a=a)
    run.advance()

    keep = ((1.0 - a) / (1.0 + a)) ** STEPS
    np.testing.assert_allclose(run.v[0], keep, rtol=ROUNDING)
    assert run.work[0, 1] == pytest.approx(0.5 * MASS.sum() * (1.0 - keep**2), rel=ROUNDING / (1.0 - keep))


@pytest.mark.parametrize("a", [0.001, 0.05])
def test_attenuation_makes_a_mode_decay_alike(a: float) -> None:
    u, v = np.zeros((2, 3, COUNT))
    u[0] = np.cos(3.0 * np.pi * np.arange(COUNT) / (COUNT - 1))  # with half masses at free ends
    run = Run(Bonds(ROD, 0), u, v, a=a)
    run.advance()

    # x⁺ = Bx − κx⁻ makes x⁺x⁻ − x² fall to κ of it in every step, whatever the frequency's B
    x = run.record[:, 0, 0]
    shrinking = x[2:] * x[:-2] - x[1:-1] ** 2
    kept = shrinking[1:] / shrinking[:-1]
    # squares of about 1 cancel down to sin²(ωΔt), with ωΔt = 0.2 · sin(3π/118) · 2
    assert kept == pytest.approx((1.0 - a) / (1.0 + a), rel=ROUNDING / np.sin(0.4 * np.sin(1.5 * np.pi / 59)) ** 2)
