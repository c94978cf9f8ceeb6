"""The ``[[load]]`` tables."""

from pydantic import model_validator

from dembound.table import Box, FileName, Table, quantity

Vector = tuple[float, float]


class Load(Table):
    """A force or an acceleration on one particle, on those of a rectangle, or on all.

    A force is split among the particles of its region in proportion to their area; on the free surface of a continuum
    it is a uniform traction. A wave's values, taken as pure numbers, are the time factor; without one the load is
    steady and acts from the static stage on.
    """

    name: FileName = quantity(..., unit="1", help="name of the load in messages and results")
    force: Vector | None = quantity(None, unit="N/m", help="force per metre of thickness on all its particles together")
    acceleration: Vector | None = quantity(None, unit="m/s²", help="body force per mass of each particle")
    position: Vector | None = quantity(None, unit="m", help="where; the nearest particle is loaded")
    region: Box | None = quantity(
        None,
        unit="m",
        help="rectangle x0, y0, x1, y1; all particles centred in it are loaded, or the continuum's surface in it",
    )
    wave: str | None = quantity(None, unit="1", help="name of the wave that is the time factor; absent: steady")

    @property
    def key(self) -> str:
        """The key that is given: ``force`` or ``acceleration``."""
        return "acceleration" if self.force is None else "force"

    @property
    def vector(self) -> Vector:
        """The force (N/m) or acceleration (m/s²) along x and y, before the time factor."""
        return getattr(self, self.key)

    @property
    def axes(self) -> tuple[int, ...]:
        """Axes along which it acts: 0 for x, 1 for y."""
        return tuple(axis for axis, value in enumerate(self.vector) if value != 0.0)

    @model_validator(mode="after")
    def _one_action_in_one_place(self) -> "Load":
        problems = [*self._problems_with_action(), *self._problems_with_place()]
        if problems:
            raise ValueError("\n".join(problems))
        return self

    def _problems_with_action(self) -> list[str]:
        """Mistakes in force and acceleration."""
        given = [key for key in ("force", "acceleration") if getattr(self, key) is not None]
        if not given:
            return ["force: is missing; give either force or acceleration"]
        if len(given) == 2:
            return ["acceleration: is not allowed together with force"]
        return [] if self.axes else [f"{self.key}: is zero along x and y, must not be"]

    def _problems_with_place(self) -> list[str]:
        """Mistakes in position and region."""
        if self.position is not None and self.region is not None:
            return ["region: is not allowed together with position"]
        if self.region is not None:
            x0, y0, x1, y1 = self.region
            return [] if x0 < x1 and y0 < y1 else ["region: must have x0 < x1 and y0 < y1, in the order x0, y0, x1, y1"]
        if self.force is not None and self.position is None:
            return ["position: is missing; a force needs either position or region"]
        return []
