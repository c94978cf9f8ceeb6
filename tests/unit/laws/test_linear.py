"""Kernels of laws that are declared as linear are linear in a run."""

import numpy as np
import pytest
from small_cases import small

from dembound.casefile.types import LAWS, _usable
from dembound.laws import Elastic
from dembound.motion.simulation import Simulation
from dembound.running import plan

STEPS = 5
BODY = {
    "packing": {"pattern": "A", "size": [2.0, 2.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
    "boundary": {},
    "run": {"duration": 1.0},
    "output": {"pictures": False},
}


def moved(law: str, factor: float) -> np.ndarray:
    """Displacements (3, n) of a free body, some time after its disks had random velocities times a factor."""
    changes = {"material.law": law} | ({"material.elastic_start": False} if LAWS[law].has_history else {})
    planned = plan(small(BODY, changes=changes))
    run = Simulation(planned.scene, planned.time_step)
    run.state.velocity = factor * np.random.default_rng(1).standard_normal((3, planned.scene.count))
    run.run(STEPS)
    return run.state.displacement


def is_linear(law: str) -> bool:
    """Whether motion is proportional to velocities, of either sign: to rounding of a few steps."""
    one = moved(law, 1e-3)
    return all(
        np.allclose(moved(law, 1e-3 * factor), factor * one, rtol=0.0, atol=1e-12 * abs(factor) * np.abs(one).max())
        for factor in (-1.0, 3.0)
    )


@pytest.mark.parametrize("law", [name for name, law in LAWS.items() if law.is_linear])
def test_laws_are_linear_that_say_so(law: str) -> None:
    assert is_linear(law)


class Rubber(Elastic):
    name = "rubber"
    is_linear = False


class Brittle(Elastic):
    name = "brittle"
    has_history = True
    linear = "rubber"


def test_the_linear_law_of_a_law_is_linear() -> None:
    """A law that is not linear may name itself; another law cannot name it as linear."""
    with pytest.warns(UserWarning, match='"brittle" names "rubber" as its linear law, which must be a linear law'):
        found = _usable({law.name: law for law in (Elastic(), Rubber(), Brittle())})
    assert list(found) == ["elastic", "rubber"]
