"""What is printed, warned of, recorded and drawn of ground in layers."""

import re

import h5py
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection
from small_cases import GRAINS, small
from warned_cases import warned

from dembound import api
from dembound.disks.material.packing_waves import front_of
from dembound.disks.scene import build
from dembound.disks.sources import sources_of
from dembound.disks.stability import step_limit
from dembound.disks.supports import forces_of
from dembound.formulas.disks.coarse_grid import Grid, undisturbed
from dembound.kinds.disks.facts import disk_facts
from dembound.kinds.disks.kind import Disks
from dembound.kinds.disks.summary import describe_layers, describe_side
from dembound.kinds.disks.wave_warnings import strong_waves
from dembound.plot.scene import plot_scene
from dembound.results.vtk import write_paraview

LAYERS = [
    {"name": "clay", "thickness": 5.0, "density": 1800.0, "p_wave_speed": 400.0},
    {"name": "sand", "thickness": 6.0, "p_wave_speed": 700.0},
    {"name": "rock", "density": 2300.0, "p_wave_speed": 1400.0},
]
SOIL = {
    "packing": {"pattern": "A", "size": [8.0, 20.0], "radius": 0.25, "origin": [0.0, -20.0]},
    "material": {"density": 2000.0, "p_wave_speed": 1000.0},
    "layer": LAYERS,
    "boundary": {"left": {"type": "viscous"}, "bottom": {"type": "viscous_input", "wave_s": "pulse"}},
    "wave": {"pulse": {"type": "cosine", "amplitude": 0.1, "period": 0.1}},
    "monitor": [{"name": "surface", "position": [4.0, 0.0]}],
    "run": {"duration": 0.3},
}
"""A lattice, on which S waves have half the speed of P waves; its surface is at y = 0."""


def soil(**changes):
    return small(SOIL, "soil", {key.replace("__", "."): value for key, value in changes.items()})


def test_each_layer_has_its_heights_speeds_and_disks_in_a_wavelength() -> None:
    scene = build(soil())
    facts = dict(disk_facts(scene))
    highest = scene.case.wave["pulse"].highest_frequency()
    assert facts["layer clay"].startswith("y = 0 to -5 m, 1800 kg/m³, c_p = 400 m/s, c_s = 200 m/s, ")
    for name, speed in (("clay", 200.0), ("sand", 350.0), ("rock", 700.0)):
        assert f", {speed / highest / 0.5:.0f} particles per wavelength at " in facts[f"layer {name}"]
    assert facts["wave pulse"].startswith(f"{200.0 / highest / 0.5:.0f} particles per shortest wavelength")  # in clay
    assert "wave speeds" not in facts
    # on a lattice mass and P stiffness change on the plane, and S stiffness .02 to .06 D above it
    text = r"; as packed above that by 0 m for the mass, 0 m for P waves, ([\d.]+) mm for S waves; corrected"
    (above,) = re.findall(text, facts["joint clay/sand"])
    assert 10.0 < float(above) < 30.0
    assert describe_layers(scene)[0]["joint"]["s"] == pytest.approx(1e-3 * float(above), rel=0.01)
    assert [layer["bottom"] for layer in describe_layers(scene)] == [-5.0, -11.0, -20.0]
    assert facts["layer rock"].startswith("y = -11 to -20 m and on below, ")
    above = build(soil(boundary__bottom={"type": "fixed"}, wave={}))
    assert dict(disk_facts(above))["layer rock"].startswith("y = -11 to -20 m, ")


def test_waves_start_in_the_lowest_layer_and_are_as_fast_as_in_the_fastest() -> None:
    scene = build(soil())
    assert strong_waves(scene)["pulse"].startswith("322 kPa, ")  # 2300 · 1400 · 0.1
    assert front_of(scene.ground, 0.9).speed >= 1400.0
    assert [source.slowest for source in sources_of(scene.case, scene.ground)] == pytest.approx([200.0])
    law = {"law": "linearpbond", "fric": 0.5, "contact_share": 0.9}  # loose disks limit the step
    stiff = step_limit(build(small({**SOIL, "layer": LAYERS[2:]}, changes={f"material.{k}": law[k] for k in law})))
    limit = step_limit(build(soil(**{f"material__{key}": value for key, value in law.items()})))
    assert limit == pytest.approx(stiff, rel=0.01)


def test_mistakes_name_the_layer_that_has_them_and_the_side_beside_it() -> None:
    """S waves of rock are given as 300 m/s, and have 700; of all others as nothing."""
    rock = {"name": "rock", "density": 2300.0, "emod": 2.254e9, "pb_emod": 2.254e9, "s_wave_speed": 300.0}
    layers = [*LAYERS[:2], rock]
    lines = warned(soil(layer=layers, boundary__left={"type": "viscous", "beta_s": 1.0}))
    given = "layer.rock.s_wave_speed: is 300 m/s, S waves along y run at 700 m/s"
    assert len([line for line in lines if line.startswith(given)]) == 1
    (side,) = [line for line in lines if "beta_s is 1" in line]
    assert side.startswith("boundary.left (beside rock): sends back 40 % of the amplitude of S waves")
    assert "matched would be 2.33" in side
    moduli = {"density": 2000.0, "emod": 1e9, "pb_emod": 1e9, "s_wave_speed": 300.0}
    inherited = warned(soil(material=moduli, layer=[{"thickness": 5.0, "density": 5500.0}, {"name": "b"}]))
    assert len([line for line in inherited if line.startswith("material.s_wave_speed: is 300 m/s")]) == 1


def test_a_side_has_factors_by_layer() -> None:
    """Those of random disks differ, as the sums of their diameters do."""
    packing = GRAINS["packing"] | {"size": [8.0, 20.0], "origin": [0.0, -20.0]}
    scene = build(soil(packing=packing))
    layers = describe_side(scene, "left")["layers"]
    assert [layer["layer"] for layer in layers] == ["rock", "sand", "clay"]
    positions, diameters = scene.edges["left"].positions, scene.edges["left"].diameters
    own = positions[:, 1] > -5.0
    nominal = LAYERS[0]["p_wave_speed"]
    speed = scene.ground.at(-1.0).wave_speeds(0)[0]
    assert layers[2]["beta_p"] == pytest.approx(speed / nominal * 5.0 / diameters[own].sum(), rel=1e-9)
    assert f"β_P = {layers[2]['beta_p']:g} (matched), " in dict(disk_facts(scene))["left side"].split(" beside clay")[0]


def test_ground_beside_sides_is_in_layers() -> None:
    """A short wave passes two joints with 2Z₁/(Z₁ + Z₂) of its amplitude each, and the surface doubles it."""
    grid = Grid.of(build(soil(wave__pulse__period=0.02)), 1)
    step = grid.time_step
    times = step * np.arange(int(0.09 / step))  # before anything comes back from a joint
    incoming = np.zeros((len(times), 2))
    incoming[:, 0] = np.where(times < 0.02, 0.5 - 0.5 * np.cos(100.0 * np.pi * times), 0.0)
    moved = undisturbed(grid, "bottom", incoming, np.zeros_like(incoming), step)
    rock, sand, clay = 2300.0 * 700.0, 2000.0 * 350.0, 1800.0 * 200.0
    expected = 2.0 * (2.0 * rock / (rock + sand)) * (2.0 * sand / (sand + clay))
    assert moved.v[:, -1, 0].max() == pytest.approx(expected, rel=0.02)


def test_a_pressure_on_bonds_is_that_of_the_layer() -> None:
    hole = {"name": "h", "type": "circle", "centre": [4.0, -11.0], "radius": 2.3}
    load = {"name": "p", "pressure": 1e5, "hole": "h", "on": "bonds"}
    packing = GRAINS["packing"] | {"size": [8.0, 20.0], "origin": [0.0, -20.0]}
    layers = [*LAYERS[:2], LAYERS[2] | {"kratio": 4.0, "pb_kratio": 4.0}]
    case = soil(packing=packing, hole=[hole], load=[load], layer=layers)
    scene = build(case)
    nodes, forces = forces_of(case.load[0], scene)
    above = scene.positions[nodes, 1] > -11.0
    for height, chosen in ((-10.0, above), (-12.0, ~above)):
        alone = build(case.uniform_at(height))
        same, own = forces_of(case.load[0], alone)
        np.testing.assert_array_equal(same, nodes)
        np.testing.assert_allclose(forces[chosen], own[chosen], rtol=1e-9, atol=1e-6)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The record of a run."""
    case = soil(run__duration=0.01, output={"pictures": False, "snapshots": 2})
    return api.run(case, tmp_path_factory.mktemp("soil"), threads=1).folder / "run.h5"


def test_disks_have_their_layer_in_the_record_in_pictures_and_for_paraview(run, tmp_path) -> None:
    import meshio

    with h5py.File(run) as file:
        heights, layer = file["particles/position"][:, 1], file["particles/layer"][:]
    np.testing.assert_array_equal(layer, np.digitize(-heights, [5.0, 11.0]) + 1)
    write_paraview(run, tmp_path / "paraview", Disks())
    mesh = meshio.read(tmp_path / "paraview" / "particles_0001.vtu")
    np.testing.assert_array_equal(mesh.point_data["layer"], layer)

    panel, bar = plot_scene(run, field="layer").axes
    (disks,) = [each for each in panel.collections if isinstance(each, EllipseCollection)]
    np.testing.assert_array_equal(disks.get_array(), layer)
    assert bar.get_ylabel() == "layer (1 at the surface)"
    panel, _ = plot_scene(run).axes
    assert {float(line.get_ydata()[0]) for line in panel.lines} == {-5.0, -11.0}
    names = {text.get_text(): text.xy[1] for text in panel.texts if text.get_text() in ("clay", "sand", "rock")}
    assert names == {"clay": pytest.approx(0.0), "sand": -5.0, "rock": -11.0}
