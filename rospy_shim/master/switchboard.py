"""The lookup of the object that answers at a URI, the master or a node of the mission, and the nodes' `xmlrpc.client`.

That module is Python's own, whose requests to the master and to nodes go to the switchboard. The module itself marshals
requests and answers, so that permitted values, received values and errors are exactly XML-RPC's. Requests to other
addresses go over HTTP, if the mission has a network.
"""

from __future__ import annotations

import errno
import importlib.util
import os
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from cfepy.nodes.refused_modules import RefusedError
from rospy_shim.master.compiled_api import CompiledApi
from rospy_shim.master.master_api import MasterApi
from rospy_shim.master.registrations import uri_of
from rospy_shim.master.slave_api import SlaveApi
from rospy_shim.master.xmlrpc_calls import UnknownMethod, call
from rospy_shim.parameters.values import DateTime

if TYPE_CHECKING:
    from cfepy.nodes import Universe
    from rospy_shim.client.node import Node
    from rospy_shim.graph.graph import Graph

MASTER_PORT = 11311
MASTER_URI = f"http://cfepy:{MASTER_PORT}/"
HERE = frozenset({"cfepy", "localhost", "127.0.0.1", "127.0.1.1", "[::1]"})
NAME = "xmlrpc.client"
ROUND_TRIP_NS = 500_000  # typical time of a request on one computer, so that a loop that polls makes progress


class Switchboard:
    """Connects XML-RPC requests.

    Args:
        graph: the mission's ROS graph.

    Attributes:
        master: answers for the master.
    """

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self.master = MasterApi(graph, MASTER_URI)

    def find(self, asker: Node, address: str) -> MasterApi | SlaveApi | CompiledApi | None:
        """Return the object that answers, or None.

        Args:
            asker: the node that asks; its ROS_MASTER_URI names the master, regardless of the host.
            address: host and port, as in a URI.
        """
        place = _place(address)
        if place in (_place(f"cfepy:{MASTER_PORT}"), _place(_host(asker.universe.environ.get("ROS_MASTER_URI", "")))):
            return self.master
        for node in self._graph.nodes.values():
            if place == _place(_host(uri_of(node))):
                return SlaveApi(node)
        for compiled in self._graph.compiled.values():
            if place == _place(_host(uri_of(compiled))):
                return CompiledApi(compiled, self._graph, MASTER_URI)
        return None

    def api_of(self, name: str) -> SlaveApi | CompiledApi | None:
        """Return the object that answers for a node of the mission, by its name; None if there is no such node."""
        node, compiled = self._graph.nodes.get(name), self._graph.compiled.get(name)
        if node is not None:
            return SlaveApi(node)
        return None if compiled is None else CompiledApi(compiled, self._graph, MASTER_URI)


def _host(uri: str) -> str:
    try:
        return urlsplit(uri).netloc
    except ValueError:
        return ""


def _place(address: str) -> tuple[str, str]:
    """Return host and port; all names of this machine become one."""
    host, _, port = address.rpartition("@")[2].rpartition(":")
    return ("cfepy" if host in HERE else host), port


def xmlrpc_client(node: Node, switchboard: Switchboard) -> Callable[[Universe], ModuleType]:
    """Return the factory of a node's `xmlrpc.client`.

    Args:
        node: the caller.
        switchboard: finds the object to call.
    """

    def make(universe: Universe) -> ModuleType:
        spec = importlib.util.find_spec(NAME)
        if spec is None or spec.origin is None:
            raise ModuleNotFoundError(f"No module named {NAME!r}", name=NAME)
        module = universe.importer.load_file(NAME, spec.origin)
        vars(module)["Transport"].request = _request(node, switchboard, module)
        vars(module)["WRAPPERS"] += (DateTime,)  # can be marshalled, too
        return module

    return make


def _request(node: Node, switchboard: Switchboard, module: Any) -> Callable[..., Any]:
    """Return a `Transport.request` that uses the switchboard."""
    over_http = vars(module)["Transport"].request

    def request(self: Any, host: Any, handler: str, request_body: bytes, verbose: bool = False) -> Any:
        node.kernel.charge(ROUND_TRIP_NS)
        address, _, _ = self.get_host_info(host)
        api = switchboard.find(node, address)
        if api is None:
            try:
                return over_http(self, host, handler, request_body, verbose)
            except RefusedError:  # without a network no program listens anywhere
                raise ConnectionRefusedError(errno.ECONNREFUSED, os.strerror(errno.ECONNREFUSED)) from None
        answer = _answer(module, api, request_body)
        parser, unmarshaller = self.getparser()
        parser.feed(answer.encode("utf-8", "xmlcharrefreplace"))
        parser.close()
        return unmarshaller.close()

    return request


def _answer(module: Any, api: object, body: bytes) -> str:
    """Return the answer of an XML-RPC server."""
    arguments, method = module.loads(body, use_builtin_types=True)
    try:
        if method == "system.multicall":
            result: Any = [_one_of_many(module, api, each) for each in arguments[0]]
        else:
            result = call(api, method, arguments)
        return str(module.dumps((result,), methodresponse=True))
    except Exception as error:
        return str(module.dumps(_fault(module, error), methodresponse=True))


def _one_of_many(module: Any, api: object, request: dict[str, Any]) -> Any:
    try:
        return [call(api, request["methodName"], request["params"])]
    except Exception as error:
        fault = _fault(module, error)
        return {"faultCode": fault.faultCode, "faultString": fault.faultString}


def _fault(module: Any, error: Exception) -> Any:
    kind = Exception if isinstance(error, UnknownMethod) else type(error)
    return module.Fault(1, f"{kind}:{error}")
