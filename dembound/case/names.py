"""Names that results are kept under."""

import re
from typing import Annotated

from pydantic import AfterValidator


def _serves_as_file_name(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9_.-]*", name):
        raise ValueError(f'is "{name}", must be made of the letters A-Z and a-z, digits, "_", "-" and "." (not first)')
    return name


FileName = Annotated[str, AfterValidator(_serves_as_file_name)]
"""A name that may become a file's on every system."""
