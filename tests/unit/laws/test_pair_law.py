"""Functions of laws compute for eight pairs in lanes what they compute for each of the pairs."""

import numpy as np
import pytest
from numba import njit

from dembound.casefile.types import LAWS
from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.lanes import bits, byte_of, load, store
from dembound.kernels.contacts import UPDATED, closing_work
from dembound.kernels.pair_law import bond, breaks, most_shear, normal, shear_of, slip_at, stored_between
from dembound.laws import Moduli
from dembound.laws.elastic import in_columns

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
        results[0, c], results[1, c], results[2, c] = push, shear_of(limits, constants, k, s, slip), pull
        results[3, c], results[4, c], results[5, c] = side, moment, most_shear(limits, k, push)
        results[6, c] = slip_at(limits, constants, k, s, push)
        results[7, c] = stored_between(limits, constants, k, abs(a), abs(b))
        results[8, c] = closing_work(limits, constants, k, a, b, c % 2 == 0, push)
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
    store(results[1], o, shear_of(limits, constants, k, s, slip))
    store(results[2], o, pull)
    store(results[3], o, side)
    store(results[4], o, moment)
    store(results[5], o, most_shear(limits, k, push))
    store(results[6], o, slip_at(limits, constants, k, s, push))
    store(results[7], o, stored_between(limits, constants, k, load(values[5], o), load(values[6], o)))
    store(results[8], o, closing_work(limits, constants, k, a, b, bits(evens), push))
    broken[0], broken[1] = byte_of(torn), byte_of(cut)


@pytest.mark.parametrize("name", WITH_HISTORY)
def test_lanes_are_eight_pairs(name: str) -> None:
    law, radius = LAWS[name], np.array([0.2])
    constants = law.pair_constants(MODULI, radius, 2.0 * radius, np.array([[0.3, 0.4]]), bonded=True)
    limits = in_columns(np.array([[0.4, 2e7, 1e7, 0.6]]), UPDATED)
    values = np.random.default_rng(1).uniform(-1e-2, 1e-2, (7, 8))
    values[5:] = np.abs(values[:2])
    single, many = np.zeros((2, 9, 8))
    broken, bytes_ = np.zeros((2, 8), dtype=bool), np.zeros(2, dtype=np.uint8)

    one_by_one(limits, constants, values, single, broken)
    eight_at_once(limits, constants, values, many, bytes_, np.uint8(0b01010101))

    # a fused multiply-add may round once where two operations round twice: 1e-16 of the larger of two terms
    scale = np.abs(single).max(axis=1, keepdims=True)
    np.testing.assert_allclose(many / scale, single / scale, rtol=0.0, atol=2e-15)
    assert np.array_equal(np.unpackbits(bytes_[:, None], axis=1, bitorder="little").astype(bool), broken)
    assert broken.any()
    assert not broken.all()
