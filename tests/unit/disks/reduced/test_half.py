"""One half of a symmetric scene: which scenes have one, and what acts on its disks."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.disks.reduced.half import HalfScene
from dembound.disks.reduced.halves import halves
from dembound.disks.reduced.one_row import OneRow
from dembound.disks.reduced.reduction import difference, reduced
from dembound.disks.scene import build

EVEN, ODD = 10.0, 10.5
"""Widths (m) of 20 and of 21 columns of disks, 6 rows high."""


@pytest.fixture
def scene(bar):
    """Makes scenes that are pushed down in the middle of their upper side, with keys of the case changed."""

    def make(width, changes=None):
        middle = 0.5 * width
        push = {"name": "push", "region": [middle - 0.4, 2.5, middle + 0.4, 3.0], "force": [0.0, -1e6]}
        sides = {f"boundary.{side}": {"type": "viscous"} for side in ("left", "right", "bottom")}
        base = {"packing.size": [width, 3.0], "motion.held": [], "material.fric": 0.5, "reduce.symmetry": True}
        return build(bar(base | sides | {"load": [push | {"wave": "pulse"}], "monitor": []} | (changes or {})))

    return make


def load(x, force, **keys):
    return {"name": "more", "region": [x - 0.1, 1.0, x + 0.1, 1.6], "force": force, **keys}


@pytest.mark.parametrize(("width", "disks"), [(EVEN, 60), (ODD, 66)])
def test_one_half_is_stepped(scene, width, disks) -> None:
    whole = scene(width)
    half = reduced(whole).scene

    assert isinstance(half, HalfScene)
    assert half.whole is whole
    assert (half.count, half.axis, half.antisymmetric) == (disks, 0, False)
    assert half.weight == pytest.approx(2.0, rel=1e-15)
    assert np.array_equal(half.places_in_whole, np.flatnonzero(whole.positions[:, 0] < 0.5 * width + 0.1))
    assert half.chain == (whole, half)


def test_it_is_off_by_default(scene) -> None:
    whole = scene(EVEN, {"reduce.symmetry": False})

    assert reduced(whole).scene is whole


NOT = "are not mirror-symmetric about x = {middle:g} m"
DRIVEN = f"the waves and loads with a wave {NOT}{{lacking}}"


@pytest.mark.parametrize("width", [EVEN, ODD])
@pytest.mark.parametrize(
    ("reason", "changes"),
    [
        (f"the dashpots {NOT}", {"boundary.left": {"type": "viscous", "beta_s": 1.0 + 1e-9}}),
        (f"the contacts and springs {NOT}", {"boundary.left": {"type": "viscoelastic", "distance": 20.0}}),
        (f"the held and driven disks {NOT}", {"boundary.left": {"type": "fixed"}}),
        (DRIVEN, {"boundary.left": {"type": "viscous_input", "wave_p": "pulse"}}),
        (f"the steady loads {NOT}{{lacking}}", {"load": [load(3.25, [0.0, 1e3])]}),
        (DRIVEN, {"load": [load(3.25, [0.0, 1e3], wave="pulse")]}),
        (
            f"the steady loads {NOT}{{lacking}}",
            {"load": [{"name": "one", "position": [4.75, 2.75], "force": [0.0, 1e3]}]},
        ),
        (f"the steady loads {NOT}{{lacking}}", {"load": [{"name": "tilted", "acceleration": [1e-9, -9.81]}]}),
        (f"the disks {NOT}", {"hole": [{"name": "gap", "type": "circle", "centre": [4.25, 1.25], "radius": 0.1}]}),
        ("x is periodic", {"boundary.left": {"type": "periodic"}, "boundary.right": {"type": "periodic"}}),
        ('under material.law = "linearpbond" contacts may open', {"material.law": "linearpbond"}),
        ("a static stage is computed for the whole scene", {"static.stress": [-1e6, -1e6, 0.0], "load": []}),
        (
            "the body is stepped with the free-field column of left and right",
            {"boundary.left": {"type": "free_field"}, "boundary.right": {"type": "free_field"}},
        ),
    ],
)
def test_near_misses_are_stepped_whole_and_the_reason_is_given(scene, width, reason, changes) -> None:
    whole = scene(width, changes)
    stepped = reduced(whole)

    assert stepped.scene is whole
    (line,) = stepped.refused
    lacking = " (antisymmetric ones need disks on this line)" if width == EVEN else ""
    expected = reason.format(middle=0.5 * width, lacking=lacking)
    assert line.startswith(f"reduce.symmetry: not applied: {expected}")


def test_both_lines_are_named(scene) -> None:
    (line,) = reduced(scene(EVEN, {"boundary.left": {"type": "fixed"}})).refused

    assert line == (
        "reduce.symmetry: not applied: the held and driven disks are not mirror-symmetric about x = 5 m; "
        "the dashpots are not mirror-symmetric about y = 1.5 m"
    )


def test_one_line_is_enough(scene) -> None:
    assert reduced(scene(EVEN)).refused == ()
    assert reduced(scene(EVEN, {"boundary.left": {"type": "fixed"}, "reduce.symmetry": False})).refused == ()


def test_a_row_is_not_halved_across(bar) -> None:
    held = {"motion.held": ["y"], "boundary.left": {"type": "viscous_input", "wave_p": "pulse"}}
    stepped = reduced(build(bar({"packing.size": [10.0, 2.0], "reduce.symmetry": True, **held})))

    assert isinstance(stepped.scene, OneRow)
    assert stepped.refused[0].endswith("; one of identical rows along x is stepped")


def test_random_bricks_have_no_half(scene) -> None:
    brick = {"pattern": "B", "size": [10.0, 5.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [5.0, 5.0]}

    (reason,) = halves(scene(EVEN, {"packing": brick}), 0)
    assert str(reason).startswith("the disks are not mirror-symmetric about x = ")


@pytest.mark.parametrize("width", [EVEN, ODD])
@pytest.mark.parametrize(
    "change",
    [
        lambda half: {"load": half.load + 1.0},
        lambda half: {"fraction": 1.001 * half.fraction},
        lambda half: {"supports": replace(half.supports, stiffness=1.001 * half.supports.stiffness + 1.0)},
        lambda half: {"supports": replace(half.supports, damping=half.supports.damping * (1.0 + 1e-9))},
        lambda half: {"supports": replace(half.supports, drive=-half.supports.drive)},
        lambda half: {"antisymmetric": True},
        lambda half: {"axis": 1},
        lambda half: {"image": ~half.image},
        lambda half: {"supports": replace(half.supports, prescribed=~half.supports.prescribed)},
    ],
)
def test_a_half_that_is_not_one_of_the_scene_is_refused(scene, width, change) -> None:
    half = reduced(scene(width)).scene

    assert difference(half) is None
    assert difference(replace(half, **change(half)))


def test_disks_on_the_line_are_halves_that_cannot_leave_it(scene) -> None:
    whole = scene(ODD)
    half = reduced(whole).scene
    on_line = half.positions[:, 0] == 5.25

    assert on_line.sum() == 6
    assert np.array_equal(half.mass[on_line], 0.5 * whole.mass[half.place][on_line])
    assert np.array_equal(half.mass[~on_line], whole.mass[half.place][~on_line])
    table = half.supports
    held = table.prescribed & np.isin(table.component, [0, 2])
    assert np.array_equal(np.unique(table.node[held]), np.flatnonzero(on_line))
    assert np.count_nonzero(table.prescribed) == 12
    upright = on_line[half.assembly.pairs].all(axis=1)
    assert (half.assembly.contact_type[upright] == 3).all()  # half of type 1, the brick has two
    assert (half.assembly.contact_type[~upright] < 2).all()


def test_contacts_with_images_are_springs(scene) -> None:
    whole = scene(EVEN)
    half = reduced(whole).scene
    stiffness = whole.ground.stiffness
    table = half.supports
    sprung = table.stiffness > 0.0
    next_to = np.flatnonzero(half.positions[:, 0] == 4.75)

    assert np.array_equal(np.unique(table.node[sprung]), next_to)
    assert set(table.stiffness[sprung & (table.component == 0)]) == {2.0 * stiffness.normal[0]}
    assert set(table.stiffness[sprung & (table.component == 2)]) == {2.0 * stiffness.bending[0]}
    assert not (sprung & (table.component == 1)).any()


@pytest.mark.parametrize("width", [EVEN, ODD])
def test_fields_of_images_have_their_signs(scene, width) -> None:
    whole = scene(width)
    half = reduced(whole).scene
    values = np.random.default_rng(0).standard_normal((half.count, 3))
    mirrored = whole.positions.copy()
    mirrored[:, 0] = width - mirrored[:, 0]
    other = np.argmin(np.hypot(*(whole.positions[:, None] - mirrored[None]).T), axis=1)
    right = whole.positions[:, 0] > 0.5 * width + 0.1

    for name, signs in (("velocity", [-1, 1, -1]), ("displacement", [-1, 1, -1]), ("stress", [1, 1, -1])):
        wide = half.widened(name, values)
        assert np.array_equal(wide[half.places_in_whole], values)
        assert np.array_equal(wide[right], wide[other[right]] * signs)
    assert np.array_equal(
        half.widened("coordination", values[:, 0])[right], half.widened("x", values[:, 0])[other[right]]
    )


def test_peaks_of_images_change_sign_and_place(scene) -> None:
    whole = scene(EVEN)
    half = reduced(whole).scene
    peaks = np.zeros((len(half.tracked), 3, 2))
    peaks[..., 0], peaks[..., 1] = -1.0, 3.0

    assert np.array_equal(half.side_peaks("left", peaks)[0], [[-1.0, 3.0]] * 3)
    assert np.array_equal(half.side_peaks("right", peaks)[0], [[-3.0, 1.0], [-1.0, 3.0], [-3.0, 1.0]])
    assert len(half.side_peaks("top", peaks)) == 20


def test_monitors_of_the_other_side_are_shown_with_their_signs(scene) -> None:
    places = [{"name": "l", "position": [0.25, 0.25]}, {"name": "r", "position": [9.75, 0.25]}]
    half = reduced(scene(EVEN, {"monitor": places})).scene
    record = np.ones((4, 2, 6))

    assert half.monitors["l"] == half.monitors["r"]
    assert half.probes.tolist() == [half.monitors["l"]] * 2
    assert half.observed(record, np.zeros(1))[0, 0].tolist() == [1.0] * 6
    assert half.observed(record, np.zeros(1))[0, 1].tolist() == [-1.0, 1.0, -1.0] * 2


@pytest.mark.parametrize("width", [EVEN, ODD])
def test_a_monitor_between_disks_has_the_same_disk_in_half_of_them(scene, width) -> None:
    """Places equally near to two or four disks, also on the mirror line: the motion is that of the whole scene's."""
    x, y = np.meshgrid(np.arange(0.5, width, 0.5), [0.5, 1.0, 1.25])
    places = [{"name": f"m{k}", "position": list(place)} for k, place in enumerate(zip(x.flat, y.flat, strict=True))]
    whole = scene(width, {"monitor": places})
    half = reduced(whole).scene
    motion = np.random.default_rng(0).normal(size=(half.count, 3))
    record = np.tile(motion[half.probes], 2)[None]

    np.testing.assert_array_equal(
        half.observed(record, np.zeros(1))[0, :, :3], half.widened("velocity", motion)[whole.probes]
    )
    taken = whole.positions[whole.probes]
    np.testing.assert_allclose(taken, np.column_stack([x.flat, y.flat]) - [0.25, 0.0], atol=0.251)
    assert (taken[:, 0] < x.flat).all()  # the left one
    assert (taken[y.flat != 1.25, 1] < y.flat[y.flat != 1.25]).all()  # the lower one
