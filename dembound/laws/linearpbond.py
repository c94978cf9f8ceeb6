"""PFC's linear parallel-bond law: contacts without tension and with friction, bonds with a strength.

At rest its stiffness is that of the elastic law; slip, opening and breaking are computed in kernels/contacts.py.
"""

from typing import ClassVar

from dembound.laws.elastic import Elastic


class LinearPBond(Elastic):
    """The springs of the elastic law, in a history-dependent law."""

    name: ClassVar[str] = "linearpbond"
    has_history: ClassVar[bool] = True

    @property
    def linear(self) -> str:
        """Name of the elastic law."""
        return Elastic.name
