"""Kernels of spectral elements against their equations, written down element by element with NumPy."""

from dataclasses import replace

import numpy as np
import pytest
from grid_scene import GridScene

from dembound.continuum.axis import Around
from dembound.continuum.layer import Profile
from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody, GridPart
from dembound.kernels.grid import move
from dembound.kernels.tables import Body

STEP = 1e-4
"""About half of the stable one of elements of 3 × 2 m of order 4."""


class Plain:
    """The law of a continuum: gradients, stresses and nodal forces of all elements, memories of layers by node."""

    def __init__(self, body: GridBody, step: float) -> None:
        self.body, self.step = body, step
        mesh = body.mesh
        shape = (2, 2, *mesh.nodes.shape)  # axis, component, element, row, column
        self.strain_memory, self.force_memory = np.zeros(shape), np.zeros((2, 2, mesh.count))
        self.decay, self.gain, self.delay = np.ones((2, mesh.count)), np.zeros((2, mesh.count)), np.zeros(mesh.count)
        for axis in (0, 1):
            place = mesh.positions[:, axis]
            thicknesses = mesh.axes[axis].thickness
            inner = [mesh.origin[axis] + thicknesses[0]]
            inner.append(mesh.origin[axis] + mesh.size[axis] - thicknesses[1])
            for sign, edge, thickness in zip((-1.0, 1.0), inner, thicknesses, strict=True):
                if thickness == 0.0:
                    continue
                q = np.maximum(sign * (place - edge), 0.0) / thickness
                speed = np.sqrt((body.medium.c11, body.medium.c22)[axis] / body.medium.density)
                profile = Profile(thickness, body.medium.normal_speed(axis), mesh.inner, body.absorption)
                assert speed <= profile.speed < 1.1 * speed
                there = q > 0.0
                self.decay[axis, there] = profile.decay(q[there], step)
                self.gain[axis, there] = profile.gain(q[there], step)
                if mesh.periodic[1 - axis]:
                    part = body.absorption.along
                    self.decay[1 - axis, there] = profile.decay(q[there], step, part)
                    self.gain[1 - axis, there] = profile.gain(q[there], step, part)
                self.delay = np.maximum(self.delay, profile.delay(q, step))

    def forces(self, u: np.ndarray, v: np.ndarray | None = None) -> np.ndarray:
        """Nodal forces (2, n) at displacements (2, n); with velocities, half a step behind, also by the layers."""
        mesh = self.body.mesh
        absorbs = v is not None
        w = u + self.delay * v if v is not None else u
        derivative = mesh.rule.derivative
        of_elements = w[:, mesh.nodes]
        steeper = 2.0 / mesh.element_sizes.T[:, :, None, None]
        gradient = np.stack(
            [
                steeper[0] * np.einsum("ik,cejk->ceji", derivative, of_elements),
                steeper[1] * np.einsum("jk,ceki->ceji", derivative, of_elements),
            ]
        )
        if absorbs:
            decay, gain = self.decay[:, mesh.nodes], self.gain[:, mesh.nodes]
            self.strain_memory = decay[:, None] * self.strain_memory + gain[:, None] * gradient
            gradient = gradient + self.strain_memory
        strain = np.stack([gradient[0, 0], gradient[1, 1], gradient[1, 0] + gradient[0, 1]])
        xx, yy, xy = np.einsum("ab,beji->aeji", self.body.medium.matrix, strain)
        weight = np.outer(mesh.rule.weights, mesh.rule.weights) / np.prod(steeper, axis=0)
        total = np.zeros((2, 2, mesh.count))
        for component, (along_x, along_y) in enumerate(((xx, xy), (xy, yy))):
            fx = -steeper[0] * np.einsum("ki,ejk->eji", derivative, weight * along_x)
            fy = -steeper[1] * np.einsum("kj,eki->eji", derivative, weight * along_y)
            for axis, force in enumerate((fx, fy)):
                total[axis, component] = np.bincount(mesh.nodes.ravel(), force.ravel(), mesh.count)
        if absorbs:
            self.force_memory = self.decay[:, None] * self.force_memory + self.gain[:, None] * total
            total = total + self.force_memory
        return total.sum(axis=0) * ~mesh.held

    def energy(self, u: np.ndarray, elements: np.ndarray) -> float:
        """½Σ σ:ε over some elements, (E,) bool."""
        mesh, values = self.body.mesh, 0.0
        weights = np.outer(mesh.rule.weights, mesh.rule.weights)
        for nodes, (width, height) in zip(mesh.nodes[elements], mesh.element_sizes[elements], strict=True):
            weight = 0.25 * width * height * weights
            along_x = 2.0 / width * np.einsum("ik,cjk->cji", mesh.rule.derivative, u[:, nodes])
            along_y = 2.0 / height * np.einsum("jk,cki->cji", mesh.rule.derivative, u[:, nodes])
            strain = np.stack([along_x[0], along_y[1], along_y[0] + along_x[1]])
            values += 0.5 * float(np.einsum("ji,aji,ab,bji->", weight, strain, self.body.medium.matrix, strain))
        return values


def close(found: np.ndarray, expected: np.ndarray, sums: int = 1) -> None:
    """Equal but for rounding: each of `sums` results has some 200 products, of size up to that of the largest."""
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=sums * 1e-14 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("order", "first_slot", "even"),
    [
        (4, 0, True),
        (4, 24, False),
        pytest.param(3, 24, True, marks=pytest.mark.slow),  # nothing else in CI compiles kernels of these orders
        pytest.param(5, 0, True, marks=pytest.mark.slow),
        pytest.param(6, 24, False, marks=pytest.mark.slow),
    ],
)
def test_elastic_forces_and_energies(grid, noise, order: int, first_slot: int, even: bool) -> None:
    body = grid(order, first_slot=first_slot, even=even)
    u = noise(body)
    slots = np.zeros((3, body.blocks.end))
    slots[:, body.blocks.slot] = u
    force = np.zeros_like(slots)
    body.fill_forces(slots, force)

    plain = Plain(body, STEP)
    close(force[:2, body.blocks.slot], plain.forces(u[:2]))
    unused = np.ones(body.blocks.end, dtype=np.bool_)
    unused[body.blocks.slot] = False
    assert not force[:, unused].any()
    elastic = ~body.mesh.absorbs.any(axis=1)
    assert GridPart(body, STEP).stored(slots)[0] == pytest.approx(plain.energy(u[:2], elastic), rel=1e-12)


@pytest.mark.parametrize(
    ("order", "even"),
    [(4, True), (4, False), *(pytest.param(order, order == 3, marks=pytest.mark.slow) for order in (3, 5))],
)
def test_steps_with_layers(grid, noise, order: int, even: bool) -> None:
    """Memories, delay, both axes and corners; each φ is that of the node, whose elements have its parts."""
    takes_the_same_steps(grid(order, even=even), noise)


@pytest.mark.parametrize(
    ("periodic", "layer"), [((True, False), Around(bottom=2)), ((False, True), Around(left=1, right=2))]
)
def test_steps_with_layers_of_periodic_meshes(grid, noise, periodic, layer: Around) -> None:
    """These layers have convolution variables of derivatives along them, too."""
    margin = Around(*(min(count, 1) for count in layer))
    mesh = Mesh.around((0.0, 0.0, 6.0, 4.0), (3.0, 2.0), 4, margin=margin, layer=layer, periodic=periodic)
    takes_the_same_steps(replace(grid(), mesh=mesh), noise)


def takes_the_same_steps(body: GridBody, noise) -> None:
    """A continuum in five steps, by the kernels and plainly."""
    plain, u, v = Plain(body, STEP), noise(body, 1)[:2] * 1e-3, noise(body, 2)[:2]
    load = np.zeros((3, body.count))
    load[:2] = 1e4 * noise(body, 3)[:2]
    layout, law = GridScene(body).layout, body.law(STEP)
    now, before, loads = (layout.spread(np.pad(each, ((0, 1), (0, 0)))) for each in (u, v, load[:2]))
    mobility = layout.spread(STEP / body.mass)
    moved = Body(mobility, mobility, np.array([1.0, 1.0, 0.0]), loads, 0.0, STEP)
    after = np.zeros_like(now)
    for _ in range(5):
        move(law, now, after, before, moved, np.zeros(0, dtype=np.int64))
        now, after = after, now
    for _ in range(5):
        v = v + STEP / body.mass * (plain.forces(u, v) + load[:2])
        u = u + STEP * v

    close(layout.gather(now)[:2], u, 5)
    close(layout.gather(before)[:2], v, 5)
    assert not now[2].any()
