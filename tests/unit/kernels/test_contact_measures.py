"""Distances of pairs from the limits of the elastic law, and their energy, against conditions written out."""

import numpy as np
import pytest
from moving_pairs import PAIRS, PARTICLES, STEP, UNBREAKABLE, two
from plain_kernels import PlainPairs, one_pair, random_pairs

from dembound.kernels.contact_measures import slack
from dembound.kernels.contacts import BONDED, INTACT, REFERENCE
from dembound.kernels.tables import Contacts
from dembound.laws.law import Limits


def outside(u: np.ndarray, pairs: Contacts, limits: Limits, law) -> np.ndarray:
    """Amount by which each pair (b,) breaks the conditions of the elastic law, written out one by one; 0: by none."""
    excess = np.zeros(len(pairs.first))
    for c, (i, j) in enumerate(zip(pairs.first, pairs.second, strict=True)):
        _, _, _, stretch, shear, *_ = law.strain(c, u[:, i], u[:, j], u[:, i], u[:, j], STEP)
        _, _, rest, touch, _, k_n, k_s, b_n, b_s, b_m, per_area, bend = pairs.constants[c]
        overlap = touch - rest - stretch
        conditions = [-overlap, k_s * abs(shear) - limits.friction * k_n * overlap] if touch >= rest else [overlap]
        if pairs.state[c] == INTACT:
            stress, turn = b_n * stretch * per_area, u[2, j] - u[2, i] + law.began(c)[2]
            conditions += [
                stress + abs(b_m * turn) * bend - limits.tension,
                b_s * abs(shear) * per_area - (limits.cohesion - stress * limits.tan_fa),
            ]
        excess[c] = max(0.0, *conditions)
    return excess


LIMITS = Limits(friction=0.8, tension=0.9, cohesion=0.8, tan_fa=0.5, geometry=REFERENCE)


def test_a_motion_smaller_than_the_slack_takes_no_pair_out_of_the_elastic_law() -> None:
    rng = np.random.default_rng(8)
    pairs = random_pairs(PARTICLES, PAIRS, gap=0.2)
    law = PlainPairs(pairs, LIMITS)
    arm = 1.1  # half of the longest distance and the largest difference of radii
    tried = 0
    for _ in range(60):
        u = 0.025 * rng.uniform(-1.0, 1.0, (3, PARTICLES))
        room = slack(u, pairs, LIMITS, False)
        if room <= 0.0:
            continue
        tried += 1
        way = rng.choice([-1.0, 1.0], (3, PARTICLES)) * rng.uniform(0.5, 1.0, (3, PARTICLES))
        surface = np.hypot(way[0], way[1]) + arm * np.abs(way[2])
        # every surface moves by half of it at most, so no two move by more against each other; 1e-14 for rounding
        assert not (outside(u + 0.5 * room * way / surface.max(), pairs, LIMITS, law) > 1e-14).any()
    assert tried > 20


def test_the_slack_of_one_pair_by_hand() -> None:
    limits = UNBREAKABLE._replace(geometry=BONDED)
    torn, shorn = {"friction": 100.0, "tension": 0.3}, {"friction": 100.0, "cohesion": 0.4, "tan_fa": 0.6}
    for moved, pair, changes, room in (
        (two(-0.05), one_pair(overlap=0.1), {}, 0.3 / 4.0),  # 0.5·4·0.15 N left, k_s + μ k_n = 4 N/m
        (two(-0.05, 0.02), one_pair(overlap=0.1), {}, (0.3 - 2.0 * 0.02) / 4.0),
        (two(0.099), one_pair(overlap=0.1), {}, 0.001 * 0.5),
        # σ = 3 x/2 + 0.75 |θ|, whose two parts change by 1.5 per metre of relative motion at most
        (two(0.04, turn=-0.08), one_pair(INTACT, overlap=1.0), torn, (0.3 - 0.06 - 0.06) / 3.0),
        # τ = y/2 against 0.4 − 0.6 · 3 x/2: 0.5 and 0.6 · 1.5 per metre
        (two(-0.1, -0.3), one_pair(INTACT, overlap=1.0), shorn, (0.4 + 0.09 - 0.15) / 1.4),
    ):
        assert slack(moved, pair, limits._replace(**changes), False) == pytest.approx(room, rel=1e-12)
