"""An absorbing end of a bar: a layer of nodes beyond it, in which waves decay without being reflected.

The layer has the spacing and the bonds of the bar. Velocities of nodes and forces of bonds decay at the same rate d(x),
at every frequency, so that the impedance remains that of the bar (a perfectly matched layer, Berenger 1994); on nodes
only the changes of d within a wavelength reflect. See bar/layers.py.
"""

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

import numpy as np

from dembound.boundaries.boundary import Drivable, Layer
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Waves
from dembound.table import quantity


class MatchedLayer(Drivable):
    """Absorbs all wavelengths in nodes beyond the end of a bar, through which a wave may enter; not for disks."""

    for_bars: ClassVar[bool] = True

    type: Literal["matched_layer"]
    nodes: int = quantity(40, means="count", ge=4, le=10_000)
    """number N of nodes beyond the end, at least twice the horizon"""
    power: float = quantity(3.0, means="setting", ge=1.0, le=10.0)
    """power p with which the rate of decay rises with the depth"""
    reflection: float | None = quantity(None, means="share", gt=0.0, lt=1.0)
    """R0, theoretical reflection of the outer end; absent: 10^−(4 + N/20), at least 1e-12"""

    @property
    def is_artificial(self) -> bool:
        """True, as the layer represents more of the bar."""
        return True

    @property
    def layer(self) -> Layer:
        """The absorbing layer."""
        reflection = usual_reflection(self.nodes) if self.reflection is None else self.reflection
        return Layer(self.nodes, self.power, reflection)

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """Mistakes: a side of disks, a layer shorter than two horizons, or one beside a range that moves."""
        yield from super().problems(side, tables)
        if "bar" not in tables:
            yield f'boundary.{side}.type: is "{self.type}", which is for ends of bars; for disks take "outside"'
            return
        method = tables["method"]
        if method and self.nodes < 2 * method.horizon_beyond:
            least = 2 * method.horizon_beyond
            yield f"boundary.{side}.nodes: is {self.nodes}, must be at least {least}, twice method.horizon"
        bar = tables["bar"]
        if bar and bar.range and (moving := bar.range[0 if side == "left" else -1]).velocity:
            yield f"boundary.{side}.type: its layer is at rest, but range {moving.name} beside it has a velocity"

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """The force 2ρcA·v_i of a wave on the end node, of which the layer takes one half, and its power."""
        impedance = medium.density * medium.p_wave_speed * edge.length
        wave = waves[self.wave_p] if self.wave_p else None
        if wave is not None:
            supports.add(edge.nodes, edge.axis, drive=2.0 * impedance, signal=wave.velocity)
        supports.add_power(
            edge.side, lambda times: np.zeros_like(times) if wave is None else impedance * wave.velocity(times) ** 2
        )

    def describe(self, edge: Edge, medium: BoundaryMedium) -> dict[str, Any]:
        """Number of nodes, power and R0."""
        layer = self.layer
        return super().describe(edge, medium) | {
            "nodes": layer.nodes,
            "power": layer.power,
            "reflection": layer.reflection,
        }


def usual_reflection(nodes: int) -> float:
    """R0 = 10^−(4 + N/20), at least 1e-12: the outer end and the profile then reflect about the same.

    Measured with pulses of 20 spacings and p = 3, finite differences and peridynamics (docs/evidence/bar_ends.md): 1e-6
    for 40 nodes, 1e-8 for 80.
    """
    return max(10.0 ** -(4.0 + nodes / 20.0), 1e-12)
