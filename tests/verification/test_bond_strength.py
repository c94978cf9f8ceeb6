"""A bond breaks when its stress reaches its strength, in the mode that does, for good.

σ = F_n/A + |M|R̄/J against pb_ten, τ = |F_s|/A against pb_coh − (F_n/A)·tan(pb_fa), tension positive. A grip moves one
of two bonded disks at constant speeds, so that the forces of the bond are its stiffnesses times the way: after n steps
F_n/A = k̄_n u, F_s/A = k̄_s s and M/J = k̄_n θ with u, s, θ in proportion to n. Strengths are such that they are reached
half-way from one step to the next.
"""

from dataclasses import replace

import numpy as np
import pytest

from dembound.boundaries.support import SupportBuilder
from dembound.motion.simulation import Simulation

RADII = np.array([0.2, 0.3])
BOND_RADIUS = 0.8 * RADII.min()
PB_EMOD, PB_KRATIO = 1e9, 2.5
NORMAL = PB_EMOD / RADII.sum()  # k̄_n
SHEAR = NORMAL / PB_KRATIO
FRICTION_ANGLE = 30.0
STEP = 1e-4
STRETCH = 1e-9
"""Way per step. After the 2000 steps of a test the pair has turned by 4e-6: nothing that a step in 1000 shows."""

DIRECTION = np.array([0.6, 0.8])
REACH = 1000.5
"""Steps after which a strength is reached."""


def gripped(lab, along: float, across: float, turning: float, turns_at: int = 10**9, **strength) -> Simulation:
    """Two bonded disks; one is fixed, the other moved by so many `STRETCH` per step, and turned by so many over R̄.

    All motion is reversed after a number of steps. Contacts are as stiff as bonds.
    """
    material = {"law": "linearpbond", "emod": PB_EMOD, "pb_emod": PB_EMOD, "pb_rmul": 0.8, "pb_kratio": PB_KRATIO}
    positions = np.outer([0.0, RADII.sum()], DIRECTION)
    scene = lab.disks(positions, RADII, [(0, 1)], held=(), material=material | {"fric": 0.5} | strength)
    normal, tangent = DIRECTION, np.array([-DIRECTION[1], DIRECTION[0]])
    # a turn shears the bond by the second disk's arm, which moving it across makes good
    way = along * normal + (across + turning * RADII[1] / BOND_RADIUS) * tangent
    grip = SupportBuilder()
    for component, speed in enumerate([*way, turning / BOND_RADIUS]):
        grip.add(np.array([0]), component, prescribed=True)
        grip.add(
            np.array([1]),
            component,
            drive=STRETCH / STEP * speed,
            signal=lambda times: np.where(times < turns_at * STEP, 1.0, -1.0),
            prescribed=True,
        )
    return Simulation(replace(scene, supports=grip.table()), STEP, np.zeros(0))


def stress(along: float, turning: float = 0.0) -> float:
    """σ (Pa) after `REACH` steps."""
    return NORMAL * STRETCH * REACH * (along + abs(turning))


def cohesion(along: float, across: float) -> float:
    """pb_coh (Pa) of a bond that breaks in shear after `REACH` steps."""
    return SHEAR * STRETCH * REACH * abs(across) + stress(along) * np.tan(np.radians(FRICTION_ANGLE))


@pytest.mark.parametrize("motion", [(0.7, 0.9, 0.0), (0.7, 0.0, -0.4), (-0.4, 0.0, 1.0)])
def test_it_breaks_in_tension_at_pb_ten(lab, motion):
    along, _, turning = motion
    simulation = gripped(lab, *motion, pb_ten=stress(along, turning))
    check_crack(simulation, shear=False)


@pytest.mark.parametrize("motion", [(0.5, 1.0, 0.0), (-0.5, -1.0, 0.0), (0.0, 1.0, 0.3)])
def test_it_breaks_in_shear_at_cohesion_and_friction(lab, motion):
    along, across, _ = motion
    simulation = gripped(lab, *motion, pb_coh=cohesion(along, across), pb_fa=FRICTION_ANGLE)
    check_crack(simulation, shear=True)


def check_crack(simulation: Simulation, *, shear: bool) -> None:
    """One crack, in the first step that begins beyond the strength, midway between the disks as they are then."""
    simulation.advance(int(REACH) + 1)
    moved = simulation.state.displacement[:2, 1].copy()
    simulation.advance(int(REACH) - 1)
    cracks = simulation.system.contacts["body"].take_cracks()
    assert cracks.pair.tolist() == [[0, 1]]
    assert cracks.shear.tolist() == [shear]
    assert cracks.step.tolist() == [int(REACH) + 1]
    middle = simulation.scene.assembly.positions.mean(axis=0) + 0.5 * moved
    np.testing.assert_allclose(cracks.position, [middle], rtol=1e-15)


@pytest.mark.parametrize(("motion", "shear"), [((1.0, 0.4, 0.0), False), ((0.4, 1.0, 0.0), True)])
def test_the_strength_reached_first_decides(lab, motion, shear):
    # at 2/3 of the other one's way; the later one is never reported
    strength = {"pb_ten": stress(motion[0]), "pb_coh": cohesion(*motion[:2]), "pb_fa": FRICTION_ANGLE}
    strength["pb_ten" if shear else "pb_coh"] *= 1.5
    check_crack(gripped(lab, *motion, **strength), shear=shear)


def test_a_broken_bond_never_heals(lab):
    turns_at = 2 * int(REACH)
    simulation = gripped(lab, 1.0, 0.0, 0.2, turns_at, pb_ten=stress(1.0, 0.2))

    contacts = simulation.system.contacts

    def force() -> np.ndarray:
        return simulation.system.forces.last(contacts)[:, 1]

    simulation.advance(turns_at)
    assert len(contacts["body"].take_cracks()) == 1
    assert not force().any()
    simulation.advance(turns_at // 2)  # half-way back, still apart
    assert not force().any()
    simulation.advance(turns_at)  # pressed together, turned back beyond the start
    assert len(contacts["body"].take_cracks()) == 0
    # the contact alone: k_n = E_c times the overlap of the last step's beginning. Across the pair the disk has moved by
    # less than the overlap, and turned the pair by less than 4e-6
    pressed = PB_EMOD * STRETCH * (simulation.state.step - 1 - 2 * turns_at)
    np.testing.assert_allclose(force(), [*(pressed * DIRECTION), 0.0], rtol=0.0, atol=1e-5 * pressed)
