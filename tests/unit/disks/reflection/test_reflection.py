"""Types of a side compared, in a run and by layer."""

from dataclasses import replace

import numpy as np
import pytest
from angles import FREQUENCY, Side, reflection
from scene_tables import ISOTROPIC, lattice, monitors, pulse
from small_cases import GRAINS, OPEN, SOIL, around, small

from dembound import api
from dembound.continuum.layer import Absorption
from dembound.disks.reflection import beyond, compare_types, layers_beside, measure_side
from dembound.disks.reflection.arrivals import amplitudes, signal_for
from dembound.disks.reflection.bricks import BrickInRow
from dembound.disks.reflection.continuum_end import ContinuumEnd, beside_elements
from dembound.disks.reflection.meter import Meter
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.spectra import fourier_spectrum

SPRINGS = {"type": "viscoelastic", "distance": 5.0, "alpha_n": 2.5}

STRIP = {
    "packing": lattice(100.0, 0.5, 0.5),
    "material": ISOTROPIC,
    "boundary": around("periodic", "bottom", "top")
    | {"left": {"type": "velocity", "wave_p": "pulse"}, "right": SPRINGS},
    "wave": pulse(0.04, 1.0),
    "monitor": monitors(middle=(50.0, 0.25)),
    "run": {"duration": 0.245, "time_step": 2e-4},
    "output": {"pictures": False, "history_interval": 2e-4},
}


def test_springs_return_in_a_run_what_is_computed_and_their_formula_says(tmp_path) -> None:
    """|R| = [1 + (2ωρc/k)²]^(−½) with k = αG/L, G = ρc²/2; run and computation within 0.1 % of each other.

    The returned pulse passes the monitor from 0.15 s on and ends as e^(−kt/ρc), kt/ρc = 14 when the next echo comes.
    The last mass, whole, and the lattice change the formula by (ωD/4c)(2ωρc/k), 3 % at 20 Hz.
    """
    case = small(STRIP)
    frequencies = [5.0, 10.0, 20.0]
    types = [SPRINGS, {"type": "viscous", "half_mass": True}]
    found, arrivals = compare_types(case, "right", types, [0.0], frequencies)
    assert [*found] == ["viscoelastic, distance 5.0, alpha_n 2.5", "viscous, half_mass"]
    computed = np.sqrt(found["viscoelastic, distance 5.0, alpha_n 2.5"].total("p")[:, 0])
    formula = 1.0 / np.sqrt(1.0 + (4.0 * np.pi * np.array(frequencies) / 250.0) ** 2)
    np.testing.assert_allclose(computed, formula, rtol=0.03)
    assert found["viscous, half_mass"].total("p").max() < 1e-7

    history = api.run(case, tmp_path).histories["middle"]
    velocity, step = history["velocity"][:, 0], float(history["time"][1])
    passed = history["time"] < 0.12
    spectra = [fourier_spectrum(np.where(window, velocity, 0.0), step) for window in (passed, ~passed)]
    returned = [np.interp(frequencies, every, np.abs(values)) for every, values in spectra]
    np.testing.assert_allclose(returned[1] / returned[0], computed, rtol=1e-3)

    signal = signal_for("p", arrivals)
    assert signal is not None
    assert signal.wave is case.wave["pulse"]
    assert signal_for("s", arrivals) is None
    np.testing.assert_allclose(amplitudes(signal, np.array([1.0, 50.0])), [1.0, 0.0], atol=0.06)
    usual = next(iter(compare_types(case, "right", [SPRINGS], [0.0])[0].values())).frequencies
    assert usual[-1] == pytest.approx(case.wave["pulse"].highest_frequency())


def test_a_side_reflects_by_layer() -> None:
    case = small(SOIL | OPEN)
    assert layers_beside(case, "left") == ["clay", "sand", "rock"]
    assert layers_beside(case, "bottom") == layers_beside(case.uniform_at(1.0), "left") == []
    with pytest.raises(CaseError, match="name one of clay, sand, rock"):
        measure_side(case, "left")

    def returned(side: str, layer: str | None, height: float | None = None) -> np.ndarray:
        one = case if height is None else case.uniform_at(height)
        return measure_side(one, side, [0.0], [10.0, 20.0], layer=layer).found.total("s")[:, 0]

    # the mass beyond whole cells reflects in proportion to the frequency over the speed
    clay = returned("left", "clay")
    for layer, slower in (("sand", 200.0 / 350.0), ("rock", 200.0 / 700.0)):
        np.testing.assert_allclose(returned("left", layer), clay * slower**2, rtol=0.02)
    np.testing.assert_allclose(returned("left", "rock"), returned("left", None, 1.0), rtol=1e-6)
    np.testing.assert_allclose(returned("bottom", None), returned("bottom", None, 1.0), rtol=1e-6)


ANGLES = [0.0, 25.0, 60.0]


@pytest.fixture(scope="module")
def side() -> Side:
    return Side.of()


@pytest.mark.parametrize(("kind", "angle"), [("p", 0.0), ("p", 75.0), ("s", 30.0)])
def test_of_a_lattice_it_sends_back_what_waves_of_rows_of_disks_say(side, kind, angle) -> None:
    """`angles` adds up the lattice's own waves, wave number by wave number, beside one row of elements.

    There sin θ/c is that of the lattice in steps, here that of the continuum: (qa)²/24 = 2e-4 of it, by which an
    exponent ln R0 · tan² θ of the energy differs, 2·9·14·2e-4.
    """
    row = BrickInRow(beside_elements(side.scene.ground, "right", side.scene.outside), "right")
    (found,) = Meter(row, side.step, ContinuumEnd(side.scene.outside, row)).measure([FREQUENCY], [angle], [kind])
    expected = reflection(side, kind, angle)["energy"]
    assert found.total(kind)[0, 0] == pytest.approx(expected, rel=5e-2 if angle > 70.0 else 2e-3)


@pytest.mark.parametrize(("name", "element"), [("left", 2.0), ("bottom", 12.0)])
def test_without_absorption_all_comes_back(name, element) -> None:
    """For P and S waves of a random packing, at all sides: the outer edge is at rest, and ties take no energy.

    Elements are a half and three times as long as bricks: two along a brick, and three bricks along an element.
    """
    changes = {"boundary": {name: {"type": "outside"}}, "outside": {"element": element, "layers": 2, "damping": 0.0}}
    scene = build(small(GRAINS, changes=changes | {"packing.size": [24.0, 24.0]}))
    body = replace(scene.outside.body, absorption=Absorption(reflection=1.0, delay=0.0))
    (found,) = beyond(replace(scene, outside=replace(scene.outside, body=body)), name, 1e-4).measure([20.0], ANGLES)
    for kind in found.kinds:
        np.testing.assert_allclose(found.total(kind), 1.0, rtol=1e-7)
        assert found.converted[kind][0, 1] > 0.01


def test_beside_a_narrow_body_only_waves_along_the_normal_are_measured() -> None:
    """Periodic and as wide as one element: its ties have the mean motion, as in a run."""
    ends = around("outside", "right") | around("periodic", "bottom", "top")
    ends |= {"left": {"type": "viscous", "beta_p": 1.0}}
    case = small({**GRAINS, "boundary": ends, "outside": {"element": 4.0}})
    found = measure_side(case, "right", [0.0, 30.0], [30.0])
    assert found.found.angles.tolist() == [0.0]
    beside = measure_side(case, "left", [0.0, 30.0], [30.0])
    assert beside.found.angles.tolist() == [0.0, 30.0]
    _, reflections = beside.continuum
    assert reflections.angles.tolist() == [0.0]
    assert 0.0 < reflections.total("p")[0, 0] < 1e-3 < beside.found.total("p")[0, 0]


def test_sides_are_measured_within_a_time_at_fewer_frequencies_or_not_at_all(dembound, tmp_path) -> None:
    """One disk: 12 frequencies of 0.08 s, 0.96 s in all, so 0.5 s is enough for 6."""
    (tmp_path / "strip.toml").write_text(small(STRIP).text)
    fewer = dembound("boundary", "strip.toml", "--side", "right", "--longest", 0.5)
    assert fewer.code == 0, fewer.err
    assert "12 frequencies take about 1 s of CPU time, so 6 are measured; --longest 1 measures all" in fewer.err
    for given in ((), ("--frequency", 20)):
        refused = dembound("boundary", "strip.toml", "--side", "right", "--longest", 0.05, *given)
        assert refused.code == 2
        assert "at most 0.05 s are allowed; --longest" in refused.err
