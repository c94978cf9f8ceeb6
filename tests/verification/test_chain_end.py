"""Reflection of a harmonic wave by a matched dashpot at the end of a chain.

With the end disk's whole mass tan(qa/4), half a disk too much mass; with half of it tan²(qa/4). Springs behind it
return [1 + (2ωLρc/(αG))²]^(−1/2).
"""

from functools import cache

import numpy as np
import pytest

WAVELENGTH = 20
"""Disks per wavelength, few enough for a reflection of 7.9 %."""

SPRING = 0.25
"""Stiffness αGD/L of the end's spring over that of a contact, ρc²."""

SPRINGS = {"distance": 2.0, "young_modulus": 2.0 * 2500.0 * 1000.0**2, "half_mass": True}


@pytest.fixture(scope="module")
def returned(lab):
    """Measured |R| of a harmonic wave, its phase qa per disk and ωΔt/2 per half step, of one of ENDS.

    Each is measured once, and so is the incident wave, on a chain whose end is too far away.
    """
    frequency = lab.speed / (WAVELENGTH * lab.diameter)
    travel = lab.diameter / lab.speed  # from disk to disk, and the stability limit of a chain

    @cache
    def motion(end: str, share_of_limit: float, disks: int):
        scene = lab.scene(
            "A",
            (disks * lab.diameter, lab.diameter),
            boundary={"left": {"type": "velocity", "wave_p": "pulse"}, "right": ENDS[end][0]},
            wave={"type": "sine_burst", "amplitude": 1.0, "frequency": frequency, "cycles": 5},
        )
        return lab.run(scene, lab.row(scene)[[300]], 1000 * travel, share_of_limit * travel)

    def measure(end: str, share_of_limit: float) -> tuple[float, float, float]:
        history = motion(end, share_of_limit, 400)
        endless = motion("whole mass", share_of_limit, 800)  # echoes from its end come after 1300 travels
        incident = endless.velocity[:, 0, 0]
        echo = history.velocity[:, 0, 0] - incident
        wave = np.exp(2j * np.pi * frequency * history.times)
        turn = np.pi * frequency * share_of_limit * travel
        per_disk = 2.0 * np.arcsin(np.sin(turn) / share_of_limit)  # see test_chain_dispersion
        return abs(echo @ wave) / abs(incident @ wave), per_disk, turn

    return measure


ENDS = {
    "whole mass": ({"type": "viscous"}, 1.0, 0.0),
    "half mass": ({"type": "viscous", "half_mass": True}, 0.5, 0.0),
    "springs": ({"type": "viscoelastic"} | SPRINGS, 0.5, SPRING),
}
"""Boundary table, share μ of the end disk's mass, and its spring over k."""

FORMULAS = {
    "whole mass": lambda qa: np.tan(0.25 * qa),
    "half mass": lambda qa: np.tan(0.25 * qa) ** 2,
    "springs": lambda qa: 1.0 / np.hypot(1.0, 2.0 * qa / SPRING),
}
"""|R| of long waves and short steps."""


@pytest.mark.parametrize(("end", "share_of_limit"), [("whole mass", 0.9), ("half mass", 0.9), ("springs", 0.1)])
def test_reflection_of_a_matched_dashpot(returned, end, share_of_limit):
    measured, per_disk, turn = returned(end, share_of_limit)
    _, mass, spring = ENDS[end]

    # the end's equation over k, for u_j = exp(−iqaj) + R exp(iqaj) at j = 0: inertia μ(2 − 2cos qa), the one contact,
    # the dashpot with the centred v of finite steps, and the spring; it is linear in R
    dashpot = 2.0 * np.sin(0.5 * per_disk) * np.cos(turn)
    towards, back = (
        2.0 * mass * (1.0 - np.cos(per_disk)) - 1.0 + np.exp(sign * per_disk) - 1j * dashpot - spring
        for sign in (1j, -1j)
    )
    # cut off at 1000 travels are waves of group speed c·cos(qa/2) below 0.55 c, hence frequencies above 5.3 f: 21 bins
    # off the burst's centre, where its Hann spectrum is 1/(π·21³) = 3e-5 of the crest. Their loose end at the cut
    # leaks into f by another 1/(2π·21), 2e-7 even if all of them came back
    assert measured == pytest.approx(abs(towards / back), abs=1e-6)


@pytest.mark.parametrize("end", ENDS)
def test_reflection_of_long_waves(returned, end):
    share = 0.1
    measured, per_disk, _ = returned(end, share)

    # sin qa, cos(ωΔt/2) and ωD/c are qa, 1 and qa but for (qa)²/6, (qa)²/8 and (qa)²/24. What half a mass returns,
    # (1 − cos ½qa)/2, is (cos ½ωΔt − cos ½qa)/2 with finite steps, less by their share² of the limit
    assert measured == pytest.approx(FORMULAS[end](per_disk), rel=per_disk**2 / 3.0 + share**2)
