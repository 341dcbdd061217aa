"""`cfepy topic`: what rostopic tells of a running robot, of a mission that is flown for it, or of a bag."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from contextlib import closing
from typing import Any

from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.topic_output import Bandwidth, Delay, Echo, Hz, Meter, candidates
from cfepy.cli.topic_source import FlightSource, TopicRow, source_of, spec_for
from cfepy.console import Console
from cfepy.mission.ground_node import GroundConsole, with_ground_node
from cfepy.mission.tracebacks import described
from cfepy.status import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Do what the command line says.

    Returns:
        The exit status: 1 when nothing was found.

    Raises:
        UsageError: no such mission or bag, or an argument that cannot be.
    """
    actions: dict[str, Callable[[argparse.Namespace], int]] = {
        "list": _list,
        "info": _info,
        "type": _type,
        "find": _find,
        "echo": _echo,
        "hz": lambda chosen: _measure(chosen, Hz(chosen.window)),
        "delay": lambda chosen: _measure(chosen, Delay(chosen.window)),
        "bw": lambda chosen: _measure(chosen, Bandwidth(chosen.window)),
        "pub": _publish,
    }
    return actions[arguments.action](arguments)


# -- the topics --------------------------------------------------------------------------------------------------------


def _rows(arguments: argparse.Namespace) -> list[TopicRow]:
    return _rows_and_addresses(arguments)[0]


def _rows_and_addresses(arguments: argparse.Namespace) -> tuple[list[TopicRow], dict[str, str]]:
    """The topics, and the URIs of nodes."""
    with source_of(arguments) as source:
        if isinstance(source, FlightSource):
            source.fly()
        return source.rows(), source.addresses()


def _list(arguments: argparse.Namespace) -> int:
    start = arguments.namespace.rstrip("/") + "/" if arguments.namespace else ""
    rows = [row for row in _rows(arguments) if row.name.startswith(start) or row.name == arguments.namespace]
    if arguments.json:
        print(json.dumps([row._asdict() for row in rows], indent=2))
    elif arguments.verbose:
        print(_verbose(rows))
    else:
        sys.stdout.writelines(f"{name}\n" for name in dict.fromkeys(row.name for row in rows))
    return ENDED_WELL if rows else _no_topic(f"in {start or '/'}", arguments)


def _no_topic(which: str, arguments: argparse.Namespace) -> int:
    sys.stdout.flush()
    print(f"cfepy: no topic {which} in {arguments.source}", file=sys.stderr)
    return FOUND_PROBLEMS


def _verbose(rows: list[TopicRow]) -> str:
    lines = ["", "Published topics:"]
    lines += [_counted(row, row.publishers, "publisher") for row in rows if row.publishers]
    lines += ["", "Subscribed topics:"]
    lines += [_counted(row, row.subscribers, "subscriber") for row in rows if row.subscribers]
    return "\n".join([*lines, ""])


def _counted(row: TopicRow, names: tuple[str, ...], what: str) -> str:
    return f" * {row.name} [{row.type or 'unknown type'}] {len(names)} {what}{'s' if len(names) > 1 else ''}"


def _known(arguments: argparse.Namespace) -> tuple[TopicRow, dict[str, str]]:
    """The topic that is meant, and the URIs of nodes.

    Raises:
        UsageError: there is none such.
    """
    found, addresses = _rows_and_addresses(arguments)
    rows = {row.name: row for row in found}
    name = next((each for each in candidates(arguments.topic) if each in rows), None)
    if name is None:
        raise UsageError(f"Unknown topic {arguments.topic}", file=arguments.source)
    return rows[name], addresses


def _info(arguments: argparse.Namespace) -> int:
    row, addresses = _known(arguments)
    if arguments.json:
        print(json.dumps(row._asdict(), indent=2))
        return ENDED_WELL
    print(f"Type: {row.type or 'unknown type'}\n")
    print(_named("Publishers", row.publishers, addresses))
    print(_named("Subscribers", row.subscribers, addresses))
    return ENDED_WELL


def _named(title: str, names: tuple[str, ...], addresses: dict[str, str]) -> str:
    if not names:
        return f"{title}: None\n"
    texts = (f" * {name} ({addresses[name]})" if name in addresses else f" * {name}" for name in names)
    return "\n".join([f"{title}: ", *texts, ""])


def _type(arguments: argparse.Namespace) -> int:
    row, _ = _known(arguments)
    print(json.dumps({"topic": row.name, "type": row.type}) if arguments.json else row.type or "unknown type")
    return ENDED_WELL


def _find(arguments: argparse.Namespace) -> int:
    names = [row.name for row in _rows(arguments) if row.type == arguments.type]
    sys.stdout.writelines([json.dumps(names), "\n"] if arguments.json else [f"{name}\n" for name in names])
    return ENDED_WELL if names else _no_topic(f"of type {arguments.type}", arguments)


# -- the messages ------------------------------------------------------------------------------------------------------


def _echo(arguments: argparse.Namespace) -> int:
    style = "json" if arguments.json else "csv" if arguments.plot else "text"
    hides = [name for name, is_hidden in (("array", arguments.noarr), ("str", arguments.nostr)) if is_hidden]
    echo = Echo(sys.stdout, _rooted(arguments.topic), style, _filter(arguments.filter), hides)
    return _nothing(arguments) if _show(arguments, echo.show) == 0 else ENDED_WELL


def _filter(expression: str | None) -> Callable[[Any], Any]:
    """Whether a message is to be shown.

    Raises:
        UsageError: the expression is none.
    """
    if expression is None:
        return lambda message: True
    try:
        code = compile(expression, "--filter", "eval")
    except SyntaxError as error:
        raise UsageError(f"{error.msg}; write something like 'm.data > 3'", field="--filter") from None

    def wanted(message: Any) -> Any:
        try:
            return eval(code, {"m": message})
        except Exception as error:  # whatever the expression makes of the message
            raise UsageError(
                f"{described(error)}; m is the whole message, here {message._type}", field="--filter"
            ) from None

    return wanted


def _measure(arguments: argparse.Namespace, meter: Meter) -> int:
    _show(arguments, meter.show)
    if not meter.values():
        return _nothing(arguments)
    print(json.dumps(meter.values()) if arguments.json else meter.text())
    return ENDED_WELL


def _show(arguments: argparse.Namespace, take: Callable[[Any], bool]) -> int:
    """Show messages until there were enough; how many there were."""
    shown, topics = 0, candidates(_rooted(arguments.topic))
    with source_of(arguments) as source, closing(source.messages(topics)) as messages:
        for message in messages:
            shown += take(message)
            if shown == arguments.count:
                break
    sys.stdout.flush()
    return shown


def _rooted(topic: str) -> str:
    return topic if topic.startswith("/") else f"/{topic}"


def _nothing(arguments: argparse.Namespace) -> int:
    sys.stdout.flush()
    print(f"cfepy: no message on {arguments.topic} in {arguments.source}", file=sys.stderr)
    return FOUND_PROBLEMS


# -- publishing --------------------------------------------------------------------------------------------------------


def _publish(arguments: argparse.Namespace) -> int:
    topic = _rooted(arguments.topic)
    told = [topic, arguments.type, arguments.values, arguments.rate, arguments.at]
    spec = with_ground_node(spec_for(arguments), "ground_publish", told)
    ground = GroundConsole()
    with FlightSource(spec, arguments, Console(sink=ground.line)) as source:
        callers = [message.header.get("callerid", "") for message in source.messages([topic])]
    count = sum(caller.startswith("/rostopic_") for caller in callers)
    problems = [each["error"] for each in ground.said if "error" in each]
    if arguments.json:
        print(json.dumps({"topic": topic, "published": count, "printed": ground.others, "problems": problems}))
    else:
        print("\n".join([*ground.others, f"published {count} message{'s' if count != 1 else ''} on {topic}"]))
    sys.stdout.flush()
    for problem in problems:
        print(f"cfepy: {problem}", file=sys.stderr)
    return FOUND_PROBLEMS if problems or not count else ENDED_WELL
