"""Choices for the chart of a bar where neither the command nor the case gives any."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, get_args

from dembound.accuracy.choice import COARSER, OWN, Named, valid
from dembound.accuracy.labels import label
from dembound.casefile.bar import BarCase
from dembound.methods import FiniteDifference, Method, Patch, Peridynamics, Switch

HORIZON = 3
"""Horizon of bars' methods where the case has none."""

STEP_KEYS = ("time_step", "safety", "courant")
"""Keys of ``[run]`` that determine the step of a bar."""


def bar_choices(case: BarCase) -> Named:
    """The case itself, every method with every spacing at its automatic step, and finite differences at ν = 1.

    A given step is dropped, as it would suit one method and spacing only.
    """
    yield OWN, {}
    spacing, run = case.bar.spacing, case.run.given()
    coarser = [change["bar.spacing"] for change in valid(case, ({"bar.spacing": k * spacing} for k in COARSER))]
    automatic = {key: value for key, value in run.items() if key not in ("time_step", "courant") or value == "auto"}
    exact = {key: value for key, value in run.items() if key not in STEP_KEYS} | {"courant": 1.0}
    differences = _method(case, FiniteDifference)
    for size in (spacing, *coarser):
        name = label(case, {"bar.spacing": size, "method": differences, "run.courant": 1.0})
        yield name, {"bar.spacing": size, "method": differences, "run": exact}
        for method in _methods(case):
            changes = {"bar.spacing": size, "method": method}
            yield label(case, changes), changes | ({} if automatic == run else {"run": automatic})


def _methods(case: BarCase) -> Iterator[dict[str, Any]]:
    """The methods to chart; a method of another package that the case uses comes first.

    Methods that wait for a break are included only if the bar can break.
    """
    kinds: list[type[Method]] = [FiniteDifference, Peridynamics]
    if case.bar.least_strength < math.inf:
        kinds += [Switch, Patch]
    if type(case.method) not in kinds:
        yield case.method.given()
    yield from (_method(case, kind) for kind in kinds)


def _method(case: BarCase, kind: type[Method]) -> dict[str, Any]:
    """The table of a method, with the case's values of all keys that both methods have."""
    (name,) = get_args(kind.model_fields["type"].annotation)
    horizon = {"horizon": max(case.method.largest_horizon, HORIZON)} if "horizon" in kind.model_fields else {}
    own = {key: value for key, value in case.method.given().items() if key in kind.model_fields and key != "type"}
    return {"type": name} | horizon | own
