"""The record of a run: recorded data are read back, with a mark whether they are complete."""

from dataclasses import fields
from pathlib import Path

import h5py
import numpy as np
import pytest

from dembound.bar.scene import build_bar
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.energy import Entry, Ledger
from dembound.motion.simulation import Simulation
from dembound.results import recorder as module
from dembound.results.reader import text_of
from dembound.results.recorder import HALF_STEP, Recorder
from dembound.results.recording import Histories, Snapshots

STEP = 3e-4
MONITORS = {"monitor": [{"name": "front", "position": [0.0, 0.0]}, {"name": "back", "position": [9.9, 0.9]}]}


ORDER = np.argsort([field.name for field in fields(Entry)])
"""Places of the ledger's columns in the alphabetical order in which a file lists its datasets."""


def breaking(bar) -> Simulation:
    """A bar of brittle bonds whose end is pulled away."""
    brittle = {
        "material.law": "linearpbond",
        "material.pb_ten": 1e6,
        "boundary.left": {"type": "velocity", "wave_p": "pulse"},
        "wave.pulse.amplitude": -5.0,
    }
    scene = build(bar({**MONITORS, **brittle}))
    return Simulation(scene, choose_step(scene)[0], list(scene.monitors.values()))


@pytest.fixture
def simulation(bar) -> Simulation:
    scene = build(bar(MONITORS))
    return Simulation(scene, STEP, np.array(list(scene.monitors.values())))


def plain(attributes) -> dict:
    """Attributes with texts as such."""
    return {key: text_of(value) if isinstance(value, bytes) else value for key, value in attributes.items()}


def recorder(path: Path, simulation: Simulation, interval: float = 0.0) -> Recorder:
    """A recorder of a simulation, whose energies are entered every ten steps."""
    ledger = Ledger(simulation, 10)
    simulation.track(ledger)
    return Recorder(path, simulation, step_limit=4e-4, interval=interval, ledger=ledger)


def test_a_record_has_the_scene_and_all_that_was_kept(tmp_path, simulation) -> None:
    records, shots = [], []
    with recorder(tmp_path / "run.h5", simulation) as kept:
        for count in (7, 12, 41):
            records.append(simulation.advance(count))
            kept.append(records[-1])
            if count > 7:
                kept.snapshot()
                shots.append((simulation.state.displacement.T.copy(), simulation.state.velocity.T.copy()))
    scene, expected = simulation.scene, np.concatenate(records)
    units: dict[str, str] = {}

    def note(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            units[name] = text_of(item.attrs.get("unit", ""))

    with h5py.File(tmp_path / "run.h5") as file:
        about = plain(file.attrs)
        assert (about["time_step"], about["step_limit"], about["steps"]) == (STEP, 4e-4, 60)
        assert bool(about["complete"])
        for index, (name, node) in enumerate(scene.monitors.items()):
            group = file["histories"][name]
            assert np.array_equal(group["time"], np.arange(60) * STEP)
            assert np.array_equal(group["displacement"], expected[:, index, :3])
            assert np.array_equal(group["velocity"], expected[:, index, 3:])
            assert group.attrs["particle"] == node
            assert np.array_equal(group.attrs["position"], scene.assembly.positions[node])
        assert [group.attrs["time"] for group in file["snapshots"].values()] == [19 * STEP, 60 * STEP]
        for group, (displacement, velocity) in zip(file["snapshots"].values(), shots, strict=True):
            assert np.array_equal(group["displacement"], displacement)
            assert np.array_equal(group["velocity"], velocity)
        assert np.array_equal(file["energy/time"], np.arange(0, 60, 10) * STEP)
        for name, column in zip(file["energy"], kept.ledger.columns.T[ORDER], strict=True):
            assert np.array_equal(file["energy"][name], column)

        assert np.array_equal(file["particles/position"], scene.assembly.positions)
        # two rows of twenty: a neighbour across, and two along but for the ends
        ends = np.isin(scene.assembly.positions[:, 0], (0.25, 9.75))
        assert np.array_equal(file["particles/bonds"], np.where(ends, 2, 3))
        side = file["boundaries/right"]
        assert np.array_equal(side["peak_velocity"], simulation.edge_peaks("right"))
        assert side["peak_velocity"][0, 0, 1] > 0.4  # the pulse of 0.5 m/s has arrived
        file.visititems(note)
    assert units.pop("laws/name") == ""  # text has none
    assert all(units.values())


@pytest.mark.parametrize(("interval", "nth", "blocks"), [(4.2, 4, (1, 1, 5, 3, 9)), (0.1, 1, (19,))])
def test_an_interval_keeps_every_nth_step_however_the_run_is_cut(tmp_path, simulation, interval, nth, blocks) -> None:
    with recorder(tmp_path / "run.h5", simulation, interval=interval * STEP) as kept:
        records = []
        for count in blocks:
            records.append(simulation.advance(count))
            kept.append(records[-1])
    with h5py.File(tmp_path / "run.h5") as file:
        assert np.array_equal(file["histories/front/time"], np.arange(0, 19, nth) * STEP)
        assert np.array_equal(file["histories/front/velocity"], np.concatenate(records)[::nth, 0, 3:])


def test_contacts_stress_and_peaks_are_kept_if_the_case_asks_for_them(tmp_path, bar, simulation) -> None:
    output = {"output.contacts": True, "output.stress": True, "output.peaks": True}
    asked = Simulation(build(bar({**output, "monitor": []})), STEP)
    fastest = np.zeros(asked.scene.count)
    with recorder(tmp_path / "asked.h5", asked) as kept:
        for _ in range(40):
            kept.append(asked.advance(1))
            fastest = np.maximum(fastest, np.hypot(*asked.state.velocity[:2]))
        kept.snapshot()
    with recorder(tmp_path / "not.h5", simulation) as kept:
        kept.append(simulation.advance(1))
        kept.snapshot()
    expected = asked.system.contact_forces(asked.state.displacement)
    with h5py.File(tmp_path / "asked.h5") as file, h5py.File(tmp_path / "not.h5") as without:
        group = file["snapshots/0000/contacts"]
        for name, (values, _) in expected.items():
            np.testing.assert_array_equal(group[name], values)
        assert group["normal_force"][:].min() < -1e4  # the wave of 0.5 m/s: ρcv is 1.25 MPa
        stress, peaks = file["snapshots/0000/stress"], file["particles/peak_velocity"]
        assert np.array_equal(stress, asked.system.stress(asked.state.displacement))
        assert stress[:, 0].min() < -1e5
        # y is held, so no square is rounded; both ends are supported
        assert np.array_equal(peaks, fastest)
        assert peaks[:].min() > 0.1
        assert set(without["snapshots/0000"]) == {"displacement", "velocity"}
        assert "peak_velocity" not in without["particles"]


def test_trackers_keep_histories_and_snapshots(tmp_path, simulation) -> None:
    plain = Simulation(simulation.scene, STEP, simulation.probes)
    with recorder(tmp_path / "run.h5", simulation) as kept:
        simulation.track(Histories(kept), Snapshots(kept, 3, 19))
        simulation.run(19)

    expected, moved = plain.advance(6), [plain.state.displacement.T.copy()]
    for steps in (6, 7):
        expected = np.concatenate([expected, plain.advance(steps)])
        moved.append(plain.state.displacement.T.copy())
    with h5py.File(tmp_path / "run.h5") as file:
        assert np.array_equal(file["histories/front/time"], np.arange(19) * STEP)
        assert np.array_equal(file["histories/back/velocity"], expected[:, 1, 3:])
        assert [group.attrs["time"] for group in file["snapshots"].values()] == [6 * STEP, 12 * STEP, 19 * STEP]
        for group, displacement in zip(file["snapshots"].values(), moved, strict=True):
            assert np.array_equal(group["displacement"], displacement)
        front = simulation.scene.monitors["front"]
        for number, step in (("0000", 6), ("0001", 12)):  # means of two half steps, as histories
            found = file[f"snapshots/{number}/velocity"][front]
            np.testing.assert_allclose(found, expected[step, 0, 3:], rtol=1e-14, atol=1e-300)
        # the step after the last one is not there
        assert [HALF_STEP in group.attrs for group in file["snapshots"].values()] == [False, False, True]


def test_cracks_laws_and_coordination_are_kept_however_the_run_is_cut(tmp_path, bar) -> None:
    for name, blocks in (("cut", 60 * (1,)), ("run", 3 * (20,))):
        simulation = breaking(bar)
        with Recorder(tmp_path / f"{name}.h5", simulation, step_limit=4e-4, interval=0.0) as kept:
            for steps in blocks:
                kept.append(simulation.advance(steps))
            kept.snapshot()

    began = next(step for name, step in simulation.state.laws if name == "linearpbond")
    with h5py.File(tmp_path / "run.h5") as file, h5py.File(tmp_path / "cut.h5") as cut:
        cracks = file["cracks"]
        for column, values in cracks.items():
            assert np.array_equal(values, cut["cracks"][column])
        assert [name.decode() for name in file["laws/name"]] == ["elastic", "linearpbond"]
        assert file["laws/time"][:].tolist() == [0.0, began * simulation.time_step]
        assert cracks["time"][0] >= file["laws/time"][1]
        assert np.all(np.diff(cracks["time"]) >= 0.0)
        assert not cracks["shear"][:].any()  # pulled apart along the lattice
        # bonds along x, between neighbours that lie on either side of the crack
        first, second = simulation.scene.assembly.positions[cracks["particles"][:].T]
        np.testing.assert_allclose(second - first, np.tile([0.5, 0.0], (len(first), 1)), atol=1e-12)
        middle = 0.5 * (first + second)
        np.testing.assert_allclose(cracks["position"][:], middle, atol=np.abs(simulation.state.displacement).max())
        bonds = np.bincount(simulation.scene.assembly.pairs.ravel(), minlength=simulation.scene.count)
        coordination = file["snapshots/0000/coordination"][:]
        assert np.all(coordination <= bonds)
        assert np.any(coordination < bonds)


@pytest.mark.parametrize(("limit", "value", "samples"), [("KEPT_BYTES", 1, 0), ("KEPT_SECONDS", 0.0, 10), (None, 0, 0)])
def test_what_was_written_can_be_read_if_the_process_dies(
    tmp_path, simulation, monkeypatch, limit, value, samples
) -> None:
    if limit is not None:
        monkeypatch.setattr(module, limit, value)
    kept = recorder(tmp_path / "run.h5", simulation)
    kept.append(simulation.advance(5))
    kept.snapshot()
    kept.append(simulation.advance(5))
    (tmp_path / "as_found.h5").write_bytes((tmp_path / "run.h5").read_bytes())
    kept.file.close()

    with h5py.File(tmp_path / "as_found.h5") as file:
        assert not file.attrs["complete"]
        assert len(file["histories/front/time"]) == samples
        assert len(file["snapshots"]) == (samples > 0)


def test_stress_and_damage_of_a_bar_are_kept(tmp_path, spalling) -> None:
    scene = build_bar(spalling())
    simulation = Simulation(scene, 2.5e-5, np.array([21]))
    with recorder(tmp_path / "run.h5", simulation) as kept:
        records = []
        for count in (25, 35):
            records.append(simulation.advance(count))
            kept.append(records[-1])
        kept.snapshot()

    (part,) = simulation.system.parts
    with h5py.File(tmp_path / "run.h5") as file:
        history, snapshot = file["histories/gauge"], file["snapshots/0000"]
        assert np.array_equal(history["stress"], np.concatenate(records)[:, 0, 6])
        assert np.array_equal(history["velocity"], np.concatenate(records)[:, 0, 3:6])
        assert np.array_equal(snapshot["stress"], part.stress(simulation.state.displacement))
        assert np.array_equal(snapshot["damage"], part.bonds.damage())
        assert snapshot["damage"][:].max() >= 0.3
