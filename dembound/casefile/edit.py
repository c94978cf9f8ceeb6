"""Changes of keys in the TOML text of a case that keep comments and order, and cases made from others."""

from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from difflib import SequenceMatcher
from functools import lru_cache
from itertools import groupby
from pathlib import Path
from typing import Any

import tomli_w

from dembound.casefile.keys import Place, Statement, applied, lines_of, statements_of
from dembound.casefile.model import Case, Schema
from dembound.casefile.reader import allowed, case_of_tables, parsed

ROUNDS = 3
"""Largest number of passes: later ones write tables that have lost their last key as empty tables."""


def edited(text: str, changes: Mapping[str, Any]) -> str:
    """The text with the values at dotted keys replaced, added, or with None left out, see `keys.applied`.

    All other lines remain. A value that is a table or a list is compared with the present one, and only differences are
    written. New keys are placed below the others of their table, new tables at the end of the table they are in.

    Raises CaseError for a text that is not TOML, and for keys that lead to no table.
    """
    return rewritten(text, applied(parsed(text), changes))


def rewritten(text: str, requested: Mapping[str, Any]) -> str:
    """The text with as few lines changed as needed to give the requested tables; errors as of `edited`."""
    for _ in range(ROUNDS):
        present = parsed(text)
        if _same(present, requested):
            return text
        page = _Page(text)
        _edit(page, (), present, requested)
        text = "".join(page.lines)
    if not _same(parsed(text), requested):
        raise RuntimeError("the text of the case could not be edited")
    return text


def commented(text: str, key: str, comments: Sequence[str], mark: str) -> str:
    """The text with lines of comments above the value at a dotted key, without those there that begin with a mark.

    Raises CaseError for a text that is not TOML, KeyError for a key that is not there.
    """
    page = _Page(text)
    statement = page.value_at(tuple(key.split(".")))
    if statement is None:
        raise KeyError(key)
    line = page.lines[statement.begin]
    indent, begin = line[: len(line) - len(line.lstrip())], statement.begin
    while begin > 0 and page.lines[begin - 1].lstrip().startswith(mark):
        begin -= 1
    page.lines[begin : statement.begin] = [f"{indent}{comment}{page.ending}" for comment in comments]
    return "".join(page.lines)


def _same(one: Any, other: Any) -> bool:
    """Whether values are equal and of the same types; the order of keys is free."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    return repr(one) == repr(other)


def _edit(page: "_Page", place: Place, present: Any, requested: Any) -> None:
    """Replace the value at a place by the requested one."""
    if _same(present, requested):
        return
    if isinstance(present, Mapping) and isinstance(requested, Mapping):
        for key in present.keys() - requested.keys():
            page.remove((*place, key))
        for key, value in requested.items():
            if key in present:
                _edit(page, (*place, key), present[key], value)
            else:
                page.add(place, key, value)
    elif _are_tables(present) and _are_tables(requested):
        _edit_list(page, place, present, requested)
    elif isinstance(present, list) and isinstance(requested, list) and len(present) == len(requested):
        for index, pair in enumerate(zip(present, requested, strict=True)):
            _edit(page, (*place, index), *pair)
    elif page.value_at(place) is not None:
        page.set(place, requested)
    else:
        page.remove(place)
        page.add(place[:-1], str(place[-1]), requested)


def _edit_list(page: "_Page", place: Place, present: Sequence[Any], requested: Sequence[Any]) -> None:
    """Edit a list of tables, each by comparison with the one of its name."""
    old, new = ([repr(each.get("name", each)) for each in tables] for tables in (present, requested))
    steps = SequenceMatcher(None, old, new, autojunk=False).get_opcodes()
    for _, begin, end, first, last in reversed(steps):  # from the last, as numbers of earlier ones remain
        shared = min(end - begin, last - first)
        for index in reversed(range(begin + shared, end)):
            page.remove((*place, index))
        for index in range(first + shared, last):
            page.insert(place, begin + index - first, requested[index])
        for index in range(shared):
            _edit(page, (*place, begin + index), present[begin + index], requested[first + index])


def _are_tables(value: Any) -> bool:
    """Whether a value is a list of one or more tables, and nothing else."""
    return isinstance(value, list) and bool(value) and all(isinstance(each, Mapping) for each in value)


class _Page:
    """The lines of a text, and where its statements are."""

    def __init__(self, text: str) -> None:
        self.lines = lines_of(text)
        self.ending = "\r\n" if text.partition("\n")[0].endswith("\r") else "\n"

    @property
    def statements(self) -> list[Statement]:
        return statements_of(self.lines)

    def value_at(self, place: Place) -> Statement | None:
        """The key whose value is at a place or contains it; None for tables with a header or dotted keys."""
        found = (each for each in self.statements if each.kind == "key" and _is_in(place, each.place))
        return next(found, None)

    def _inside(self, place: Place) -> list[Statement]:
        """The statements of the table or list at a place."""
        return [each for each in self.statements if _is_in(each.place, place)]

    def set(self, place: Place, value: Any) -> None:
        """Replace a value."""
        self._within(place, lambda table, key: table.__setitem__(key, _inline(value)))

    def remove(self, place: Place) -> None:
        """Remove a key, or a table with its contents; comments below its last key belong to the next table."""
        statement = self.value_at(place)
        if statement is not None and statement.place != place:
            self._within(place, lambda table, key: table.__delitem__(key))
            return
        for begin, end in reversed(list(_blocks(self.statements, place))):
            del self.lines[begin:end]
            if begin > 0 and not self.lines[begin - 1].strip() and not "".join(self.lines[begin : begin + 1]).strip():
                del self.lines[begin - 1]

    def add(self, place: Place, key: str, value: Any) -> None:
        """Add a key to the table at a place."""
        if self.value_at(place) is not None:
            self._within((*place, key), lambda table, name: _append(table, name, value))
            return
        own = [each for each in self.statements if each.table == place and (place or each.kind == "key")]
        dotted = [each for each in self._inside(place) if each.kind == "key" and len(each.table) < len(place)]
        below = isinstance(value, Mapping) or _are_tables(value)
        if dotted:
            self._put(dotted[-1].end, self._line(dotted[-1], (*place, key), value))
        elif below or not (own or place == ()):
            inside = self._inside(place)
            at = inside[-1].end if place and inside else len(self.lines)
            self._put(at, self._new_section((*place, key), value) if below else self._section(place, {key: value}))
        elif own:
            self._put(own[-1].end, self._line(own[-1], (*place, key), value))
        else:
            self._put_first(_assignment((key,), value))

    def insert(self, place: Place, index: int, table: Mapping[str, Any]) -> None:
        """Insert a table into a list of tables; index : its position."""
        if self.value_at(place) is not None:
            self._within((*place, index), lambda tables, position: tables.insert(position, _inline(table)))
            return
        if index > 0:
            self._put(self._inside((*place, index - 1))[-1].end, self._section((*place, index), table))
            return
        at = self._above(self._inside((*place, 0))[0].begin)
        section = self._section((*place, 0), table)
        self._put(at, [*section[1:], self.ending] if section[0] == self.ending else [*section, self.ending])

    def _within(self, place: Place, change: Any) -> None:
        """Change a place in the value of a key, by a function of the table or list around it and the last key."""
        import tomlkit

        statement = self.value_at(place)
        assert statement is not None
        document = tomlkit.parse("".join(self.lines[statement.begin : statement.end]))
        around: Any = document
        *path, last = place[len(statement.table) :]
        for key in path:
            around = around[key]
        change(around, last)
        self.lines[statement.begin : statement.end] = lines_of(document.as_string())

    def _line(self, beside: Statement, place: Place, value: Any) -> list[str]:
        """A key with its value, in the section and with the indentation of another statement."""
        first = self.lines[beside.begin]
        indent = first[: len(first) - len(first.lstrip())]
        return [indent + _assignment(place[len(beside.table) :], value)]

    def _new_section(self, place: Place, value: Any) -> list[str]:
        """The lines of a table, or of a list of tables."""
        if isinstance(value, Mapping):
            return self._section(place, value)
        return [line for index, each in enumerate(value) for line in self._section((*place, index), each)]

    def _section(self, place: Place, table: Mapping[str, Any]) -> list[str]:
        """The lines of a table with its header, and of the tables in it, below a blank line."""
        below = {key: value for key, value in table.items() if isinstance(value, Mapping) or _are_tables(value)}
        plain = {key: value for key, value in table.items() if key not in below}
        name = ".".join(_quoted(key) for key in place if isinstance(key, str))
        in_list = not isinstance(place[-1], str)
        lines = []
        if plain or not below or in_list:
            lines = [self.ending, f"[[{name}]]" if in_list else f"[{name}]"]
            lines += [_assignment((key,), value) for key, value in plain.items()]
        return [*lines, *(line for key, value in below.items() for line in self._new_section((*place, key), value))]

    def _put(self, at: int, lines: Sequence[str]) -> None:
        """Insert lines before a line, each with the ending of the text."""
        if at > 0 and not self.lines[at - 1].endswith("\n"):
            self.lines[at - 1] += self.ending
        if at == 0 or not self.lines[at - 1].strip():
            lines = lines[1:] if lines[0] == self.ending else lines
        self.lines[at:at] = [line.rstrip("\r\n") + self.ending for line in lines]

    def _put_first(self, line: str) -> None:
        """Insert the first key outside tables: above the first header."""
        headers = [each.begin for each in self.statements]
        at = self._above(headers[0]) if headers else len(self.lines)
        self._put(at, [line, self.ending] if headers else [line])

    def _above(self, at: int) -> int:
        """The line of a header, or the first of the comments right above it unless they begin the text."""
        begin = at
        while begin > 0 and self.lines[begin - 1].lstrip().startswith("#"):
            begin -= 1
        return begin or at


def _is_in(place: Place, other: Place) -> bool:
    """Whether a place is equal to another one or inside it."""
    return place[: len(other)] == other


def _blocks(statements: Sequence[Statement], place: Place) -> Iterator[tuple[int, int]]:
    """First line and end of the statements inside a place, those of one section together if no other is between."""
    for _, group in groupby(statements, lambda each: (_is_in(each.place, place), each.table)):
        block = list(group)
        if _is_in(block[0].place, place):
            yield block[0].begin, block[-1].end


def _assignment(keys: Sequence[Any], value: Any) -> str:
    """The line of a key and its value."""
    return f"{'.'.join(map(_quoted, keys))} = {_inline(value).as_string()}"


def _quoted(key: str) -> str:
    """A key, in quotes where it needs them."""
    import tomlkit

    return tomlkit.key(key).as_string()


def _append(table: Any, key: str, value: Any) -> None:
    """Add a key to a table on one line."""
    item = _inline(value)
    if table:
        item.trivia.indent = " "
    table.append(key, item)


def _inline(value: Any) -> Any:
    """A value on one line, for tomlkit."""
    import tomlkit

    if isinstance(value, Mapping):
        table = tomlkit.inline_table()
        for key, inner in value.items():
            table[key] = _inline(inner)
        return table
    if isinstance(value, list | tuple):
        array = tomlkit.array()
        for inner in value:
            array.append(_inline(inner))
        return array
    return tomlkit.item(deepcopy(value))


def with_changes(case: Case, changes: Mapping[str, Any], schemas: Sequence[Schema]) -> Case:
    """The case with some keys changed, checked as if it had been read from a file of one of the schemas' kinds.

    Parameters
    ----------
    case
        The case to start from; it is not changed.
    changes
        Dotted key -> value in TOML terms, such as ``{"boundary.right.beta_p": 0.81}``. A value may be a whole
        table; missing tables are created. A load, monitor or hole is identified by its name or its number, from 1:
        ``load.blow.pressure`` or ``load.1.pressure``. None leaves a key out. Keys set by neither case nor changes stay
        unset.

    Raises
    ------
    CaseError
        If a key does not exist or the changed case is not valid.
    """
    tables = applied(deepcopy(_tables(case.text)), changes)
    text = tomli_w.dumps(tables)  # in a tenth of the time that `edited` takes
    return case_of_tables(allowed(tables, case.name), text, schemas, case.folder, case.name, files=case.files)


@lru_cache(maxsize=32)
def _tables(text: str) -> dict[str, Any]:
    """The tables of a text, cached and not to be changed: a search changes one case a thousand times."""
    return parsed(text)


def to_toml(case: Case, folder: Path | None = None) -> str:
    """The case's TOML text, for a file in `folder` (its own folder when None).

    The text is the one the case was read from, with its comments; relative paths are rewritten so that they refer to
    the same files from another folder.
    """
    here, there = case.folder.resolve(), (folder or case.folder).resolve()
    moved = {
        f"wave.{name}.{key}": path for name, wave in case.wave.items() for key, path in wave.moved(here, there).items()
    }
    return edited(case.text, moved)
