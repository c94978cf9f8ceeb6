"""Mistakes of free-field sides that show only beside the other tables."""

from collections.abc import Iterator, Mapping

from dembound.boundaries import BoundaryTable, FreeField, Periodic, ViscoelasticInput, normal_axis

Sides = Mapping[str, BoundaryTable | None]


def free_field_problems(boundaries: Sides) -> Iterator[str]:
    """Check that a column can stand beside the body; a side that is invalid on its own is None."""
    beside = [side for side, table in boundaries.items() if isinstance(table, FreeField)]
    for side in beside:
        if normal_axis(side) == 1:
            yield (
                f'boundary.{side}.type: "free_field" is for left and right; '
                "its column stands upright and ends where the body does"
            )
    for side, table in boundaries.items():
        if not beside or normal_axis(side) == 0:
            continue
        if isinstance(table, Periodic):
            yield f'boundary.{side}.type: is "periodic", but beside boundary.{beside[0]} stands a column with two ends'
        if isinstance(table, ViscoelasticInput) and table.source is not None:
            yield (
                f"boundary.{side}.source: makes springs differ along the side, and the column beside "
                f"boundary.{beside[0]} with them; give distance"
            )
