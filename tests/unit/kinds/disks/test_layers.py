"""What is printed, warned of, recorded and drawn of ground in layers."""

import re

import h5py
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection
from small_cases import small

from dembound import api
from dembound.check import check
from dembound.disks.scene import build
from dembound.kinds.disks.facts import disk_facts
from dembound.kinds.disks.kind import Disks
from dembound.kinds.disks.summary import describe_layers
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


def test_layers_that_differ_left_and_right_have_their_side(tmp_path) -> None:
    import meshio

    sided = [LAYERS[0] | {"side": "left"}, LAYERS[1] | {"thickness": 7.0, "side": "right"}, LAYERS[2]]
    tables = {"layer": sided, "ground.meet": 4.0, "output": {"pictures": False, "snapshots": 2}, "run.duration": 0.01}
    case = soil(
        **tables
        | {"boundary.left": {"type": "outside"}, "boundary.right": {"type": "outside"}}
        | {"boundary.bottom": {"type": "outside", "wave_s": "pulse"}}
    )
    scene = build(case)
    facts = dict(disk_facts(scene))
    assert facts["layer clay, left"].startswith("y = 0 to -5 m, 1800 kg/m³, c_p = 400 m/s, ")
    assert facts["layer rock, left"].startswith("y = -5 to -20 m and on below, ")
    assert facts["layer sand, right"].startswith("y = 0 to -7 m, ")
    assert facts["joint sand/rock, right"].startswith("y = -7 m; ")
    assert facts["layers"] == "those of the left side and of the right one meet at x = 4 m"
    assert "left of x = 4 m, where the layers meet," in facts["free field"]
    assert [(each["name"], each["side"]) for each in describe_layers(scene)][::2] == [
        ("clay", "left"),
        ("sand", "right"),
    ]
    assert check(case)[0]["errors"].startswith("not predicted: ground.meet: errors are not predicted where the layers")

    found = api.run(case, tmp_path, threads=1).folder
    with h5py.File(found / "run.h5") as file:
        (x, y), layer = file["particles/position"][:].T, file["particles/layer"][:]
    np.testing.assert_array_equal(layer, np.where(x < 4.0, np.where(y > -5.0, 1, 3), np.where(y > -7.0, 2, 3)))
    write_paraview(found / "run.h5", tmp_path / "paraview", Disks())
    mesh = meshio.read(tmp_path / "paraview" / "particles_0001.vtu")
    np.testing.assert_array_equal(mesh.point_data["layer"], layer)
    panel, _ = plot_scene(found / "run.h5").axes
    ends = {tuple(np.ravel(line.get_data()).round(6).tolist()) for line in panel.lines}
    across = {(x1, y1) for _, x1, y1, y2 in ends if y1 == y2 == -5.0} | {
        (x0, y1) for x0, _, y1, y2 in ends if y1 == y2 == -7.0
    }
    assert across == {(4.0, -5.0), (4.0, -7.0)}  # joints end and begin there
    assert any(x0 == x1 == 4.0 and y0 == -7.0 for x0, x1, y0, _ in ends)
