"""The reference of case files: all tables and keys, with the texts of the tables (docstrings and `quantity`)."""

import inspect
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from paragraphs import GENERATED, joined

from dembound import boundaries, holes, methods, packings, waves
from dembound.boundaries import Boundary
from dembound.casefile.bar.bar import Bar, BarRange
from dembound.casefile.bar.model import BarLoad, BarMonitor, BarRun
from dembound.casefile.disks.ground import Ground
from dembound.casefile.disks.group import Group
from dembound.casefile.disks.incident import Damping, IncidentWave, Motion
from dembound.casefile.disks.joint_sets import JointTable
from dembound.casefile.disks.layer import Layer, OutsideTable
from dembound.casefile.disks.load import Load
from dembound.casefile.disks.material import Material
from dembound.casefile.disks.model import DiskRun, Reduce
from dembound.casefile.disks.monitor_rows import MonitorTable
from dembound.casefile.disks.static import Static
from dembound.casefile.disks.targets import Scatter
from dembound.casefile.disks.wall import Wall
from dembound.casefile.tables import Chart, ChartChoice, Output, Sweep
from dembound.table import LARGEST_WHOLE, Table, name_of

Type = type[Table]


class Row(NamedTuple):
    """A key of a table: its name, unit, allowed values, default ("required" if it must be given) and meaning.

    Allowed values are empty where the default is true or false.
    """

    key: str
    unit: str
    values: str
    default: str
    meaning: str

    def __str__(self) -> str:
        """The row as an item of a list; values that the meaning names, and > 0 of a unit, are left out."""
        required = self.default == "required"
        equal = f" = {self.default}" if self.default and not required else ""
        named = self.values if not all(each in self.meaning for each in self.values.split(", ")) else ""
        limits = "" if self.unit and named == "> 0" else named
        what = ", ".join(filter(None, (self.unit, limits, "required" if required else "")))
        return f"- `{self.key}`{equal}{f' ({what})' if what else ''}: {self.meaning}"


@dataclass(frozen=True)
class Part:
    """A part of the page of case files.

    Attributes
    ----------
    heading : its heading, from which its anchor follows.
    tables : the table, or the types of it.
    base : what types have in common, whose sentence begins the part; None: one table.
    within : the part whose table has keys of the same meaning, which are not explained again; None: none.
    more : a text below the sentence. guide : the page of docs that tells how to use it; empty for none.
    """

    heading: str
    tables: Sequence[Type]
    base: Type | None = None
    within: "Part | None" = None
    more: str = ""
    guide: str = ""


MATERIAL = Part("`[material]`", (Material,), guide="tasks/cracks")
RUN = Part("`[run]`", (DiskRun,))
BAR = Part("`[bar]`", (Bar,), guide="tasks/bars")

DISKS = (
    Part("`[packing]`", packings.TYPES, packings.Packing),
    Part("`[ground]`", (Ground,), guide="tasks/absorb_waves"),
    MATERIAL,
    Part(
        "`[material.pb_scatter]`",
        (Scatter,),
        more='In the line of its key: `pb_scatter = {type = "weibull", shape = 5.0}`.',
        guide="tasks/cracks",
    ),
    Part("`[[layer]]`", (Layer,), within=MATERIAL, guide="tasks/layers"),
    Part("`[[group]]`", (Group,), within=MATERIAL, guide="tasks/breaking_ground"),
    Part("`[damping]`", (Damping,), guide="tasks/damping"),
    Part("`[motion]`", (Motion,)),
    Part("`[reduce]`", (Reduce,), guide="evidence/reductions"),
    Part(
        "`[boundary]`",
        boundaries.TYPES,
        Boundary,
        more="The sides are tables `[boundary.left]`, `[boundary.right]`, `[boundary.bottom]` and `[boundary.top]`.",
        guide="tasks/absorb_waves",
    ),
    Part("`[outside]`", (OutsideTable,), guide="tasks/absorb_waves"),
    Part(
        "`[static]`",
        (Static,),
        more="Its sides are tables `[static.boundary.left]` and so on, of type `"
        + "`, `".join(f'"{name_of(table)}"' for table in boundaries.TYPES if table.for_static)
        + "`.",
        guide="tasks/holes_and_stress",
    ),
    Part("`[incident]`", (IncidentWave,), guide="tasks/absorb_waves"),
    Part("`[wave]`", waves.TYPES, waves.Wave, more="Each wave is a table `[wave.NAME]`."),
    Part("`[[load]]`", (Load,), guide="tasks/blasts"),
    Part("`[[hole]]`", holes.TYPES, holes.Hole, guide="tasks/holes_and_stress"),
    Part("`[[wall]]`", (Wall,), guide="tasks/walls"),
    Part("`[[joint]]`", (JointTable,), guide="tasks/joints"),
    Part("`[[monitor]]`", (MonitorTable,), guide="tasks/show_results"),
    RUN,
    Part("`[output]`", (Output,), guide="tasks/show_results"),
    Part("`[chart]`", (Chart,), guide="tasks/trust_a_result"),
    Part("`[[chart.choice]]`", (ChartChoice,)),
    Part("`[sweep]`", (Sweep,), guide="tasks/many_runs"),
)
"""The tables of a case of disks."""

BARS = (
    BAR,
    Part("`[[bar.range]]`", (BarRange,), within=BAR),
    Part("`[method]`", methods.TYPES, methods.Method, guide="tasks/bars"),
    Part("`[[load]]` of a bar", (BarLoad,)),
    Part("`[[monitor]]` of a bar", (BarMonitor,)),
    Part("`[run]` of a bar", (BarRun,), within=RUN),
)
"""The tables of a case of a bar that are not those of disks."""

RULES = """# The case file

All tables and keys of a case, a TOML file.

- **Units** are SI, angles degrees. Two dimensions mean a thickness of 1 m: forces are per metre.
- **Signs**: velocities are positive along +x and +y on every side; tension is positive, a pressure pushes.
- **Names** of loads, holes, walls and monitors consist of A–Z, a–z, 0–9, `_`, `-` and `.` (not first).
- **Sizes**: numbers are 0 or between 1e-30 and 1e30; a scene has at most 5e8 disks, a random brick 1e6, a bar 2e6
  spacings, a case 1,000 monitors.
- **Keys**: `seed` = 0 has a default, (m) is a positive number in metres; unknown keys and tables are refused.
- **Files** are relative to the folder of the case.
- `--set load.blow.pressure=5e6` changes a key for one command; layers, loads, holes, walls and monitors go by names or
  numbers.
- Z is Zhou et al. (2018), L is Lu & Wang (2016).

At the top level a case may have a `title`, one line for pictures and reports.
"""

BAR_RULES = """## Case of a bar

A file with `[bar]` is the case of a bar. It has the tables below, and [`[wave]`](#wave), [`[output]`](#output) (without
effect: `stress`, `contacts`, `load_factor`), [`[chart]`](#chart) and [`[sweep]`](#sweep) as above.
"""

BAR_ENDS = """## `[boundary]` of a bar

Tables `[boundary.left]` and `[boundary.right]` of the types {types}, with the keys named there but `wave_s`, `beta_s`
and `half_mass`; a `beta_p` of `"matched"` is 1. An end without a table is free.
"""


def case_file() -> str:
    """The page of all tables and keys of case files."""
    ends = [f'[`"{name_of(table)}"`](#boundary-{name_of(table)})' for table in boundaries.TYPES if table.for_bars]
    bars = [_part(part) for part in BARS]
    bars.insert(3, BAR_ENDS.format(types=", ".join(ends)))
    return GENERATED + "\n".join([RULES, *map(_part, DISKS), BAR_RULES, *bars]).rstrip() + "\n"


def _part(part: Part) -> str:
    """A part: the sentence, the keys of several types, and the first sentence of each; or the keys of the one table."""
    given = {table: _rows(table) for table in part.tables}
    guide = f"[{part.guide.split('/')[-1].replace('_', ' ').capitalize()}](../{part.guide}.md)" if part.guide else ""
    texts: list[str] = [f"## {part.heading}", _sentence(part.base or part.tables[0]), part.more, guide]
    if part.base is None:
        rows = given[part.tables[0]]
        known = _rows(part.within.tables[0]) if part.within else []
        names = {row.key for row in known}
        shared = [row for row in rows if row in known or (row.key in names and row.default != "required")]
        if part.within and shared:
            texts.append(f"As in [{part.within.heading}](#{_slug(part.within.heading)}): {_named(shared)}.")
        return joined([*texts, _keys(row for row in rows if row not in shared)])
    count = Counter(row for rows in given.values() for row in rows)
    of_all = [row for row in count if count[row] == len(given)]
    of_several = [row for row in count if 1 < count[row] < len(given)]
    for head, rows in (("Keys of all types:", of_all), ("Keys of several types:", of_several)):
        texts += [head, _keys(rows)] if rows else []
    for table, rows in given.items():
        shared = [row for row in rows if row in of_several]
        also = f"Also {_named(shared)}." if shared else ""
        own = [row for row in rows if count[row] == 1]
        texts += [f'### {part.heading} `"{name_of(table)}"`', _sentence(table).split("\n\n")[0], also, _keys(own)]
    return joined(texts)


def _named(rows: Iterable[Row]) -> str:
    """The names of keys."""
    return ", ".join(f"`{row.key}`" for row in rows)


def _slug(heading: str) -> str:
    """The anchor of a heading."""
    return re.sub(r"[^\w -]", "", heading.lower()).strip().replace(" ", "-")


def _sentence(table: Type) -> str:
    """A table's docstring, up to its first section such as Attributes or Notes."""
    text = re.split(r"\n\n\w+\n-+\n", inspect.getdoc(table) or "")[0]
    return _quoted(re.sub(r"(?<!\n)\n(?!\n)", " ", text).replace("``", "`"))


def _quoted(text: str) -> str:
    """The text with names of several words, and values in quotation marks, as code."""
    text = re.sub(r'(?<![`{] )(?<!`)("[\w:]+")', r"`\1`", text)
    return re.sub(r"(?<![`\"\w.])([a-z]+(?:[_.][a-z]+)+|\[\[?[a-z.]+\]?\])(?![\w`./])", _if_key, text)


def _if_key(found: re.Match[str]) -> str:
    """A name as code, if it is that of a key or table."""
    word = found[1]
    return f"`{word}`" if word[0] == "[" or word.split(".")[-1] in KEYS else word


def _rows(table: Type) -> list[Row]:
    """The keys of a table, without the one that gives its type."""
    schema = table.model_json_schema()
    required = schema.get("required", [])
    return [
        Row(
            key,
            "" if value.get("unit", "1") == "1" else value["unit"],
            _values(value),
            "required" if key in required else _default(value.get("default")),
            _quoted(value["description"]),
        )
        for key, value in schema["properties"].items()
        if "const" not in value
    ]


KEYS = {table.key_of(name) for part in (*DISKS, *BARS) for table in part.tables for name in table.model_fields}
"""All keys."""


def _default(value: Any) -> str:
    """A default value as TOML; empty for none."""
    if value is None or value in ([], {}):
        return ""
    if isinstance(value, list):
        texts = (f'"{each}"' if isinstance(each, str) else f"{each:g}" for each in value)
        return f"`[{', '.join(texts)}]`"
    text = {True: "true", False: "false"}.get(value) if isinstance(value, bool) else None
    return f"`{text or (f'{value:g}' if isinstance(value, float) else repr(value).replace(chr(39), chr(34)))}`"


def _values(schema: Mapping[str, Any]) -> str:
    """The allowed values of a key, in words."""
    if "anyOf" in schema:
        kinds = [_values(each) for each in schema["anyOf"] if each.get("type") != "null"]
        return " or ".join(kind or "text" for kind in kinds) if len(kinds) > 1 else kinds[0]
    if "enum" in schema or "const" in schema:
        return ", ".join(f'`"{each}"`' for each in schema.get("enum", [schema.get("const")]))
    if "$ref" in schema or schema.get("type") == "object":
        return "table"
    kind = schema["type"]
    if kind == "array":
        if "prefixItems" in schema:
            items = [_values(each) for each in schema["prefixItems"]]
            return f"{len(items)} {_plural(items[0])}"
        inner = _values(schema["items"])
        return "tables" if inner == "table" else f"list of {inner}"
    if kind in ("number", "integer"):
        return _range(schema, "whole number" if kind == "integer" else "number")
    return {"boolean": "" if isinstance(schema.get("default"), bool) else "true or false", "string": ""}[kind]


def _plural(values: str) -> str:
    """The values of several numbers, from those of one."""
    noun, found, limits = values.rpartition("number")
    return f"{noun}numbers {limits.strip() if found else values}".strip()


def _range(schema: Mapping[str, Any], noun: str) -> str:
    """The limits of a number."""
    schema = {name: value for name, value in schema.items() if value != LARGEST_WHOLE}
    if "minimum" in schema and "maximum" in schema:
        limits = [f"{_number(schema['minimum'])}–{_number(schema['maximum'])}"]
    else:
        signs = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
        limits = [f"{sign} {_number(schema[name])}" for name, sign in signs.items() if name in schema]
    return " ".join(([noun] if noun != "number" or not limits else []) + ([", ".join(limits)] if limits else []))


def _number(value: float) -> str:
    """A limit, short."""
    return f"{value:,}" if isinstance(value, int) else f"{value:g}".replace("-", "−")


def _keys(rows: Iterable[Row]) -> str:
    """A list of keys; empty without any."""
    return "\n".join(map(str, rows))
