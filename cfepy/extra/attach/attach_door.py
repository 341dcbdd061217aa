"""The door of each run with --realtime, for programs of the same user."""

from __future__ import annotations

import argparse

from cfepy.cli.flight_add_ons import FlightAddOn, Tell
from cfepy.status import UsageError


class AttachDoor(FlightAddOn):
    """The socket of a flight in real time.

    Args:
        arguments: as for `FlightAddOn`.
        name: as for `FlightAddOn`.
        tell: receives the reason if there is no socket.
    """

    def __init__(self, arguments: argparse.Namespace, name: str, tell: Tell) -> None:
        super().__init__(arguments, name, tell)
        self._tell = tell

    def __enter__(self) -> AttachDoor:
        from cfepy.extra.attach import AttachServer

        try:
            server = AttachServer()
        except UsageError as error:
            self._tell(f"{error}; no second terminal can attach to this flight")
            return self
        self.attachments.append(server)
        self.guests.append(server)
        return self

    def close(self) -> None:
        for each in self.attachments:
            each.close()
