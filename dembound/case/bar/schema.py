"""What the case file of a bar consists of."""

from pydantic import TypeAdapter

from dembound.case.bar.bar import Bar
from dembound.case.bar.load import BarLoad
from dembound.case.bar.model import BarCase
from dembound.case.bar.monitor import BarMonitor
from dembound.case.bar.problems import bar_problems
from dembound.case.bar.run import BarRun
from dembound.case.output import Output
from dembound.case.schema import Schema
from dembound.case.types import BarEndTable, MethodTable

SCHEMA = Schema(
    case=BarCase,
    noun="a bar",
    new="dembound new --bar",
    marks=("bar", "method"),
    tables={
        "bar": TypeAdapter(Bar),
        "method": TypeAdapter(MethodTable),
        "run": TypeAdapter(BarRun),
        "output": TypeAdapter(Output),
    },
    side=TypeAdapter(BarEndTable),
    sides=("left", "right"),
    lists={"load": TypeAdapter(BarLoad), "monitor": TypeAdapter(BarMonitor)},
    problems=bar_problems,
)
