"""What the case file of bonded disks consists of."""

from pydantic import TypeAdapter

from dembound.case.disks.load import Load
from dembound.case.disks.material import Material
from dembound.case.disks.model import DiskCase
from dembound.case.disks.monitor import Monitor
from dembound.case.disks.motion import Motion
from dembound.case.disks.problems import problems_between
from dembound.case.disks.static import Static
from dembound.case.output import Output
from dembound.case.run import Run
from dembound.case.schema import Schema
from dembound.case.types import BoundaryTable, HoleTable, PackingTable, StaticSide

SCHEMA = Schema(
    case=DiskCase,
    noun="disks",
    new="dembound new",
    marks=("packing",),
    tables={
        "packing": TypeAdapter(PackingTable),
        "material": TypeAdapter(Material),
        "motion": TypeAdapter(Motion),
        "run": TypeAdapter(Run),
        "output": TypeAdapter(Output),
    },
    side=TypeAdapter(BoundaryTable),
    staged={"static": (TypeAdapter(Static), TypeAdapter(StaticSide))},
    lists={"hole": TypeAdapter(HoleTable), "load": TypeAdapter(Load), "monitor": TypeAdapter(Monitor)},
    problems=problems_between,
)
