"""`cfepy rosservice`: the answers and calls of rosservice, on a mission that is flown for them."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from cfepy.cli.json_output import write_json
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.ros.source import FlightSource
from cfepy.cli.text_table import print_lines
from cfepy.cli.viewed_runs import flight_plan
from cfepy.flight import library_near
from cfepy.ground import GroundConsole, is_bag, with_ground_node
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError
from cfepy.writing.console import Console
from rospy_shim.graph.compiled import DeclaredType


def run(arguments: argparse.Namespace) -> int:
    """Carry out the action that the command line names.

    Returns:
        The exit status: 1 if nothing was found, or the call failed.

    Raises:
        UsageError: there is no such mission or service.
    """
    if is_bag(arguments.source):
        raise UsageError("a bag has no services; give a mission", file=arguments.source)
    if arguments.action == "call":
        return _call(arguments)
    services = _services(arguments)
    return _list(services, arguments) if arguments.action == "list" else _tell(services, arguments)


def _services(arguments: argparse.Namespace) -> dict[str, dict[str, Any]]:
    """Fly the mission, and return its services at the end, by name."""
    with FlightSource(flight_plan(arguments)) as source:
        ros = source.fly().ros
        found = {} if ros is None else dict(sorted(ros.graph.services.items()))
        near = source.mission.spec.folder
        return {name: _described(name, entry.service, near) for name, entry in found.items()}


def _described(name: str, service: Any, near: Path) -> dict[str, Any]:
    kind = service.service_class
    fields = _arguments(kind, near)
    return {
        "service": name,
        "node": service.__node__.names.name,
        "uri": service.uri,
        "type": kind._type,
        "args": fields,
    }


def _arguments(kind: Any, near: Path) -> list[str]:
    """Return the fields of the request. A compiled node has only the type, whose definition is searched near the
    mission.
    """
    if isinstance(kind, DeclaredType):
        try:
            kind = library_near(near).service_class(kind._type)
        except UsageError:
            return []
    return list(kind._request_class.__slots__)


def _list(services: dict[str, dict[str, Any]], arguments: argparse.Namespace) -> int:
    start = arguments.namespace.rstrip("/") + "/" if arguments.namespace else ""
    chosen = [each for name, each in services.items() if name.startswith(start)]
    write_json(arguments, chosen)
    print_lines(each["service"] for each in chosen)
    if not chosen:
        sys.stdout.flush()
        print(f"cfepy: no service in {start or '/'} in {arguments.source}", file=sys.stderr)
    return ENDED_WELL if chosen else FOUND_PROBLEMS


def _tell(services: dict[str, dict[str, Any]], arguments: argparse.Namespace) -> int:
    name = arguments.service if arguments.service.startswith("/") else f"/{arguments.service}"
    if name not in services:
        raise UsageError(f"Unknown service [{name}]{did_you_mean(name, services, before='; ')}", file=arguments.source)
    found = services[name]
    write_json(arguments, found)
    if arguments.action == "type":
        print(found["type"])
    elif arguments.action == "args":
        print(" ".join(found["args"]))
    else:
        print(f"Node: {found['node']}\nURI: {found['uri']}\nType: {found['type']}\nArgs: {' '.join(found['args'])}")
    return ENDED_WELL


def _call(arguments: argparse.Namespace) -> int:
    name = arguments.service if arguments.service.startswith("/") else f"/{arguments.service}"
    plan = flight_plan(arguments)
    spec = with_ground_node(plan.spec(), "ground_call", [name, arguments.values, arguments.at])
    ground = GroundConsole()
    with FlightSource(plan, spec, Console(sink=ground.line)) as source:
        ros = source.fly(lambda: bool(ground.said)).ros
        known = [] if ros is None or ground.said else [each for each in ros.graph.services if each != name]
    hint = did_you_mean(name, known, before="; ")
    silence = {"error": f"no answer from {name} until the run was over; see --for{hint}"}
    answer = ground.said[0] if ground.said else silence
    write_json(arguments, {"service": name, **{key: answer[key] for key in answer if key != "text"}}, indent=None)
    if "error" not in answer:
        print(answer["text"])
    sys.stdout.flush()
    if "error" in answer:
        print(f"cfepy: {answer['error']}", file=sys.stderr)
        return FOUND_PROBLEMS
    return ENDED_WELL
