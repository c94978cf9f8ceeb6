"""A circular hole excavated in a stressed plate moves its wall as Kirsch's solution says.

Kirsch (1898), in plane strain and for ν = 0 (Jaeger, Cook and Zimmerman, Fundamentals of Rock Mechanics, section 8.6):
what the excavation of radius a adds to the displacements of an infinite body under the mean stress p̄ and the deviator
s, σ_xx = p̄ + s and σ_yy = p̄ − s, is

    u_r = a²/(2Gr) [p̄ + s (4 − a²/r²) cos 2θ],   u_θ = −a²/(2Gr) s (2 + a²/r²) sin 2θ.

The square lattice with k_s = k_n = K is isotropic with ν = 0 and G = K/2.
"""

import numpy as np

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.kinds import with_changes

DISKS = 6  # in the hole's radius
WIDTH = 12  # of the plate, in radii
MEAN, DEVIATOR = -1.5e6, 0.5e6  # Pa
RATIO = 3e-5
"""Force ratio of rest. One way at all disks it would move the wall by 36²/2 such shares of a disk, 1/300 of its way."""


def test_the_wall_moves_as_kirsch_says(lab):
    """A plate under biaxial stress, all sides free, with a hole excavated in its middle."""
    a = DISKS * lab.diameter
    case = lab.case(
        "A",
        (WIDTH * a, WIDTH * a),
        held=(),
        material={"fric": 1.0},
        static={"stress": (MEAN + DEVIATOR, MEAN - DEVIATOR, 0.0), "ratio": RATIO},
    )
    middle = [0.5 * WIDTH * a] * 2
    hole = {"name": "tunnel", "type": "circle", "centre": middle, "radius": a, "stage": "after"}
    scene = build(with_changes(case, {"hole": [hole]}))
    settled = settle(scene)
    shear_modulus = 0.5 * lab.density * lab.speed**2
    x, y = (scene.assembly.positions - 0.5 * WIDTH * a).T
    r, angle = np.hypot(x, y), np.arctan2(y, x)
    wall = r < a + lab.diameter
    moved = (settled.start.displacement - settled.before.start.displacement[:, scene.kept])[:2, wall]
    r, c, s = r[wall], np.cos(angle[wall]), np.sin(angle[wall])
    found = np.concatenate([c * moved[0] + s * moved[1], c * moved[1] - s * moved[0]])

    scale = a**2 / (2.0 * shear_modulus * r)
    cos, sin = np.cos(2.0 * angle[wall]), np.sin(2.0 * angle[wall])
    by_mean = np.concatenate([scale, np.zeros_like(r)])
    by_deviator = np.concatenate([scale * (4.0 - a**2 / r**2) * cos, -scale * (2.0 + a**2 / r**2) * sin])
    kirsch = np.stack([by_mean, by_deviator], axis=1)
    stress, *_ = np.linalg.lstsq(kirsch, found, rcond=None)

    # The wall is a staircase of disks centred between a and a + D. The squares of those taken out have the area of a
    # circle of radius b: there ground begins that carries along the wall, as whole disks do. Across it carries from
    # their centres on, D/2 further. So the radius is b + D/4 within D/4 either way; displacements go with its square
    removed = len(settled.before.start.displacement[0]) - scene.count
    carried = np.sqrt(removed / np.pi) * lab.diameter + 0.25 * lab.diameter
    rough = 0.5 / DISKS
    stress /= (carried / a) ** 2
    # The plate is finite and gives way more than an infinite body, but less than a disk of radius b, half its width:
    # with ε = (a/b)², that one's exact excess (Lamé) is 2ε/(1 − ε) for the mean stress. For the deviator, Kirsch's
    # solution lacks 4ε s of traction at b. This uniform field again, 4ε/(1 − 4ε) with what it lacks in turn, moves the
    # wall by 4as/2G, the excavation by 3as/2G
    share = (2.0 / WIDTH) ** 2
    soft = 2.0 * share / (1.0 - share), 4.0 / 3.0 * 4.0 * share / (1.0 - 4.0 * share)
    for fitted, given, excess in zip(stress, (MEAN, DEVIATOR), soft, strict=True):
        assert -rough < fitted / given - 1.0 < rough + excess
    # single disks of the staircase stand D/2 before or behind such a circle
    assert np.abs(found - (carried / a) ** 2 * kirsch @ stress).max() < np.abs(found).max() / DISKS
