"""PFC's linear parallel-bond law: contacts without tension and with friction, bonds with a strength.

At rest it is as stiff as the elastic law; how contacts and bonds give way is in kernels/contacts.py.
"""

from typing import ClassVar

from dembound.laws.elastic import Elastic


class LinearPBond(Elastic):
    """The springs of the elastic law, with a history."""

    name: ClassVar[str] = "linearpbond"
    has_history: ClassVar[bool] = True

    @property
    def linear(self) -> str:
        """The elastic law."""
        return Elastic.name
