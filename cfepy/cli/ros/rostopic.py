"""`cfepy rostopic`: the answers of rostopic, from a mission that is flown for them, a running flight or a bag."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from contextlib import closing
from typing import Any

from cfepy.cli.json_output import STDOUT, json_lines, write_json
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.options import refuse_run_options
from cfepy.cli.ros.rostopic_output import Bandwidth, Delay, Echo, Hz, Meter
from cfepy.cli.ros.source import FlightSource, SeenTopic, source_of
from cfepy.cli.text_table import print_lines
from cfepy.cli.user_notes import tell
from cfepy.cli.viewed_runs import flight_plan
from cfepy.ground import GroundConsole, candidates, check_message_type, with_ground_node
from cfepy.io import live_flight, live_name
from cfepy.mission import described
from cfepy.reading.plain_yaml import YamlError, plain_yaml
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError
from cfepy.writing.console import Console
from cfepy.writing.escapes import visible_line


def run(arguments: argparse.Namespace) -> int:
    """Carry out the action that the command line names.

    Returns:
        The exit status: 1 if nothing was found.

    Raises:
        UsageError: there is no such mission or bag, or an argument is invalid.
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


def _rows(arguments: argparse.Namespace) -> list[SeenTopic]:
    return _rows_and_addresses(arguments)[0]


def _rows_and_addresses(arguments: argparse.Namespace) -> tuple[list[SeenTopic], dict[str, str]]:
    """Return the topics, and the URIs of nodes."""
    with source_of(arguments) as source:
        if isinstance(source, FlightSource):
            source.fly()
        return source.topics(), source.addresses()


def _list(arguments: argparse.Namespace) -> int:
    start = arguments.namespace.rstrip("/") + "/" if arguments.namespace else ""
    rows = [row for row in _rows(arguments) if row.name.startswith(start) or row.name == arguments.namespace]
    write_json(arguments, [row._asdict() for row in rows])
    if arguments.verbose:
        print(_verbose(rows))
    else:
        print_lines(dict.fromkeys(row.name for row in rows))
    return ENDED_WELL if rows else _no_topic(f"in {start or '/'}", arguments)


def _no_topic(which: str, arguments: argparse.Namespace) -> int:
    sys.stdout.flush()
    print(f"cfepy: no topic {which} in {arguments.source}", file=sys.stderr)
    return FOUND_PROBLEMS


def _verbose(rows: list[SeenTopic]) -> str:
    lines = ["", "Published topics:"]
    lines += [_counted(row, row.publishers, "publisher") for row in rows if row.publishers]
    lines += ["", "Subscribed topics:"]
    lines += [_counted(row, row.subscribers, "subscriber") for row in rows if row.subscribers]
    return "\n".join([*lines, ""])


def _counted(row: SeenTopic, names: tuple[str, ...], what: str) -> str:
    kind = row.type or "unknown type"
    return visible_line(f" * {row.name} [{kind}] {len(names)} {what}{'s' if len(names) > 1 else ''}")


def _known(arguments: argparse.Namespace) -> tuple[SeenTopic, dict[str, str]]:
    """Return the topic that the command line names, and the URIs of nodes.

    Raises:
        UsageError: there is no such topic.
    """
    found, addresses = _rows_and_addresses(arguments)
    rows = {row.name: row for row in found}
    name = next((each for each in candidates(arguments.topic) if each in rows), None)
    if name is None:
        hint = did_you_mean(_rooted(arguments.topic), rows, before="; ")
        raise UsageError(f"Unknown topic {arguments.topic}{hint}", file=arguments.source)
    return rows[name], addresses


def _info(arguments: argparse.Namespace) -> int:
    row, addresses = _known(arguments)
    write_json(arguments, row._asdict())
    print(f"Type: {row.type or 'unknown type'}\n")
    print(_named("Publishers", row.publishers, addresses))
    print(_named("Subscribers", row.subscribers, addresses))
    return ENDED_WELL


def _named(title: str, names: tuple[str, ...], addresses: dict[str, str]) -> str:
    if not names:
        return f"{title}: None\n"
    texts = (f" * {name} ({addresses[name]})" if name in addresses else f" * {name}" for name in names)
    return "\n".join([f"{title}: ", *map(visible_line, texts), ""])


def _type(arguments: argparse.Namespace) -> int:
    row, _ = _known(arguments)
    write_json(arguments, {"topic": row.name, "type": row.type}, indent=None)
    print(row.type or "unknown type")
    return ENDED_WELL


def _find(arguments: argparse.Namespace) -> int:
    names = [row.name for row in _rows(arguments) if row.type == arguments.type]
    write_json(arguments, names, indent=None)
    print_lines(names)
    return ENDED_WELL if names else _no_topic(f"of type {arguments.type}", arguments)


# -- the messages ------------------------------------------------------------------------------------------------------


def _echo(arguments: argparse.Namespace) -> int:
    topic, is_wanted = _rooted(arguments.topic), _filter(arguments.filter)
    hides = [name for name, is_hidden in (("array", arguments.noarr), ("str", arguments.nostr)) if is_hidden]
    with json_lines(arguments) as lines:
        echoes = [] if lines is None else [Echo(lines, topic, "json", is_wanted)]
        if arguments.json != STDOUT:
            echoes.append(Echo(sys.stdout, topic, "csv" if arguments.plot else "text", is_wanted, hides))
        shown, known = _show(arguments, lambda message: sum(echo.show(message) for echo in echoes) > 0)
    return _ended(arguments, shown > 0, known)


def _filter(expression: str | None) -> Callable[[Any], Any]:
    """Make the filter of messages.

    Raises:
        UsageError: the expression is invalid.
    """
    if expression is None:
        return lambda message: True
    try:
        code = compile(expression, "--filter", "eval")
    except SyntaxError as error:
        raise UsageError(
            f"invalid expression: {error.msg}; write for instance 'm.data > 3'", field="--filter"
        ) from None

    def wanted(message: Any) -> Any:
        try:
            return eval(code, {"m": message})
        except Exception as error:  # the expression may raise any error
            raise UsageError(
                f"{described(error)}; m is the message, here of type {message._type}", field="--filter"
            ) from None

    return wanted


def _measure(arguments: argparse.Namespace, meter: Meter) -> int:
    _, known = _show(arguments, meter.show)
    if meter.values():
        write_json(arguments, meter.values(), indent=None)
        print(meter.text())
    return _ended(arguments, bool(meter.values()), known)


def _show(arguments: argparse.Namespace, take: Callable[[Any], bool]) -> tuple[int, list[str]]:
    """Show messages until there were enough. Returns their number, and the names of the existing topics."""
    shown, topics = 0, candidates(_rooted(arguments.topic))
    with source_of(arguments) as source, closing(source.messages(topics)) as messages:
        for message in messages:
            shown += take(message)
            if shown == arguments.count:
                break
        known = [row.name for row in source.topics()]
    sys.stdout.flush()
    return shown, known


def _rooted(topic: str) -> str:
    return topic if topic.startswith("/") else f"/{topic}"


def _ended(arguments: argparse.Namespace, is_shown: bool, known: list[str]) -> int:
    """Return the exit status. If no message came, report it, with a similar topic as a hint."""
    if is_shown:
        return ENDED_WELL
    topic = _rooted(arguments.topic)
    hint = "" if topic in known else did_you_mean(topic, known, before="; ")
    tell([f"no message on {arguments.topic} in {arguments.source}{hint}"])
    return FOUND_PROBLEMS


# -- publishing --------------------------------------------------------------------------------------------------------


def _publish(arguments: argparse.Namespace) -> int:
    topic = _rooted(arguments.topic)
    name = live_name(arguments.source)
    if name is not None:
        return _publish_live(arguments, name, topic)
    told = [topic, arguments.type, arguments.values, arguments.rate, arguments.at]
    plan = flight_plan(arguments)
    base = plan.spec()
    check_message_type(base, arguments.type)
    spec = with_ground_node(base, "ground_publish", told)
    ground = GroundConsole()
    with FlightSource(plan, spec, Console(sink=ground.line)) as source:
        callers = [message.header.get("callerid", "") for message in source.messages([topic])]
    count = sum(caller.startswith("/rostopic_") for caller in callers)
    problems = [each["error"] for each in ground.said if "error" in each]
    found = {"topic": topic, "published": count, "printed": ground.others, "problems": problems}
    write_json(arguments, found, indent=None)
    print("\n".join([*ground.others, f"published {count} message{'s' if count != 1 else ''} on {topic}"]))
    sys.stdout.flush()
    for problem in problems:
        print(f"cfepy: {problem}", file=sys.stderr)
    return FOUND_PROBLEMS if problems or not count else ENDED_WELL


def _publish_live(arguments: argparse.Namespace, name: str, topic: str) -> int:
    """Publish one message in a running flight."""
    refuse_run_options(arguments, "only valid for a mission to be run; leave it out")
    for option, value in (("--rate", arguments.rate), ("--at", arguments.at)):
        if value is not None:
            raise UsageError("only valid for a mission to be run; a running flight gets one message now", field=option)
    fields: dict[str, Any] = {}
    for text in arguments.values:
        value = _yaml(text)
        if not isinstance(value, dict):
            raise UsageError(f"invalid value {text!r}; expected fields, such as 'data: hi' or '{{linear: {{x: 1}}}}'")
        fields |= value
    with live_flight(name) as flight:
        kinds = {row.name: row.type for row in flight.topics()}
        if kinds.get(topic, arguments.type) != arguments.type:
            raise UsageError(f"{topic} has type {kinds[topic]}, not {arguments.type}", file=arguments.source)
        flight.ask({"op": "publish", "topic": topic, "fields": fields})
    write_json(arguments, {"topic": topic, "published": 1}, indent=None)
    print(f"published 1 message on {topic}")
    return ENDED_WELL


def _yaml(text: str) -> Any:
    try:
        return plain_yaml(text)
    except YamlError as error:
        raise UsageError(f"invalid value {text!r}: {error}") from None
