"""A dashpot on the full end mass of a chain returns tan(qa/4) of a harmonic wave: half a disk too much mass."""

import numpy as np
import pytest

WAVELENGTH = 20
"""Disks per wavelength, few enough for a reflection of 7.9 %."""


@pytest.mark.parametrize("share_of_limit", [0.1, 0.9])
def test_reflection_of_a_matched_dashpot(lab, share_of_limit):
    frequency = lab.speed / (WAVELENGTH * lab.diameter)
    travel = lab.diameter / lab.speed  # from disk to disk, and the stability limit of a chain
    step = share_of_limit * travel

    def motion(disks: int):
        scene = lab.scene(
            "A",
            (disks * lab.diameter, lab.diameter),
            boundary={"left": {"type": "velocity", "wave_p": "pulse"}, "right": "viscous"},
            wave={"type": "sine_burst", "amplitude": 1.0, "frequency": frequency, "cycles": 5},
        )
        return lab.run(scene, lab.row(scene)[[300]], 1000 * travel, step)

    history, endless = motion(400), motion(800)  # echoes from the long chain's end come after 1300 travels
    incident = endless.velocity[:, 0, 0]
    echo = history.velocity[:, 0, 0] - incident
    omega = 2.0 * np.pi * frequency
    wave = np.exp(1j * omega * history.times)
    measured = abs(echo @ wave) / abs(incident @ wave)

    turn = 0.5 * omega * step
    per_disk = 2.0 * np.arcsin(np.sin(turn) * travel / step)  # qa, see test_chain_dispersion
    # the end disk's missing neighbour k(u_{n+1} − u_n) is replaced by −Zv; with the centred v of finite steps
    # cos(ωΔt/2) stands where continuous time has 1
    exact = abs((np.cos(turn) - np.exp(-0.5j * per_disk)) / (np.cos(turn) + np.exp(0.5j * per_disk)))
    # cut off at 1000 travels are waves of group speed c·cos(qa/2) below 0.55 c, hence frequencies above 5.3 f: 21 bins
    # off the burst's centre, where its Hann spectrum is 1/(π·21³) = 3e-5 of the crest. Their loose end at the cut
    # leaks into f by another 1/(2π·21), and the end returns them 7 times as well: 2e-6, 1e-5 for certain
    assert measured == pytest.approx(exact, rel=1e-5)
    # steps change the cosine by (ωΔt)²/8 and R by at most half of it, against tan(qa/4) = 7.9 % of continuous time
    assert measured == pytest.approx(np.tan(0.25 * per_disk), rel=per_disk**2 / 16.0)
