"""The tables in the case file of bonded disks."""

from pydantic import TypeAdapter

from dembound.casefile.chart import Chart
from dembound.casefile.disks.damping import Damping
from dembound.casefile.disks.ground import Ground
from dembound.casefile.disks.incident import IncidentWave
from dembound.casefile.disks.layer import Layer, completed_by_layers
from dembound.casefile.disks.load import Load
from dembound.casefile.disks.material import Material
from dembound.casefile.disks.model import DiskCase
from dembound.casefile.disks.monitor import Monitor
from dembound.casefile.disks.motion import Motion
from dembound.casefile.disks.outside import OutsideTable
from dembound.casefile.disks.problems import problems_between
from dembound.casefile.disks.reduce import Reduce
from dembound.casefile.disks.run import DiskRun
from dembound.casefile.disks.static import Static
from dembound.casefile.output import Output
from dembound.casefile.schema import Schema
from dembound.casefile.sweep import Sweep
from dembound.casefile.types import BoundaryTable, HoleTable, PackingTable, StaticSide

SCHEMA = Schema(
    case=DiskCase,
    noun="disks",
    new="dembound new",
    marks=("packing",),
    tables={
        "ground": TypeAdapter(Ground),
        "packing": TypeAdapter(PackingTable),
        "material": TypeAdapter(Material),
        "damping": TypeAdapter(Damping),
        "motion": TypeAdapter(Motion),
        "outside": TypeAdapter(OutsideTable),
        "reduce": TypeAdapter(Reduce),
        "run": TypeAdapter(DiskRun),
        "output": TypeAdapter(Output),
        "chart": TypeAdapter(Chart),
        "sweep": TypeAdapter(Sweep),
    },
    side=TypeAdapter(BoundaryTable),
    optional={"incident": TypeAdapter(IncidentWave)},
    staged={"static": (TypeAdapter(Static), TypeAdapter(StaticSide))},
    lists={
        "layer": TypeAdapter(Layer),
        "hole": TypeAdapter(HoleTable),
        "load": TypeAdapter(Load),
        "monitor": TypeAdapter(Monitor),
    },
    problems=problems_between,
    completed=completed_by_layers,
    completing={"material": "layer"},
)
