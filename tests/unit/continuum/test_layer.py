"""Profiles of the absorbing layer, against the continuous equations they stand for."""

import numpy as np
import pytest

from dembound.continuum.layer import Profile, along_in, along_needed
from dembound.continuum.medium import Medium

LAYER = Profile(thickness=30.0, speed=1000.0, inner=200.0)
Q = np.linspace(0.0, 1.0, 2001)


def mean(values: np.ndarray) -> float:
    """Mean of a profile over the depth."""
    return float(np.trapezoid(values, Q))


def test_the_strength_belongs_to_the_reflection() -> None:
    # a wave decays by exp(−∫σ dx/c) on its way in, and again on its way out
    assert np.exp(-2.0 * LAYER.thickness * mean(LAYER.damping(Q)) / LAYER.speed) == pytest.approx(1e-4, rel=1e-4)
    assert LAYER.strongest == pytest.approx(3.0 * 1000.0 * np.log(1e4) / 60.0)


@pytest.mark.parametrize("q", [0.0, 0.3, 1.0])
def test_the_memory_follows_its_equation(q: float) -> None:
    """ψ′ = −(σ + α)ψ − σ g for κ = 1; for a constant g the recursion is exact."""
    step, depth = 1e-3, np.array([q])
    sigma, alpha = LAYER.damping(depth)[0], LAYER.shift(depth)[0]
    decay, gain = LAYER.decay(depth, step)[0], LAYER.gain(depth, step)[0]
    memory = 0.0
    for _ in range(50):
        memory = decay * memory + gain
    exact = -sigma / (sigma + alpha) * (1.0 - np.exp(-(sigma + alpha) * 50 * step))

    assert memory == pytest.approx(exact, rel=1e-12, abs=1e-300)


def test_the_delay_is_a_part_of_the_step() -> None:
    np.testing.assert_allclose(LAYER.delay(np.array([0.0, 0.5, 1.0]), 2e-3), [0.0, 0.5e-4, 2e-4])


def test_the_expected_reflection() -> None:
    high, low = LAYER.expected_reflection(1e4), LAYER.expected_reflection(0.05)
    assert high == pytest.approx(1e-4, rel=1e-3)
    passed = (2 * np.pi * 0.05) ** 2 / ((2 * np.pi * 0.05) ** 2 + LAYER.shift(Q) ** 2)
    share = mean(LAYER.damping(Q) * passed) / mean(LAYER.damping(Q))
    assert low == pytest.approx(1e-4**share, rel=1e-3)
    # S waves of half the speed take twice as long; at 60° the path along the normal counts half
    assert LAYER.expected_reflection(1e4, speed=500.0) == pytest.approx(1e-8, rel=1e-3)
    assert LAYER.expected_reflection(1e4, angle=60.0) == pytest.approx(1e-2, rel=1e-3)


def lattice(ratio: float) -> Medium:
    """The square lattice with a ratio of normal to shear stiffness."""
    return Medium(2000.0, 1e8, 1e8, 0.0, 0.5e8 / ratio)


def turned(medium: Medium) -> Medium:
    """The medium with x and y exchanged."""
    return Medium(medium.density, medium.c22, medium.c11, medium.c12, medium.c66, medium.c26, medium.c16)


ROUGH = Medium(2000.0, 1e8, 2.5e8, 0.1e8, 1.7e8)
TILTED = Medium(2000.0, 2.2e8, 1e8, 0.3e8, 1.2e8, 0.4e8, -0.2e8)


@pytest.mark.parametrize("medium", [lattice(0.1), lattice(0.4), ROUGH, TILTED, turned(ROUGH), turned(TILTED)])
def test_the_part_along_layers_is_the_least_with_which_nothing_grows(medium: Medium) -> None:
    """Against all λ of det(Γ(k_x/(λ + 1), k_y/(λ + p)) + ρ) = 0, the eigenvalues of u, v and the memories of layers.

    Static fields have several λ = 0, which rounding moves by the root of 1e-16 and of the entries of the matrix, k²c².
    """
    needed = along_needed(medium)
    assert 0.01 < needed < 1.0
    assert largest_growth(medium, 1.1 * needed) < 1e-5
    assert largest_growth(medium, 0.9 * needed) > 1e-3
    assert largest_growth(medium, 0.0) > 0.01


def largest_growth(medium: Medium, part: float) -> float:
    """Largest Re λ over σ of wave vectors in all directions, of waves much shorter and as long as c/σ.

    ∂_x u / (1 + 1/λ) is ∂_x u − ψ, ψ′ = ∂_x u − ψ: with u, v and memories of strains and of forces, λ are eigenvalues.
    """
    speed, worst = medium.normal_speed(0), -np.inf
    rates = np.diag([1.0, 1.0, part, part])
    for number in (2.0, 60.0):
        for angle in np.linspace(0.0, np.pi, 91)[:-1]:
            kx, ky = number / speed * np.array([np.cos(angle), np.sin(angle)])
            gradient = np.kron(1j * np.array([[kx], [ky]]), np.eye(2))  # of u: ∂_x u, then ∂_y u
            strain = np.array([[1.0, 0, 0, 0], [0, 0, 0, 1.0], [0, 1.0, 1.0, 0]])  # (xx, yy, γ) of gradients
            stiff = strain.T @ medium.matrix @ strain / medium.density
            # v′ = −Gᴴ(S(Gu − ψ) − φ), ψ′ = R(Gu − ψ), φ′ = R(S(Gu − ψ) − φ); u′ = v
            g, s, r, o = gradient, stiff, rates, np.zeros
            back = -g.conj().T
            system = np.block(
                [
                    [o((2, 2)), np.eye(2), o((2, 4)), o((2, 4))],
                    [back @ s @ g, o((2, 2)), -back @ s, -back],
                    [r @ g, o((4, 2)), -r, o((4, 4))],
                    [r @ s @ g, o((4, 2)), -r @ s, -r],
                ]
            )
            worst = max(worst, float(np.linalg.eigvals(system).real.max()))
    return worst


def test_lattices_need_it_from_a_ratio_on() -> None:
    """cos²φ = (1 − ratio)/2, which is ½ at most; nothing with stiffer normal springs."""
    for ratio in (0.05, 0.5):
        sine = np.sqrt(0.5 * (1.0 + ratio))
        assert along_needed(lattice(ratio)) == pytest.approx((1.0 - sine) / (1.0 + sine), rel=1e-9)
    assert along_needed(lattice(2.0)) < 1e-12
    assert along_in(lattice(0.5)) == 0.0
    assert along_in(lattice(0.4)) == pytest.approx(1.3 * along_needed(lattice(0.4)))
