"""A body at rest, from which a run or a static stage can start."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from dembound.disks.contacts.contact_list import ContactList


@dataclass(frozen=True)
class Start:
    """A body at rest to start from: displacement (3, n) m and rad since it was built, and its contacts.

    contacts : of each part by name, empty if the scene's law has no history. The system that starts from them changes
    them, so a start can be used only once. has_history : whether they have any history.
    """

    displacement: np.ndarray
    contacts: Mapping[str, ContactList] = field(default_factory=dict)
    has_history: bool = False

    def __post_init__(self) -> None:
        """Store displacements row after row, as in a record, so that sums over them have the same bits from there."""
        object.__setattr__(self, "displacement", np.ascontiguousarray(self.displacement))
