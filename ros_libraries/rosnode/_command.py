"""The command `rosnode`: ping, list, info, machine, kill, cleanup."""

from __future__ import annotations

import sys
from collections.abc import Callable
from optparse import OptionParser
from typing import NoReturn

import rosgraph
import rosgraph.names

import rosnode

USAGE = """rosnode is a command-line tool for printing information about ROS Nodes.

Commands:
\trosnode ping\ttest connectivity to node
\trosnode list\tlist active nodes
\trosnode info\tprint information about node
\trosnode machine\tlist nodes running on a particular machine or list machines
\trosnode kill\tkill a running node
\trosnode cleanup\tpurge registration information of unreachable nodes

Type rosnode <command> -h for more detailed usage, e.g. 'rosnode ping -h'
"""


def print_usage(return_error: bool = True) -> NoReturn:
    """Say how the command is used, and end the program."""
    print(USAGE)
    sys.exit(64 if return_error else 0)


def run(argv: list[str]) -> None:
    """Run a command line. Errors are printed and end the program."""
    command = argv[1] if len(argv) > 1 else ""
    try:
        if command in COMMANDS:
            sys.exit(COMMANDS[command](argv[2:]) or 0)
        print_usage(return_error=command not in ("-h", "--help"))
    except OSError:
        print("Network communication failed. Most likely failed to communicate with master.", file=sys.stderr)
    except (rosgraph.MasterException, rosnode.ROSNodeException) as error:
        print(f"ERROR: {error}", file=sys.stderr)
        sys.exit(1)


def _parser(usage: str) -> OptionParser:
    return OptionParser(usage=f"usage: %prog {usage}", prog=rosnode.NAME)


def _ping(args: list[str]) -> int:
    parser = _parser("ping [options] <node>")
    parser.add_option("-a", "--all", dest="ping_all", default=False, action="store_true", help="ping all nodes")
    parser.add_option("-c", dest="count", default=None, type="int", metavar="COUNT", help="number of pings to send")
    options, names = parser.parse_args(args)
    if options.ping_all:
        rosnode.rosnode_ping_all(verbose=True)
        return 0  # also if a node is silent, as on ROS
    if len(names) != 1:
        parser.error("Please enter a node to ping" if not names else "you may only specify one input node")
    name = rosgraph.names.script_resolve_name(rosnode.NAME, names[0])
    print(f"rosnode: node is [{name}]")
    rosnode.rosnode_ping(name, max_count=options.count, verbose=True)
    return 0


def _list(args: list[str]) -> None:
    parser = _parser("list")
    parser.add_option("-u", dest="list_uri", default=False, action="store_true", help="list XML-RPC URIs")
    parser.add_option("-a", "--all", dest="list_all", default=False, action="store_true", help="list all information")
    options, names = parser.parse_args(args)
    if len(names) > 1:
        parser.error("invalid args: you may only specify one namespace")
    namespace = rosgraph.names.script_resolve_name(rosnode.NAME, names[0]) if names else None
    rosnode.rosnode_listnodes(namespace, options.list_uri, options.list_all)


def _info(args: list[str]) -> None:
    parser = _parser("info [options] node1 [node2...]")
    parser.add_option("-q", "--quiet", dest="quiet", default=False, action="store_true", help="ask the master only")
    options, names = parser.parse_args(args)
    if not names:
        parser.error("You must specify at least one node name")
    for name in names:
        rosnode.rosnode_info(name, options.quiet)


def _machine(args: list[str]) -> None:
    parser = _parser("machine [machine-name]")
    _, names = parser.parse_args(args)
    if len(names) > 1:
        parser.error("please enter only one machine name")
    found = rosnode.get_nodes_by_machine(names[0]) if names else rosnode.get_machines_by_nodes()
    print("\n".join(sorted(found)))


def _kill(args: list[str]) -> int:
    parser = _parser("kill [node]...")
    parser.add_option("-a", "--all", dest="kill_all", default=False, action="store_true", help="kill all nodes")
    options, names = parser.parse_args(args)
    if options.kill_all and names:
        parser.error("invalid arguments with kill all (-a) option")
    if not options.kill_all and not names:
        parser.error("You must specify at least one node name")
    known = sorted(rosnode.get_node_names())
    names = known if options.kill_all else [rosgraph.names.script_resolve_name(rosnode.NAME, name) for name in names]
    unknown = [name for name in names if name not in known]
    if unknown:
        raise rosnode.ROSNodeException("Unknown node(s):" + _listed(unknown))
    print(f"killing {names[0]}" if len(names) == 1 else "killing:" + _listed(names))
    _, failed = rosnode.kill_nodes(names)
    if failed:
        print("ERROR: Failed to kill:" + _listed(failed), file=sys.stderr)
        return 1
    print("killed")
    return 0


def _listed(names: list[str]) -> str:
    return "".join(f"\n * {name}" for name in names)


def _cleanup(args: list[str]) -> None:
    rosnode.rosnode_cleanup()


COMMANDS: dict[str, Callable[[list[str]], int | None]] = {
    "cleanup": _cleanup,
    "info": _info,
    "kill": _kill,
    "list": _list,
    "machine": _machine,
    "ping": _ping,
}
