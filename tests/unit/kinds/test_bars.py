"""Bars as a kind of body, for runs, checks and reports."""

import json
from pathlib import Path

import h5py
import numpy as np
import pytest
import pyvista

from dembound.bar.fracture import Spall, spalls
from dembound.bar.scene import build_bar
from dembound.errors import CaseError
from dembound.exact.bar import cells_per_wavelength, courant_limit
from dembound.gauge.peaks import first_fall
from dembound.kinds.bar import summary
from dembound.kinds.bar.kind import Bars
from dembound.kinds.bar.summary import LATER_SPALLS, bar_facts, bar_outcome, cells_of_waves, part_of, summarise_bar
from dembound.motion.energy import Ledger
from dembound.motion.kind import Beginning, Plan
from dembound.motion.simulation import Simulation
from dembound.results.recorder import Recorder
from dembound.results.recording import Histories
from dembound.results.summary import summarise
from dembound.results.vtk import write_paraview
from dembound.running import plan, preflight


def test_what_would_stop_a_run_is_found_before_it(spalling) -> None:
    with pytest.raises(CaseError, match=r"run\.courant"):
        preflight(spalling({"run.courant": 2.0}))
    preflight(spalling())


def test_what_a_bar_has_is_drawn(spalled_run, tmp_path) -> None:
    assert len(Bars().field_picture(spalled_run, "damage", None, None).axes) > 0
    with pytest.raises(CaseError):
        Bars().field_picture(spalled_run, "stress_xx", None, None)
    unwatched = tmp_path / "run.h5"
    unwatched.write_bytes(spalled_run.read_bytes())
    with h5py.File(unwatched, "r+") as file:
        del file["histories/gauge"]

    assert [name for name, _ in Bars().pictures(spalled_run)] == ["scene", "histories_stress"]
    assert [name for name, _ in Bars().pictures(unwatched)] == ["scene"]


def facts_of(case) -> dict[str, str]:
    planned = plan(case)
    return dict(bar_facts(planned.scene, planned.time_step))


def test_facts_are_those_of_the_bar(spalling) -> None:
    law = {"bar.fracture_energy": 1e4, "bar.strength_per_decade": 2e6, "bar.strength_rates": [1.0, 100.0]}
    facts = facts_of(spalling({"boundary.right": {"type": "viscous", "beta_p": 0.9}, "bar.attenuation": 0.2, **law}))

    assert facts.pop("right end").startswith("viscous, β_P = 0.9; returns at most ")
    expected = {
        "nodes": "41, 25 mm apart",
        "method": "peridynamics, horizon = 3, corrected_ends = false",
        "Courant number": "1",
        "bar": "1 m long, section 1 m², density 2500 kg/m³",
        "stiffness": "E = 2.5 GPa, c = 1000 m/s",
        "strength": "8 MPa, critical stretch 0.0032",
        "attenuation": "α = 0.2 1/m",
        "left end": "free",
        "load hit": "12 MPa times wave hit, on 3 nodes at the left end",
        "monitor gauge": "node 21 at 0.525 m",
        "cracks": "G_f = 10000 J/m², open at w_c = 2G_f/σ_t = 2.5 mm, characteristic length EG_f/σ_t² = 174 mm, "
        "spacing at most 34.7 mm",
        "strain rates": "strength from 8 MPa at 1 1/s to 12 MPa at 100 1/s",
    }
    assert facts.items() >= expected.items()


def test_a_layer_is_reported_with_its_length_and_what_it_returns(spalling) -> None:
    method = {"type": "finite_difference"}
    case = spalling({"boundary.right": {"type": "matched_layer", "nodes": 80}, "method": method, "run.courant": 0.5})
    layer, echo = facts_of(case)["right end"].split("; ")
    assert layer == "matched_layer, nodes = 80, power = 3, reflection = 1e-08, layer_length = 2"
    assert echo.startswith("returns at most ")
    assert echo.endswith(" of wave hit")
    assert 1e-9 < float(echo.split()[3]) < 1e-4


def test_cells_in_the_shortest_wavelength(spalling) -> None:
    found, needed = cells_of_waves(build_bar(spalling()), 2e-5)["hit"]

    # the spectrum of the even triangle of 0.4 ms has faded at 5.36 over its length, which is given to two decimals
    assert found == pytest.approx(1000.0 / (5.36 / 4e-4) / 0.025, rel=1e-3)
    assert needed == cells_per_wavelength(3, 0.8, 0.01)
    for method in ("finite_difference", "switch", "patch"):  # families of three come about only where something breaks
        changes = {"method": {"type": method} | ({} if method == "finite_difference" else {"horizon": 3})}
        of_springs = cells_of_waves(build_bar(spalling(changes)), 2e-5)["hit"][1]
        assert needed > of_springs == pytest.approx(cells_per_wavelength(1, 0.8, 0.01), rel=1e-12)
    # ends make a bar stable a little beyond the limit of an endless one, for which cells are counted
    step = courant_limit(3) * (1.0 + 1e-6) * 0.025 / 1000.0
    assert cells_of_waves(build_bar(spalling()), step)["hit"][1] == cells_per_wavelength(3, courant_limit(3), 0.01)


def test_paraview_has_nodes_where_they_have_moved_and_lines_with_the_bonds_broken_across_them(spalled_run, tmp_path):
    """With what the record holds, rounded to single precision."""
    run, totals, peaks = tmp_path / "run.h5", [], np.linspace(0.0, 3.0, 41)
    run.write_bytes(spalled_run.read_bytes())
    with h5py.File(run, "r+") as file:
        file["particles/peak_velocity"] = peaks
    write_paraview(run, tmp_path / "paraview", Bars())
    with h5py.File(run) as file:
        particles, times, pairs = file["particles"], file["cracks/time"][:], file["cracks/particles"][:]
        for number, snapshot in file["snapshots"].items():
            mesh, moved = pyvista.read(tmp_path / "paraview" / f"bar_{number}.vtu"), snapshot["displacement"][:, 0]
            np.testing.assert_array_equal(mesh.points[:, 0], particles["position"][:, 0] + moved)
            np.testing.assert_array_equal(mesh.points[:, 1:], 0.0)
            expected = {name: snapshot[name][:] for name in ("displacement", "velocity", "stress", "damage")}
            expected |= {"volume": particles["volume"][:], "id": np.arange(41), "peakVelocity": peaks}
            assert set(mesh.point_data.keys()) == set(expected)
            for name, values in expected.items():
                np.testing.assert_array_equal(mesh.point_data[name], values.astype(np.float32), err_msg=name)
            assert set(mesh.celltypes) == {pyvista.CellType.LINE}
            np.testing.assert_array_equal(mesh.cell_connectivity.reshape(-1, 2), [[k, k + 1] for k in range(40)])
            broken = pairs[times <= snapshot.attrs["time"]]
            counted = [sum(first <= k < last for first, last in broken) for k in range(40)]
            np.testing.assert_array_equal(mesh.cell_data["brokenBonds"], counted)
            totals.append(sum(counted))
    assert np.abs(moved).max() > 0.0
    assert totals[0] == 0 < totals[-1]


@pytest.fixture
def run(spalling, tmp_path):
    """Runs the spalling bar with keys changed: its plan, simulation and record."""

    def make(**changes: object):
        planned = plan(spalling(changes))
        simulation = Simulation(planned.scene, planned.time_step, planned.scene.probes)
        path: Path = tmp_path / "run.h5"
        ledger = Ledger(simulation, planned.steps - 1)
        with Recorder(path, simulation, planned.step_limit, ledger=ledger) as recorder:
            simulation.track(Histories(recorder), ledger)
            simulation.run(planned.steps)
        return planned, simulation, path

    return make


def summary_of(planned: Plan, simulation: Simulation, path: Path) -> dict:
    """The summary of a run that took a second."""
    common = summarise(planned, simulation, path, {"step": 1.0})
    return common | planned.kind.summarise(planned.scene, simulation, Beginning(simulation.system), path)


def test_the_summary_of_a_bar_is_plain_json_with_the_spalls_of_its_bonds(run, monkeypatch) -> None:
    planned, simulation, path = run()
    found = json.loads(json.dumps(summary_of(planned, simulation, path), allow_nan=False))

    assert (found["name"], found["nodes"], found["steps"]) == ("spalling", 41, 60)
    assert found["method"] == {"type": "peridynamics", "horizon": 3, "corrected_ends": False}
    assert found["courant"] == pytest.approx(1.0, rel=1e-12)
    assert found["laws"] == [{"law": "peridynamics, m = 3", "from": 0.0}]
    # the books close to rounding: 60 steps of sums over 41 nodes
    assert found["energy"]["relative_error"] < 60 * 41 * np.finfo(float).eps

    bonds = part_of(simulation).bonds
    expected = spalls(bonds, planned.scene.positions[:, 0], planned.time_step)
    assert found["spalls"] == [spall.describe() for spall in expected]
    # tension comes once crest and tail, 0.4 m apart, have met at the far end
    assert expected[0].time > 1e-3
    assert found["cracks"] == {"tension": len(bonds.breaks(0)[0]), "shear": 0}
    for count in (0, 1, 2):  # those after the first are not to be relied on
        monkeypatch.setattr(summary, "spalls", lambda *_, n=count: n * [Spall(1e-3, (0.9, 0.9), (0.9, 0.9))])
        note = summarise_bar(planned.scene, simulation, path)["spalls_note"]
        assert note == (LATER_SPALLS if count > 1 else None)


@pytest.mark.parametrize("held", [{"type": "fixed"}, {"type": "velocity", "wave_p": "still"}], ids=["fixed", "moved"])
def test_a_bar_torn_off_the_end_that_holds_it_has_not_spalled(run, held: dict) -> None:
    # tension, which an end that is held doubles: the bar breaks there at the latest
    pull = {"name": "pull", "pressure": -6e6, "nodes": 3, "wave": "hit"}
    still = {"wave.still": {"type": "constant", "amplitude": 1e-9, "start": 0.0}} if "wave_p" in held else {}
    planned, simulation, path = run(**{"boundary.right": held, "load": [pull], **still})
    found = summary_of(planned, simulation, path)

    assert found["spalls"] == []
    assert list(found["breaks_at_ends"]) == ["right"]
    assert found["breaks_at_ends"]["right"]["start"][1] == 1.0
    # the front is there at 1 ms
    assert found["breaks_at_ends"]["right"]["time"] > 1e-3


def gauges(*places: float) -> dict:
    return {"monitor": [{"name": f"at-{place:g}", "position": place} for place in places]}


@pytest.mark.parametrize(("side", "free", "outwards"), [("left", 1.0, 1.0), ("right", 0.0, -1.0)])
def test_pull_back_is_that_of_a_free_end_beyond_a_spall(run, side: str, free: float, outwards: float) -> None:
    hit = {"name": "hit", "pressure": 12e6, "nodes": 3, "wave": "hit", "side": side}
    planned, simulation, path = run(**gauges(0.0, 0.5, 1.0), load=[hit], **{"run.duration": 2e-3})
    with h5py.File(path) as file:
        velocity = file[f"histories/at-{free:g}/velocity"][:, 0]

    # ½ρc of how far the velocity falls; the loaded end and the middle tell nothing of it
    found = summarise_bar(planned.scene, simulation, path)["pull_back_strength"]
    assert found == {f"at-{free:g}": 0.5 * 2500.0 * 1000.0 * first_fall(outwards * velocity)}


def outcome(spalls: list[dict], note: str | None = None, **more) -> list[str]:
    summary = {
        "laws": [{"law": "finite differences", "from": 0.0}],
        "spalls": spalls,
        "breaks_at_ends": {},
        "spalls_note": note,
        "bar": {"strength": 1e7},
        "energy": {"crack": 0.0, "supplied": 1.0, "relative_error": 0.0},
    }
    return bar_outcome(summary | more)


def test_a_bar_that_comes_off_an_end_that_holds_it_has_not_spalled() -> None:
    off = {"right": {"start": [1.99, 2.0], "end": [1.99, 2.0], "time": 7.41e-4}}
    ends = {"left": {"type": "free"}, "right": {"type": "fixed"}}
    assert outcome([], breaks_at_ends=off, boundaries=ends) == ["broke at the right end (fixed), 741 µs"]
