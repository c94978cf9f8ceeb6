"""Which particles keep half their mass."""

import numpy as np
import pytest

from dembound.boundaries import Fixed, Viscoelastic, ViscoelasticInput, Viscous, ViscousInput
from dembound.boundaries.half_mass import mass_factor
from dembound.boundaries.support import Edge


def edge(side: str, nodes: list[int]) -> Edge:
    return Edge(side, np.array(nodes), np.zeros((len(nodes), 2)), np.ones(len(nodes)), 2.0)


EDGES = {"left": edge("left", [0, 2]), "right": edge("right", [1, 3]), "top": edge("top", [2, 3])}

KINDS = {
    "viscous": Viscous,
    "viscous_input": lambda **keys: ViscousInput(**keys, wave_p="pulse"),
    "viscoelastic": lambda **keys: Viscoelastic(**keys, distance=1.0),
    "viscoelastic_input": lambda **keys: ViscoelasticInput(**keys, distance=1.0, wave_p="pulse"),
}


@pytest.mark.parametrize("kind", KINDS)
def test_sides_that_ask_for_it_halve_their_particles(kind: str) -> None:
    for asks, factor in ((True, [0.5, 1.0, 0.5, 1.0, 1.0]), (False, [1.0] * 5)):
        boundary = {"left": KINDS[kind](type=kind, half_mass=asks), "right": Fixed(type="fixed")}
        assert mass_factor(5, EDGES, boundary).tolist() == factor


def test_a_corner_of_two_such_sides_keeps_a_quarter() -> None:
    half = Viscous(type="viscous", half_mass=True)

    assert mass_factor(5, EDGES, {"left": half, "top": half}).tolist() == [0.5, 1.0, 0.25, 0.5, 1.0]


def test_a_side_that_is_no_edge_halves_nothing() -> None:
    assert mass_factor(5, EDGES, {"bottom": Viscous(type="viscous", half_mass=True)}).tolist() == [1.0] * 5
