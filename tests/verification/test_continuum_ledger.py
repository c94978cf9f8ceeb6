"""The energy ledger of a continuum closes to rounding, and a layer takes all that waves bring to it."""

from collections.abc import Callable

import numpy as np
import pytest

from dembound.motion.energy import Entry, Ledger
from dembound.motion.simulation import Simulation
from dembound.outside.alone import GridScene, step_limit
from dembound.outside.body import GridBody
from dembound.outside.medium import Medium
from dembound.outside.mesh import NONE, Around, Mesh

STEPS = 2000


def equal(layer: Around) -> Mesh:
    """Elements of 10 m × 8 m."""
    return Mesh.uniform(order=4, element=(10.0, 8.0), cells=(11, 8), layer=layer)


def unequal(layer: Around) -> Mesh:
    """Elements of two widths and three heights, also within layers, one of them left out."""
    widths, heights = (10.0,) * 9 + (8.0,) * 2, (8.0, 7.0, 8.0, 8.0, 8.0, 8.0, 8.0, 6.0)
    return Mesh(order=4, widths=widths, heights=heights, layer=layer, box=(6, 4, 7, 5))


def entries(mesh: Mesh) -> list[Entry]:
    """A run in which a bump of displacement, and a steady force at the surface, send waves into a continuum."""
    medium = Medium(2500.0, c11=2.5e9, c22=1.8e9, c12=0.6e9, c66=0.7e9, c16=0.3e9, c26=-0.2e9)
    body = GridBody(mesh=mesh, medium=medium)
    load = np.zeros((3, body.count))
    top = np.flatnonzero(mesh.positions[:, 1] == mesh.positions[:, 1].max())
    load[1, top[len(top) // 2]] = -1e6
    simulation = Simulation(GridScene(body, load=load), 0.9 * step_limit(body))
    start = np.zeros((3, body.count))
    away = (mesh.positions - [50.0, 44.0]) / 10.0
    start[:2] = 1e-3 * np.array([[1.0], [0.5]]) * np.exp(-0.5 * np.sum(away**2, axis=1))
    simulation.state.displacement = start
    ledger = Ledger(simulation, 20)
    simulation.track(ledger)
    simulation.run(STEPS + 1)
    return ledger.entries


@pytest.mark.parametrize("mesh", [equal, unequal])
@pytest.mark.parametrize("layer", [NONE, Around(3, 3, 3, 0)], ids=["elastic", "absorbing"])
def test_books_close(layer: Around, mesh: Callable[[Around], Mesh]) -> None:
    """Sums of at most some thousand numbers, rounded by ε of the total in each step."""
    books = entries(mesh(layer))
    largest = max(max(entry.kinetic, abs(entry.contact), abs(entry.load)) for entry in books)
    error = np.array([entry.error for entry in books])

    assert np.abs(error - error[0]).max() < STEPS * np.finfo(float).eps * largest
    assert min(entry.contact for entry in books) < 0.0  # from the strain of the bump on
    assert abs(books[-1].load) > 0.1 * largest
    assert (books[-1].damping == 0.0) == (layer == NONE)


def test_layers_take_the_energy_of_waves() -> None:
    """What remains is the work of the load that goes into its static field, and modes that do not travel.

    The load begins at once on one node, which goes on swinging beside its neighbours with an amplitude A of velocity at
    about ωΔt = √2. With E = ½mA² and s = sin(ωΔt/2), its kinetic energy of the mean velocity is E(1 − s²)cos²ωt and
    `stepping` −E s² sin²ωt: for s² = ½ each of them, and their sum, change with the phase at the end between 0 and E/2,
    while kinetic − stepping is E/2 at any phase. The load F brings at most ½F²/(mω²) = F²Δt²/4m to a node of mass m,
    here 4 % of the largest kinetic energy, which its neighbours carry away slowly: 6e-4 is left after 2000 steps.
    """
    books = entries(equal(Around(3, 3, 3, 0)))
    most = max(entry.kinetic for entry in books)

    last = books[-1]
    assert last.kinetic - last.stepping < 1e-3 * most
    assert books[-1].damping > most
