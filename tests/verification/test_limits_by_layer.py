"""Limits by type of contact: where they differ by height bonds break, and contacts slide, where they are low."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from dembound.disks.contacts import contact_list, layout
from dembound.disks.contacts.row_plan import plan_rows
from dembound.disks.material.constants import limits_between, limits_of
from dembound.disks.stability import choose_step
from dembound.disks.stepping import scene_parts
from dembound.motion.part import Cracks
from dembound.motion.simulation import Simulation

STEPS, JOINT = 250, 10.0
SIDES = {"left": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}, "right": "viscous"}
BRITTLE = {"law": "linearpbond", "elastic_start": False, "pb_ten": 4e5, "pb_coh": 4e5, "pb_fa": 20.0, "fric": 0.5}
TOUGH = {"pb_ten": 1e9, "pb_coh": 1e9, "fric": 0.9}


@pytest.fixture
def run(lab, monkeypatch) -> Callable[..., Simulation]:
    """Runs a pulse through a body whose contacts below and above a joint are of different types."""
    twice, by_level = contact_list.brick_constants, lambda part: plan_rows(part, part.tile[:, 1].astype(np.int64))
    monkeypatch.setattr(contact_list, "brick_constants", lambda *each, **more: np.vstack(2 * [twice(*each, **more)]))

    def make(
        pattern: str, geometry: str, columns: tuple[dict, dict] | None, joined: bool = True, steps: int = STEPS
    ) -> Simulation:
        for module in (layout, scene_parts):
            monkeypatch.setattr(module, "plan_rows", lambda part, _: replace(by_level(part), by_level=joined))
        words = {"held": (), "boundary": SIDES, "wave": lab.pulse(0.01)}
        if pattern == "B":
            words["brick"] = (4.0, 4.0)
        scenes = [
            lab.scene(pattern, (20.0, 20.0), **words, material=BRITTLE | {"geometry": geometry} | each)
            for each in columns or ({},)
        ]
        scene, materials = scenes[0], [each.case.material for each in scenes]
        heights, types = scene.assembly.positions[:, 1], 2 * len(scene.ground.brick.pairs)
        above = (heights[scene.assembly.pairs] > JOINT).all(axis=1)
        assembly = replace(scene.assembly, contact_type=scene.assembly.contact_type + types * above.astype(np.int32))
        layers = None
        if columns is not None:
            below, on_top = materials
            friction = np.where(heights > JOINT, on_top.fric, below.fric)
            layers = limits_between([(below, on_top), (on_top, on_top)], types), friction, 0.0 * friction
        monkeypatch.setattr(scene_parts, "layers_of", lambda *_: layers)
        simulation = Simulation(replace(scene, assembly=assembly), choose_step(scene)[0])
        (contacts,) = simulation.system.contacts.values()
        contacts.cells = contacts.cells._replace(reach=0.0)  # pairs are searched for as if any two disks might meet
        simulation.advance(steps)
        assert contacts.rows is not None
        return simulation

    return make


def cracks_of(simulation: Simulation) -> Cracks:
    """The cracks of a run."""
    return simulation.system.take_cracks(STEPS)


@pytest.mark.slow  # kernels of rows for limits by type are compiled for these alone
@pytest.mark.parametrize(("pattern", "geometry"), [("A", "reference"), ("B", "updated")])
def test_equal_columns_give_the_bits_of_numbers(run, pattern: str, geometry: str) -> None:
    numbers, columns = (run(pattern, geometry, each) for each in (None, ({}, {})))
    expected, found = cracks_of(numbers), cracks_of(columns)

    assert len(expected) > 50
    assert all(contacts.origin.any() for contacts in columns.system.contacts.values())  # pairs were searched for
    assert np.array_equal(found.pair, expected.pair)
    assert np.array_equal(found.step, expected.step)
    for name in ("displacement", "velocity", "work", "peaks"):
        assert np.array_equal(getattr(columns.state, name), getattr(numbers.state, name))


@pytest.mark.slow  # kernels of rows for limits by type are compiled for these alone
@pytest.mark.parametrize(("pattern", "geometry"), [("A", "reference"), ("B", "updated")])
def test_only_the_weaker_layer_breaks_and_slides(run, pattern: str, geometry: str) -> None:
    simulation = run(pattern, geometry, ({}, TOUGH))
    (contacts,) = simulation.system.contacts.values()
    cracks, heights = cracks_of(simulation), contacts.assembly.positions[:, 1]
    other = contacts.of("contact_type") >= 4 * len(contacts.ground.brick.pairs)  # near pairs, which have no bonds

    assert len(cracks) > 30
    assert (heights[cracks.pair].min(axis=1) < JOINT).all()
    friction = contacts.limits.friction[contacts.of("contact_type")]
    lowest = np.minimum(*(np.where(heights > JOINT, 0.9, 0.5)[disks] for disks in contacts.pairs))
    assert other.any() == (pattern == "B")
    assert np.array_equal(friction[other], lowest[other])


@pytest.mark.parametrize("geometry", ["reference", "updated"])
def test_pairs_between_rows_of_bricks_move_as_one_by_one(run, geometry: str) -> None:
    apart, joined = (run("A", geometry, None, joined=each, steps=STEPS // 3) for each in (False, True))
    (less,), (more,) = (each.system.contacts.values() for each in (apart, joined))
    in_rows = [int(np.bitwise_count(each.rows.exists).sum()) / len(each.live) for each in (less, more)]
    largest = np.abs(apart.state.peaks).max()

    assert in_rows[0] < 0.6
    assert in_rows[1] > 0.9
    assert largest > 0.1
    np.testing.assert_allclose(joined.state.velocity, apart.state.velocity, rtol=0.0, atol=1e-9 * largest)
    for each in (apart, joined):
        each.advance(STEPS - STEPS // 3)
    expected, found = cracks_of(apart), cracks_of(joined)
    assert len(expected) > 50
    assert np.array_equal(found.pair, expected.pair)
    assert np.array_equal(found.step, expected.step)


def test_between_two_materials_the_smaller_limits_hold(lab) -> None:
    one, other = (lab.scene("A", (4.0, 4.0), material=BRITTLE | each).case.material for each in ({}, TOUGH))
    uncut = {"law": "linearpbond", "pb_ten": 5e5, "fric": 0.1}
    unbroken = lab.scene("A", (4.0, 4.0), material=uncut).case.material
    found = limits_between([(one, one), (other, one), (one, unbroken)], 2)

    alone = limits_of(one)
    assert np.array_equal(np.array(found[:4]).T[:4], np.tile([alone[:4]], (4, 1)))
    assert np.array_equal(np.array(found[:4]).T[4:], np.tile([(0.1, *alone[1:4])], (2, 1)))
    assert found.geometry == alone.geometry

    rolling = [lab.scene("A", (4.0, 4.0), material=BRITTLE | {"rr_fric": each}).case.material for each in (0.2, 0.4)]
    found = limits_between([(rolling[1], rolling[0]), (rolling[1], rolling[1]), (one, rolling[1])], 1)
    assert found.rolling.tolist() == [0.2, 0.4, 0.0]
    assert np.array_equal(np.array(found[:4]).T, np.tile([alone[:4]], (3, 1)))
