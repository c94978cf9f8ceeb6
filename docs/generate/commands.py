"""The reference of commands: arguments and options of each, with the texts of its help."""

import enum
import inspect
import re
import typing
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import typer
from paragraphs import GENERATED, joined

from dembound.cli.app import EXIT_CODES, MORE, app

COMMANDS = """# Commands

Options with … may be repeated; `dembound COMMAND --help` prints more. Options of several commands are explained
[below](#options-of-several-commands).
"""

MANY = 5
"""From this number on, options of the same commands have a list of their own."""


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
    count = Counter(line for given_lines in given.values() for line in given_lines)
    usual = [_name(line) for line, times in count.most_common() if times > 1]
    common = [line for line, times in count.most_common() if times > 1]
    common = [line for place, line in enumerate(common) if _name(line) not in usual[:place]]
    codes = EXIT_CODES.removeprefix("Exit codes: ").rstrip(".").split("; ")
    users = {line: tuple(name for name in given if line in given[name]) for line in common}
    group_of = {line: names for line, names in users.items() if list(users.values()).count(names) >= MANY}
    texts = [COMMANDS.rstrip(), "## Exit codes", "\n".join("- `{}`: {}".format(*code.split(" ", 1)) for code in codes)]
    for panel, of_panel in panels.items():
        texts.append(f"## {'More commands' if panel == MORE else panel}")
        for name in of_panel:
            texts += _command(name, every[name], given[name], common, group_of)
    texts += ["## Options of several commands", "\n".join(sorted(set(common) - set(group_of)))]
    for group in sorted(set(group_of.values())):
        lines = sorted(line for line in group_of if group_of[line] == group)
        texts += [f"### Options of {_and(group)}", "\n".join(lines)]
    return GENERATED + joined(texts)


def _and(names: Sequence[str]) -> str:
    """Names in one phrase."""
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))


def _name(line: str) -> str:
    """The name of the argument or option that a line explains."""
    return line.split("`")[1]


def _command(
    name: str, command: Any, lines: Sequence[str], common: Sequence[str], group_of: Mapping[str, tuple[str, ...]]
) -> list[str]:
    """The texts of one command: its sentence, its own arguments and options, and the names of the others."""
    usage = " ".join(["dembound", name, *(_argument(each) for each in command.params if _is_argument(each))])
    shared = [f"`{_name(line)}`" for line in lines if line in common and "`--" in line and line not in group_of]
    heads = {f"Options of {_and(group_of[line])}" for line in lines if line in group_of}
    shared += [f"[{head[0].lower()}{head[1:]}](#{head.lower().replace(' ', '-')})" for head in sorted(heads)]
    return [
        f"### {name}",
        f"`{usage}`: {_as_code(_first_sentence(command.help or ''))}",
        "\n".join([line for line in lines if line not in common] + ([f"- {', '.join(shared)}"] if shared else [])),
    ]


def _first_sentence(text: str) -> str:
    """The first sentence of the help of a command or option, without the hint that the latter may be repeated."""
    text = re.sub(r"[.;] (May|may) be repeated\b", "", " ".join(inspect.cleandoc(text).split()))
    return re.split(r"(?<=[^.]\.) (?=[A-Z])", text)[0].rstrip(".")


def _as_code(text: str) -> str:
    """The text of a command with options as code."""
    return re.sub(r"(?<![`\w-])(--[a-z][a-z-]*(?: [a-z]+\.[a-z]+=\w+)?)", r"`\1`", text)


def _is_argument(parameter: Any) -> bool:
    return bool(parameter.param_type_name == "argument")


def _arguments(command: Any) -> list[str]:
    """The arguments of a command, a line each."""
    return [
        f"- `{_value(each)}`: {_as_code(_first_sentence(each.help or ''))}"
        for each in command.params
        if _is_argument(each)
    ]


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
        f"- {_names(each, signature[each.name].annotation)}{_given(each)}: {_as_code(_first_sentence(each.help or ''))}"
        for each in command.params
        if not _is_argument(each) and not each.hidden and each.name in signature
    ]


def _names(parameter: Any, annotation: Any) -> str:
    """The names of an option, and what it takes, with … if it may be repeated."""
    names = ", ".join(f"`{name}`" for name in (*parameter.opts, *parameter.secondary_opts))
    often = " …" if parameter.multiple else ""
    return names if parameter.is_flag else f"{names} {parameter.metavar or _kind(annotation)}{often}"


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
    """The default of an option, behind its names; empty for a switch that is off."""
    value = parameter.default
    if value in (None, (), [], False):
        return ""
    return f" = {'on' if value is True else f'`{value.value if isinstance(value, enum.Enum) else value}`'}"
