"""Layers on a half-space beside tables of other programs, and in time beside an independent solution."""

from pathlib import Path

import numpy as np
import pytest
from ground_motions import GENERAL

from dembound.continuum.medium import Medium, incident_wave, waves_with
from dembound.disks.surroundings.oblique_layers import bed_of
from dembound.exact.column import Column, ColumnMotion, Layer
from dembound.exact.oblique import Bed, amplitudes

HERE = Path(__file__).parent
REFERENCE = 3.0**0.5


def layers(times: float = 1.0) -> list[Layer]:
    """The stack of layers3_transfer.csv, with speeds so many times as large."""
    rows = [(30.0, 1800.0, 200.0, 20.0), (40.0, 2000.0, 350.0, 40.0), (1.0, 2300.0, 700.0, np.inf)]
    return [Layer(thickness, density, times * speed, quality) for thickness, density, speed, quality in rows]


@pytest.mark.parametrize("damping", ["elastic", "hysteretic", "constant_q"])
@pytest.mark.parametrize(("kind", "times"), [("S", 1.0), ("P", 2.0)])
def test_three_layers_with_each_modulus(kind: str, times: float, damping) -> None:
    """To the nine digits of the table, of values up to 5."""
    table = np.genfromtxt(HERE / "layers3_transfer.csv", delimiter=",", names=True, skip_header=2)
    column = Column(layers(times), damping, REFERENCE)
    for place, depth in (("surface", 0.0), ("30m", 30.0), ("70m", 70.0)):
        of = f"{kind}_{damping}_{place}"
        expected = table[f"{of}_re"] + 1j * table[f"{of}_im"]
        np.testing.assert_allclose(column.transfer(table["f_Hz"], depth), expected, rtol=0.0, atol=2e-8)


def test_four_hundred_layers_of_nrattle() -> None:
    """To the five digits that NRATTLE prints."""
    stack = [Layer(*row) for row in np.loadtxt(HERE / "nrattle_layers.csv", delimiter=",")[:, [0, 2, 1]]]
    frequencies, expected = np.loadtxt(HERE / "nrattle_amplification.csv", delimiter=",").T
    found = Column([*stack, Layer(1.0, 2720.0, 3500.0)]).transfer(frequencies, over="outcrop")
    np.testing.assert_allclose(np.abs(found), expected, rtol=5e-5)


@pytest.mark.parametrize("damping", ["elastic", "constant_q"])
def test_a_history_is_causal_and_returns_from_each_motion_below(damping) -> None:
    """The surface under a pulse is at rest until the pulse arrives; and is the same under the motions of its base."""
    column, step = Column(layers(), damping, REFERENCE), 0.005
    time = step * np.arange(800)
    pulse = np.exp(-(((time - 0.5) / 0.08) ** 2))
    surface = column.history(pulse, step)
    arrival = 30.0 / 200.0 + 40.0 / 350.0
    assert np.abs(surface[time < 0.1 + 0.8 * arrival]).max() < 1e-6 < np.abs(surface).max()
    within, outcrop = column.history(pulse, step, 70.0), 2.0 * pulse
    # the undamped base nearly stands still at some frequencies: 1e-8 of what comes round is magnified
    np.testing.assert_allclose(column.history(outcrop, step, over="outcrop"), surface, atol=1e-9)
    np.testing.assert_allclose(column.history(within, step, over="within"), surface, atol=1e-5)


DENSITIES, SPEEDS = (1800.0, 2000.0, 2300.0), (200.0, 350.0, 700.0)
THICKNESSES = 30.0, 40.0


def pulse(t: np.ndarray) -> np.ndarray:
    """A Ricker wavelet of 3 Hz, m/s."""
    power = (3.0 * np.pi * (t - 0.6)) ** 2
    return np.asarray((1.0 - 2.0 * power) * np.exp(-power))


def motion(until: float = 3.0) -> ColumnMotion:
    """Of two layers on an elastic half-space."""
    two = [Layer(*each) for each in zip(THICKNESSES, DENSITIES[:2], SPEEDS[:2], strict=True)]
    return ColumnMotion(Column([*two, Layer(1.0, DENSITIES[2], SPEEDS[2])]), pulse, 70.0, 0.0, until)


def scattered(until: float) -> tuple[np.ndarray, np.ndarray]:
    """Times (k,) and velocities (k, 3) of surface, joint and base, of waves from interface to interface of thin cells.

    Exact in cells of equal travel time (Goupillaud, Geophysics 26, 1961).
    """
    cells, step = (84, 64), 0.15 / 84
    z = np.repeat(np.multiply(DENSITIES, SPEEDS), [*cells, 1])
    up, down, found = np.zeros(len(z)), np.zeros(len(z)), []  # about to meet the top of each cell from below and above
    for time in step * np.arange(round(until / step) + 1):
        up[-1] = pulse(time)
        rising = (2.0 * z[1:] * up[1:] + (z[:-1] - z[1:]) * down[1:]) / (z[:-1] + z[1:])
        falling = (2.0 * z[:-1] * down[1:] + (z[1:] - z[:-1]) * up[1:]) / (z[:-1] + z[1:])
        found.append([2.0 * up[0], rising[cells[0] - 1] + down[cells[0]], rising[-1] + down[-1]])
        down[1:] = np.append(up[0], falling[:-1])
        up[:-1] = rising
    return step * np.arange(len(found)), np.array(found)


def test_elastic_layers_move_as_by_scattering_at_interfaces() -> None:
    (times, expected), column, depths = scattered(3.0), motion(), (0.0, 30.0, 70.0)
    found = column.at("velocity", times, depths)
    assert np.abs(found - expected).max() < 1e-8 * np.abs(expected).max()
    moved = np.diff(column.at("displacement", times, depths), axis=0) / times[1]
    between = column.at("velocity", times[1:] - 0.5 * times[1], depths)
    assert np.abs(moved - between).max() < 1e-4 * np.abs(expected).max()  # the differences err by (ω Δt)²/24


def test_times_after_the_last_one_continue_the_motion() -> None:
    times = np.linspace(0.0, 3.0, 50)
    early = motion(until=0.8)
    early.at("velocity", times[:5], (0.0,))
    expected = motion().at("velocity", times, (0.0,))
    np.testing.assert_allclose(early.at("velocity", times, (0.0,)), expected, atol=1e-7 * np.abs(expected).max())


FREQUENCIES = np.array([0.3, 1.7, 4.1, 9.0])
MEDIA = (Medium.isotropic(1800.0, 400.0, 200.0), GENERAL, Medium.isotropic(2300.0, 1400.0, 700.0))
THREE = (30.0, 40.0, 1.0)


def bed(medium: Medium, sx: float, thickness: float) -> Bed:
    return bed_of(medium, [wave for way in waves_with(medium, sx) for wave in way], thickness)


def flux(each: Bed, amplitude: np.ndarray) -> np.ndarray:
    """Energy (k, 4) per |ġ|² that the waves carry upwards."""
    return (np.abs(amplitude) ** 2) * np.sum(each.traction * each.motion, axis=0)


@pytest.mark.parametrize("mass", [None, 0.0, 800.0], ids=["goes_on", "free", "with_mass"])
def test_interfaces_keep_motion_traction_and_energy(mass: float | None) -> None:
    """At all joints of three layers, one of them without symmetry, and so does the surface with its mass."""
    sx = incident_wave(MEDIA[-1], "p", 30.0).slowness[0]
    beds = [bed(*each) for each in zip(MEDIA, (sx,) * 3, THREE, strict=True)]
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
    assert (in_rock * [1.0, 1.0, -1.0, -1.0] > 0.0).all()


@pytest.mark.parametrize("kind", [0, 1], ids=["sv", "p"])
def test_straight_up_it_is_the_column(kind: int) -> None:
    """At the surface, at both joints, and at complex frequencies, also with nearly straight waves."""
    media = (MEDIA[0], Medium.isotropic(2000.0, 700.0, 350.0), MEDIA[2])
    frequencies = FREQUENCIES - 0.2j
    speeds = [medium.plane_waves((0.0, 1.0))[0][kind] for medium in media]
    layers = [Layer(*each) for each in zip(THREE, (m.density for m in media), speeds, strict=True)]
    expected = Column(layers, mass=900.0).motion(frequencies, [0.0, 30.0, 70.0])[0]
    for sx in (0.0, 1e-13):
        beds = [bed(medium, sx, thick) for medium, thick in zip(media, THREE, strict=True)]
        rising = np.linalg.solve(beds[-1].motion[:, :2], np.eye(2)[kind])
        found = amplitudes(beds, rising, frequencies, 900.0)
        late = [each.late(frequencies) for each in beds]
        ones = np.ones((4, 2))
        factors = [np.hstack([late[0][:, :2], ones]), np.hstack([late[1][:, :2], ones]), np.ones((4, 4))]
        for own, factor, each, exact in zip(found, factors, beds, expected, strict=True):
            np.testing.assert_allclose((own * factor) @ each.motion[kind], exact, rtol=1e-9)
