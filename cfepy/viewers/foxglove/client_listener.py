"""What the server calls when a viewer does something, in its own threads: notes it, and answers from what is known.

Nothing of the mission is touched here, for it is on its way meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cfepy.viewers.foxglove.inbox import (
    Advertised,
    ParametersSet,
    Published,
    Subscribed,
    Unadvertised,
    ViewerInbox,
)


class ClientListener:
    """A `foxglove.websocket.ServerListener`.

    Args:
        inbox: gets what the run must see to.
        parameters: what they are at present, by name; replaced, never changed.
        make: makes a parameter as the library has it.

    Attributes:
        listeners: of each channel, by its id: the viewers that have subscribed.
    """

    def __init__(
        self, inbox: ViewerInbox, parameters: Callable[[], Mapping[str, Any]], make: Callable[[str, Any], Any]
    ) -> None:
        self.listeners: dict[int, set[int]] = {}
        self._inbox = inbox
        self._parameters = parameters
        self._make = make

    def on_subscribe(self, client: Any, channel: Any) -> None:
        """A viewer has subscribed."""
        self.listeners.setdefault(channel.id, set()).add(client.id)
        self._inbox.put(Subscribed(client.id, channel.id))

    def on_unsubscribe(self, client: Any, channel: Any) -> None:
        """It has not any more, or is gone."""
        self.listeners.setdefault(channel.id, set()).discard(client.id)

    def on_client_advertise(self, client: Any, channel: Any) -> None:
        """A viewer wants to publish."""
        schema = channel.schema if channel.schema_encoding in (None, "", "ros1msg") else None
        text = (schema or b"").decode(errors="replace")
        kind = channel.schema_name
        self._inbox.put(Advertised(client.id, channel.id, channel.topic, channel.encoding, kind, text))

    def on_client_unadvertise(self, client: Any, client_channel_id: int) -> None:
        """It will not any more, or is gone."""
        self._inbox.put(Unadvertised(client.id, client_channel_id))

    def on_message_data(self, client: Any, client_channel_id: int, data: bytes) -> None:
        """A message came."""
        self._inbox.put(Published(client.id, client_channel_id, data))

    def on_get_parameters(self, client: Any, param_names: list[str], request_id: str | None = None) -> list[Any]:
        """A viewer asks for parameters, for all of them if it names none."""
        known = self._parameters()
        return [self._make(name, known[name]) for name in (param_names or known) if name in known]

    def on_set_parameters(self, client: Any, parameters: list[Any], request_id: str | None = None) -> list[Any]:
        """A viewer sets parameters; what came of it is told when the mission has done it."""
        self._inbox.put(ParametersSet(client.id, {each.name: each.get_value() for each in parameters}))
        return parameters

    def on_parameters_subscribe(self, param_names: list[str]) -> None:
        """The server keeps who wants to know of what."""

    def on_parameters_unsubscribe(self, param_names: list[str]) -> None:
        """As above."""

    def on_connection_graph_subscribe(self) -> None:
        """The server tells the last graph."""

    def on_connection_graph_unsubscribe(self) -> None:
        """As above."""
