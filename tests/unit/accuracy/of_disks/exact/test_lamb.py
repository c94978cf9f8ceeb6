"""The exact curve beside a case of Lamb's problem."""

import h5py
import numpy as np
import pytest
import tomli_w

from dembound.accuracy.of_disks.exact import lamb as module
from dembound.accuracy.of_disks.exact import write_exact
from dembound.errors import CaseError
from dembound.exact import Solid, buried_displacement, lamb_below
from dembound.kinds import loads, with_changes

ROCK = Solid(2500.0, 300.0, 300.0 / np.sqrt(2.0))

CASE = tomli_w.dumps(
    {
        "packing": {"pattern": "A", "size": [10.0, 5.0], "radius": 0.25},
        "material": {"density": 2500.0, "p_wave_speed": 300.0, "fric": 0.5},
        "wave": {"pulse": {"type": "cubic_spline", "amplitude": 1.0, "period": 0.1}},
        "load": [{"name": "hammer", "force": [0.0, -1000.0], "position": [4.75, 4.75], "wave": "pulse"}],
        "monitor": [{"name": "before", "position": [2.75, 4.75]}, {"name": "behind", "position": [6.75, 4.75]}],
        "run": {"duration": 0.2},
    }
)


def histories(path, case):
    """Displacements (k, 3) of the two monitors, and their times."""
    write_exact(case, path)
    with h5py.File(path) as file:
        groups = [file[f"histories/{name}"] for name in ("before", "behind")]
        return groups[0]["time"][:], *(group["displacement"][:] for group in groups)


def test_a_load_on_the_open_surface_moves_both_sides_alike(tmp_path):
    case = loads(CASE)
    time, before, behind = histories(tmp_path / "run.h5", case)
    pulse = case.wave["pulse"].velocity
    out, down = buried_displacement(time, 2.0, 0.25, lambda t: 1000.0 * pulse(t), ROCK)  # half a disk deep

    # both from the same quadrature
    np.testing.assert_allclose(behind, np.column_stack([out, -down, 0.0 * time]), atol=1e-12 * down.max())
    np.testing.assert_allclose(before, behind * [-1.0, 1.0, 1.0], atol=1e-12 * down.max())


HAMMER = {"name": "hammer", "force": [0.0, -1000.0], "position": [4.75, 4.75], "wave": "pulse"}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"load": [{**HAMMER, "force": [10.0, -1000.0]}]}, "one vertical force"),
        ({"monitor": [{"name": "deep", "position": [2.0, 1.0]}]}, "monitor.deep.position: must be on the top"),
        ({"boundary.top": {"type": "viscous"}}, 'boundary.top.type: is "viscous", must be "free"'),
        ({"load": [{**HAMMER, "position": [0.75, 4.75]}]}, "load: is 0.75 m from the left side and 6 m from a monitor"),
        ({"monitor": [{"name": "under", "position": [4.75, 4.75]}]}, "monitor.under.position: lies under the load"),
        ({"wave.pulse": {"type": "constant", "amplitude": 1.0, "start": 0.05}}, "has a jump at 0.05 s"),
    ],
)
def test_other_problems_are_refused_and_leave_nothing(tmp_path, changes, message):
    with pytest.raises(CaseError, match=message):
        write_exact(with_changes(loads(CASE), changes), tmp_path / "new" / "run.h5")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("step", "at", "refused"),
    [
        (0.02, 0.0773, True),
        (0.5, 0.1934, False),  # from 0.19333 s on, what sets out comes to the monitors, 2 m away, after the end
    ],
)
def test_jumps_are_found_beside_steep_flanks_and_before_the_quadrature(tmp_path, monkeypatch, step, at, refused):
    # the step follows a pulse of 1 m/s, whose flanks of 0.5 ms change by 0.2 m/s from one of 2000 samples to the next
    pulse = [(0.0, 0.0), (0.03, 0.0), (0.0305, 1.0), (0.031, 0.0)]
    samples = [*pulse, (at, 0.0), (np.nextafter(at, 1.0), step), (1.0, 0.0)]
    np.savetxt(tmp_path / "wave.txt", samples, fmt="%.17g")
    monkeypatch.setattr(module, "buried_displacement", lambda times, *_: np.zeros((2, len(times))))
    case = with_changes(loads(CASE, tmp_path), {"wave.pulse": {"type": "file", "path": "wave.txt"}})
    if refused:
        with pytest.raises(CaseError, match=rf"wave\.pulse: has a jump at {at:.3g} s; .* continuous wave$"):
            write_exact(case, tmp_path / "run.h5")
    else:
        write_exact(case, tmp_path / "run.h5")


def test_a_load_whose_quadrature_does_not_settle_is_refused(tmp_path, monkeypatch):
    # as of one that jumps to and fro between two samples; the pulse takes more than the fewest panels
    monkeypatch.setattr(lamb_below, "MOST_PANELS", lamb_below.FEWEST_PANELS)
    with pytest.raises(CaseError, match=r"wave\.pulse: is so rough .* continuous wave$"):
        write_exact(loads(CASE), tmp_path / "run.h5")
    assert not list(tmp_path.iterdir())


def test_monitors_in_the_continuum_are_on_the_same_surface(tmp_path):
    """The load is nearer to the sides of a small body than to the monitors, without effect, as the ground goes on."""
    changes = {f"boundary.{side}": {"type": "outside"} for side in ("left", "right", "bottom")}
    changes |= {
        "outside.element": 5.0,
        "outside.margin": 2,
        "packing.size": [5.0, 5.0],
        "load.hammer.position": [0.75, 4.75],
    }
    places = {"before": [-5.25, 4.75], "behind": [6.75, 4.9]}
    monitor = [{"name": name, "position": place} for name, place in places.items()]
    case = with_changes(loads(CASE), changes | {"monitor": monitor})
    _, before, behind = histories(tmp_path / "run.h5", case)

    np.testing.assert_allclose(before, behind * [-1.0, 1.0, 1.0], atol=1e-9 * np.abs(behind).max())
    with h5py.File(tmp_path / "run.h5") as file:
        attributes = file["histories/behind"].attrs
        assert attributes["particle"] == -1
        np.testing.assert_allclose(attributes["position"], [6.75, 4.75], atol=1e-12)
    with pytest.raises(CaseError, match=r"monitor\.behind\.position: must be on the top of the scene"):
        write_exact(with_changes(case, {"monitor.behind.position": [6.75, 2.0]}), tmp_path / "run.h5")
