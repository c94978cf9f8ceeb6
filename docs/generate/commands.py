"""The reference of commands: arguments and options of each, with the texts of its help."""

import enum
import inspect
import re
import typing
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer
from paragraphs import GENERATED, joined

from dembound.cli.app import EXIT_CODES, MORE, app

COMMANDS = """# Commands

All commands with their arguments and options, as `dembound --help` and `dembound COMMAND --help` print them. What
several commands have in common is explained once, [below](#options-of-several-commands).
"""


def commands() -> str:
    """The page of all commands."""
    panels: dict[str, list[str]] = {}
    every: dict[str, Any] = {}
    group: Any = typer.main.get_command(app)
    for name in group.list_commands(group.make_context("dembound", [], resilient_parsing=True)):
        command = group.commands[name]
        found = {name: command} | {f"{name} {inner}": each for inner, each in getattr(command, "commands", {}).items()}
        panels.setdefault(command.rich_help_panel or "Usual commands", []).extend(found)
        every |= found
    given = {name: _arguments(command) + _options(command) for name, command in every.items()}
    count = Counter(line for lines in given.values() for line in lines)
    names = [_name(line) for line, times in count.most_common() if times > 1]
    common = [line for line, times in count.most_common() if times > 1]
    common = [line for place, line in enumerate(common) if _name(line) not in names[:place]]
    codes = EXIT_CODES.removeprefix("Exit codes: ").rstrip(".").split("; ")
    texts = [COMMANDS.rstrip(), "## Exit codes", "\n".join("- `{}`: {}".format(*code.split(" ", 1)) for code in codes)]
    for panel, of_panel in panels.items():
        texts.append(f"## {'More commands' if panel == MORE else panel}")
        for name in of_panel:
            texts += _command(name, every[name], given[name], common)
    return GENERATED + joined([*texts, "## Options of several commands", "\n".join(sorted(common))])


def _name(line: str) -> str:
    """The name of the argument or option that a line explains."""
    return line.split("`")[1]


def _command(name: str, command: Any, lines: Sequence[str], common: Sequence[str]) -> list[str]:
    """The texts of one command: its sentences, its own arguments and options, and the names of the others."""
    usage = " ".join(["dembound", name, *(_argument(each) for each in command.params if _is_argument(each))])
    shared = [f"`{_name(line)}`" for line in lines if line in common and "`--" in line]
    return [
        f"### {name}",
        f"`{usage}`: {_as_code(' '.join(inspect.cleandoc(command.help or '').split()))}",
        "\n".join([line for line in lines if line not in common] + ([f"- {', '.join(shared)}"] if shared else [])),
    ]


def _as_code(text: str) -> str:
    """The text of a command with options as code, and pages of docs as links."""
    text = re.sub(
        r"docs/((?:\w+/)*)(\w+)\.md", lambda page: f"[{page[2].replace('_', ' ')}](../{page[1]}{page[2]}.md)", text
    )
    return re.sub(r"(?<![`\w-])(--[a-z][a-z-]*(?: [a-z]+\.[a-z]+=\w+)?)", r"`\1`", text)


def _is_argument(parameter: Any) -> bool:
    return bool(parameter.param_type_name == "argument")


def _arguments(command: Any) -> list[str]:
    """The arguments of a command, a line each."""
    return [f"- `{_value(each)}`: {_as_code(each.help or '')}" for each in command.params if _is_argument(each)]


def _argument(parameter: Any) -> str:
    """An argument in the usage line."""
    return _value(parameter) if parameter.required else f"[{_value(parameter)}]"


def _value(parameter: Any) -> str:
    """What stands for the value of an argument."""
    return (parameter.metavar or parameter.name.upper()).strip("[]")


def _options(command: Any) -> list[str]:
    """The options of a command, a line each, in the order of its help, without ``--help``."""
    signature = inspect.signature(command.callback, eval_str=True).parameters
    return [
        f"- {_names(each, signature[each.name].annotation)}: {_as_code(each.help or '')}{_given(each)}"
        for each in command.params
        if not _is_argument(each) and not each.hidden and each.name in signature
    ]


def _names(parameter: Any, annotation: Any) -> str:
    """The names of an option, and what it takes."""
    names = ", ".join(f"`{name}`" for name in (*parameter.opts, *parameter.secondary_opts))
    return names if parameter.is_flag else f"{names} {parameter.metavar or _kind(annotation)}"


def _kind(annotation: Any) -> str:
    """What an option of a Python type takes."""
    choices: tuple[Any, ...] = ()
    while not choices and (inner := [each for each in typing.get_args(annotation) if each is not type(None)]):
        choices, annotation = (tuple(inner), str) if typing.get_origin(annotation) is typing.Literal else ((), inner[0])
    if choices or issubclass(annotation, enum.Enum):
        *others, last = map(str, choices or annotation)
        return f"{', '.join(others)} or {last}"
    return {int: "N", float: "X", Path: "PATH"}.get(annotation, "TEXT")


def _given(parameter: Any) -> str:
    """The default of an option, as a sentence."""
    value = parameter.default
    if value in (None, (), [], False):
        return ""
    return f" Default: {'on' if value is True else f'`{value.value if isinstance(value, enum.Enum) else value}`'}."
