"""Results do not depend on the number of threads, as nothing is summed in an order that depends on it.

Each particle sums its own row of contacts. Energies and work are summed in chunks of particles and contacts that are
the same for any number of threads, and chunks are added in order. A sum that threads share, each adding what it has
found, has as many partial sums as there are threads, and differs in its last bits with a probability near one in each
of the entries compared here.
"""

import numba
import numpy as np
import pytest
from grid_scene import GridScene, step_limit

from dembound.continuum.axis import Around
from dembound.continuum.medium import Layered, Medium
from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody
from dembound.disks.rest.stage import settle
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.kinds import with_changes
from dembound.kinds.disks.kind import Disks
from dembound.motion import memory
from dembound.motion.endings import Peak, peak_rule

STEPS = 150

ROWS, FEW = (40.0, 10.0), (20.0, 10.0)
"""Sizes of scenes whose copies of a brick are stepped side by side, and disk by disk."""

WEAK = {"law": "linearpbond", "fric": 0.3, "pb_ten": 0.2e6, "pb_coh": 0.2e6, "pb_fa": 30.0, "damp": 0.1}
"""Contacts open and slide and bonds break under the pulses."""

INPUT = {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}
ENDS = {"left": INPUT, "right": "viscous"}
FREE_FIELD = {"left": "free_field", "right": "free_field", "bottom": INPUT}
PLATEN = {"type": "velocity", "wave_p": "pulse", "hold": ["normal"], "within": [4.0, 15.0]}
"""Smooth, of a part of the width; the others push on the outer disks as membranes."""

SETTLED = {"ratio": 0.5, "boundary": {"bottom": {"type": "fixed"}}}
WEIGHT = [{"acceleration": [0.0, -9.81]}]

SCENES = {
    "elastic": {"size": ROWS, "boundary": ENDS, "material": {"damp": 0.1}},
    "periodic, continuum below": {
        "size": (10.0, 10.0),
        "boundary": dict.fromkeys(("left", "right"), "periodic") | {"bottom": {"type": "outside", "wave_s": "pulse"}},
    },
    "damped by Q": {"size": ROWS, "boundary": ENDS, "material": {"quality_factor": 10.0}},
    "Rayleigh damping": {
        "size": FEW,
        "boundary": ENDS,
        "material": {"quality_factor": 10.0},
        "damping": {"type": "rayleigh"},
    },
    "damped by Q, disk by disk, continuum below": {
        "size": (10.0, 10.0),
        "boundary": dict.fromkeys(("left", "right"), "periodic") | {"bottom": {"type": "outside", "wave_s": "pulse"}},
        "material": {"quality_factor": 10.0},
    },
    "damped by Q, breaking": {
        "size": ROWS,
        "boundary": ENDS,
        "material": {key: value for key, value in WEAK.items() if key != "damp"} | {"quality_factor": 10.0},
    },
    "breaking": {"size": ROWS, "boundary": ENDS, "material": WEAK},
    "breaking, disk by disk": {"size": FEW, "boundary": ENDS, "material": WEAK},
    "on walls": {
        "size": ROWS,
        "material": {"law": "linearpbond", "emod": 1e8, "pb_emod": 0.0, "fric": 0.5, "dp_nratio": 0.1},
        "wall": [
            {"points": [[-9.0, -0.3], [20.0, -0.3], [60.0, -2.3]], "fric": 0.5},
            {"points": [[-0.4, 0.5], [-0.4, 12.0]], "velocity": [20.0, 0.0]},
        ],
        "load": [{"acceleration": [3.0, -9.81]}],
    },
    "settled, free field": {
        "size": ROWS,
        "boundary": FREE_FIELD,
        "material": {"law": "linearpbond", "fric": 0.5},
        "static": SETTLED,
        "load": WEIGHT,
    },
    "settled, layers": {
        "size": ROWS,
        "boundary": FREE_FIELD,
        "static": SETTLED,
        "load": WEIGHT,
        "layer": [{"thickness": 4.0, "density": 2000.0, "p_wave_speed": 500.0}, {"name": "stiff"}],
    },
    "settled, layers under K0, continuum beside": {
        "size": FEW,
        "boundary": {**dict.fromkeys(("left", "right"), "outside"), "bottom": {"type": "outside", "wave_s": "pulse"}},
        "material": {"law": "linearpbond", "fric": 0.5},
        "static": SETTLED | {"k0": 0.5},
        "load": WEIGHT,
        "layer": [{"thickness": 4.0, "density": 2000.0, "p_wave_speed": 500.0, "k0": 0.8}, {"name": "stiff"}],
    },
    "settled, test of a sample under pressure": {
        "size": FEW,
        "boundary": {"bottom": {"type": "fixed", "within": PLATEN["within"]}, "top": PLATEN},
        "material": WEAK | {"damp": 0.7},
        "static": {"ratio": 1e-2},
        "load": [{"pressure": 2e4, "sides": ["left", "right", "bottom", "top"]}],
        "run": {"duration": 1.0, "until": "peak", "peak_for": 0.008},
    },
    "settled, box in the ground": {"box": (20.0, 20.0, 40.0, 40.0), "static": SETTLED, "load": WEIGHT},
}


def scene_of(lab, name: str) -> tuple[DiskScene | GridScene, float]:
    """A scene under strong pulses, or of a continuum alone, and its step."""
    if name.endswith("continuum"):
        mesh = Mesh.around((0.0, 0.0, 40.0, 20.0), (10.0, 10.0), margin=Around(2, 2, 1, 0), layer=Around(3, 2, 3, 0))
        rock, soil = Medium.isotropic(2500.0, 1000.0, 600.0), Medium.isotropic(1800.0, 400.0, 200.0)
        body = GridBody(mesh=mesh, medium=Layered((rock, soil), (10.0,)) if name.startswith("layered") else rock)
        return GridScene(body), 0.9 * step_limit(body)
    words = {"held": (), **SCENES[name]}
    if "box" in words:
        scene = build(lab.window("B", words.pop("box"), hole=True, **words))
    else:
        wave = {"type": "cosine", "amplitude": 1.0, "period": 0.02}
        more = {key: words.pop(key) for key in ("layer", "damping", "run") if key in words}
        scene = build(with_changes(lab.case("B", words.pop("size"), wave=wave, **words), more))
    return scene, choose_step(scene)[0]


def run_with(number: int, lab, name: str) -> dict[str, np.ndarray]:
    """All arrays of the state after a run with so many threads, and its energy ledger."""
    numba.set_num_threads(number)
    assert memory.thread_count_for(1000) == number
    scene, step = scene_of(lab, name)
    start = settle(scene).start if name.startswith("settled") else None
    is_test = name.endswith("under pressure")
    simulation = lab.simulation(scene, start, step, side_stride=8 * is_test)
    if name.endswith("continuum"):
        noise = np.random.default_rng(0).standard_normal((3, scene.count)) * scene.moves
        simulation.state.velocity = noise
    ledger = lab.ledger(simulation, 10)
    if is_test:
        simulation.track(Peak(peak_rule(scene, Disks().sources(scene)), scene, step), *Disks().trackers(simulation))
    simulation.run(2 * STEPS if is_test else STEPS)
    return simulation.state.arrays() | {"energies": ledger.columns, "time_step": np.array(step)}


@pytest.mark.skipif(numba.config.NUMBA_NUM_THREADS < 2, reason="needs two threads")
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(n, marks=pytest.mark.slow) if n.startswith(("settled, layers", "damped by Q, disk by disk")) else n
        for n in SCENES
    ]
    + ["continuum", "layered continuum"],
)
def test_same_bits_of_motion_contacts_and_energies(lab, name, monkeypatch):
    monkeypatch.setattr(memory, "PARTICLES_PER_THREAD", 1)  # else a scene as small as this has one thread
    before = numba.get_num_threads()
    try:
        one, *others = [run_with(number, lab, name) for number in sorted({1, 2, numba.config.NUMBA_NUM_THREADS})]
    finally:
        numba.set_num_threads(before)
    for other in others:
        assert other.keys() == one.keys()
        for key, values in one.items():
            np.testing.assert_array_equal(other[key], values, err_msg=key)
    assert np.abs(one["velocity"]).max() > 0.1  # the pulses did run
    assert (np.abs(one["energies"][1:, 1:3]) > 0.0).all()  # kinetic, and in contacts
    if name.endswith("under pressure"):
        assert 0 < one["step"] < 2 * STEPS
        assert one["work/crack"][1] > 0.0
    if name.startswith("breaking"):
        assert one["work/crack"][1] > 0.0
        assert one["work/friction"][1] > 0.0
