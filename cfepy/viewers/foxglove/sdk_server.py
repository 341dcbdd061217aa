"""The server of the library foxglove-sdk: the one place that needs it (`pip install 'cfepy[viz]'`).

It runs in threads of its own. A message is copied into a queue for each viewer that has subscribed, and nobody waits:
of a viewer that is too slow the oldest of `MOST_WAITING` messages is lost. It checks neither tokens nor origins, so it
listens at an address that only the door (`door.py`) knows.
"""

from __future__ import annotations

import contextlib
import logging
import secrets
import socket
from collections.abc import Callable, Iterable, Mapping
from types import ModuleType
from typing import Any

from cfepy.status import UsageError

MOST_WAITING = 1024  # messages for one viewer, foxglove-sdk's own default
LOOPBACK = "127.0.0.1"
ENCODINGS = ("ros1", "json")
LOGGER = "foxglove"


class SdkServer:
    """The server.

    Args:
        name: of the mission; viewers show it.
        listener: is told what viewers do (`foxglove.websocket.ServerListener`), in the server's threads.
        log: gets what the server says of bad frames and connections, in its threads.

    Raises:
        UsageError: the library is not installed, or no port is free.
    """

    def __init__(self, name: str, listener: Any, log: Callable[[str], object]) -> None:
        self.library = _library()
        can = self.library.websocket.Capability
        self._log = _LogHandler(log)
        self._logger = logging.getLogger(LOGGER)
        self._was = (self._logger.propagate, self._logger.level)
        self._context = self.library.Context()
        self.host = _private_host()
        try:
            self._server: Any = self.library.start_server(
                name=name,
                host=self.host,
                port=0,
                capabilities=[can.ClientPublish, can.ConnectionGraph, can.Parameters, can.Services, can.Time],
                server_listener=listener,
                supported_encodings=list(ENCODINGS),
                context=self._context,
                message_backlog_size=MOST_WAITING,
            )
        except RuntimeError as error:
            raise UsageError(f"Foxglove's server does not start: {error}", field="--foxglove") from None
        self.port: int = self._server.port
        self._logger.addHandler(self._log)
        self._logger.propagate = False
        self._logger.setLevel(logging.WARNING)

    def channel(self, topic: str, encoding: str, schema: tuple[str, str, bytes], metadata: Mapping[str, str]) -> Any:
        """A new channel.

        Args:
            topic: its name.
            encoding: of its messages.
            schema: name, encoding and text of the schema.
            metadata: what else is known of it.
        """
        kind, form, text = schema
        made = self.library.Schema(name=kind, encoding=form, data=text)
        return self._context._create_channel(topic, message_encoding=encoding, schema=made, metadata=dict(metadata))

    def parameter(self, name: str, value: Any) -> Any:
        """A parameter as the library has it; None is one that is not set."""
        return self.library.Parameter(name, value=value)

    def tell_time(self, time_ns: int) -> None:
        """Tell the viewers what time it is in the mission."""
        self._server.broadcast_time(time_ns)

    def tell_parameters(self, parameters: Iterable[Any]) -> None:
        """Tell those that have subscribed to them of parameters that have changed."""
        self._server.publish_parameter_values(list(parameters))

    def tell_problem(self, text: str, key: str) -> None:
        """Show a warning in the viewers; one with the same key takes its place."""
        self._server.publish_status(text, self.library.StatusLevel.Warning, key)

    def tell_graph(self, topics: Mapping[str, tuple[list[str], list[str]]], services: Mapping[str, list[str]]) -> None:
        """Tell who publishes and hears which topic, and who offers which service."""
        graph = self.library.ConnectionGraph()
        for topic, (publishers, subscribers) in topics.items():
            graph.set_published_topic(topic, publishers)
            graph.set_subscribed_topic(topic, subscribers)
        for service, providers in services.items():
            graph.set_advertised_service(service, providers)
        self._server.publish_connection_graph(graph)

    def offer(self, service: str, kind: str, request: str, response: str, handler: Callable[[Any], bytes]) -> None:
        """Offer a service of ROS.

        Args:
            service: its name.
            kind: its type.
            request, response: their definitions.
            handler: answers a request, in a thread of its own, which may wait.
        """
        library = self.library

        def schema(part: str, text: str) -> Any:
            made = library.Schema(name=f"{kind}{part}", encoding="ros1msg", data=text.encode())
            return library.MessageSchema(encoding="ros1", schema=made)

        form = library.ServiceSchema(
            name=kind, request=schema("Request", request), response=schema("Response", response)
        )
        self._server.add_services([library.Service(service, schema=form, handler=handler)])

    def withdraw(self, services: list[str]) -> None:
        """Offer services no more."""
        self._server.remove_services(services)

    def close(self) -> None:
        """End all connections."""
        self._server.stop()
        self._logger.removeHandler(self._log)
        self._logger.propagate, level = self._was
        self._logger.setLevel(level)


class _LogHandler(logging.Handler):
    """Takes what the server says, which would be printed otherwise."""

    def __init__(self, take: Callable[[str], object]) -> None:
        super().__init__()
        self._take = take

    def emit(self, record: logging.LogRecord) -> None:
        """See `logging.Handler.emit`."""
        self._take(record.getMessage())


def _private_host() -> str:
    """An address that a page in a browser does not guess, where the system has more than one for itself."""
    part = secrets.randbelow
    guess = f"127.{part(256)}.{part(256)}.{1 + part(254)}"
    with contextlib.suppress(OSError), socket.socket() as trial:
        trial.bind((guess, 0))
        return guess
    return LOOPBACK


def _library() -> ModuleType:
    try:
        import foxglove
        import foxglove.websocket
    except ImportError:
        raise UsageError(
            "Foxglove is served by the library foxglove-sdk: pip install 'cfepy[viz]'", field="--foxglove"
        ) from None
    return foxglove
