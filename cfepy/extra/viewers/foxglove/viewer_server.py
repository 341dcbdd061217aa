"""`ViewerServer`: admits viewers, sends messages to all of them, and passes on their requests to the mission."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from http import HTTPStatus
from itertools import count
from typing import TYPE_CHECKING, Any

from cfepy.extra.viewers.foxglove.protocol import (
    SUBPROTOCOLS,
    WARNING,
    Graph,
    GraphWatched,
    Op,
    ParametersAsked,
    ParametersWatched,
    graph_update,
    parameters,
    server_info,
    service,
    status,
    text,
    time_message,
)
from cfepy.extra.viewers.foxglove.viewer import PEER, Viewer, ViewerChannel
from cfepy.extra.viewers.listen import Admission, ListenPlace
from cfepy.extra.viewers.websocket_listener import CONNECTIONS, Refusal, WebSocketListener, token_of
from cfepy.io import OUT_OF, PeerCounts

if TYPE_CHECKING:
    from websockets.http11 import Request

OPTION, EXTRA = "--foxglove", "viz"
APPS = ("https://app.foxglove.dev", "https://studio.foxglove.dev")
"""Sites that are Foxglove itself."""
PROGRAMS = ("app",)
"""Schemes of the pages in desktop programs, besides files; --viewer-origin admits others."""
MOST_WATCHED = 10_000  # names of parameters, by one viewer
NOTHING: Graph = ({}, {}, {})


class ViewerServer:
    """The server.

    Args:
        place: the address that it listens at.
        admission: decides which viewers may connect.
        name: name of the mission; viewers show it.
        counts: counts for the run's report.
        do: carries out a viewer's request to the mission.
        gone: called when a viewer has left.

    Attributes:
        place: the address that it listens at, with the actual port.
        values: the mission's parameters; `tell_parameters` names the changed ones.

    Raises:
        UsageError: the package websockets is not installed, or the port is taken.
    """

    def __init__(
        self,
        place: ListenPlace,
        admission: Admission,
        name: str,
        counts: PeerCounts,
        do: Callable[[Viewer, Op], object],
        gone: Callable[[Viewer], object],
    ) -> None:
        self.values: Mapping[str, Any] = {}
        self._admission = admission
        self._info = server_info(name, str(time.time_ns() // 1_000_000))
        self._counts = counts
        self._do = do
        self._gone = gone
        self._service_numbers = count(1)
        self._channels: dict[int, ViewerChannel] = {}
        self._services: dict[int, dict[str, Any]] = {}
        self._graph = NOTHING
        self._listener = WebSocketListener(
            place, OPTION, EXTRA, self._viewer, self._refusal, self._refused, SUBPROTOCOLS
        )
        self.place = self._listener.place

    @property
    def viewers(self) -> list[Viewer]:
        """The connected viewers."""
        return self._listener.clients

    def fileno(self) -> int:
        """Return the descriptor that becomes readable when input arrives."""
        return self._listener.fileno()

    def exchange(self) -> None:
        """Send messages that have waited for room, and take the requests of viewers."""
        self._listener.exchange()

    def close(self) -> None:
        """Send the last messages, and end all connections."""
        self._listener.close()

    # -- admission -----------------------------------------------------------------------------------------------------

    def _viewer(self, address: str) -> Viewer:
        return Viewer(self._counts, self._channels.get, self._welcome, self._ask, self._gone)

    def _refusal(self, viewer: Viewer, request: Request) -> Refusal | None:
        if self._admission.token:
            is_known = self._admission.knows(token_of(request))
            return None if is_known else (HTTPStatus.UNAUTHORIZED, "the token is missing or wrong\n")
        origin = request.headers.get("Origin")
        if _is_app(origin) or self._admission.welcomes(origin):
            return None
        return HTTPStatus.FORBIDDEN, f"pages of {origin!r:.100} are strangers\n"

    def _refused(self, address: str, why: str) -> None:
        row = self._counts.of(CONNECTIONS, PEER, OUT_OF)
        row.refused += 1
        row.why = why

    def _welcome(self, viewer: Viewer) -> None:
        viewer.tell(self._info)
        viewer.tell(text("advertise", channels=[each.description for each in self._channels.values()]))
        if self._services:
            viewer.tell(text("advertiseServices", services=list(self._services.values())))

    # -- requests ------------------------------------------------------------------------------------------------------

    def _ask(self, viewer: Viewer, op: Op) -> None:
        match op:
            case ParametersAsked():
                names = op.names or self.values
                known = [(name, self.values[name]) for name in names if name in self.values]
                viewer.tell(parameters(known, op.request))
            case ParametersWatched(names, True):
                viewer.watched |= set(names or self.values)
                if len(viewer.watched) > MOST_WATCHED:
                    viewer.watched.clear()
                    viewer.complain(f"more than {MOST_WATCHED:,} parameters cannot be watched")
            case ParametersWatched(names, False):
                viewer.watched -= set(names or viewer.watched)
            case GraphWatched(True):
                if not viewer.watches_graph:
                    viewer.tell(graph_update(NOTHING, self._graph))
                viewer.watches_graph = True
            case GraphWatched(False):
                viewer.watches_graph = False
            case _:
                self._do(viewer, op)

    # -- output --------------------------------------------------------------------------------------------------------

    def _tell(self, message: str) -> None:
        for viewer in self.viewers:
            viewer.tell(message)

    def advertise(self, channel: ViewerChannel) -> None:
        """Advertise a new channel; its number must be unique."""
        self._channels[channel.number] = channel
        self._tell(text("advertise", channels=[channel.description]))

    def unadvertise(self, channel: ViewerChannel) -> None:
        """Remove a channel."""
        del self._channels[channel.number]
        for viewer in list(channel.viewers):
            viewer.ends(channel)
        self._tell(text("unadvertise", channelIds=[channel.number]))

    def offer(self, name: str, kind: str, request: str, response: str) -> int:
        """Offer a service of ROS.

        Args:
            name: name of the service.
            kind: its type.
            request: definition of its request.
            response: definition of its response.

        Returns:
            Its number.
        """
        number = next(self._service_numbers)
        self._services[number] = service(number, name, kind, request, response)
        self._tell(text("advertiseServices", services=[self._services[number]]))
        return number

    def withdraw(self, services: list[int]) -> None:
        """Withdraw services."""
        for each in services:
            del self._services[each]
        if services:
            self._tell(text("unadvertiseServices", serviceIds=services))

    def tell_time(self, time_ns: int) -> None:
        """Send the viewers the mission's time."""
        message = time_message(time_ns)
        for viewer in self.viewers:
            viewer.tell_if_idle(message)

    def tell_parameters(self, names: Iterable[str]) -> None:
        """Send changed parameters to the viewers that have subscribed to them."""
        changed = list(names)
        for viewer in self.viewers:
            told = [(name, self.values.get(name)) for name in changed if name in viewer.watched]
            if told:
                viewer.tell(parameters(told))

    def tell_problem(self, what: str, key: str) -> None:
        """Show a warning in the viewers; one with the same key replaces it."""
        self._tell(status(WARNING, what, key))

    def tell_graph(self, graph: Graph) -> None:
        """Send the changes of the graph to the viewers that have subscribed to it."""
        update = graph_update(self._graph, graph)
        self._graph = graph
        for viewer in self.viewers:
            if viewer.watches_graph:
                viewer.tell(update)


def _is_app(origin: str | None) -> bool:
    """Return True if a page is Foxglove's own: from its site, or in a desktop program such as one based on Electron.

    Extensions of a browser are not; their schemes differ, such as chrome-extension and moz-extension.
    """
    if origin is None or origin.rstrip("/") in APPS:
        return True
    scheme, mark, rest = origin.lower().partition("://")
    return bool(mark) and (scheme in PROGRAMS or (scheme == "file" and rest in ("", "/")))
