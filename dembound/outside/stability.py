"""The largest stable time step of a continuum."""

import numpy as np

from dembound.motion.eigenvalue import largest_eigenvalue
from dembound.motion.layout import Layout
from dembound.outside.body import GridBody


def step_limit(body: GridBody) -> float:
    """Largest stable step 2/ω_max (s) of central differences of a continuum alone, with its layers' delay τ.

    The layers' memories are not counted: they make no step unstable that is stable without them.
    """
    slot = body.blocks.slot - body.first_slot
    layout = Layout(slot, body.blocks.end - body.first_slot)
    moves = np.stack([~body.mesh.held] * 2 + [np.zeros_like(body.mesh.held)])
    mass = body.mass_for_limit
    return float(
        2.0 / np.sqrt(largest_eigenvalue(layout, mass, mass, np.array([1.0, 1.0, 0.0]), moves, body.fill_forces))
    )
