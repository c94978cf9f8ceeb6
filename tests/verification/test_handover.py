"""The elastic law is left in the step in which it would go wrong: the answer is that of the history-dependent law.

A weak pulse runs along a bar of random disks under a low locked-in stress and meets a free end, where contacts open.
"""

import numpy as np

from dembound.disks.scene import build
from dembound.disks.stepping.contact_lists import contact_lists
from dembound.disks.stepping.start import Start

EPS = np.finfo(float).eps
CONTACT_MODULUS = 1.25e9
PRESSURE, AMPLITUDE = 6.3e5, 0.003
"""Pa and m/s, so weak that contacts open only once the pulse is back from the free end."""


def runs(lab, geometry: str):
    """The bar with an elastic start and without: both motions of all particles (k, n, 6), and the laws of the first."""
    motions, laws = [], []
    for elastic_start in (True, False):
        material = {"law": "linearpbond", "geometry": geometry, "elastic_start": elastic_start, "fric": 0.5}
        material["locked_in"] = PRESSURE
        scene = build(
            lab.case(
                "B",
                (20.0, 10.0),
                held=(),
                material=material,
                boundary={"left": {"type": "viscous_input", "wave_p": "pulse"}},
                wave={"type": "cosine", "amplitude": AMPLITUDE, "period": 0.02},
                static={"damp": 0.7},
                confining_stress=PRESSURE,
            )
        )
        # taken as settled: with the cut sides balanced, and all contacts as closed as at the start
        start = Start(np.zeros((3, scene.count)), contact_lists(scene))
        simulation = lab.settled(scene, start, probes=np.arange(scene.count))
        motions.append(simulation.advance(320))
        laws.append(simulation.state.laws)
    assert [name for name, _ in laws[0]] == ["elastic", "linearpbond"]
    assert laws[1] == [("linearpbond", 0)]
    return *motions, laws[0]


def test_small_displacements_agree_to_rounding(lab):
    handed_over, from_the_start, laws = runs(lab, "reference")
    assert 0.2 * len(handed_over) < laws[1][1] < 0.8 * len(handed_over)
    # the locked-in forces, against which the wave's are rounded, are this much larger than those of ρcv
    ratio = PRESSURE / (lab.density * lab.speed * AMPLITUDE)
    peak = np.abs(from_the_start[..., 3:5]).max()
    assert np.abs(handed_over - from_the_start)[..., 3:5].max() < ratio * EPS * len(handed_over) * peak


def test_updated_geometry_differs_by_the_locked_in_strain(lab):
    """What turns with the contacts is the locked-in force, p/E_c of the stiffness; 1e-3 of the largest displacement."""
    handed_over, from_the_start, laws = runs(lab, "updated")
    assert laws[1][1] > 0.4 * len(handed_over)
    largest = np.abs(from_the_start[..., :2]).max()
    strain = PRESSURE / CONTACT_MODULUS
    assert np.abs(handed_over - from_the_start)[..., :2].max() < 2.0 * strain * largest
