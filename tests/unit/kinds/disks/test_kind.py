"""Bonded disks as a kind of body, for runs, checks and reports."""

import json

import h5py
import meshio
import numpy as np
import pytest
import pyvista

from dembound.continuum.axis import Around
from dembound.continuum.mesh import Mesh
from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.kinds.disks.kind import Disks
from dembound.kinds.disks.mesh import continuum_mesh
from dembound.kinds.disks.summary import asked_stress, describe_static, disk_outcome, summarise_disks
from dembound.motion.simulation import Simulation
from dembound.results.vtk import write_paraview
from dembound.running import plan, preflight

HANGING = {
    "wave.pulse.start": 1.0,
    "boundary.left": {"type": "fixed"},
    "boundary.right": {"type": "free"},
    "load": [{"name": "weight", "acceleration": [9.81, 0.0]}],
    "static": {"ratio": 1e-6, "boundary": {"left": {"type": "fixed"}}},
}
"""The bar hangs from its left end."""

NICHE = {"name": "niche", "type": "rectangle", "corners": [1.0, 0.5, 2.0, 1.1], "stage": "after"}
"""Two disks of the upper row."""


def test_the_stage_before_an_excavation_is_reported_for_the_disks_that_are_left(bar) -> None:
    weak = {"material.law": "linearpbond", "material.pb_ten": 0.3 * 19 * 625.0 * 9.81 / 0.5}
    held = {"boundary.right": {"type": "fixed"}, "static.boundary.right": {"type": "fixed"}}
    case = bar({**HANGING, **held, **weak, "hole": [NICHE]})
    scene = Disks().build(case)
    beginning = Disks().begin(scene, 1e-4, lambda *look: None)
    settled = settle(Disks().build(case))

    before, last = beginning.stages
    assert (before.name, last.name) == ("static/before", "static")
    assert len(scene.kept) == scene.count == 38
    assert before.displacement.shape == last.displacement.shape == (3, 38)
    assert np.array_equal(before.displacement, settled.before.start.displacement[:, scene.kept])
    assert before.facts["steps"] == settled.before.steps == beginning.summary["before"]["steps"]
    # all that broke is counted, and that between disks which are left is kept
    assert before.facts["cracks"] == len(settled.before.cracks) > 0
    left = np.isin(settled.before.cracks.pair, scene.kept).all(axis=1)
    assert np.array_equal(scene.kept[before.cracks.pair], settled.before.cracks.pair[left])
    assert np.array_equal(before.cracks.position, settled.before.cracks.position[left])


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"run.time_step": 5e-3}, "run.time_step"),
        ({"material": {"density": 2500.0, "emod": 1e9, "pb_emod": 0.0}}, "material"),
        ({"load": [{"name": "a", "force": [1.0, 0.0], "region": [3.01, 0.3, 3.02, 0.31]}]}, "no particle is centred"),
    ],
)
def test_what_would_stop_a_run_is_found_before_it(bar, changes: dict, said: str) -> None:
    with pytest.raises(CaseError, match=said):
        preflight(bar(changes))
    preflight(bar())


def test_the_static_stage_is_reported(bar) -> None:
    weight = {"name": "weight", "acceleration": [9.81, 0.0]}
    case = bar({"load": [weight], "static": {"ratio": 1e-6, "boundary": {"left": {"type": "fixed"}}}})
    scene = build(case)
    found = json.loads(json.dumps(describe_static(settle(scene), asked_stress(scene)), allow_nan=False))

    named = "steps ratio mean_reaction mean_residual stress asked uniformity elastic cracks before column right_column"
    assert set(found) == set(named.split())
    assert found["before"] is found["column"] is found["right_column"] is found["asked"] is found["uniformity"] is None
    assert found["elastic"]
    assert found["ratio"] <= 1e-6
    assert found["mean_residual"] < 1e-4 * found["mean_reaction"]
    # 20 disks in a row: contacts bear 1 to 19 weights, and those of the middle 6 m of 10 m 10 on the mean
    assert found["stress"][0] == pytest.approx(10.0 * 625.0 * 9.81 / 0.5, rel=1e-3)
    assert found["mean_reaction"] == pytest.approx(20 * 625.0 * 9.81, rel=1e-4)
    assert asked_stress(build(bar({"static": {"stress": [-1e6, -2e6, 0.5e6]}}))) == [-1e6, -2e6, 0.5e6]


@pytest.mark.parametrize("law", ["elastic", "linearpbond"])
def test_the_summary_of_disks_is_plain_json(bar, law: str) -> None:
    planned = plan(bar({"material.law": law}))
    simulation = Simulation(planned.scene, planned.time_step)
    simulation.advance(60)
    found = json.loads(json.dumps(summarise_disks(planned.scene, simulation), allow_nan=False))

    of_scene = {"particles", "has_history", "contacts", "loose_disks_left_out", "packing", "layers", "boundaries"}
    assert set(found) == of_scene | {"load_factor", "forces_at_rest", "far", "turns", "joints"}
    assert found["load_factor"] is None
    assert (found["particles"], found["contacts"], found["loose_disks_left_out"]) == (40, 2 * 19 + 20, 0)
    assert found["has_history"] == (law == "linearpbond")
    assert found["boundaries"]["right"]["peak_velocity"][0] > 0.4  # of a pulse of 0.5 m/s


def test_only_what_applies_is_reported() -> None:
    elastic = {"static": None, "has_history": False, "laws": [{"law": "elastic", "from": 0.0}]}
    elastic |= {"seconds": {"settle": 4.2}, "reduced": [], "not_reduced": [], "load_factor": None}
    quiet = {"has_history": True, "cracks": {"tension": 0, "shear": 0}, "energy": {"relative_error": 0.0}}
    settled = {"steps": 3100, "ratio": 9.84e-6, "cracks": 0, "elastic": True}
    settled |= dict.fromkeys(("before", "asked", "column"))
    steps = "3,100 steps, unbalanced force ratio 9.8e-06"
    stage, took = f"static stage: {steps}", "; 4.2 s"

    assert disk_outcome(elastic) == []
    said = "contacts slid or opened while the body settled, so that its rest is one of several: dembound estimate says"
    assert disk_outcome(elastic | {"static": settled | {"elastic": False}})[1].startswith(said)
    joints = {"static": settled | {"elastic": False}, "joints": {"fault": {}}}  # errors beside them are not predicted
    assert disk_outcome(elastic | joints | {"cracks": {"tension": 0, "shear": 0}})[1] == said.split(":")[0]
    first = {"factor": 1.25, "limit": "slides", "time": 0.5, "position": [3.0, 4.0], "particles": [1, 2]}
    assert disk_outcome(elastic | {"load_factor": first}) == [
        "the elastic law holds up to 1.25 times the waves, where the pair at (3, 4) m slides at t = 0.5 s"
    ]
    draw = ", one draw of many: see dembound estimate --repeat"
    broken = {"cracks": {"tension": 1200, "shear": 30}, "static": settled | {"cracks": 1100}}
    assert disk_outcome(elastic | quiet | broken) == [
        f"{stage}, breaking 1,100 bonds{took}",
        "elastic law all through",
        f"1,230 bonds broke in all (1,200 tension, 30 shear){draw}",
    ]
    at_rest = {"cracks": {"tension": 20, "shear": 4}, "static": settled | {"cracks": 24}}
    assert disk_outcome(elastic | quiet | at_rest)[::2] == [
        f"{stage}, breaking 24 bonds{took}",
        "bonds broke only in the static stage (20 tension, 4 shear)",
    ]
    even = {"block": [5.0, 6.25], "deviation": 0.0123, "packing": 1e-6, "beyond": 0.0123, "near_holes": None}
    pressed = settled | {"asked": [-1e6, -2e6, 0.0], "stress": [-0.5e6, -2e6, 1e-3], "uniformity": even}
    reached = f"{stage}, stress (-0.5, -2, 0) of (-1, -2, 0) MPa requested, within 1.2 % in blocks of"
    assert disk_outcome(elastic | {"static": pressed}) == [f"{reached} 5 m × 6.25 m{took}"]
    excavated = {"static": settled | {"steps": 900, "before": settled}}
    assert disk_outcome(elastic | excavated) == [
        f"static stage before the excavation: {steps}",
        f"static stage after the excavation: 900 steps, unbalanced force ratio 9.8e-06{took} for all stages",
    ]


def expected(file: h5py.File, number: str) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Points and point data of a snapshot, written out column by column, and rounded to single precision."""
    particles, snapshot = file["particles"], file["snapshots"][number]
    displacement, velocity = snapshot["displacement"][:], snapshot["velocity"][:]
    flat, moved, linear = (
        np.pad(each[:, :2], ((0, 0), (0, 1))) for each in (particles["position"][:], displacement, velocity)
    )
    data = {
        "radii": particles["radius"][:],
        "id": np.arange(len(velocity)),
        "linVelVec": linear,
        "angVelVec": velocity * [0.0, 0.0, 1.0],
        "speed": np.hypot(velocity[:, 0], velocity[:, 1]),
        "displacement": moved,
        "rotation": displacement[:, 2],
        "brick_particle": particles["brick_particle"][:],
        **dict.fromkeys(("column", "nbCracks", "damage"), np.zeros(len(velocity))),
    }
    return flat + moved, {name: values.astype(np.float32) for name, values in data.items()}


def test_meshio_and_vtk_read_back_what_the_record_holds(small_run, tmp_path):
    """Places in double and fields in single precision, one vertex per disk."""
    write_paraview(small_run, tmp_path, Disks())
    mesh, of_vtk = meshio.read(tmp_path / "particles_0001.vtu"), pyvista.read(tmp_path / "particles_0001.vtu")
    with h5py.File(small_run) as file:
        points, data = expected(file, "0001")
    assert all(np.abs(data[name]).max() > 0.0 for name in ("linVelVec", "angVelVec", "displacement", "rotation"))
    assert set(of_vtk.celltypes) == {pyvista.CellType.VERTEX}
    assert mesh.point_data.keys() == data.keys()
    for name, values in data.items():
        for found in (mesh, of_vtk):
            np.testing.assert_array_equal(found.points, points)
            np.testing.assert_array_equal(found.point_data[name], values, err_msg=name)


def test_cracks_and_damage_are_counted_up_to_each_snapshot(cracked_run, tmp_path):
    write_paraview(cracked_run, tmp_path, Disks())
    with h5py.File(cracked_run) as file:
        bonds, cracks = file["particles/bonds"][:], {name: values[:] for name, values in file["cracks"].items()}
        for number, snapshot in file["snapshots"].items():
            data = meshio.read(tmp_path / f"particles_{number}.vtu").point_data
            counted = np.zeros(len(bonds), dtype=int)
            for time, pair in zip(cracks["time"], cracks["particles"], strict=True):
                counted[pair] += time <= snapshot.attrs["time"]
            np.testing.assert_array_equal(data["nbCracks"], counted)
            np.testing.assert_array_equal(data["damage"], (counted / bonds).astype(np.float32))
            np.testing.assert_array_equal(data["coordNumber"], snapshot["coordination"][:])
        broken = [np.count_nonzero(cracks["time"] <= each.attrs["time"]) for each in file["snapshots"].values()]
    assert 0 < broken[0] < broken[1] == len(cracks["time"])


def test_contacts_are_lines_between_the_centres_of_their_disks(cracked_run, tmp_path):
    write_paraview(cracked_run, tmp_path, Disks())
    with h5py.File(cracked_run) as file:
        for number, snapshot in file["snapshots"].items():
            mesh = pyvista.read(tmp_path / f"contacts_{number}.vtu")
            disks = pyvista.read(tmp_path / f"particles_{number}.vtu")
            contacts = {name: values[:] for name, values in snapshot["contacts"].items()}
            ends = mesh.points.reshape(-1, 2, 3)
            first, second = contacts["particles"].T
            assert set(mesh.celltypes) == {pyvista.CellType.LINE}
            # places of up to 10 m
            np.testing.assert_array_equal(ends[:, 0], disks.points[first])
            np.testing.assert_allclose(ends[:, 1], disks.points[second], atol=1e-12)
            np.testing.assert_array_equal(mesh.cell_data["particles"], contacts["particles"])
            for name, column in (("normalForce", "normal_force"), ("shearForce", "shear_force")):
                np.testing.assert_array_equal(mesh.cell_data[name], contacts[column].astype(np.float32))
            np.testing.assert_array_equal(mesh.cell_data["bonded"], contacts["bonded"])


def test_vtk_reads_one_quadrilateral_per_cell(surrounded_run, tmp_path) -> None:
    write_paraview(surrounded_run, tmp_path, Disks())
    mesh = pyvista.read(tmp_path / "continuum_0001.vtu")
    with h5py.File(surrounded_run) as file:
        columns = {name: values[:] for name, values in file["continuum"].items()}
        fields = {name: values[:] for name, values in file["snapshots/0001/continuum"].items()}
    velocity, tensor = fields["velocity"], np.zeros((len(fields["velocity"]), 6))
    tensor[:, 0], tensor[:, 1], tensor[:, 3] = fields["stress"].T  # VTK's order: xx, yy, zz, xy, yz, xz
    points, linear, shift = (
        np.pad(each[:, :2], ((0, 0), (0, 1))) for each in (columns["position"], velocity, fields["displacement"])
    )
    data = {
        "linVelVec": linear,
        "speed": np.hypot(velocity[:, 0], velocity[:, 1]),
        "displacement": shift,
        "stress": tensor,
        "absorbs": columns["absorbs"],
        "peakVelocity": columns["peak_velocity"],
    }
    assert set(mesh.celltypes) == {pyvista.CellType.QUAD}
    np.testing.assert_array_equal(mesh.cell_connectivity.reshape(-1, 4), columns["cell"])
    np.testing.assert_array_equal(mesh.points, points + shift)
    assert mesh.point_data.keys() == list(data)
    for name, values in data.items():
        np.testing.assert_array_equal(mesh.point_data[name], values.astype(np.float32), err_msg=name)


@pytest.mark.parametrize(("axis", "columns"), [(0, 1), (1, 3)])
def test_the_last_cells_of_a_periodic_continuum_reach_its_first_nodes(axis: int, columns: int) -> None:
    """The first nodes are repeated a period on, with all their data, so that no gap is left."""
    along = (columns, 4) if axis == 0 else (4, columns)
    layer = Around(bottom=2) if axis == 0 else Around(left=2)
    ring = {"origin": (1.0, -2.0), "layer": layer, "periodic": (axis == 0, axis == 1)}
    mesh = Mesh.uniform(order=3, element=(2.0, 1.5), cells=along, **ring)
    data = {"position": mesh.positions, "cell": mesh.node_cells, "element": mesh.rectangles, "node": mesh.nodes}
    data["absorbs"] = np.any(mesh.depth > 0.0, axis=1)
    rng = np.random.default_rng(0)
    moved = {name: rng.normal(size=(mesh.count, 3)) for name in ("displacement", "velocity", "stress")}
    moved["displacement"] *= 1e-9
    made = continuum_mesh(*({f"continuum/{name}": each for name, each in of.items()} for of in (data, moved)))

    first = np.flatnonzero(mesh.positions[:, axis] < mesh.origin[axis] + 1e-9)
    repeated = made.points[mesh.count :, :2]
    shift = np.zeros(2)
    shift[axis] = mesh.size[axis]
    np.testing.assert_allclose(repeated, mesh.positions[first] + shift, rtol=0.0, atol=1e-8)
    for name, values in made.point_data.items():
        np.testing.assert_array_equal(values[mesh.count :], values[first], err_msg=name)
