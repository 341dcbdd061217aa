"""`ViewerServer`: what all viewers are told, whom it lets in, and what they ask of the mission."""

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
"""Pages that are Foxglove itself."""
PROGRAMS = ("app",)
"""Schemes of the pages in programs with windows of their own, besides files; --viewer-origin lets others in."""
MOST_WATCHED = 10_000  # names of parameters, by one viewer
NOTHING: Graph = ({}, {}, {})


class ViewerServer:
    """The server.

    Args:
        place: where it listens.
        admission: whom it lets in.
        name: of the mission; viewers show it.
        counts: of the run's report.
        do: does what a viewer asks of the mission.
        gone: is told of a viewer that has left.

    Attributes:
        place: where it listens, with the port that was free.
        values: the mission's parameters; `tell_parameters` says which of them have changed.

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
        """Those that are connected."""
        return self._listener.clients

    def fileno(self) -> int:
        """What can be read when something wants to come in."""
        return self._listener.fileno()

    def exchange(self) -> None:
        """Send what has waited for room, and bring in what viewers ask for."""
        self._listener.exchange()

    def close(self) -> None:
        """Let the last messages out, and end all connections."""
        self._listener.close()

    # -- whom it lets in -----------------------------------------------------------------------------------------------

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

    # -- what it is asked ----------------------------------------------------------------------------------------------

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

    # -- what it tells -------------------------------------------------------------------------------------------------

    def _tell(self, message: str) -> None:
        for viewer in self.viewers:
            viewer.tell(message)

    def advertise(self, channel: ViewerChannel) -> None:
        """There is a new channel; its number is no other's."""
        self._channels[channel.number] = channel
        self._tell(text("advertise", channels=[channel.description]))

    def unadvertise(self, channel: ViewerChannel) -> None:
        """There is no such channel any more."""
        del self._channels[channel.number]
        for viewer in list(channel.viewers):
            viewer.ends(channel)
        self._tell(text("unadvertise", channelIds=[channel.number]))

    def offer(self, name: str, kind: str, request: str, response: str) -> int:
        """Offer a service of ROS; returns its number.

        Args:
            name: of the service.
            kind: its type.
            request, response: their definitions.
        """
        number = next(self._service_numbers)
        self._services[number] = service(number, name, kind, request, response)
        self._tell(text("advertiseServices", services=[self._services[number]]))
        return number

    def withdraw(self, services: list[int]) -> None:
        """Offer services no more."""
        for each in services:
            del self._services[each]
        if services:
            self._tell(text("unadvertiseServices", serviceIds=services))

    def tell_time(self, time_ns: int) -> None:
        """Tell the viewers what time it is in the mission."""
        message = time_message(time_ns)
        for viewer in self.viewers:
            viewer.tell_if_idle(message)

    def tell_parameters(self, names: Iterable[str]) -> None:
        """Parameters have changed: tell those that want to know of them."""
        changed = list(names)
        for viewer in self.viewers:
            told = [(name, self.values.get(name)) for name in changed if name in viewer.watched]
            if told:
                viewer.tell(parameters(told))

    def tell_problem(self, what: str, key: str) -> None:
        """Show a warning in the viewers; one with the same key takes its place."""
        self._tell(status(WARNING, what, key))

    def tell_graph(self, graph: Graph) -> None:
        """Tell those that want to know how the graph has changed."""
        update = graph_update(self._graph, graph)
        self._graph = graph
        for viewer in self.viewers:
            if viewer.watches_graph:
                viewer.tell(update)


def _is_app(origin: str | None) -> bool:
    """Whether a page is Foxglove's own: from its site, or in a program that has windows of its own, such as Electron.

    Extensions of a browser are not: they have schemes of their own, too, such as chrome-extension and moz-extension.
    """
    if origin is None or origin.rstrip("/") in APPS:
        return True
    scheme, mark, rest = origin.lower().partition("://")
    return bool(mark) and (scheme in PROGRAMS or (scheme == "file" and rest in ("", "/")))
