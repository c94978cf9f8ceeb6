"""Waves of a medium, against closed forms; plane waves at an angle, and those that a free surface sends back."""

import numpy as np
import pytest

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
