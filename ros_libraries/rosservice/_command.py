"""The command `rosservice`: args, call, find, info, list, node, type, uri."""

from __future__ import annotations

import sys
from collections.abc import Callable
from optparse import OptionParser
from typing import Any, NoReturn

import rosgraph
import rosgraph.names
import rospy
import rostopic

import rosservice

USAGE = """Commands:
\trosservice args\tprint service arguments
\trosservice call\tcall the service with the provided args
\trosservice find\tfind services by service type
\trosservice info\tprint information about service
\trosservice list\tlist active services
\trosservice type\tprint service type
\trosservice uri\tprint service ROSRPC uri

Type rosservice <command> -h for more detailed usage, e.g. 'rosservice call -h'
"""


def print_usage() -> NoReturn:
    """Say how the command is used, and end the program."""
    print(USAGE)
    sys.exit(64)


def run(argv: list[str]) -> None:
    """Run a command line. Errors are printed and end the program."""
    argv = rospy.myargv(argv)
    command, args = (argv[1] if len(argv) > 1 else ""), argv[2:]
    try:
        if command not in COMMANDS:
            print_usage()
        COMMANDS[command](args)
    except OSError:
        print("Network communication failed with the master or a node.", file=sys.stderr)
        sys.exit(1)
    except (rosservice.ROSServiceException, rosgraph.MasterException) as error:
        print(f"ERROR: {error}", file=sys.stderr)
        sys.exit(2)


def _parser(usage: str) -> OptionParser:
    return OptionParser(usage=f"usage: %prog {usage}", prog=rosservice.NAME)


def _one_service(command: str, args: list[str]) -> str:
    parser = _parser(f"{command} /service")
    _, names = parser.parse_args(args)
    if len(names) != 1:
        parser.error("service must be specified" if not names else "you may only specify one input service")
    return str(rosgraph.names.script_resolve_name(rosservice.NAME, names[0]))


def _printer(command: str, ask: Callable[[str], str | None]) -> Callable[[list[str]], None]:
    """Return a command that prints one thing about a service."""

    def print_it(args: list[str]) -> None:
        name = _one_service(command, args)
        answer = ask(name)
        if answer is None:
            print(f"Unknown service [{name}]", file=sys.stderr)
            sys.exit(1)
        print(answer)

    return print_it


def _list(args: list[str]) -> None:
    parser = _parser("list [/namespace]")
    parser.add_option(
        "-n", "--nodes", dest="nodes", default=False, action="store_true", help="print nodes that provide service(s)"
    )
    options, names = parser.parse_args(args)
    if len(names) > 1:
        parser.error("you may only specify one input namespace")
    namespace = rosgraph.names.script_resolve_name(rosservice.NAME, names[0]) if names else None
    for name, nodes in sorted(rosservice.get_service_list(namespace=namespace, include_nodes=True)):
        print(f"{name} {','.join(nodes)}" if options.nodes else name)


def _find(args: list[str]) -> None:
    parser = _parser("find msg-type")
    _, names = parser.parse_args(args)
    if len(names) != 1:
        parser.error("please specify a message type" if not names else "you may only specify one message type")
    print("\n".join(rosservice.rosservice_find(names[0])))


def _info(args: list[str]) -> None:
    name = _one_service("info", args)
    node = rosservice.get_service_node(name)
    if not node:
        print("ERROR: unknown service", file=sys.stderr)
        sys.exit(1)
    print(f"Node: {node}")
    print(f"URI: {rosservice.get_service_uri(name)}")
    print(f"Type: {rosservice.get_service_type(name)}")
    print(f"Args: {rosservice.get_service_args(name)}")


def _call(args: list[str]) -> None:
    import yaml

    parser = _parser("call /service [args...]")
    parser.add_option("-v", dest="verbose", default=False, action="store_true", help="print verbose output")
    parser.add_option(
        "--wait", dest="wait", default=False, action="store_true", help="wait for service to be advertised"
    )
    options, given = parser.parse_args(args)
    if not given:
        parser.error("service must be specified")
    name = rosgraph.names.script_resolve_name(rosservice.NAME, given[0])
    if options.wait:
        rospy.wait_for_service(name)
    service_class = rosservice.get_service_class_by_name(name)
    values = [yaml.safe_load(each or "''") for each in given[1:]]
    if values or not rosservice.has_service_args(name, service_class):
        _print_call(name, values, options.verbose, service_class)
        return
    for document in rostopic.stdin_yaml_arg():
        _print_call(name, document if isinstance(document, list) else [document], options.verbose, service_class)


def _print_call(name: str, values: list[Any], verbose: bool, service_class: Any) -> None:
    request, response = rosservice.call_service(name, values, service_class)
    if verbose:
        print(request)
        print("---")
    print(response)


COMMANDS: dict[str, Callable[[list[str]], None]] = {
    "args": _printer("args", rosservice.get_service_args),
    "call": _call,
    "find": _find,
    "info": _info,
    "list": _list,
    "node": _printer("node", rosservice.get_service_node),
    "type": _printer("type", rosservice.get_service_type),
    "uri": _printer("uri", rosservice.get_service_uri),
}
