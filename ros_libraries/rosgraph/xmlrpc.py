"""rosgraph.xmlrpc: servers for a program's own XML-RPC API. They need sockets, which may not be available."""

from __future__ import annotations

import _thread
import logging
import socketserver
from collections.abc import Callable
from typing import Any
from xmlrpc.server import SimpleXMLRPCRequestHandler, SimpleXMLRPCServer

from rosgraph.network import create_local_xmlrpc_uri, get_bind_address


def isstring(s: object) -> bool:
    """Return whether something is a text."""
    return isinstance(s, str)


class SilenceableXMLRPCRequestHandler(SimpleXMLRPCRequestHandler):
    """Handles a request without a word."""

    protocol_version = "HTTP/1.1"

    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing."""


class ThreadingXMLRPCServer(socketserver.ThreadingMixIn, SimpleXMLRPCServer):
    """A server with a thread for each connection.

    Args:
        addr: host and port to bind.
        log_requests: write a line for each request.
    """

    daemon_threads = True
    allow_reuse_address = True

    def __init__(self, addr: tuple[str, int], log_requests: int = 1) -> None:
        super().__init__(addr, SilenceableXMLRPCRequestHandler, bool(log_requests))

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Log it."""
        logging.getLogger("xmlrpc").exception("request of %s failed", client_address)


class XmlRpcHandler:
    """Base of objects whose public methods an `XmlRpcNode` offers."""

    def _ready(self, uri: str) -> None:
        """The server is there.

        Args:
            uri: where it answers.
        """

    def _shutdown(self, reason: str) -> None:
        """The server ends."""


class XmlRpcNode:
    """A program's XML-RPC server.

    Args:
        port: port to bind; 0 for any.
        rpc_handler: the object whose methods are offered.
        on_run_error: called with the exception that ended the server.
    """

    def __init__(
        self,
        port: int | str = 0,
        rpc_handler: XmlRpcHandler | None = None,
        on_run_error: Callable[[Exception], object] | None = None,
    ) -> None:
        self.handler = rpc_handler
        self.uri: str | None = None
        self.server: ThreadingXMLRPCServer | None = None
        self.port = int(port or 0)
        self.is_shutdown = False
        self.on_run_error = on_run_error

    def set_uri(self, uri: str) -> None:
        """The server answers at a URI."""
        self.uri = uri

    def start(self) -> None:
        """Run the server in a thread."""
        _thread.start_new_thread(self.run, ())

    def run(self) -> None:
        """Run the server until `shutdown`."""
        try:
            self._run()
        except Exception as error:
            if self.is_shutdown:
                return
            if self.on_run_error is None:
                raise
            self.on_run_error(error)

    def _run(self) -> None:
        self.server = server = ThreadingXMLRPCServer((get_bind_address(), self.port), False)
        self.port = server.server_address[1]
        self.set_uri(create_local_xmlrpc_uri(self.port))
        server.register_multicall_functions()
        server.register_instance(self.handler)
        if self.handler is not None:
            self.handler._ready(self.uri or "")
        server.serve_forever()

    def shutdown(self, reason: str) -> None:
        """End the server.

        Args:
            reason: handed to the handler.
        """
        self.is_shutdown = True
        server, handler = self.server, self.handler
        self.server = self.handler = self.uri = None
        if server is not None:
            if handler is not None:
                handler._shutdown(reason)
            server.server_close()
