"""The forces on the sides of a body balance all else that acts on it, and give its stress.

Newton's second law of the whole body holds at every step of central differences: the sum of all forces on the sides is
that of m·Δv/Δt, less all loads.
"""

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.motion.simulation import Simulation

GRAVITY = 9.81
SIDES = ("left", "right", "bottom", "top")
PULSE = {"type": "cosine", "amplitude": 0.5, "period": 0.01}


def forces(simulation: Simulation) -> dict[str, np.ndarray]:
    """Forces (2,) N before the last step by side."""
    return dict(zip(simulation.sides.names, simulation.side_samples.record[-1, :, 3:], strict=True))


DASHPOTS = {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}
SPRINGS = {"type": "viscoelastic_input", "wave_p": "pulse", "distance": 5.0}
GRIP = {"type": "velocity", "wave_p": "pulse"}


@pytest.mark.parametrize(
    "boundary",
    [
        {"left": DASHPOTS, "top": "viscous"},
        {"bottom": SPRINGS, "right": {"type": "viscoelastic", "distance": 3.0}},
        {"bottom": "fixed", "left": "roller", "top": GRIP},
        {"left": "symmetry", "bottom": GRIP},
    ],
)
def test_forces_on_sides_are_all_that_changes_the_momentum(lab, boundary):
    """To rounding: some hundred forces per side, each rounded by 1e-16 of the largest, a hundred of their sum."""
    scene = lab.scene("B", (10.0, 10.0), held=(), boundary=boundary, wave=PULSE)
    simulation = lab.simulation(scene, side_stride=1)
    for _ in range(5):
        simulation.run(simulation.state.step + 40)
        before = scene.mass @ simulation.state.velocity[:2].T
        simulation.run(simulation.state.step + 1)
        gained = (scene.mass @ simulation.state.velocity[:2].T - before) / simulation.time_step
        size = np.abs(simulation.side_samples.record[..., 3:]).max()
        assert size > 1e3
        np.testing.assert_allclose(sum(forces(simulation).values()), gained, rtol=0.0, atol=1e-11 * size)


def test_a_sample_that_settled_under_a_stress_shows_it_from_the_start(lab):
    """Each side has the stress times its length, contacts across corners included."""
    stress = np.array([[-1e6, 2e5], [2e5, -2e6]])
    scene = lab.scene(
        "B",
        (20.0, 10.0),
        held=(),
        material={"law": "linearpbond", "elastic_start": False},
        boundary=dict.fromkeys(SIDES, "viscous"),
        static={"stress": [-1e6, -2e6, 2e5], "ratio": 1e-4},
    )
    simulation = lab.simulation(scene, settle(scene).start, side_stride=1)
    simulation.run(30)
    assert simulation.system.turning is not None  # balancing forces rotate with the sides
    for side, force in forces(simulation).items():
        edge = scene.sides[side]
        outward = np.zeros(2)
        outward[edge.axis] = 1.0 if side in ("right", "top") else -1.0
        # at rest to 1e-4 of the mean contact force; forces follow the length, with strains of 2 MPa / 2.5 GPa
        np.testing.assert_allclose(force / edge.length, stress @ outward, rtol=0.0, atol=1e-3 * 2e6)


def test_a_free_field_side_carries_what_the_ground_beyond_it_does(lab):
    """At rest its sides push against each other and the bottom, with that of the column apart, carries the weight."""
    scene = lab.scene(
        "B",
        (20.0, 10.0),
        held=(),
        boundary={"bottom": "viscous", "left": "free_field", "right": "free_field"},
        load=[{"acceleration": [0.0, -GRAVITY]}],
        static={"boundary": {"bottom": {"type": "fixed"}}, "ratio": 1e-6},
    )
    simulation = lab.simulation(scene, settle(scene).start, side_stride=1)
    simulation.run(1)
    found, column = forces(simulation), scene.column_count
    body, beside = GRAVITY * scene.mass[column:].sum(), GRAVITY * scene.mass[:column].sum()
    total = sum(force for side, force in found.items() if not side.endswith(".free_field"))
    np.testing.assert_allclose(total, [0.0, body], rtol=0.0, atol=1e-4 * body)
    assert found["bottom.free_field"][1] == pytest.approx(beside, rel=1e-4)
    assert found["left"][0] > 0.02 * body
    assert scene.sides["bottom"].length == pytest.approx(20.0)
