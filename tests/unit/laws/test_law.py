"""Laws: eight pairs in lanes are eight pairs, linear laws are linear, and moduli from wave speeds."""

from dataclasses import asdict
from types import SimpleNamespace

import numpy as np
import pytest
from numba import njit
from small_cases import small

from dembound.casefile.types import LAWS, _usable
from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.lane_access import load, store
from dembound.kernels.compiler.lanes import bits, byte_of
from dembound.kernels.contacts import UPDATED, closing_work
from dembound.kernels.pair_law import (
    bond,
    breaks,
    most_shear,
    normal,
    rubbed,
    shear_of,
    slip_after,
    slip_at,
    stored_between,
)
from dembound.laws import Elastic, Moduli, lattice_moduli
from dembound.laws.law import in_columns
from dembound.motion.simulation import Simulation
from dembound.running import plan

OPTIONS = {name: value for name, value in FAST.items() if name != "cache"}
WITH_HISTORY = [name for name, law in LAWS.items() if law.has_history]
MODULI = Moduli(emod=6e9, pb_emod=3e9, kratio=2.0, pb_kratio=3.0, pb_rmul=0.5, fric=0.4)


@njit(**OPTIONS)
def one_by_one(limits, constants, values, results, broken):  # type: ignore[no-untyped-def]
    k = U(0)
    for c in range(8):
        a, b, s, slip, turn = values[0, c], values[1, c], values[2, c], values[3, c], values[4, c]
        push = normal(limits, constants, k, a)
        pull, side, moment = bond(limits, constants, k, a, s, turn)
        torn, cut = breaks(limits, constants, k, k, 1.0, pull, side, moment)
        results[0, c], results[1, c], results[2, c] = push, shear_of(limits, constants, k, a, s, slip), pull
        results[3, c], results[4, c], results[5, c] = side, moment, most_shear(limits, k, push)
        results[6, c] = slip_at(limits, constants, k, a, s, push)
        results[7, c] = stored_between(limits, constants, k, abs(a), abs(b))
        results[8, c] = closing_work(limits, constants, k, a, b, c % 2 == 0, push)
        slid = slip_after(limits, constants, k, a, b, s, slip)
        results[9, c], results[10, c] = slid, rubbed(limits, constants, k, a, b, turn, s, slip, slid, push, pull)
        broken[0, c], broken[1, c] = torn, cut


@njit(**OPTIONS)
def eight_at_once(limits, constants, values, results, broken, evens):  # type: ignore[no-untyped-def]
    k, o = U(0), U(0)
    a, b, s = load(values[0], o), load(values[1], o), load(values[2], o)
    slip, turn = load(values[3], o), load(values[4], o)
    push = normal(limits, constants, k, a)
    pull, side, moment = bond(limits, constants, k, a, s, turn)
    torn, cut = breaks(limits, constants, k, k, 1.0, pull, side, moment)
    store(results[0], o, push)
    store(results[1], o, shear_of(limits, constants, k, a, s, slip))
    store(results[2], o, pull)
    store(results[3], o, side)
    store(results[4], o, moment)
    store(results[5], o, most_shear(limits, k, push))
    store(results[6], o, slip_at(limits, constants, k, a, s, push))
    store(results[7], o, stored_between(limits, constants, k, load(values[5], o), load(values[6], o)))
    store(results[8], o, closing_work(limits, constants, k, a, b, bits(evens), push))
    slid = slip_after(limits, constants, k, a, b, s, slip)
    store(results[9], o, slid)
    store(results[10], o, rubbed(limits, constants, k, a, b, turn, s, slip, slid, push, pull))
    broken[0], broken[1] = byte_of(torn), byte_of(cut)


@pytest.mark.parametrize("name", WITH_HISTORY)
def test_lanes_are_eight_pairs(name: str) -> None:
    law, radius = LAWS[name], np.array([0.2])
    moduli = law.moduli(SimpleNamespace(**asdict(MODULI), **{key.name: 0.3 for key in law.keys}))
    constants = law.pair_constants(moduli, radius, 2.0 * radius, np.array([[0.3, 0.4]]), bonded=True)
    limits = law.limits(in_columns(np.array([[0.4, 2e7, 1e7, 0.6]]), UPDATED))
    values = np.random.default_rng(1).uniform(-1e-2, 1e-2, (7, 8))
    values[5:] = np.abs(values[:2])
    single, many = np.zeros((2, 11, 8))
    broken, bytes_ = np.zeros((2, 8), dtype=bool), np.zeros(2, dtype=np.uint8)

    one_by_one(limits, constants, values, single, broken)
    eight_at_once(limits, constants, values, many, bytes_, np.uint8(0b01010101))

    # a fused multiply-add may round once where two operations round twice: 1e-16 of the larger of two terms
    scale = np.maximum(np.abs(single).max(axis=1, keepdims=True), 1e-300)  # without bonds their forces are zero
    np.testing.assert_allclose(many / scale, single / scale, rtol=0.0, atol=2e-15)
    assert np.array_equal(np.unpackbits(bytes_[:, None], axis=1, bitorder="little").astype(bool), broken)
    assert broken.any() == bool(law.strengths)
    assert not broken.all()


STEPS = 5
BODY = {
    "packing": {"pattern": "A", "size": [2.0, 2.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
    "boundary": {},
    "run": {"duration": 1.0},
    "output": {"pictures": False},
}


def moved(law: str, factor: float) -> np.ndarray:
    """Displacements (3, n) of a free body, some time after its disks had random velocities times a factor."""
    changes = {"material.law": law} | ({"material.elastic_start": False} if LAWS[law].has_history else {})
    planned = plan(small(BODY, changes=changes))
    run = Simulation(planned.scene, planned.time_step)
    run.state.velocity = factor * np.random.default_rng(1).standard_normal((3, planned.scene.count))
    run.run(STEPS)
    return run.state.displacement


def is_linear(law: str) -> bool:
    """Whether motion is proportional to velocities, of either sign: to rounding of a few steps."""
    one = moved(law, 1e-3)
    return all(
        np.allclose(moved(law, 1e-3 * factor), factor * one, rtol=0.0, atol=1e-12 * abs(factor) * np.abs(one).max())
        for factor in (-1.0, 3.0)
    )


@pytest.mark.parametrize("law", [name for name, law in LAWS.items() if law.is_linear])
def test_laws_are_linear_that_say_so(law: str) -> None:
    assert is_linear(law)


class Rubber(Elastic):
    name = "rubber"
    is_linear = False


class Brittle(Elastic):
    name = "brittle"
    has_history = True
    linear = "rubber"


def test_the_linear_law_of_a_law_is_linear() -> None:
    """A law that is not linear may name itself; another law cannot name it as linear."""
    with pytest.warns(UserWarning, match='"brittle" names "rubber" as its linear law, which must be a linear law'):
        found = _usable({law.name: law for law in (Elastic(), Rubber(), Brittle())})
    assert list(found) == ["elastic", "rubber"]


def test_shares_and_bond_radius_divide_the_stiffness_as_equation_9_says() -> None:
    contact, bond = lattice_moduli(2500.0, 1000.0, contact_share=0.75, bond_radius_factor=0.5)

    assert (contact, bond) == (1.875e9, 1.25e9)
    assert contact + 0.5 * bond == pytest.approx(2500.0 * 1000.0**2, rel=1e-15)
