"""A viscoelastic input side lets a wave in whatever its springs are, and no drift is left behind."""

import numpy as np

TRAVELS = 200
"""The pulse's length in disks, and in travel times from disk to disk."""


def test_the_side_moves_with_the_incident_wave(lab):
    travel = lab.diameter / lab.speed
    period = TRAVELS * travel
    springs = {"distance": 2.0, "young_modulus": 2.0 * lab.density * lab.speed**2}  # K = αGD/L = k/4, stiff
    scene = lab.scene(
        "A",
        (1000 * lab.diameter, lab.diameter),
        boundary={"left": {"type": "viscoelastic_input", "wave_p": "pulse", "half_mass": True} | springs},
        wave=lab.pulse(period),
    )
    history = lab.run(scene, lab.row(scene)[[0]], 2.0 * period, 0.5 * travel)  # no echo before ten periods
    pulse = scene.case.wave["pulse"]

    # the end's equation with half its mass, x = ωD/c, κ = K/k: u/u_i = (2ix + κ)/(i sin qa + ix(1 − x²/24) + κ), the
    # last term the centred v of steps D/2c. It is 1 but for 0.09 x², whatever κ: that much of (D/c)² times the pulse's
    # acceleration rate, 0.25·(2π/T)² at most, and twice as much for where that jumps, at the pulse's ends
    tolerance = 2.0 * 0.09 * 0.25 * (2.0 * np.pi / TRAVELS) ** 2
    np.testing.assert_allclose(history.velocity[:, 0, 0], pulse.velocity(history.times), rtol=0.0, atol=tolerance)
    # the pulse leaves MT/2; what differs dies in 2Z/K = 8 travels, to e⁻²⁵ in the last 200
    np.testing.assert_allclose(history.displacement[-1, 0, 0], 0.25 * period, rtol=1e-10)
