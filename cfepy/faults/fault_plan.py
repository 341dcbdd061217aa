"""`FaultPlan`: the faults of a run as a plain value, from a file, a dictionary, or a program.

    plan = read_plan("faults.yaml")
    plan = FaultPlan.from_dict({"faults": [{"drop": "/odom", "probability": 0.1}]})

Errors in a plan are reported with their place. A plan can be written again. Each option has one reader and one writer
for all kinds of faults. See docs/how_to/faults.md for the kinds of faults and the form of the file.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from cfepy.faults import kinds
from cfepy.faults.call_faults import call_name, status_of
from cfepy.faults.kinds import KINDS, FaultKind
from cfepy.faults.timing import When
from cfepy.reading.marked_yaml import Marked, load
from cfepy.reading.mistakes import Mistakes, collected, each_of
from cfepy.reading.suggestions import did_you_mean, expected, listed
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

ALWAYS = When()
LONGEST_S = 1e9
DATAGRAMS = "udp:"
WHEN = {"at": "at_ns", "after": "after_ns", "until": "until_ns"}
"""Options of `When` with other names in a plan, where they are in s; these are in ns."""
ALTERNATIVES = (
    ("bits", "bytes", "fields"),
    ("for", "times"),
    ("message", "times"),
    ("explored", "probability"),
    ("explored", "count"),
    ("at", *kinds.WINDOW),
)
EXAMPLES = {"at": "2.5", "explored": "1", "by": "0.01", "times": "10", "extra": "0.001", "for": "0.02"}
_TIMES = ("after", "until", "within", "for", "extra")


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault.

    Attributes:
        kind: a key of `cfepy.faults.kinds.KINDS`.
        target: its target, as written in the plan; several messages or applications are several targets.
        name: its name in reports, unique in its plan; its random numbers are derived from it and the run's seed.
        when: at which occasions it happens.
        options: the other options, by their names in the plan; times in ns.
        line: line in the file, 0 if there is none.
    """

    kind: str
    target: tuple[str, ...]
    name: str = ""
    when: When = ALWAYS
    options: Mapping[str, Any] = field(default_factory=dict)
    line: int = field(default=0, compare=False)

    @property
    def text(self) -> str:
        """Description in the words of the plan: "drop /odom"."""
        return f"{self.kind} {', '.join(self.target)}"


@dataclass(frozen=True, slots=True)
class FaultPlan:
    """Faults, in the order in which they apply to a message.

    Attributes:
        faults: the faults; each has a name.
        file: their file, for errors; empty if there is none.
    """

    faults: tuple[Fault, ...] = ()
    file: str = field(default="", compare=False)

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any]) -> FaultPlan:
        """Return the plan of a dictionary in the form of the file.

        Raises:
            UsageError: if it is not such a plan.
        """
        return read_marked(_marked(plain, ""))

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain values, which `from_dict` takes."""
        return {"faults": [plain_fault(fault) for fault in self.faults]}

    def to_yaml(self) -> str:
        """Return the text of a file with this plan."""
        import yaml

        return str(yaml.safe_dump(self.to_dict(), sort_keys=False, default_flow_style=None, width=100))


def read_plan(path: str | Path) -> FaultPlan:
    """Read a plan from a file.

    Raises:
        UsageError: if it cannot be read, or has a mistake, with file, line and field.
    """
    return read_marked(load(Path(path), handed=True))


def _marked(value: Any, place: str) -> Marked:
    """Return a plain value as if it had been read from a file."""
    inner = value
    if isinstance(value, Mapping):
        inner = {str(key): _marked(item, f"{place}.{key}".lstrip(".")) for key, item in value.items()}
    elif isinstance(value, list | tuple):
        inner = [_marked(item, f"{place}[{index}]") for index, item in enumerate(value)]
    return Marked(inner, Path("fault plan"), 0, place)


def read_marked(root: Marked) -> FaultPlan:
    """Return the plan in a tree of YAML: `faults:` with a list, or the list by itself.

    Raises:
        UsageError: if there is a mistake in it.
    """
    return collected(partial(_plan, root))


def _plan(root: Marked, mistakes: Mistakes) -> FaultPlan:
    section = root
    if not isinstance(root.value, list):
        sections = dict(mistakes.fields(root, ("faults",)))
        if "faults" not in sections:
            if mistakes.errors:
                raise mistakes.errors.pop()  # it may have a misspelt key
            raise root.fail("missing faults; write `faults:` and a list of faults, such as `- drop: /odom`")
        section = sections["faults"]
    faults: list[Fault] = []
    names: set[str] = set()
    for item in section.items():
        fault = mistakes.whole(partial(_fault, item, faults))
        if fault is None:
            continue
        if fault.name in names:
            mistakes.add(item.fail(f"the name {fault.name!r} is already used by another fault; choose another name"))
        names.add(fault.name)
        faults.append(fault)
    return FaultPlan(tuple(faults), str(root.file))


def _fault(item: Marked, before: list[Fault], mistakes: Mistakes) -> Fault:
    fields = dict(item.mapping())
    kind_name = _kind_of(item, fields)
    kind = KINDS[kind_name]
    target = mistakes.attempt(partial(_target, kind, fields.pop(kind_name))) or ()
    name = mistakes.attempt(fields.pop("name").text) if "name" in fields else None
    known = _known_options(kind_name, kind, fields, mistakes)
    when = When()
    options: dict[str, Any] = {}
    for option, value in known.items():
        read = mistakes.attempt(partial(READERS[option], value))
        if read is None:
            continue
        if option in kinds.OCCASIONS:
            when = replace(when, **{WHEN.get(option, option): read})
        else:
            options[option] = read
    if mistakes.errors:
        raise mistakes.errors.pop()  # the combination of wrong options means nothing
    _check_combination(item, kind_name, kind, known, mistakes)
    if when.until_ns is not None and when.until_ns <= when.after_ns:
        mistakes.add(fields["until"].fail("must be later than `after`, otherwise the fault never happens"))
    _check_datagram(item, target, options)
    return Fault(kind_name, target, name or _free_name(kind_name, before), when, options, item.line)


def _kind_of(item: Marked, fields: dict[str, Marked]) -> str:
    found = [name for name in fields if name in KINDS]
    if len(found) > 1:
        raise item.fail(f"{found[0]} cannot be combined with {found[1]}; write two faults")
    if found:
        return found[0]
    hints = [(name, did_you_mean(name, KINDS)) for name in fields]
    for name, hint in hints:
        if hint:
            raise fields[name].fail(f"unknown kind of fault {name!r}; {hint}")
    raise item.fail(f"missing kind of fault; write one of {listed(KINDS)}, such as `drop: /odom`")


def _free_name(kind: str, before: list[Fault]) -> str:
    number = 1 + sum(fault.kind == kind for fault in before)
    taken = {fault.name for fault in before}
    while f"{kind}-{number}" in taken:
        number += 1
    return f"{kind}-{number}"


def _known_options(name: str, kind: FaultKind, fields: dict[str, Marked], mistakes: Mistakes) -> dict[str, Marked]:
    for option, value in fields.items():
        if option not in kind.options:
            hint = expected(option, ["name", *kind.options], subject="it takes", last="and")
            mistakes.add(value.fail(f"unknown option of {name}; {hint}"))
    return {option: value for option, value in fields.items() if option in kind.options}


def _check_combination(item: Marked, name: str, kind: FaultKind, fields: dict[str, Marked], mistakes: Mistakes) -> None:
    if kind.needed and not any(option in fields for option in kind.needed):
        wanted = listed(kind.needed)
        mistakes.add(item.fail(f"{name} requires {wanted}, such as `{kind.needed[0]}: {EXAMPLES[kind.needed[0]]}`"))
    for group in ALTERNATIVES:
        said = [option for option in group if option in fields]
        if len(said) > 1 and (group[0] != "at" or said[0] == "at"):
            mistakes.add(fields[said[1]].fail(f"cannot be combined with {said[0]}; write two faults"))


def _check_datagram(item: Marked, target: tuple[str, ...], options: dict[str, Any]) -> None:
    if any(each.startswith(DATAGRAMS) for each in target):
        if not all(each.startswith(DATAGRAMS) for each in target):
            raise item.fail("messages cannot be combined with datagrams; write two faults")
        wrong = [option for option in ("from", "to", "unit", "fields", "checksum") if option in options]
        if wrong:
            raise item.fail(f"{wrong[0]} is not an option of faults of datagrams; remove it")


# -- targets -----------------------------------------------------------------------------------------------------------
def _target(kind: FaultKind, entry: Marked) -> tuple[str, ...]:
    items = entry.items() if isinstance(entry.value, list) else [entry]
    if not items or (len(items) > 1 and kind.strikes not in (kinds.MESSAGE, kinds.APP)):
        raise entry.fail("missing target" if not items else "takes one target; write several faults")
    return tuple(each_of(partial(_one_target, kind.strikes, item) for item in items))


def _one_target(strikes: str, item: Marked) -> str:
    if strikes in (kinds.SECONDS, kinds.PPM):
        return f"{_number(item, -LONGEST_S, LONGEST_S, 'a number other than 0, such as -2.5'):.12g}"
    if strikes == kinds.MESSAGE and isinstance(item.value, int) and not isinstance(item.value, bool):
        return f"0x{item.integer(1, 0xFFFF):04X}"
    if not isinstance(item.value, str) or not item.value:
        raise item.fail(f"must be the name of the {strikes} as text, not {item.shown()}")
    choices = {kinds.SIGNAL: kinds.SIGNALS, kinds.MEMORY: kinds.MEMORIES, kinds.RESET: kinds.RESETS}.get(strikes)
    if choices is not None:
        return _choice(choices)(item)
    if strikes == kinds.FILE and not item.value.startswith("/"):
        raise item.fail(f"must be a path of the virtual file system, such as /cf/hk_cpy_tbl.tbl, not {item.shown()}")
    if strikes == kinds.CALL:
        _checked(item, call_name)
    return item.value


def _checked(item: Marked, check: Callable[[str], object]) -> str:
    """Return a text converted by a function, whose error is reported with the place."""
    try:
        check(item.text())
    except UsageError as error:
        raise error if error.file else item.fail(error.text) from None
    return item.text()


# -- options -----------------------------------------------------------------------------------------------------------
def _number(item: Marked, least: float, most: float, what: str) -> float:
    value = item.value
    if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value <= most or not value:
        raise item.fail(f"must be {what}, not {item.shown()}")
    return value


def _seconds(item: Marked) -> int:
    value = item.value
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value <= LONGEST_S:
        raise item.fail(f"must be a number of seconds, such as 2.5, not {item.shown()}")
    return round(value * NS_PER_S)


def _duration(item: Marked) -> int:
    found = _seconds(item)
    if not found:
        raise item.fail("must be a number of seconds greater than 0")
    return found


def _instants(item: Marked) -> tuple[int, ...]:
    return tuple(each_of(partial(_seconds, each) for each in _several(item)))


def _numbers(item: Marked) -> tuple[int, ...]:
    return tuple(each_of(partial(each.integer, 1) for each in _several(item)))


def _several(item: Marked) -> list[Marked]:
    return item.items() if isinstance(item.value, list) else [item]


def _range(item: Marked) -> tuple[int, int]:
    """Return a time, or a range of times."""
    if not isinstance(item.value, list):
        return _duration(item), _duration(item)
    if len(item.value) != 2 or _duration(item.value[0]) > _duration(item.value[1]):
        raise item.fail("must be a shortest and a longest time in seconds, such as [0.01, 0.05]")
    return _duration(item.value[0]), _duration(item.value[1])


def _probability(item: Marked) -> float:
    return float(_number(item, 0, 1, "a probability greater than 0 and at most 1"))


def _bytes(item: Marked) -> dict[int, int]:
    """Return positions and values, such as {16: 0xFF}; keys of YAML mappings are texts here."""
    if not isinstance(item.value, dict) or not item.value:
        raise item.fail('must be a mapping of positions to bytes, such as {"16": 0xFF}')
    return dict(each_of(partial(_byte, key, value) for key, value in item.value.items()))


def _byte(key: str, value: Marked) -> tuple[int, int]:
    try:
        position = int(key, 0)
    except ValueError:
        raise value.fail(f"invalid position {key!r}; expected a whole number") from None
    return position, value.integer(0, 255)


def _fields(item: Marked) -> dict[str, Any]:
    if not isinstance(item.value, dict) or not item.value:
        raise item.fail("must be a mapping of fields to values, such as {data: 3}")
    return {name: value.plain() for name, value in item.value.items()}


def _choice(choices: tuple[str, ...]) -> Callable[[Marked], str]:
    def read(item: Marked) -> str:
        if item.value not in choices:
            raise item.fail(f"invalid value {item.shown()}; {expected(str(item.value), choices)}")
        return str(item.value)

    return read


def _positive(item: Marked) -> int:
    return item.integer(1)


READERS: dict[str, Callable[[Marked], Any]] = {
    "at": _instants,
    "after": _seconds,
    "until": _seconds,
    "number": _numbers,
    "every": _positive,
    "probability": _probability,
    "count": _positive,
    "explored": _positive,
    "from": Marked.text,
    "to": Marked.text,
    "unit": _choice(kinds.UNITS),
    "copies": _positive,
    "by": _range,
    "past": _positive,
    "within": _duration,
    "bits": _positive,
    "bytes": _bytes,
    "fields": _fields,
    "checksum": _choice(kinds.CHECKSUMS),
    "message": Marked.text,
    "task": Marked.text,
    "for": _duration,
    "times": lambda item: float(_number(item, 0, 1e6, "how many times as much, such as 10")),
    "extra": _duration,
    "clock": _choice(kinds.CLOCKS),
    "block": Marked.text,
    "app": Marked.text,
    "object": Marked.text,
    "status": lambda item: _checked(item, lambda name: status_of("", name)),
}


def plain_fault(fault: Fault) -> dict[str, Any]:
    """Return a fault as in a plan, without default values."""
    target: Any = fault.target[0] if len(fault.target) == 1 else list(fault.target)
    if KINDS[fault.kind].strikes in (kinds.SECONDS, kinds.PPM):
        target = _plain_number(float(fault.target[0]))
    found: dict[str, Any] = {fault.kind: target, "name": fault.name}
    nothing = When()
    for option in kinds.OCCASIONS:
        value = getattr(fault.when, WHEN.get(option, option))
        if value != getattr(nothing, WHEN.get(option, option)):
            found[option] = _written(option, value)
    for option, value in fault.options.items():
        found[option] = _written(option, value)
    return found


def _written(option: str, value: Any) -> Any:
    if option in _TIMES:
        return _in_seconds(value)
    if option == "by":
        return _in_seconds(value[0]) if value[0] == value[1] else [_in_seconds(each) for each in value]
    if option in ("at", "number"):
        values = [_in_seconds(each) if option == "at" else each for each in value]
        return values[0] if len(values) == 1 else values
    if option == "bytes":
        return {str(position): byte for position, byte in value.items()}
    return _plain_number(value) if option == "times" else value


def _in_seconds(time_ns: int) -> float | int:
    return _plain_number(time_ns / NS_PER_S)


def _plain_number(value: float) -> float | int:
    return int(value) if value == int(value) else value
