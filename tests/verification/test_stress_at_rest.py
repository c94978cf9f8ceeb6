"""Contacts that begin with the forces of a stress at rest: body, columns and continuum rest together under it.

The forces are those of the endless packing (homogenise.py), so under a uniform stress nothing has to move, whatever is
beyond the sides. Under weight with K0 they are scaled by height, which leaves each disk .3 of its weight to settle.
"""

import numpy as np
import pytest

from dembound.disks.rest.settled import Settled
from dembound.disks.rest.stage import settle
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.disks.stepping.load_factor import LoadFactor
from dembound.kinds import with_changes
from dembound.kinds.disks.side_warnings import load_warnings

STRESS = [-2e6, -3e6, 0.5e6]
WEIGHT = [{"acceleration": (0.0, -9.81)}]
K0 = {"k0": 0.5, "boundary": {"bottom": {"type": "fixed"}}}
STRONG = {"law": "linearpbond", "fric": 0.5, "pb_ten": 1e12, "pb_coh": 1e12}
REFERENCE = STRONG | {"geometry": "reference", "fric": 50.0}
PULSE = {"type": "cosine", "amplitude": 0.02, "period": 0.02}
SIDES = {
    "column": {"left": "free_field", "right": "free_field", "bottom": {"type": "viscous_input", "wave_s": "pulse"}},
    "continuum": {**dict.fromkeys(("left", "right"), "outside"), "bottom": {"type": "outside", "wave_s": "pulse"}},
    "wrapped": {"left": "periodic", "right": "periodic", "bottom": {"type": "viscous_input", "wave_s": "pulse"}},
}
BONDED, DAMPED = STRONG | {"pb_ten": 1e6, "pb_coh": 2e6}, {"quality_factor": 20.0}
HOLE = {"name": "tunnel", "type": "circle", "centre": [10.0, 10.0], "radius": 2.0, "stage": "after"}


def ground(lab, pattern: str, sides, material=None, *, hole=False, size=(20.0, 20.0), **words) -> DiskScene:
    """The scene of a body beside some sides; elements are so small that they change nothing."""
    material = {"fric": 0.5} | (material or {})
    case = lab.case(pattern, size, held=(), material=material, boundary=sides, **words)
    element = {"outside.element": 5.0} if case.outside_sides else {}
    return build(with_changes(case, element | ({"hole": [HOLE]} if hole else {})))


def silent(name: str) -> dict[str, str]:
    """Sides of `SIDES` without a wave."""
    return SIDES[name] | {"bottom": "outside" if name == "continuum" else "viscous"}


def speed(lab, scene: DiskScene, found: Settled, steps: int = 500) -> float:
    """Largest speed (m/s) in a run from rest without waves."""
    simulation = lab.simulation(scene, found.start)
    simulation.run(steps)
    return float(np.abs(simulation.state.velocity).max())


@pytest.mark.parametrize("law", [pytest.param("elastic", marks=pytest.mark.slow), "linearpbond"])
@pytest.mark.parametrize("name", SIDES)
def test_a_stress_is_there_from_the_start(lab, name: str, law: str) -> None:
    """On the lattice to rounding: ε of a stress, over the forces of some ten contacts in sums of a block's 400."""
    top = {"top": "outside"} if name == "continuum" else {}
    scene = ground(lab, "A", silent(name) | top, {} if law == "elastic" else STRONG, static={"stress": STRESS})
    found = settle(scene)
    assert np.abs(found.start.displacement).max() < 1e-12
    assert found.uniformity.deviation < 1e-12
    np.testing.assert_allclose(found.stress, STRESS, rtol=1e-12)
    assert speed(lab, scene, found) < 1e-9


@pytest.mark.parametrize(
    ("geometry", "name"),
    [
        *(("updated", name) for name in ("column", "wrapped")),
        ("reference", "column"),
        pytest.param("updated", "continuum", marks=pytest.mark.slow),
        *(pytest.param("reference", name, marks=pytest.mark.slow) for name in ("continuum", "wrapped")),
    ],
)
def test_contacts_that_slide_under_a_stress_begin_with_what_they_bear(lab, name: str, geometry: str) -> None:
    """Random disks, of whose contacts half slide: the stress is that of their endless packing, and nothing moves."""
    material = STRONG | {"fric": 0.3, "geometry": geometry}
    scene = ground(lab, "B", silent(name), material, hole=name == "continuum", static={"stress": [-5e6, -9e6, 2e6]})
    found = settle(scene)
    whole = found.before or found
    assert np.abs(whole.start.displacement).max() < 1e-15
    assert whole.uniformity.beyond < 1e-12
    np.testing.assert_allclose(whole.stress, [-5e6, -9e6, 2e6], atol=0.1e6)  # in the blocks of a random packing
    slip = whole.start.contacts["body"].of("slip")
    assert 0.3 < np.count_nonzero(slip) / len(slip) < 0.6
    assert speed(lab, scene, found) < 1e-9


def test_friction_alone_may_not_bear_a_stress(lab) -> None:
    """A lattice without bonds bears shear up to its friction."""
    for shear, borne in ((0.2e6, True), (0.4e6, False)):
        material = {"law": "linearpbond", "fric": 0.3, "contact_share": 1.0}
        scene = ground(lab, "A", silent("wrapped"), material, static={"stress": [-1e6, -1e6, shear]})
        assert scene.at_rest.is_borne == borne
        warned = any(line.startswith("static.stress") for line in load_warnings(scene))
        assert warned != borne


@pytest.mark.parametrize(
    ("name", "material"),
    [
        *(("column", {}), ("continuum", REFERENCE)),
        *(pytest.param(*each, marks=pytest.mark.slow) for each in (("column", REFERENCE), ("continuum", {}))),
    ],
)
def test_a_wave_passes_as_through_ground_without_stress(lab, name: str, material) -> None:
    """As long as nothing opens or slides stresses add up; the motion is the same to rounding, over 400 steps."""
    plain = ground(lab, "B", SIDES[name], {"fric": 0.5}, wave=PULSE)
    under = ground(lab, "B", SIDES[name], material, wave=PULSE, static={"stress": STRESS} | K0, load=WEIGHT)
    step = choose_step(under)[0]
    moving = lab.simulation(plain, step=step), lab.simulation(under, settle(under).start, step)
    ledger = lab.ledger(moving[1], 20)
    for simulation in moving:
        simulation.run(400)
    (alone, stressed) = (simulation.state.velocity for simulation in moving)
    assert np.abs(stressed - alone).max() < 400 * 1e-12 * np.abs(alone).max()
    assert max(abs(entry.error) for entry in ledger.entries) < 1e-9 * max(abs(each.outside) for each in ledger.entries)


@pytest.mark.parametrize("name", SIDES)
@pytest.mark.parametrize("law", ["elastic", pytest.param("linearpbond", marks=pytest.mark.slow)])
def test_k0_stays_what_it_is_given_as(lab, name: str, law: str) -> None:
    """Random disks: 0.02 in inner bricks, 0.06 in the top one, where .3 of a disk's weight is a part of all stress."""
    material = {} if law == "elastic" else STRONG
    scene = ground(lab, "B", silent(name), material, size=(20.0, 30.0), static=K0, load=WEIGHT)
    found = settle(scene)
    simulation = lab.simulation(scene, found.start)
    stress = simulation.system.stress(simulation.state.displacement)[scene.column_count :]
    places, area = scene.assembly.positions[scene.column_count : scene.disk_count], scene.assembly.radii**2
    for brick, allowed in ((0, 0.02), (1, 0.02), (2, 0.06)):
        inside = (np.abs(places[:, 0] - 10.0) < 8.0) & (places[:, 1] // 10.0 == brick)
        xx, yy, _ = area[scene.column_count :][inside] @ stress[inside]
        assert abs(xx / yy - 0.5) < allowed
    # half a disk of 60 more or less carries, above the mean height
    assert abs(found.stress[1] / (-lab.density * 9.81 * 15.0) - 1.0) < 0.5 / 30.0
    assert speed(lab, scene, found) < 1e-9


@pytest.mark.parametrize("law", ["elastic", pytest.param("linearpbond", marks=pytest.mark.slow)])
def test_each_layer_has_its_own_k0(lab, law: str) -> None:
    """On the lattice, whose disks bear all their weight, it is exact where contacts on all sides are of one layer."""
    layers = [{"thickness": 10.0, "density": 1800.0, "p_wave_speed": 400.0, "k0": 0.8}, {"density": 2300.0}]
    case = lab.case(
        "A",
        (10.0, 20.0),
        held=(),
        material={"law": law, "fric": 0.5},
        boundary={"left": "periodic", "right": "periodic", "bottom": "viscous"},
        static=K0,
        load=WEIGHT,
    )
    scene = build(with_changes(case, {"layer": layers}))
    found = settle(scene)
    simulation = lab.simulation(scene, found.start)
    xx, yy, _ = simulation.system.stress(simulation.state.displacement).T
    height = scene.assembly.positions[:, 1]
    weight = -9.81 * (1800.0 * np.minimum(20.0 - height, 10.0) + 2300.0 * np.maximum(10.0 - height, 0.0))
    inner = (height > 1.0) & (height < 19.0) & (np.abs(height - 10.0) > 3.0)  # nor of corrected springs
    np.testing.assert_allclose(yy[inner], weight[inner], rtol=1e-9)
    np.testing.assert_allclose((xx / yy)[inner], np.where(height > 10.0, 0.8, 0.5)[inner], rtol=1e-9)
    assert speed(lab, scene, found) < 1e-9


@pytest.mark.parametrize(
    ("name", "material"),
    [
        # nothing else in CI compiles their kernels
        pytest.param(name, material, marks=pytest.mark.slow)
        for material in (DAMPED, BONDED)
        for name in SIDES
    ],
)
def test_layers_under_k0_a_hole_and_a_wave_go_together(lab, hold_in_order, name: str, material) -> None:
    """Each layer keeps its K0 and has its strengths; the ground rests with a hole, and a wave passes from below."""
    layers = [
        {"thickness": 10.0, "density": 1800.0, "p_wave_speed": 400.0, "k0": 0.8},
        {"thickness": 10.0, "density": 2200.0, "p_wave_speed": 700.0, "k0": 0.6},
        {"density": 2300.0},
    ]
    bonded = "law" in material
    if bonded:
        hold_in_order()
    layers[0] |= {"pb_ten": 2e5, "pb_coh": 4e5, "fric": 0.4} if bonded else {}
    silence = ground(lab, "A", silent(name), material, hole=True, size=(20.0, 30.0), static=K0, load=WEIGHT)
    layered = build(with_changes(silence.case, {"layer": layers}))
    found = settle(layered)
    before = lab.simulation(layered.before, found.before.start)
    xx, yy, _ = before.system.stress(before.state.displacement)[layered.before.column_count :].T
    x, height = layered.before.assembly.positions[layered.before.column_count : layered.before.disk_count].T
    for number, ratio in enumerate((0.5, 0.6, 0.8)):
        inner = (np.abs(height - 10.0 * number - 5.0) < 2.0) & (np.abs(x - 10.0) < 8.0)
        assert xx[: len(height)][inner].sum() / yy[: len(height)][inner].sum() == pytest.approx(ratio, abs=1e-3)
    assert speed(lab, layered, found) < 1e-9
    moved = build(with_changes(layered.case, {"boundary.bottom": SIDES[name]["bottom"], "wave": {"pulse": PULSE}}))
    simulation = lab.simulation(moved, found.start)
    ledger = lab.ledger(simulation, 20)
    simulation.run(400)
    assert np.abs(simulation.state.velocity).max() > 0.5 * PULSE["amplitude"]
    most = max(abs(each.outside) for each in ledger.entries)
    assert max(abs(entry.error) for entry in ledger.entries) < (1e-4 if bonded else 1e-9) * most


@pytest.mark.parametrize("name", [n if n == "column" else pytest.param(n, marks=pytest.mark.slow) for n in SIDES])
def test_layers_at_rest_begin_to_slide_at_their_load_factor(lab, hold_in_order, name: str) -> None:
    """Found under the elastic law; 0.1 % below it nothing slides in the geometry of the start, 0.1 % above it does."""
    hold_in_order()
    layers = [{"thickness": 10.0, "density": 1800.0, "p_wave_speed": 400.0, "k0": 0.8}, {"density": 2300.0, "k0": 0.6}]
    wave, static = PULSE | {"period": 0.05}, K0 | {"ratio": 1e-9}
    plain = ground(lab, "A", SIDES[name], {"fric": 0.9}, wave=wave, static=static, load=WEIGHT)
    elastic = build(with_changes(plain.case, {"layer": layers, "output.load_factor": True}))
    simulation = lab.simulation(elastic, settle(elastic).start)
    found = LoadFactor(elastic.case, simulation.system)
    simulation.track(found)
    simulation.run(400)
    for share in (0.999, 1.001):
        amplitude = {"wave.pulse.amplitude": share * found.factor * PULSE["amplitude"]}
        full = {"material.law": "linearpbond", "material.geometry": "reference", "layer": layers}
        scene = build(with_changes(plain.case, full | amplitude))
        other = lab.simulation(scene, settle(scene).start, simulation.time_step)
        other.run(400)
        slips = [part.contacts.of("slip") for part in other.system.disks.parts]
        assert any(slip.any() for slip in slips) == (share > 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("name", SIDES)
@pytest.mark.parametrize("static", [{"stress": STRESS}, K0])
def test_what_slides_or_is_excavated_comes_to_rest_and_stays(lab, name: str, static) -> None:
    """Unbonded and weakly bonded contacts beyond friction slide while settling; then a hole is made."""
    weak = {"law": "linearpbond", "fric": 0.5}
    scene = ground(lab, "B", silent(name), weak, hole=True, static=static, load=WEIGHT if "k0" in static else [])
    found = settle(scene)
    assert found.start.has_history
    assert speed(lab, scene, found) < 1e-9


@pytest.mark.parametrize(("radius", "allowed"), [(6.0, 0.04), pytest.param(24.0, 0.01, marks=pytest.mark.slow)])
def test_the_continuum_carries_what_an_excavation_sets_free(lab, radius: float, allowed: float) -> None:
    """Kirsch's stresses and displacements at two radii, in an infinite body, although disks end at three.

    radius : in disks. The carried radius is that of test_excavation.py; what is left is first order in D over it.
    """
    a, mean, deviator = radius * lab.diameter, -1.5e6, 0.5e6
    wide = 6.0 * a
    sides = dict.fromkeys(("left", "right", "bottom", "top"), "outside")
    static = {"stress": [mean + deviator, mean - deviator, 0.0], "ratio": 1e-6}
    case = lab.case("A", (wide, wide), held=(), material={"fric": 1.0}, boundary=sides, static=static)
    hole = HOLE | {"centre": [0.5 * wide] * 2, "radius": a}
    scene = build(with_changes(case, {"hole": [hole]}))
    found = settle(scene)
    disks = slice(scene.column_count, scene.disk_count)
    moved = (found.start.displacement[:, disks] - found.before.start.displacement[:, scene.kept[disks]])[:2]
    simulation = lab.simulation(scene, found.start)
    xx, yy, xy = simulation.system.stress(simulation.state.displacement)[disks].T
    x, y = (scene.assembly.positions[disks] - 0.5 * wide).T
    r, angle = np.hypot(x, y), np.arctan2(y, x)
    near = np.abs(r - 2.0 * a) < lab.diameter
    removed = scene.before.disk_count - scene.disk_count
    b = np.sqrt(removed / np.pi) * lab.diameter + 0.25 * lab.diameter
    k, cos, sin = (b / r[near]) ** 2, np.cos(2.0 * angle[near]), np.sin(2.0 * angle[near])
    c, s = np.cos(angle[near]), np.sin(angle[near])
    radial = c * c * xx[near] + s * s * yy[near] + 2.0 * c * s * xy[near]
    hoop = xx[near] + yy[near] - radial
    exact = (
        mean * (1.0 - k) + deviator * (1.0 - 4.0 * k + 3.0 * k * k) * cos,
        (mean * (1.0 + k) - deviator * (1.0 + 3.0 * k * k) * cos),
    )
    harmonics = np.column_stack([np.ones_like(cos), cos, sin, np.cos(4.0 * angle[near]), np.sin(4.0 * angle[near])])
    for own, kirsch in zip((radial, hoop), exact, strict=True):
        off, *_ = np.linalg.lstsq(harmonics, own - kirsch, rcond=None)
        assert np.abs(off).max() < allowed * 2e6
    out = c * moved[0, near] + s * moved[1, near]
    scale = b**2 / (lab.density * lab.speed**2 * r[near])  # 2G = ρc²
    off, *_ = np.linalg.lstsq(harmonics, out - scale * (mean + deviator * (4.0 - k) * cos), rcond=None)
    assert np.abs(off).max() < allowed * scale.mean() * 4.0 * deviator
