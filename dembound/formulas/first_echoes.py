"""Times of the first echoes of artificial sides at monitors, from travel times of waves."""

from collections.abc import Iterator

import numpy as np

from dembound.boundaries import SIDES, normal_axis
from dembound.motion.endings import monitored
from dembound.motion.kind import Plan
from dembound.words import Entries


def echoes(planned: Plan) -> Entries:
    """The line for `dembound check` on the first echo of each artificial side, if there are any within the run."""
    scene = planned.scene
    if scene.case.monitor and (lines := list(_echoes(planned))):
        yield "echoes", "; ".join(lines)


def _echoes(planned: Plan) -> Iterator[str]:
    """A line for each artificial side without waves with the time of its first echo at a monitor."""
    scene = planned.scene
    sources = planned.kind.sources(scene)
    speed, places = planned.kind.front(scene, planned.time_step).speed, monitored(scene)
    names = [monitor.name for monitor in scene.case.monitor]
    for side in SIDES:
        table, axis = scene.case.side(side), normal_axis(side)
        is_across = axis in planned.stepped.uniform_axes or scene.size[axis] == 0.0
        if is_across or not table.may_move or table.absorber:
            continue
        seen = [source for source in sources if source.is_local or not table.needs_column]  # of columns only local ones
        times = [source.start + source.distance_over(side, scene.plane(side), places) / speed for source in seen]
        first = np.min(times, axis=0, initial=np.inf) if times else np.full(len(places), np.inf)
        if first.min() < scene.case.run.duration:
            yield f"{side} ({table.type}) may reflect to {names[int(first.argmin())]} from {first.min():.3g} s on"
