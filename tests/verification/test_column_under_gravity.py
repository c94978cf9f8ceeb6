"""A column of a random packing stands on its base with its weight, and every section carries what is above it.

Whatever the law, and whatever was locked in and relaxed. Sections carry from nothing to the weight W, so that the mean
vertical stress is half of W over the width, ρgH/2.
"""

import numpy as np
import pytest

from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.rest.stage import settle
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.contact_lists import contact_lists

WIDTH, HEIGHT = 5.0, 10.0
LARGEST = 0.3  # m, radius
DENSITY, GRAVITY = 2500.0, 9.81
RATIO = 1e-7
LAWS = {
    "elastic": {},
    "just touching": {"law": "linearpbond", "fric": 0.5},
    "locked in": {"law": "linearpbond", "fric": 0.5, "locked_in": 10e6},
}


def column(lab, law: dict, walls: str) -> DiskScene:
    """The column on a smooth base, between smooth walls or periodic sides."""
    supports = ("left", "right", "bottom") if walls == "roller" else ("bottom",)
    return lab.scene(
        "B",
        (WIDTH, HEIGHT),
        held=(),
        material=law,
        brick=(WIDTH, WIDTH),
        boundary={side: walls for side in ("left", "right")},
        load=[{"acceleration": (0.0, -GRAVITY)}],
        static={"ratio": RATIO, "boundary": {side: {"type": "roller"} for side in supports}},
    )


@pytest.fixture(scope="module", params=LAWS.values(), ids=LAWS)
def standing(request, lab) -> tuple[DiskScene, ContactList]:
    """The column between walls, and its contacts once it has come to rest."""
    scene = column(lab, request.param, "roller")
    start = settle(scene).start
    if start.contacts:
        return scene, start.contacts["body"]
    contacts = contact_lists(scene)["body"]
    contacts.push(start.displacement)
    return scene, contacts


def left(contacts: ContactList) -> float:
    """The most (N) that what the stage has left unbalanced on all disks comes to: a share of the mean contact force."""
    pairs = np.hypot(*contacts.force[:, :2].T)
    return len(contacts.assembly.radii) * RATIO * float(pairs[pairs > 0.0].mean())


def test_the_base_carries_the_weight(standing):
    scene, contacts = standing
    base = scene.edges["bottom"].nodes
    force = np.zeros((3, scene.count))
    contacts.add_forces(force)
    reaction = np.sum(GRAVITY * scene.mass[base] - force[1, base])
    assert reaction == pytest.approx(DENSITY * GRAVITY * WIDTH * HEIGHT, abs=left(contacts))


def test_a_section_carries_what_is_above(standing):
    scene, contacts = standing
    y = scene.assembly.positions[:, 1]
    above_base = y > y[scene.edges["bottom"].nodes].max()
    pairs, (first, second) = contacts.arrays, contacts.pairs
    # a section goes below a disk and all that stand higher; what crosses it upwards pushes the lower disk down
    carried = [
        np.sum(pairs.force[1, contacts.live] * ((y[second] >= height).astype(int) - (y[first] >= height)))
        for height in y[above_base]
    ]
    weights = GRAVITY * scene.mass
    above = [weights[y >= height].sum() for height in y[above_base]]
    np.testing.assert_allclose(carried, -np.array(above), rtol=0.0, atol=left(contacts))


@pytest.mark.parametrize("name", ["elastic", "just touching"])
def test_the_mean_vertical_stress_is_half_of_that_at_the_base(lab, name):
    settled = settle(column(lab, LAWS[name], "periodic"))
    # The mean is taken over disks four mean diameters away from base and top. What presses on them from above and below
    # acts within a radius of these two levels, and is the weight W of the column in all: W/b·R/h for a width b, the
    # mean being ½W/b
    radius_over_height = LARGEST / (HEIGHT - 8.0 * lab.diameter)
    assert settled.stress[1] == pytest.approx(-0.5 * DENSITY * GRAVITY * HEIGHT, rel=2.0 * radius_over_height)
