"""Waves at an angle in layers beside a free surface alone, a column, and what waves at interfaces must obey."""

import numpy as np
import pytest
from ground_motions import GENERAL

from dembound.continuum.medium import Medium, incident_wave, waves_with
from dembound.disks.surroundings.oblique_layers import bed_of
from dembound.exact.column import Column, Layer
from dembound.exact.oblique import Bed, amplitudes

FREQUENCIES = np.array([0.3, 1.7, 4.1, 9.0])
MEDIA = (Medium.isotropic(1800.0, 400.0, 200.0), GENERAL, Medium.isotropic(2300.0, 1400.0, 700.0))
THICKNESSES = (30.0, 40.0, 1.0)


def bed(medium: Medium, sx: float, thickness: float) -> Bed:
    return bed_of(medium, [wave for way in waves_with(medium, sx) for wave in way], thickness)


def flux(each: Bed, amplitude: np.ndarray) -> np.ndarray:
    """Energy (k, 4) per |ġ|² that the waves carry upwards."""
    return (np.abs(amplitude) ** 2) * np.sum(each.traction * each.motion, axis=0)


@pytest.mark.parametrize("mass", [None, 0.0, 800.0], ids=["goes_on", "free", "with_mass"])
def test_interfaces_keep_motion_traction_and_energy(mass: float | None) -> None:
    """At all joints of three layers, one of them without symmetry, and so does the surface with its mass."""
    sx = incident_wave(MEDIA[-1], "p", 30.0).slowness[0]
    beds = [bed(*each) for each in zip(MEDIA, (sx,) * 3, THICKNESSES, strict=True)]
    found = amplitudes(beds, np.array([0.3, 1.0]), FREQUENCIES, mass)
    late = [each.late(FREQUENCIES) for each in beds]
    for above, below in ((0, 1), (1, 2)):
        upper = found[above] * np.hstack([np.ones((4, 2)), late[above][:, 2:]])
        factor = late[below][:, :2] if below < 2 else np.ones((4, 2))
        lower = found[below] * np.hstack([factor, np.ones((4, 2))])
        for of in ("motion", "traction"):
            one, other = upper @ getattr(beds[above], of).T, lower @ getattr(beds[below], of).T
            np.testing.assert_allclose(one, other, atol=1e-12 * np.abs(other).max())
    at_top = found[0] * np.hstack([late[0][:, :2], np.ones((4, 2))])
    if mass is not None:
        inertia = 2j * np.pi * mass * FREQUENCIES[:, None] * (at_top @ beds[0].motion.T)
        np.testing.assert_allclose(at_top @ beds[0].traction.T, inertia, atol=1e-9 * np.abs(beds[0].traction).max())
    leaves = flux(beds[0], at_top)[:, :2].sum(axis=1) if mass is None else 0.0
    in_rock = flux(beds[2], found[2])
    np.testing.assert_allclose(in_rock.sum(axis=1), leaves, atol=1e-12 * in_rock.max())
    assert (in_rock[:, :2] > 0.0).all()
    assert (in_rock[:, 2:] < 0.0).all()


@pytest.mark.parametrize("kind", [0, 1], ids=["sv", "p"])
def test_straight_up_it_is_the_column(kind: int) -> None:
    """At the surface, at both joints, and at complex frequencies, also with nearly straight waves."""
    media = (MEDIA[0], Medium.isotropic(2000.0, 700.0, 350.0), MEDIA[2])
    frequencies = FREQUENCIES - 0.2j
    speeds = [medium.plane_waves((0.0, 1.0))[0][kind] for medium in media]
    layers = [Layer(*each) for each in zip(THICKNESSES, (m.density for m in media), speeds, strict=True)]
    expected = Column(layers, mass=900.0).motion(frequencies, [0.0, 30.0, 70.0])[0]
    for sx in (0.0, 1e-13):
        beds = [bed(medium, sx, thick) for medium, thick in zip(media, THICKNESSES, strict=True)]
        rising = np.linalg.solve(beds[-1].motion[:, :2], np.eye(2)[kind])
        found = amplitudes(beds, rising, frequencies, 900.0)
        late = [each.late(frequencies) for each in beds]
        ones = np.ones((4, 2))
        factors = [np.hstack([late[0][:, :2], ones]), np.hstack([late[1][:, :2], ones]), np.ones((4, 4))]
        for own, factor, each, exact in zip(found, factors, beds, expected, strict=True):
            np.testing.assert_allclose((own * factor) @ each.motion[kind], exact, rtol=1e-9)
