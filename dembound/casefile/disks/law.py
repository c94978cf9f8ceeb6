"""Keys of [material] that single laws add, and mistakes in a case that depend on its law."""

from collections.abc import Iterator, Mapping
from typing import Any

from dembound.casefile.types import LAWS
from dembound.table import Table, quantity

KEYS = {key.name: key for law in LAWS.values() for key in law.keys}
"""Keys that single laws add, by name."""

FIELDS: dict[str, Any] = {
    key.name: (float | None, quantity(None, unit=key.unit, means=key.means, help=key.help, **key.limits))
    for key in KEYS.values()
}
"""The same as fields of a table."""


def with_history() -> str:
    """The history-dependent laws that start elastic, for messages."""
    return " or ".join(f'"{name}"' for name, law in LAWS.items() if law.has_history and law.starts_elastic)


def keys_problems(material: Table, law_name: str, stiff: tuple[str, ...]) -> Iterator[str]:
    """Keys of a material that belong to another law, that its law lacks, or that it has no use for.

    stiff : keys from which the stiffness follows under laws without keys of their own.
    """
    law, own = LAWS[law_name], [key.name for key in LAWS[law_name].keys]
    for name, other in LAWS.items():
        for key in other.keys:
            if key.name in material.model_fields_set and key.name not in own:
                yield f'{key.name}: is only allowed with law = "{name}"'
    for name in own:
        if getattr(material, name) is None:
            yield f'{name}: is missing; law = "{law_name}" needs {" and ".join(own)}'
    if law.uses is not None:
        for name in type(material).model_fields:
            if name in material.model_fields_set - {*law.uses, *KEYS}:
                why = f"whose stiffness follows from {' and '.join(own)}" if name in stiff else "which does not use it"
                yield f'{name}: is not allowed with law = "{law_name}", {why}'


def law_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """What a law that does not start elastic does not go with: it has no stiffness without a stress at rest.

    tables : of the case by name; None for an invalid one.
    """
    material, static = tables["material"], tables["static"]
    if not material or LAWS[material.law].starts_elastic:
        return
    given = f'material.law is "{material.law}"'
    if tables["layer"]:
        yield f"layer: {given}, which is for uniform ground; layers need a law that starts elastic, as {with_history()}"
    if static and static.k0 is not None:
        yield f"static.k0: {given}, whose stiffness would change with depth; give static.stress, the same everywhere"
    is_pressed = static and static.stress and any(static.stress)
    for side, table in tables["boundary"].items():
        if not table:
            continue
        if table.is_outside:
            yield f'boundary.{side}.type: is "outside", but {given}; "viscous" or "free_field" absorb its waves'
        elif not is_pressed and (table.factors or table.needs_column or table.waves):
            yield (
                f"boundary.{side}: needs wave speeds, but {given}, whose contacts have no stiffness without pressure; "
                "give static.stress"
            )
