"""JSON files for scripts: strict JSON, which has no NaN and no infinity, written completely or not at all."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dembound.results.replacing import replacing


def write_json(path: Path, values: Any) -> None:
    """Write plain values, numbers that are not finite as null.

    Raises FileNotFoundError as `require_folder`.
    """
    with replacing(path) as part:
        part.write_text(json.dumps(strict(values), indent=2, allow_nan=False) + "\n", encoding="utf-8")


def strict(value: Any) -> Any:
    """A plain value with None in place of every number that is not finite."""
    if isinstance(value, Mapping):
        return {name: strict(inner) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        return [strict(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
