"""rosnode: lists nodes, checks whether they answer, shows their topics, and ends them (wiki.ros.org/rosnode).

It asks the master, and the nodes themselves at their URIs.
"""

from __future__ import annotations

import socket
import sys
import time
import urllib.parse as urlparse
from collections.abc import Iterable, Sequence
from typing import Any
from xmlrpc.client import ServerProxy

import rosgraph
import rosgraph.names
from ros_tools import command_of

NAME = "rosnode"
ID = "/rosnode"

_caller_apis: dict[str, str] = {}


class ROSNodeException(Exception):
    """Base of the errors of this library."""


class ROSNodeIOException(ROSNodeException):
    """The master or a node does not answer."""


def _succeed(args: Any) -> Any:
    """Return the value of an answer.

    Raises:
        ROSNodeException: the answer is not success.
    """
    code, text, value = args
    if code != 1:
        raise ROSNodeException(f"remote call failed: {text}")
    return value


def _state(master: rosgraph.Master) -> Any:
    try:
        return master.getSystemState()
    except OSError:
        raise ROSNodeIOException("Unable to communicate with master!") from None


# -- which nodes -----------------------------------------------------------------------------------------------------


def get_api_uri(master: rosgraph.Master, caller_id: str, skip_cache: bool = False) -> str | None:
    """Return the URI of a node, or None if the node is unknown.

    Args:
        master: the master to ask.
        caller_id: name of the node.
        skip_cache: ask even if it is known from before.

    Raises:
        ROSNodeIOException: the master does not answer.
    """
    if skip_cache or not _caller_apis.get(caller_id):
        try:
            _caller_apis[caller_id] = master.lookupNode(caller_id)
        except rosgraph.MasterError:
            return None
        except OSError:
            raise ROSNodeIOException("Unable to communicate with master!") from None
    return _caller_apis[caller_id]


def lookup_uri(master: rosgraph.Master, system_state: Any, topic: str, uri: str) -> str:
    """Return a URI with the name of the node on a topic that has it, or the bare URI if there is none."""
    for entries in system_state[:2]:
        for name, nodes in entries:
            for node in nodes if name == topic else ():
                if get_api_uri(master, node) == uri:
                    return f"{node} ({uri})"
    return uri


def get_node_names(namespace: str | None = None) -> list[str]:
    """Return the names of all nodes, or of those in a namespace.

    Raises:
        ROSNodeIOException: the master does not answer.
    """
    names = _names(_state(rosgraph.Master(ID)))
    if not namespace:
        return names
    prefix = rosgraph.names.make_global_ns(namespace)
    return [name for name in names if name.startswith(prefix) or name == namespace]


def _names(state: Any) -> list[str]:
    return list(dict.fromkeys(node for entries in state for _, nodes in entries for node in nodes))


def get_machines_by_nodes() -> list[str]:
    """Return the names of the machines that nodes run on.

    Raises:
        ROSNodeIOException: the master does not answer.
    """
    return list(dict.fromkeys(machine for _, machine in _machines()))


def get_nodes_by_machine(machine: str) -> list[str]:
    """Return the names of the nodes that run on a machine.

    Raises:
        ROSNodeException: the machine is unknown.
        ROSNodeIOException: the master does not answer.
    """
    try:
        address = socket.gethostbyname(machine)
    except OSError:
        raise ROSNodeException(f"cannot resolve machine name [{machine}] to address") from None
    return [node for node, host in _machines() if host == machine or socket.gethostbyname(host) == address]


def _machines() -> Iterable[tuple[str, str]]:
    master = rosgraph.Master(ID)
    for name in get_node_names():
        uri = get_api_uri(master, name, skip_cache=True)
        if uri is not None:
            yield name, urlparse.urlparse(uri).hostname or ""


# -- do they answer --------------------------------------------------------------------------------------------------


def rosnode_ping(node_name: str, max_count: int | None = None, verbose: bool = False, skip_cache: bool = False) -> bool:
    """Return whether a node answers.

    Args:
        node_name: name of the node.
        max_count: how often to ask, once a second; None forever.
        verbose: print each answer.
        skip_cache: ask the master for the URI even if it is known from before.

    Raises:
        ROSNodeIOException: the master does not answer.
    """
    master = rosgraph.Master(ID)
    uri = get_api_uri(master, node_name, skip_cache=skip_cache)
    if not uri:
        print(f"cannot ping [{node_name}]: unknown node", file=sys.stderr)
        return False
    if verbose:
        print(f"pinging {node_name} with a timeout of 3.0s")
    times: list[float] = []
    while True:
        start = time.time()
        try:
            _succeed(ServerProxy(uri).getPid(ID))
        except OSError:
            former, uri = uri, get_api_uri(master, node_name, skip_cache=True)
            if uri and uri != former:
                continue  # the node has been started anew
            text = f"ERROR: connection refused to [{uri}]" if uri else f"cannot ping [{node_name}]: unknown node"
            print(text, file=sys.stderr)
            return False
        times.append((time.time() - start) * 1000)
        if verbose:
            print(f"xmlrpc reply from {uri}\ttime={times[-1]:f}ms")
        if max_count and len(times) >= max_count:
            break
        time.sleep(1.0)
    if verbose and len(times) > 1:
        print(f"ping average: {sum(times) / len(times):f}ms")
    return True


def rosnode_ping_all(verbose: bool = False, skip_cache: bool = False) -> tuple[list[str], list[str]]:
    """Return the nodes that answer and those that do not.

    Raises:
        ROSNodeIOException: the master does not answer.
    """
    names = get_node_names()
    if verbose:
        print("Will ping the following nodes: \n" + "".join(f" * {name}\n" for name in names))
    answered = {name: rosnode_ping(name, max_count=1, verbose=verbose, skip_cache=skip_cache) for name in names}
    return [name for name in names if answered[name]], [name for name in names if not answered[name]]


# -- the end of nodes ------------------------------------------------------------------------------------------------


def kill_nodes(node_names: Iterable[str]) -> tuple[list[str], list[str]]:
    """Ask nodes to shut down. Returns the nodes that were asked, and the unknown ones.

    Raises:
        ROSNodeIOException: the master does not answer.
    """
    master = rosgraph.Master(ID)
    uris = {name: get_api_uri(master, name, skip_cache=True) for name in node_names}
    for uri in filter(None, uris.values()):
        try:
            _succeed(ServerProxy(uri).shutdown(ID, "user request"))
        except Exception:
            pass  # it may end before it has answered
    return [name for name, uri in uris.items() if uri], [name for name, uri in uris.items() if not uri]


def cleanup_master_blacklist(master: rosgraph.Master, blacklist: Sequence[str]) -> None:
    """Remove all registrations of some nodes from the master."""
    for name in blacklist:
        print("Unregistering", name)
        _unregister(master, name)
        _caller_apis.pop(name, None)


def cleanup_master_whitelist(master: rosgraph.Master, whitelist: Sequence[str]) -> None:
    """Remove all registrations from the master, except for those of the listed nodes."""
    for name in _names(master.getSystemState()):
        if name not in whitelist:
            _unregister(master, name)


def _unregister(master: rosgraph.Master, node: str) -> None:
    publishers, subscribers, services = master.getSystemState()
    uri = get_api_uri(master, node) or ""
    its_master = rosgraph.Master(node)
    for topic, nodes in publishers:
        if node in nodes:
            its_master.unregisterPublisher(topic, uri)
    for topic, nodes in subscribers:
        if node in nodes:
            its_master.unregisterSubscriber(topic, uri)
    for service, nodes in services:
        if node in nodes:
            its_master.unregisterService(service, master.lookupService(service))


# -- connections of nodes --------------------------------------------------------------------------------------------


def get_node_info_description(node_name: str) -> str:
    """Return a text that lists a node's publications, subscriptions and services.

    Raises:
        ROSNodeIOException: the master does not answer.
    """
    master = rosgraph.Master(ID)
    publishers, subscribers, services = (
        sorted(name for name, nodes in entries if node_name in nodes) for entries in _state(master)
    )
    types = dict(master.getPublishedTopics("/"))
    text = f"Node [{node_name}]"
    for title, topics in (("Publications", publishers), ("Subscriptions", subscribers)):
        text += _listed(title, [f"{topic} [{types.get(topic, 'unknown type')}]" for topic in topics])
    return text + _listed("Services", services)


def _listed(title: str, lines: Sequence[str]) -> str:
    return f"\n{title}: \n" + "\n".join(f" * {line}" for line in lines) + "\n" if lines else f"\n{title}: None\n"


def get_node_connection_info_description(node_api: str, master: rosgraph.Master) -> str:
    """Return a text that lists a node's connections.

    Args:
        node_api: the node's URI.
        master: the master to ask for names.

    Raises:
        ROSNodeIOException: the node does not answer.
    """
    node = ServerProxy(node_api)
    try:
        pid, connections = _succeed(node.getPid(ID)), _succeed(node.getBusInfo(ID))
    except OSError:
        raise ROSNodeIOException(f"Communication with node[{node_api}] failed!") from None
    state = master.getSystemState()
    text = f"Pid: {pid}\n" + ("Connections:\n" if connections else "")
    for _, other, direction, transport, topic, connected, *_ in connections:
        if connected:
            way = {"i": "inbound", "o": "outbound"}.get(direction, "unknown")
            text += f" * topic: {topic}\n    * to: {lookup_uri(master, state, topic, other)}\n"
            text += f"    * direction: {way}\n    * transport: {transport}\n"
    return text


def rosnode_info(node_name: str, quiet: bool = False) -> None:
    """Print all information about a node.

    Args:
        node_name: name of the node.
        quiet: ask the master only.
    """
    master = rosgraph.Master(ID)
    node_name = rosgraph.names.script_resolve_name(NAME, node_name)
    print("-" * 80)
    print(get_node_info_description(node_name))
    uri = get_api_uri(master, node_name)
    if not uri:
        print(f"cannot contact [{node_name}]: unknown node", file=sys.stderr)
    elif not quiet:
        print(f"\ncontacting node {uri} ...")
        print(get_node_connection_info_description(uri, master))


rosnode_debugnode = rosnode_info


def _sub_rosnode_listnodes(namespace: str | None = None, list_uri: bool = False, list_all: bool = False) -> str:
    """Return the lines that `rosnode list` prints."""
    master = rosgraph.Master(ID)
    lines = []
    for name in sorted(get_node_names(namespace)):
        uri = (get_api_uri(master, name) or "unknown address") if list_uri or list_all else ""
        lines.append(f"{uri} \t{name}" if list_all else uri or name)
    return "\n".join(lines)


def rosnode_listnodes(namespace: str | None = None, list_uri: bool = False, list_all: bool = False) -> None:
    """Print the names of all nodes, their URIs, or both."""
    print(_sub_rosnode_listnodes(namespace, list_uri, list_all))


def rosnode_cleanup() -> None:
    """Remove nodes that do not answer from the master, after asking on stdin."""
    _, silent = rosnode_ping_all()
    if not silent:
        return
    print("Unable to contact the following nodes:")
    print("\n".join(f" * {name}" for name in silent))
    print("Cleanup will purge all information about these nodes from the master.")
    print("Please type y or n to continue:")
    answer = None
    while answer not in ("y", "n", ""):
        answer = sys.stdin.readline().strip()
    if answer == "y":
        cleanup_master_blacklist(rosgraph.Master(ID), silent)
        print("done")
    else:
        print("aborting")


def rosnodemain(argv: Sequence[str] | None = None) -> None:
    """Run the command `rosnode`.

    Args:
        argv: its command line; sys.argv by default.
    """
    from rosnode._command import run

    run(list(sys.argv if argv is None else argv))


def __getattr__(name: str) -> Any:
    """Return a command by the name that tests and tools use: `_rosnode_cmd_list(argv)`."""
    return command_of("rosnode", name)
