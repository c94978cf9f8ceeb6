"""A viscoelastic end takes back the displacement a pulse leaves behind, at the pace of its springs and dashpots.

The bar and its matched left side answer the right one with one more impedance Z = ρc_eff·H, so that 2Z u' + K u = 0
once the pulse is over: u decays with τ = 2Z/K = 2ρc_eff L H/(α_n G ΣD), whatever the length of the bar.
"""

import numpy as np
import pytest

ALPHA, MODULUS, DISTANCE, PERIOD = 2.5, 0.625e9, 100.0, 0.05


@pytest.mark.parametrize("pattern", ["A", "B"])
def test_displacement_decays_with_tau(lab, pattern):
    plain = lab.scene(pattern, (60.0, 10.0), boundary={"bottom": "periodic", "top": "periodic"})
    speed = plain.ground.wave_speeds(0)[0]
    matched = {side: speed / lab.speed / plain.edges[side].diameter_sum_ratio for side in ("left", "right")}
    scene = lab.scene(
        pattern,
        (60.0, 10.0),
        boundary={
            "left": {"type": "viscous_input", "wave_p": "pulse", "beta_p": matched["left"]},
            "right": {
                "type": "viscoelastic",
                "beta_p": matched["right"],
                "alpha_n": ALPHA,
                "young_modulus": 2.0 * MODULUS,
                "distance": DISTANCE,
            },
            "bottom": "periodic",
            "top": "periodic",
        },
        wave=lab.pulse(PERIOD),
    )
    tau = 2.0 * lab.density * speed * DISTANCE / (ALPHA * MODULUS * scene.edges["right"].diameter_sum_ratio)
    middle = np.argsort(np.abs(scene.assembly.positions[:, 0] - 30.0))[:1]
    history = lab.run(scene, middle, 6.0 * tau)
    moved = history.displacement[:, 0, 0]
    # the pulse passes the middle whole before the springs' answer comes back: u = ½M T
    passed = (30.0 / speed + PERIOD) < history.times
    assert moved.max() == pytest.approx(0.5 * 0.5 * PERIOD, rel=0.5 * PERIOD / tau)
    times = (1.0 * tau, 5.0 * tau)
    late = [np.interp(t, history.times[passed], moved[passed]) for t in times]
    # c_eff of a brick as a bar is known to 0.4 %, β with it; the end reflects πD/4cT ≈ 1 % of what little still moves
    assert (times[1] - times[0]) / np.log(late[0] / late[1]) == pytest.approx(tau, rel=0.01)
    assert moved[-1] < 0.01 * moved.max()
