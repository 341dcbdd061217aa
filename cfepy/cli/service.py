"""`cfepy service`: what rosservice tells of a running robot, of a mission that is flown for it; and calls."""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any

from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.topic_source import FlightSource, spec_for
from cfepy.console import Console
from cfepy.mission.bag import is_bag
from cfepy.mission.ground_node import GroundConsole, with_ground_node
from cfepy.status import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Do what the command line says.

    Returns:
        The exit status: 1 when nothing was found, or the call failed.

    Raises:
        UsageError: no such mission or service.
    """
    if is_bag(arguments.source):
        raise UsageError("is a bag, which has no services; give a mission", file=arguments.source)
    if arguments.action == "call":
        return _call(arguments)
    services = _services(arguments)
    return _list(services, arguments) if arguments.action == "list" else _tell(services, arguments)


def _services(arguments: argparse.Namespace) -> dict[str, dict[str, Any]]:
    """What is offered when the mission has flown, by name."""
    with FlightSource(spec_for(arguments), arguments) as source:
        ros = source.fly().ros
        found = {} if ros is None else dict(sorted(ros.graph.services.items()))
        return {name: _described(name, entry.service) for name, entry in found.items()}


def _described(name: str, service: Any) -> dict[str, Any]:
    kind = service.service_class
    fields = list(kind._request_class.__slots__)
    return {"service": name, "node": service.node.names.name, "uri": service.uri, "type": kind._type, "args": fields}


def _list(services: dict[str, dict[str, Any]], arguments: argparse.Namespace) -> int:
    start = arguments.namespace.rstrip("/") + "/" if arguments.namespace else ""
    chosen = [each for name, each in services.items() if name.startswith(start)]
    if arguments.json:
        print(json.dumps(chosen, indent=2))
    else:
        sys.stdout.writelines(f"{each['service']}\n" for each in chosen)
    if not chosen:
        sys.stdout.flush()
        print(f"cfepy: no service in {start or '/'} in {arguments.source}", file=sys.stderr)
    return ENDED_WELL if chosen else FOUND_PROBLEMS


def _tell(services: dict[str, dict[str, Any]], arguments: argparse.Namespace) -> int:
    name = arguments.service if arguments.service.startswith("/") else f"/{arguments.service}"
    if name not in services:
        raise UsageError(f"Unknown service [{name}]", file=arguments.source)
    found = services[name]
    if arguments.json:
        print(json.dumps(found, indent=2))
    elif arguments.action == "type":
        print(found["type"])
    elif arguments.action == "args":
        print(" ".join(found["args"]))
    else:
        print(f"Node: {found['node']}\nURI: {found['uri']}\nType: {found['type']}\nArgs: {' '.join(found['args'])}")
    return ENDED_WELL


def _call(arguments: argparse.Namespace) -> int:
    name = arguments.service if arguments.service.startswith("/") else f"/{arguments.service}"
    spec = with_ground_node(spec_for(arguments), "ground_call", [name, arguments.values, arguments.at])
    ground = GroundConsole()
    with FlightSource(spec, arguments, Console(sink=ground.line)) as source:
        source.fly(lambda: bool(ground.said))
    answer = ground.said[0] if ground.said else {"error": f"no answer from {name} until the run was over; see --for"}
    if arguments.json:
        print(json.dumps({"service": name, **{key: answer[key] for key in answer if key != "text"}}))
    elif "error" not in answer:
        print(answer["text"])
    sys.stdout.flush()
    if "error" in answer:
        print(f"cfepy: {answer['error']}", file=sys.stderr)
        return FOUND_PROBLEMS
    return ENDED_WELL
