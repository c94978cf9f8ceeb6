"""The record of a run: what was kept comes back, and says whether it is whole."""

from pathlib import Path

import h5py
import numpy as np
import pytest

from dembound import __version__
from dembound.record import Recorder
from dembound.scene import build
from dembound.simulate import Simulation

STEP = 3e-4
MONITORS = {"monitor": [{"name": "front", "position": [0.0, 0.0]}, {"name": "back", "position": [9.9, 0.9]}]}


@pytest.fixture
def simulation(bar) -> Simulation:
    scene = build(bar(MONITORS))
    return Simulation(scene, STEP, np.array(list(scene.monitors.values())))


def recorder(path: Path, simulation: Simulation, interval: float = 0.0) -> Recorder:
    return Recorder(path, simulation, step_limit=4e-4, interval=interval)


def test_histories_come_back_as_they_were(tmp_path, simulation) -> None:
    with recorder(tmp_path / "run.h5", simulation) as kept:
        records = [simulation.advance(count) for count in (7, 12)]
        for record in records:
            kept.append(record)

    expected = np.concatenate(records)
    with h5py.File(tmp_path / "run.h5") as file:
        for index, (name, node) in enumerate(simulation.scene.monitors.items()):
            group = file["histories"][name]
            assert np.array_equal(group["time"], np.arange(19) * STEP)
            assert np.array_equal(group["displacement"], expected[:, index, :3])
            assert np.array_equal(group["velocity"], expected[:, index, 3:])
            assert group.attrs["particle"] == node
            assert np.array_equal(group.attrs["position"], simulation.scene.assembly.positions[node])
        assert file["histories/back"].attrs["wanted"].tolist() == [9.9, 0.9]


@pytest.mark.parametrize("blocks", [(19,), (7, 12), (1, 1, 5, 3, 9)])
def test_an_interval_keeps_every_nth_step_however_the_run_is_cut(tmp_path, simulation, blocks) -> None:
    with recorder(tmp_path / "run.h5", simulation, interval=4.2 * STEP) as kept:
        records = [simulation.advance(count) for count in blocks]
        for record in records:
            kept.append(record)

    with h5py.File(tmp_path / "run.h5") as file:
        assert np.array_equal(file["histories/front/time"], np.array([0, 4, 8, 12, 16]) * STEP)
        assert np.array_equal(file["histories/front/velocity"], np.concatenate(records)[::4, 0, 3:])


def test_an_interval_shorter_than_a_step_keeps_every_step(tmp_path, simulation) -> None:
    with recorder(tmp_path / "run.h5", simulation, interval=0.1 * STEP) as kept:
        kept.append(simulation.advance(5))

    with h5py.File(tmp_path / "run.h5") as file:
        assert len(file["histories/front/time"]) == 5


def test_a_snapshot_is_the_whole_scene_at_its_time(tmp_path, simulation) -> None:
    with recorder(tmp_path / "run.h5", simulation) as kept:
        kept.append(simulation.advance(10))
        kept.snapshot()
        displacement = simulation.displacement.copy()
        kept.append(simulation.advance(5))
        kept.snapshot()

    with h5py.File(tmp_path / "run.h5") as file:
        assert list(file["snapshots"]) == ["0000", "0001"]
        assert file["snapshots/0000"].attrs["time"] == 10 * STEP
        assert np.array_equal(file["snapshots/0000/displacement"], displacement.T)
        assert np.array_equal(file["snapshots/0001/velocity"], simulation.velocity.T)


def test_scene_and_sides_are_kept(tmp_path, simulation) -> None:
    with recorder(tmp_path / "run.h5", simulation) as kept:
        kept.append(simulation.advance(60))

    scene = simulation.scene
    with h5py.File(tmp_path / "run.h5") as file:
        assert np.array_equal(file["particles/position"], scene.assembly.positions)
        assert np.array_equal(file["particles/radius"], scene.assembly.radii)
        assert np.array_equal(file["particles/brick_particle"], scene.assembly.brick_particle)
        assert set(file["boundaries"]) == set(scene.edges)
        side = file["boundaries/right"]
        assert np.array_equal(side["particle"], scene.edges["right"].nodes)
        assert np.array_equal(side["position"], scene.assembly.positions[scene.edges["right"].nodes])
        assert side["diameter"][:].tolist() == [0.5, 0.5]
        assert (side.attrs["length"], side.attrs["cover"]) == (1.0, 1.0)
        assert np.array_equal(side["peak_velocity"], simulation.edge_peaks("right"))
        assert side["peak_velocity"][0, 0, 1] > 0.4  # the pulse of 0.5 m/s has arrived


def test_a_record_says_what_it_is_of(tmp_path, simulation) -> None:
    with recorder(tmp_path / "run.h5", simulation) as kept:
        kept.append(simulation.advance(3))

    with h5py.File(tmp_path / "run.h5") as file:
        about = dict(file.attrs)
    assert (about["name"], about["version"]) == ("bar", __version__)
    assert about["case"] == simulation.scene.case.text
    assert (about["time_step"], about["step_limit"], about["steps"]) == (STEP, 4e-4, 3)
    assert about["size"].tolist() == [10.0, 1.0]
    assert bool(about["complete"])


def test_every_dataset_has_its_unit(tmp_path, simulation) -> None:
    with recorder(tmp_path / "run.h5", simulation) as kept:
        kept.append(simulation.advance(3))
        kept.snapshot()

    units: dict[str, str] = {}

    def note(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            units[name] = item.attrs.get("unit", "")

    with h5py.File(tmp_path / "run.h5") as file:
        file.visititems(note)
    assert len(units) == 3 + 2 * 3 + 4 * 4 + 2
    assert all(units.values())
    assert units["histories/front/time"] == "s"
    assert units["snapshots/0000/velocity"] == units["boundaries/left/peak_velocity"] == "m/s, m/s, rad/s"


def test_a_run_that_fails_leaves_its_histories_and_is_not_complete(tmp_path, simulation) -> None:
    def fail() -> None:
        with recorder(tmp_path / "run.h5", simulation) as kept:
            kept.append(simulation.advance(5))
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    with h5py.File(tmp_path / "run.h5") as file:
        assert not file.attrs["complete"]
        assert file.attrs["steps"] == 5
        assert len(file["histories/front/time"]) == 5
        assert "boundaries" not in file


def test_what_was_appended_can_be_read_if_the_process_dies(tmp_path, simulation) -> None:
    kept = recorder(tmp_path / "run.h5", simulation)
    kept.append(simulation.advance(5))
    (tmp_path / "as_found.h5").write_bytes((tmp_path / "run.h5").read_bytes())
    kept.file.close()

    with h5py.File(tmp_path / "as_found.h5") as file:
        assert not file.attrs["complete"]
        assert len(file["histories/front/time"]) == 5
