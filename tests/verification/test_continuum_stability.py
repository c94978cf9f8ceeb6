"""The step limit of a continuum holds with the memories and the delay of its layers, and is nearly sharp.

The delay makes the largest ω² count 1 + 2τ/Δt times if it acts alike on all nodes of the mode. In the mode that grows
first it varies, from zero at the inner edge of a layer, so up to 5 % more than the limit may be stable.
"""

from collections.abc import Callable

import numpy as np
import pytest
from grid_scene import GridScene, step_limit

from dembound.continuum import layer
from dembound.continuum.axis import Around
from dembound.continuum.layer import Absorption
from dembound.continuum.medium import Medium
from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody
from dembound.motion.simulation import Simulation

STEPS = 2000


def equal(layers: int) -> Mesh:
    """Elements of 10 m, layers of so many of them on three sides."""
    return Mesh.uniform(order=4, element=(10.0, 10.0), cells=(8, 6), layer=Around(layers, layers, layers, 0))


def unequal(layers: int) -> Mesh:
    """Elements of 7 … 10 m, the lowest ones at the surface."""
    widths, heights = (10.0,) * 5 + (8.0,) * 3, (9.0,) + (10.0,) * 4 + (7.0,)
    return Mesh(order=4, widths=widths, heights=heights, layer=Around(layers, layers, layers, 0))


def growth(share: float, delay: float, ratio: float, mesh: Mesh) -> float:
    """Growth of noise in an isotropic medium of a Poisson's ratio."""
    slower = np.sqrt((1.0 - 2.0 * ratio) / (2.0 - 2.0 * ratio))
    return growth_in(Medium.isotropic(2500.0, 1000.0, 1000.0 * slower), share, delay, mesh)


def growth_in(medium: Medium, share: float, delay: float, mesh: Mesh) -> float:
    """Kinetic energy at the end over that of the noise at the start, at a share of the limit; infinite beyond 1e20."""
    body = GridBody(mesh=mesh, medium=medium, absorption=Absorption(delay=delay))
    simulation = Simulation(GridScene(body), share * step_limit(body))
    noise = np.random.default_rng(0).standard_normal((3, body.count)) * ~mesh.held
    noise[2] = 0.0
    simulation.state.velocity = noise
    for _ in range(STEPS // 10):
        simulation.run(simulation.state.step + 10)
        rise = float(np.sum(body.mass * simulation.state.velocity**2) / np.sum(body.mass * noise**2))
        if rise > 1e20:
            return np.inf
    return rise


@pytest.mark.parametrize(("mesh", "delay", "ratio"), [(equal, 0.5, 0.0), (equal, 0.1, 0.4), (unequal, 0.1, 0.25)])
def test_layers(mesh: Callable[[int], Mesh], delay: float, ratio: float) -> None:
    assert growth(0.999, delay, ratio, mesh(3)) < 1.0
    assert growth(1.06, delay, ratio, mesh(3)) == np.inf


def test_no_layers() -> None:
    """As kinetic energy is at most E/(1 − r²) at a share r of the limit."""
    assert growth(0.998, 0.1, 0.25, unequal(0)) < 1.0 / (1.0 - 0.999**2)
    assert growth(1.002, 0.1, 0.25, unequal(0)) == np.inf


def test_anisotropic(monkeypatch: pytest.MonkeyPatch) -> None:
    """A lattice whose shear springs are stiffer: noise grows in layers that stretch one axis only, without end."""
    medium = Medium(2000.0, 1e8, 0.8e8, 0.0, 7e8)
    mesh = Mesh.uniform(order=4, element=(10.0, 10.0), cells=(14, 9), layer=Around(4, 4, 4, 0))
    assert growth_in(medium, 0.8, 0.1, mesh) < 0.1
    monkeypatch.setattr(layer, "QUIET", 1.0)
    assert growth_in(medium, 0.8, 0.1, mesh) > 1e3
