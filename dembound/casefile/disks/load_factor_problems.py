"""Mistakes of the load factor, and of strengths that nothing reads."""

from collections.abc import Iterator, Sequence

from dembound.casefile.disks.load import Load
from dembound.casefile.disks.material import STRENGTH_KEYS, Material, with_history
from dembound.casefile.messages import numbered
from dembound.casefile.output import Output
from dembound.casefile.types import LAWS


def load_factor_problems(
    output: Output, material: Material, loads: Sequence[Load | None], has_static: bool
) -> Iterator[str]:
    """Check the material against the output; an invalid load is None. has_static : whether there is a static stage."""
    elastic = not LAWS[material.law].has_history
    if elastic and not output.load_factor:
        for key in (*STRENGTH_KEYS, "pb_fa"):
            if key in material.model_fields_set:
                yield f"material.{key}: is only allowed with law = {with_history()} or output.load_factor"
    if not output.load_factor:
        return
    if not elastic:
        yield f'output.load_factor: is of linear laws, material.law is "{material.law}"; give "elastic"'
    if material.damp > 0.0:
        yield f"output.load_factor: needs material.damp = 0, as local damping is not linear; it is {material.damp:g}"
    for place, load in numbered("load", loads):
        if load.wave is None and not has_static:
            yield f"output.load_factor: needs a [static] stage, in which the body comes to rest under {place}"
