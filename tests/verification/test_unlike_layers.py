"""Ground whose layers differ left and right of a plane moves beside near sides as in ground that goes on far.

Each side has a column and a continuum of its own layers, and the disks those of the side of the plane they are at.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import pytest

from dembound.casefile import Case
from dembound.disks import columns
from dembound.disks.rest.stage import settle
from dembound.disks.scene import build, column_alone
from dembound.disks.stability import choose_step
from dembound.kinds import with_changes
from dembound.motion.simulation import Simulation
from dembound.packings.column import Standing

HIGH = 20.0
"""Height of the ground, m."""

JOINTS, SOFT = {"left": 10.0, "right": 12.0}, {"left": 600.0, "right": 800.0}
"""Height (m) of the joint, and P-wave speed (m/s) of the layer above it, by side; the lower one has 1000 m/s."""

PLACES = ((-9.5, 19.5), (-0.5, 19.5), (0.5, 19.5), (9.5, 19.5), (0.5, 4.5))
"""At the surface beside the sides and the plane, and deep below."""


def layers(soft: Mapping[str, float] = SOFT, joints: Mapping[str, float] = JOINTS) -> list[dict]:
    """A layer of each side over common ground."""
    return [{"side": side, "bottom": joints[side], "p_wave_speed": speed} for side, speed in soft.items()] + [{}]


def ground(lab, half: float, kind: str = "s", sides: str = "outside", **changes) -> Case:
    """Disks of 1 m from x = −half to half (m) under a wave of 40 diameters, by default unlike beside x = 0."""
    bottom = {"type": {"outside": "outside", "free_field": "viscous_input"}[sides], f"wave_{kind}": "pulse"}
    case = lab.case(
        "A",
        (2.0 * half, HIGH),
        radius=0.5,
        origin=[-half, 0.0],
        held=(),
        material={"fric": 0.5},
        boundary={"left": {"type": sides}, "right": {"type": sides}, "bottom": bottom},
        wave={"type": "cosine", "amplitude": 1.0, "period": 40.0 / {"s": 1000.0 / np.sqrt(2.0), "p": 1000.0}[kind]},
        duration=0.13,
    )
    known = {"ground.meet": 0.0, "layer": layers()}
    known |= {"outside.element": 5.0} if sides == "outside" else {}
    return with_changes(case, {key: value for key, value in (known | changes).items() if value is not None})


def velocities(case: Case, step: float, places: Sequence[tuple[float, float]] = PLACES) -> np.ndarray:
    """Velocities (s, p, 2) of the disks nearest to places."""
    scene = build(case)
    body = np.arange(scene.column_count, scene.disk_count)
    probes = [body[np.argmin(np.hypot(*(scene.positions[body] - place).T))] for place in places]
    record = Simulation(scene, step, np.array(probes)).advance(int(case.run.duration / step))
    return record[:, :, 3:5]


def error(own: np.ndarray, expected: np.ndarray) -> float:
    """The largest deviation of a place, RMS over RMS."""
    return float(np.sqrt(((own - expected) ** 2).sum(axis=(0, 2)) / (expected**2).sum(axis=(0, 2))).max())


SLOPE = ((-10.0, 20.0), (-5.0, 20.0), (3.0, 15.0), (10.0, 15.0))


@pytest.mark.parametrize(
    ("kind", "sloped"), [pytest.param("s", False, marks=pytest.mark.slow), ("p", False), ("s", True)]
)
def test_near_sides_leave_the_motion_as_it_is(lab, kind: str, sloped: bool) -> None:
    """Half a height away: 0.14 % (SV), 0.16 % (P), 0.14 % where the surface differs, too; 2 to 4 % with wrong layers.

    Nothing comes back from the far sides: P waves need 0.14 s over the 70 m from the places and back.
    """
    near, far = {}, {}
    if sloped:
        near["ground.surface"] = [list(point) for point in SLOPE]
        far["ground.surface"] = [[-80.0, 20.0], *near["ground.surface"][1:-1], [80.0, 15.0]]
    places = [(x, y - 5.0 * (sloped and x > 3.0)) for x, y in PLACES[:2] + PLACES[3:]]
    wide = ground(lab, 80.0, kind, **far)
    step = choose_step(build(wide))[0]
    own = velocities(ground(lab, 10.0, kind, **near), step, places)
    assert error(own, velocities(wide, step, places)) < 3e-3


@pytest.mark.parametrize("kind", ["s", "p"])
def test_layers_given_by_side_are_common_ones_if_they_are_the_same(lab, monkeypatch, kind: str) -> None:
    """To rounding: contacts across the plane are then two equal springs in series."""
    alike = (dict.fromkeys(SOFT, value) for value in (600.0, 10.0))
    by_side = ground(lab, 6.0, kind, layer=layers(*alike))
    common = ground(lab, 6.0, kind, layer=[{"bottom": 10.0, "p_wave_speed": 600.0}, {}], **{"ground.meet": None})
    step = choose_step(build(common))[0]
    places = ((-5.5, 19.5), (0.5, 12.5), (5.5, 3.5))
    own = velocities(by_side, step, places)
    monkeypatch.setattr(columns, "standing_of", lambda *_: (Standing(("left", "bottom")), Standing(("right",))))
    np.testing.assert_allclose(own, velocities(common, step, places), rtol=0.0, atol=1e-11)
    assert np.abs(own).max() > 1.5


def test_each_column_moves_as_that_of_its_own_layers(lab) -> None:
    """Bitwise, beside ground of one side alone; monitors record that of the side of the plane they are at."""
    at = {side: [x, 19.5] for side, x in (("left", -3.5), ("right", 3.5))}
    row = [{"name": side, "position": place} for side, place in at.items()]
    unlike = build(ground(lab, 6.0, sides="free_field", monitor=row))
    step = choose_step(unlike)[0]
    both = Simulation(unlike, step)
    both.run(150)
    for number, side in enumerate(("left", "right")):
        stack = [{"bottom": JOINTS[side], "p_wave_speed": SOFT[side]}, {}]
        alone = build(ground(lab, 6.0, sides="free_field", layer=stack, **{"ground.meet": None}))
        plain = Simulation(alone, step)
        plain.run(150)
        own, expected = unlike.seams[number].disks, alone.seams[0].disks
        np.testing.assert_array_equal(both.state.velocity[:, own], plain.state.velocity[:, expected])
        assert np.abs(both.state.velocity[:, own]).max() > 0.5
        assert own.start <= unlike.monitors[f"{side}.free_field"] < own.stop
        assert column_alone(unlike, number).ground.layers[-1].material.given_speeds[0] == SOFT[side]


def test_at_rest_each_side_has_the_weight_and_k0_of_its_layers(lab) -> None:
    held = {side: {"type": "roller"} for side in ("left", "right", "bottom")}
    own = layers()
    own[0] |= {"density": 2000.0, "k0": 0.4}
    own[1] |= {"k0": 0.8}
    stage = {"static": {"k0": 0.5, "boundary": held}, "load": [{"name": "weight", "acceleration": [0.0, -9.81]}]}
    scene = build(ground(lab, 10.0, layer=own, **stage, **{"wave.pulse.start": 1.0}))
    begins = scene.at_rest.at(np.array([13.0, 13.0, 5.0]), np.array([-5.0, 5.0, -5.0]))
    vertical = -9.81 * np.array([2000.0 * 7.0, 2500.0 * 7.0, 2000.0 * 10.0 + 2500.0 * 5.0])
    np.testing.assert_allclose(begins, np.array([[0.4, 0.8, 0.5], [1.0] * 3, [0.0] * 3]) * vertical, rtol=1e-12)
    settled = settle(scene)
    for seam, (k0, density) in zip(scene.seams, ((0.4, 2000.0), (0.8, 2500.0)), strict=True):
        name = "right_column" if seam.sides == ("right",) else "column"
        beside = scene.at_rest_of(name).at(np.array([13.0]))[:, 0]
        np.testing.assert_allclose(beside, -9.81 * density * 7.0 * np.array([k0, 1.0, 0.0]), rtol=1e-12)
    simulation = lab.simulation(scene, settled.start)
    simulation.run(200)
    assert np.abs(simulation.state.velocity).max() < 1e-9
