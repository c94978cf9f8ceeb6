"""Waves of a medium, against closed forms; plane waves at an angle, and those that a free surface sends back."""

import numpy as np
import pytest

from dembound.continuum.layer import Profile, along_in, along_needed
from dembound.continuum.medium import Medium, critical_angle, incident_wave, reflected_waves, traction_of

ROCK = Medium.isotropic(2500.0, 1000.0, 600.0)


@pytest.mark.parametrize("degrees", [0.0, 20.0, 45.0, 90.0])
def test_isotropic_speeds_do_not_depend_on_the_direction(degrees: float) -> None:
    direction = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    speeds, polarisations = ROCK.plane_waves(direction)

    np.testing.assert_allclose(speeds, [600.0, 1000.0], rtol=1e-12)
    assert abs(polarisations[:, 1] @ direction) == pytest.approx(1.0)
    assert abs(polarisations[:, 0] @ direction) < 1e-12


DENSITY, C_P, SURFACE = 2500.0, 1000.0, 7.0
GENERAL = Medium(DENSITY, c11=2.5e9, c22=2.2e9, c12=0.4e9, c66=0.9e9, c16=0.2e9, c26=0.3e9)
ORTHOTROPIC = Medium(DENSITY, 2.5e9, 2.5e9, 0.0, 0.625e9)
"""The square lattice without friction: C66 = K/4."""


def isotropic(ratio: float) -> Medium:
    """c_s over c_p."""
    return Medium.isotropic(DENSITY, C_P, ratio * C_P)


def amplitudes(medium: Medium, kind: str, angle: float) -> dict[str, float]:
    """Signed amplitudes of reflected waves: P along its way, SV to the right of it as one looks along."""
    found = {}
    for wave in reflected_waves(medium, incident_wave(medium, kind, angle), SURFACE):
        x, y = np.array(wave.slowness) / np.hypot(*wave.slowness)
        speed = 1.0 / np.hypot(*wave.slowness)
        is_p = abs(speed - C_P) < 1e-6 * C_P
        found["p" if is_p else "sv"] = float(np.array(wave.motion) @ ((x, y) if is_p else (y, -x)))
    return found


@pytest.mark.parametrize(("ratio", "angle"), [(0.3, 10.0), (0.577, 25.0), (0.7071, 60.0)])
def test_p_waves_are_reflected_as_in_the_textbook(ratio: float, angle: float) -> None:
    """Potentials of Achenbach (1973), Wave Propagation in Elastic Solids, section 5.6; κ = c_p/c_s, κ sin j = sin θ.

    PP = (sin 2θ sin 2j − κ² cos² 2j)/(sin 2θ sin 2j + κ² cos² 2j); displacements of SV are κ times the potential's.
    """
    theta, kappa = np.radians(angle), 1.0 / ratio
    j = np.arcsin(ratio * np.sin(theta))
    both, shear = np.sin(2 * theta) * np.sin(2 * j), kappa**2 * np.cos(2 * j) ** 2
    found = amplitudes(isotropic(ratio), "p", angle)

    assert found["p"] == pytest.approx((both - shear) / (both + shear), abs=1e-12)
    assert abs(found["sv"]) == pytest.approx(2 * kappa * np.sin(2 * theta) * np.cos(2 * j) / (both + shear), abs=1e-12)


@pytest.mark.parametrize("kind", ["sv", "p"])
def test_straight_up_the_surface_moves_twice_as_far(kind: str) -> None:
    assert amplitudes(isotropic(0.5), kind, 0.0) == {kind: pytest.approx({"p": -1.0, "sv": -1.0}[kind])}


MEDIA = {"isotropic": isotropic(0.5), "orthotropic": ORTHOTROPIC, "general": GENERAL}


@pytest.mark.parametrize("medium", MEDIA.values(), ids=MEDIA)
@pytest.mark.parametrize(("kind", "angle"), [("sv", -15.0), ("p", 35.0)])
def test_the_surface_is_free_and_takes_no_energy(medium: Medium, kind: str, angle: float) -> None:
    incident = incident_wave(medium, kind, angle)
    waves = [incident.shifted(0.3), *reflected_waves(medium, incident.shifted(0.3), SURFACE)]
    tractions = [traction_of(medium, *wave.slowness) @ wave.motion for wave in waves]
    along = np.array([(x, SURFACE) for x in (-5.0, 0.0, 40.0)])
    flux = [wave.flux(medium)[1] for wave in waves]

    np.testing.assert_allclose(sum(tractions), 0.0, atol=1e-9 * np.abs(tractions[0]).max())
    for wave in waves[1:]:  # all reach a place on the surface at the same time
        np.testing.assert_allclose(wave.delays(along), waves[0].delays(along), atol=1e-15)
    assert sum(flux) == pytest.approx(0.0, abs=1e-9 * flux[0])
    assert flux[0] > 0.0 > max(flux[1:])


@pytest.mark.parametrize("ratio", [0.3, 0.7071])
def test_sv_waves_of_isotropic_media_have_the_critical_angle_of_snell(ratio: float) -> None:
    critical = critical_angle(isotropic(ratio), "sv")

    assert critical == pytest.approx(np.degrees(np.arcsin(ratio)), abs=1e-6)
    assert reflected_waves(isotropic(ratio), incident_wave(isotropic(ratio), "sv", critical + 0.01), 0.0) is None
    assert reflected_waves(isotropic(ratio), incident_wave(isotropic(ratio), "sv", critical - 0.01), 0.0) is not None
    assert critical_angle(isotropic(ratio), "p") == 90.0


@pytest.mark.parametrize("kind", ["sv", "p"])
def test_a_mass_on_the_surface_delays_what_it_sends_back(kind: str) -> None:
    """Against the exact amplitudes at one frequency: (T − iωm P) a = −(t − iωm p), the same for waves e^(−iωt).

    Of the first order in μ = ωm/(ρc), so that a tenth of the mass leaves a hundredth of the error.
    """
    medium, omega = GENERAL, 2.0 * np.pi
    incident = incident_wave(medium, kind, 25.0)
    errors = []
    for mass in (1e3, 1e2):
        waves = reflected_waves(medium, incident, 0.0)
        motions = np.array([np.array(wave.motion) / np.hypot(*wave.motion) for wave in waves]).T
        tractions = np.array(
            [traction_of(medium, *wave.slowness) @ motion for wave, motion in zip(waves, motions.T, strict=True)]
        ).T
        own = traction_of(medium, *incident.slowness) @ incident.motion
        inertia = -1j * omega * mass
        exact = np.linalg.solve(tractions - inertia * motions, -(own - inertia * np.array(incident.motion)))
        found = np.zeros(2, dtype=complex)
        for wave in reflected_waves(medium, incident, 0.0, mass):
            number = int(np.argmin([abs(wave.slowness[1] - other.slowness[1]) for other in waves]))
            found[number] += (np.array(wave.motion) @ motions[:, number]) * np.exp(1j * omega * wave.delay)
        errors.append(np.abs(found - exact).max())
        size = np.abs(exact - [np.hypot(*wave.motion) for wave in waves]).max()
    assert errors[1] < 0.012 * errors[0]
    assert errors[1] < 0.01 * size


def test_critical_angles_to_the_left_are_those_of_the_mirror_image() -> None:
    mirrored = Medium(DENSITY, GENERAL.c11, GENERAL.c22, GENERAL.c12, GENERAL.c66, -GENERAL.c16, -GENERAL.c26)

    left = critical_angle(GENERAL, "sv", -1.0)
    assert left == pytest.approx(critical_angle(mirrored, "sv"), abs=1e-6)
    assert abs(critical_angle(GENERAL, "sv") - left) > 0.5


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
