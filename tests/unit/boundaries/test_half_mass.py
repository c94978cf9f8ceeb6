"""Particles with half their mass, and contacts with half their stiffness."""

import numpy as np
import pytest

from dembound.boundaries import Fixed, ViscoelasticInput, Viscous
from dembound.boundaries.half_mass import half_contacts, half_edges, mass_factor, with_shares
from dembound.boundaries.support import Edge


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
