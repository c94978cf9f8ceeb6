"""The tables in the case file of a bar."""

from pydantic import TypeAdapter

from dembound.casefile.bar.bar import Bar
from dembound.casefile.bar.load import BarLoad
from dembound.casefile.bar.model import BarCase
from dembound.casefile.bar.monitor import BarMonitor
from dembound.casefile.bar.problems import bar_problems
from dembound.casefile.bar.run import BarRun
from dembound.casefile.chart import Chart
from dembound.casefile.output import Output
from dembound.casefile.schema import Schema
from dembound.casefile.sweep import Sweep
from dembound.casefile.types import BarEndTable, MethodTable

SCHEMA = Schema(
    case=BarCase,
    noun="a bar",
    new="dembound new --from rock_bar",
    marks=("bar", "method"),
    tables={
        "bar": TypeAdapter(Bar),
        "method": TypeAdapter(MethodTable),
        "run": TypeAdapter(BarRun),
        "output": TypeAdapter(Output),
        "chart": TypeAdapter(Chart),
        "sweep": TypeAdapter(Sweep),
    },
    side=TypeAdapter(BarEndTable),
    sides=("left", "right"),
    lists={"load": TypeAdapter(BarLoad), "monitor": TypeAdapter(BarMonitor)},
    problems=bar_problems,
)
