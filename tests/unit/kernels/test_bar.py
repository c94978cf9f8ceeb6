"""The compiled step of a bar against a plain implementation with a dense stiffness matrix."""

from dataclasses import replace

import numpy as np
import pytest
from plain_kernels import stepped

from dembound.kernels import bar, tables
from dembound.kernels.common import DONE
from dembound.kernels.loop import advance
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Rod

EPS = np.finfo(float).eps
COUNT, STEPS = 60, 41
STEP = 0.1
SUPPORTED = np.array([0, 1, 7, 30, 59])
ROD = Rod.uniform(COUNT, spacing=0.5, section=2.0, modulus=1.0, critical_stretch=np.inf)
MASS = ROD.mass
"""Masses of 1 inside, so that the fastest waves stay far below the limit of the step."""

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
    "corrected ends": lambda rod: laid(rod, 5, (0, COUNT)),
    "a zone": lambda rod: laid(rod, 3, (20, 40)),
    "zones": lambda rod: laid(rod, 2, (3, 9), (12, 20), (50, 60)),
    "a zone without complement": lambda rod: laid(rod, 3, (20, 40), complement=False),
}


def damaged(bonds: Bonds) -> Bonds:
    """The bonds with some springs and bonds broken earlier."""
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


def shaken(seed: int = 3) -> tuple[np.ndarray, np.ndarray]:
    """Random displacements and velocities (3, n) along x."""
    u, v = np.zeros((2, 3, COUNT))
    u[0], v[0] = np.random.default_rng(seed).uniform(-0.1, 0.1, (2, COUNT))
    return u, v


class Run:
    """A bar stepped by the kernel, free or with dashpots, springs and drives at SUPPORTED nodes, the last prescribed.

    a : half the share of a velocity that attenuation takes in a step.
    """

    def __init__(self, bonds: Bonds, u: np.ndarray, v: np.ndarray, held: bool = False, a: float = 0.0) -> None:
        model = stepped(COUNT, STEPS, STEP, supported=held, loaded=False, free=np.array([1.0, 0.0, 0.0]))
        nodes, drag = SUPPORTED if held else model.nodes, 2.0 * a / STEP * MASS
        model = replace(model, inertia=np.stack([MASS] * 3), nodes=nodes)
        self.given = replace(model, damping=model.damping + drag[nodes, None])
        everywhere = np.arange(COUNT)  # attenuation as dashpots of all nodes
        columns = {name: np.zeros((COUNT, 3)) for name in ("damping", "stiffness", "prescribed")}
        for name, values in columns.items():
            values[nodes] = getattr(model, name)
        push = np.zeros((STEPS, COUNT, 3))
        push[:, nodes] = model.push
        columns |= {"damping": columns["damping"] + drag[:, None], "prescribed": columns["prescribed"] > 0.0}
        self.plain = replace(model, nodes=everywhere, push=push, **columns)
        bonds.rod = Rod(tuple(replace(part, drag_rate=2.0 * a / STEP) for part in bonds.rod.ranges))
        self.bonds, self.u, self.v, self.arrays = bonds, u, v, bonds.arrays(nodes, STEP)
        self.work, self.top_speed = np.zeros((2, 7)), np.zeros(COUNT)
        self.record = np.zeros((STEPS, COUNT, 7))

    def advance(self, steps: int = STEPS, number: int = 0) -> tuple[int, int]:
        given = replace(self.given, push=self.given.push[number : number + steps])
        body, supports, log = given.bundles()
        log = log._replace(record=self.record[number:], work=self.work, top_speed=self.top_speed)
        u_next = np.zeros_like(self.u)
        return advance(self.u, u_next, self.v, number, (self.arrays,), (), None, body, supports, log)


BOTH = pytest.mark.parametrize(("held", "a"), [(False, 0.0), (True, 0.02)], ids=["free", "held, attenuated"])


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
    springs, peridynamic = bar.stored(u, arrays)
    assert springs == pytest.approx(0.5 * np.sum(bonds.spring * np.diff(u) ** 2), rel=COUNT * EPS)
    # terms of either sign may be larger than their sum
    assert springs + peridynamic == pytest.approx(-0.5 * u @ expected, rel=10 * COUNT * EPS)


@BOTH
def test_step_is_the_same_as_written_down_plainly(layout, held: bool, a: float) -> None:
    run = Run(damaged(layout(ROD)), *shaken(), held, a)
    stiffness = matrix(run.bonds)
    states = run.plain.leapfrog(lambda u, v: np.stack([-stiffness @ u[0], *np.zeros((2, COUNT))]), run.u, run.v)
    places, before, after = np.array(states)[:, :, 0].transpose(1, 0, 2)
    # odd numbers of steps, after which displacements stand in the other array
    for number, steps in ((0, 7), (7, 1), (8, 33)):
        assert run.advance(steps, number) == (steps, DONE)

    np.testing.assert_allclose(run.u[0], places[-1], rtol=0.0, atol=ROUNDING)
    np.testing.assert_allclose(run.v[0], after[-1], rtol=0.0, atol=ROUNDING)
    assert not run.u[1:].any()
    np.testing.assert_allclose(run.record[..., 0], places[:-1], rtol=0.0, atol=ROUNDING)
    np.testing.assert_allclose(run.record[..., 3], 0.5 * (before + after)[:-1], rtol=0.0, atol=ROUNDING)
    np.testing.assert_allclose(run.top_speed, np.abs(after).max(axis=0), rtol=0.0, atol=ROUNDING)
    assert not run.record[..., [1, 2, 4, 5]].any()
    for step in (0, 1, STEPS - 1):
        stress = np.empty(COUNT)
        bar.stresses(np.ascontiguousarray(run.record[step, :, 0]), run.arrays, stress)
        assert np.array_equal(run.record[step, :, 6], stress)


def all_mixed(arrays: tables.BarBonds) -> tables.BarBonds:
    """The arrays without plain nodes."""
    runs = np.array(sorted([*arrays.mixed.tolist(), *([a, b, 1] for a, b in arrays.plain)]))
    return arrays._replace(plain=arrays.plain[:0], mixed=runs, mixed_keep=np.full(len(runs), arrays.mixed_keep[0]))


def flying(bonds: Bonds, plane: int) -> Run:
    """Two halves that fly apart from a plane at 1 m/s; springs and bonds across it are far too soft to hold them."""
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
    # what is broken does not heal; the third length breaks in the step that comes
    broken, whole = run.bonds.bond_broken.copy(), run.bonds.bond > 0.0
    run.v *= -1.0
    run.advance()
    assert np.diff(run.u[0]).max() < 1e-6
    assert np.array_equal(run.bonds.bond_broken[:2], broken[:2])
    assert np.array_equal(run.bonds.bond[:2] > 0.0, whole[:2])


def test_force_through_a_plane_is_what_pulls_at_either_side(layout) -> None:
    bonds = damaged(layout(ROD))
    u = shaken()[0][0]
    sections = np.linspace(1.0, 3.0, COUNT - 1)
    arrays = bonds.arrays(SUPPORTED, STEP)._replace(sections=sections)
    force, stress = -matrix(bonds) @ u, np.empty(COUNT)
    bar.stresses(u, arrays, stress)

    through = np.array([bar.plane_force(k, u, arrays) for k in range(COUNT - 1)])
    # sums of up to 60 forces below 4 N
    np.testing.assert_allclose(through, np.cumsum(force)[:-1], rtol=0.0, atol=COUNT * 4 * EPS)
    np.testing.assert_allclose(through, -np.cumsum(force[::-1])[-2::-1], rtol=0.0, atol=COUNT * 4 * EPS)
    # of nodes the mean of both planes, over the mean section
    mean = (through[1:] + through[:-1]) / (sections[1:] + sections[:-1])
    np.testing.assert_allclose(stress[1:-1], mean, rtol=0.0, atol=4 * EPS)
    assert stress[[0, -1]].tolist() == [through[0], through[-1] / 3.0]
