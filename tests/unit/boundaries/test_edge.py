"""A side of the scene, the medium that it represents, and its particles, also those with half their mass."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.boundaries import Fixed, ViscoelasticInput, Viscous
from dembound.boundaries.edge import BoundaryMedium, Edge, exposed, outer_row
from dembound.boundaries.half_mass import half_contacts, half_edges, mass_factor, with_shares


def no_mirror(diameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return 0.0 * diameters, 0.0 * diameters


MEDIUM = BoundaryMedium(density=2000.0, p_wave_speed=1000.0, s_wave_speed=500.0, mirror_stiffness=no_mirror)


def test_a_medium_gives_p_dashpots_along_the_normal_and_s_across() -> None:
    # βρc by hand: 0.5·2000·1000 and 3·2000·500
    assert MEDIUM.impedances(0.5, 3.0, normal_axis=0).tolist() == [1e6, 3e6]
    assert MEDIUM.impedances(0.5, 3.0, normal_axis=1).tolist() == [3e6, 1e6]
    assert MEDIUM.shear_modulus == 5e8  # 2000·500²


def test_matched_factors_make_up_for_speeds_and_for_what_the_disks_cover() -> None:
    edge = Edge("right", np.arange(2), positions=np.zeros((2, 2)), diameters=np.array([0.5, 1.0]), length=1.2)

    # ΣD/H = 1.25; own speeds of 900 and 600 m/s where 1000 and 500 are nominal
    assert MEDIUM.matched(edge) == pytest.approx({"p": 0.8, "s": 0.8}, rel=1e-15)
    own = replace(MEDIUM, own_speeds=lambda: (900.0, 600.0))
    assert own.matched(edge) == pytest.approx({"p": 0.72, "s": 0.96}, rel=1e-15)
    # no S waves in the medium, and a held motion
    fluid = replace(MEDIUM, s_wave_speed=0.0, own_speeds=lambda: (np.nan, 0.0))
    assert fluid.matched(edge) == pytest.approx({"p": np.nan, "s": 0.8}, rel=1e-15, nan_ok=True)


def test_a_disk_shared_by_two_sides_takes_its_part_of_the_width() -> None:
    diameters, shares = np.array([0.5, 1.0]), np.array([0.5, 1.0])
    edge = Edge("right", np.arange(2), np.zeros((2, 2)), diameters, length=1.25, shares=shares)
    assert edge.widths.tolist() == [0.25, 1.0]


COLUMNS, ROWS = 6, 4


def lattice() -> tuple[np.ndarray, np.ndarray]:
    """Touching disks of radius 0.5, 6 × 4, numbered row after row."""
    x, y = np.meshgrid(np.arange(COLUMNS) + 0.5, np.arange(ROWS) + 0.5)
    return np.column_stack([x.ravel(), y.ravel()]), np.full(COLUMNS * ROWS, 0.5)


@pytest.mark.parametrize(("side", "expected"), [("right", [5, 11, 17, 23]), ("top", [18, 19, 20, 21, 22, 23])])
def test_a_flat_side_is_its_outer_row_in_order_of_places_not_of_numbers(side: str, expected: list[int]) -> None:
    positions, radii = lattice()
    shuffle = np.random.default_rng(0).permutation(len(radii))
    assert shuffle[exposed(positions[shuffle], radii, side)].tolist() == expected
    assert outer_row(positions, radii, side).tolist() == expected


def test_a_disk_behind_a_hole_is_seen_and_one_behind_a_disk_is_not() -> None:
    positions, radii = lattice()
    without = np.delete(np.arange(len(radii)), 12)  # a hole in the left side, disk 13 behind it
    assert without[exposed(positions[without], radii[without], "left")].tolist() == [0, 6, 13, 18]
    # two disks 0.2 apart, and a third behind the gap; a gap of 0.004 is less than 1 % of the radius: not seen
    for gap, seen in ((0.2, [0, 2, 1]), (0.004, [0, 1])):
        positions = np.array([[0.0, 0.0], [0.0, 1.0 + gap], [1.0, 0.5 + gap / 2.0]])
        assert exposed(positions, np.full(3, 0.5), "left").tolist() == seen


@pytest.mark.parametrize(("period", "at_once"), [(40.0, 7)])
def test_sides_do_not_depend_on_how_many_disks_are_looked_at_together(monkeypatch, at_once: int, period) -> None:
    rng = np.random.default_rng(0)
    positions, radii = rng.uniform(0.0, (5.0, 40.0), (200, 2)), rng.uniform(0.2, 0.6, 200)
    positions[1], radii[1] = positions[0], radii[0] = (-0.5, 20.0), 0.5  # of two in one place the first is seen
    together = exposed(positions, radii, "left", period).tolist()
    monkeypatch.setattr("dembound.boundaries.edge.AT_ONCE", at_once)

    assert exposed(positions, radii, "left", period).tolist() == together
    assert 10 < len(together) < 100
    assert 0 in together
    assert 1 not in together


def test_a_disk_on_the_shoulder_of_a_larger_one_is_seen_and_one_sunk_into_it_hidden() -> None:
    # seen from the left the large disk reaches farther out, to 1, and over all of the small one's height; but there it
    # has rounded off to 0.6 and less, and the small one stands on it, up to 0.73: (0.63, 0.9) is 1.1 from its centre
    positions, radii = np.array([[0.0, 0.0], [-np.sqrt(1.1**2 - 0.9**2), 0.9]]), np.array([1.0, 0.1])

    assert exposed(positions, radii, "left").tolist() == [0, 1]
    assert exposed(-positions, radii, "right").tolist() == [1, 0]
    assert exposed(positions, radii, "right").tolist() == [0]
    # of height 0 to 1 both; the small one's top, at 0.2, is farther out than the large one's rim, but below its surface
    assert exposed(np.array([[0.0, 0.0], [0.3, 0.5]]), np.array([1.0, 0.5]), "left").tolist() == [0]


def test_a_periodic_side_sees_disks_reach_over_its_ends() -> None:
    # the last disk covers y in [3.1, 4.1] and so, seen periodically over 4 m, [-0.9, 0.1] too: its image hides the
    # small disk at the lower end
    positions = np.array([[0.6, 0.0], [0.0, 0.6], [0.0, 1.5], [0.0, 2.5], [0.0, 3.6]])
    radii = np.array([0.05, 0.4, 0.5, 0.5, 0.5])

    assert exposed(positions, radii, "left", period=4.0).tolist() == [1, 2, 3, 4]
    assert exposed(positions, radii, "left").tolist() == [0, 1, 2, 3, 4]


@pytest.mark.parametrize(("side", "seen"), [("bottom", [0, 1, 2, 5]), ("top", [6, 7, 8, 5])])
def test_an_outer_row_ends_where_the_next_one_is_seen_past_it(side: str, seen: list[int]) -> None:
    # three rows of three, hexagonally: the middle one reaches past the corners on the right
    x, y = np.meshgrid(np.arange(3.0), np.arange(3.0))
    positions, radii = np.column_stack([(x + 0.5 * (y == 1.0)).ravel(), np.sqrt(0.75) * y.ravel()]), np.full(9, 0.5)
    rounded = positions + 1e-12 * np.random.default_rng(0).normal(size=positions.shape)

    assert exposed(positions, radii, side).tolist() == seen
    for places in (positions, rounded):
        assert outer_row(places, radii, side).tolist() == seen[:3]


def test_a_rough_side_is_seen_to_its_ground_but_not_across_the_scene() -> None:
    # steps of one radius are part of the side; a lone corner six radii behind the face is not
    positions = np.array([[0.0, 0.0], [0.5, 1.0], [1.0, 2.0], [3.0, 3.0]])

    assert exposed(positions, np.full(4, 0.5), "left").tolist() == [0, 1, 2]
    assert exposed(positions, np.full(4, 0.5), "right").tolist() == [3]


def edge(side: str, nodes: list[int]) -> Edge:
    return Edge(side, np.array(nodes), np.zeros((len(nodes), 2)), np.ones(len(nodes)), 2.0)


EDGES = {"left": edge("left", [0, 2]), "right": edge("right", [1, 3]), "top": edge("top", [2, 3])}

KINDS = {
    "viscous": Viscous,
    "viscoelastic_input": lambda **keys: ViscoelasticInput(**keys, distance=1.0, wave_p="pulse"),
}


@pytest.mark.parametrize("kind", KINDS)
def test_sides_that_ask_for_it_halve_their_particles(kind: str) -> None:
    for triggers, factor in ((True, [0.5, 1.0, 0.5, 1.0, 1.0]), (False, [1.0] * 5)):
        boundary = {"left": KINDS[kind](type=kind, half_mass=triggers), "right": Fixed(type="fixed")}
        assert mass_factor(5, EDGES, boundary).tolist() == factor


HALF = Viscous(type="viscous", half_mass=True)


def test_a_corner_of_two_such_sides_keeps_a_quarter_and_half_its_width() -> None:
    def widths(boundary: dict) -> dict[str, list[float]]:
        return {side: edge.widths.tolist() for side, edge in with_shares(5, EDGES, boundary).items()}

    assert mass_factor(5, EDGES, {"left": HALF, "top": HALF}).tolist() == [0.5, 1.0, 0.25, 0.5, 1.0]
    assert mass_factor(5, EDGES, {"bottom": HALF}).tolist() == [1.0] * 5  # no edge
    assert widths({"left": HALF}) == {"left": [1.0, 1.0], "right": [1.0, 1.0], "top": [0.5, 1.0]}
    assert widths({"left": HALF, "top": HALF}) == {"left": [1.0, 0.5], "right": [1.0, 0.5], "top": [0.5, 1.0]}
    boundary = {"left": HALF, "right": Viscous(type="viscous"), "bottom": HALF, "top": HALF}
    assert [found.side for found in half_edges(EDGES, boundary)] == ["left", "top"]


CONTACTS = {
    "along left": (0, 2, [0.1, -1.0]),
    "across left": (0, 2, [1.0, -0.1]),
    "from left inwards": (0, 4, [0.1, 1.0]),
    "along top": (2, 3, [-1.0, 0.1]),
    "across top": (2, 3, [-0.1, 1.0]),
    "along right": (1, 3, [0.0, 1.0]),
    "with its own image, along top": (3, 3, [1.0, 0.0]),
    "with its own image, across top": (3, 3, [0.0, 1.0]),
}


@pytest.mark.parametrize(
    ("sides", "halved"),
    [
        ((), set()),
        (("top",), {"along top", "with its own image, along top"}),
        (("left", "top"), {"along left", "along top", "with its own image, along top"}),
    ],
)
def test_contacts_between_half_cells_along_their_side_are_half_contacts(sides: tuple[str, ...], halved: set) -> None:
    boundary = {side: HALF if side in sides else Viscous(type="viscous") for side in EDGES}
    for way in (1.0, -1.0):
        first, second, vectors = (np.array(column) for column in zip(*CONTACTS.values(), strict=True))
        found = half_contacts(first, second, way * vectors, EDGES, boundary)
        assert {name for name, half in zip(CONTACTS, found, strict=True) if half} == halved
