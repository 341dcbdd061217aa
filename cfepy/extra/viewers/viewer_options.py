"""`--foxglove`, `--rosbridge`: servers for programs that watch a run, from before it until after its end."""

from __future__ import annotations

import argparse
import contextlib
from collections.abc import Callable
from typing import TYPE_CHECKING, ClassVar

from cfepy.cli.flight_add_ons import FlightAddOn
from cfepy.cli.parser import shared_group
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.extra.viewers import Admission, ListenPlace
    from cfepy.io import PeerCounts

FOXGLOVE, ROSBRIDGE, TOKEN, ORIGIN = "--foxglove", "--rosbridge", "--viewer-token", "--viewer-origin"


class Viewers(FlightAddOn):
    """The servers that a command line asks for; use as a context manager around the run.

    Args:
        arguments: as for `FlightAddOn`.
        name: as for `FlightAddOn`.
        tell: receives messages with the addresses of the servers, and with a random token.

    Raises:
        UsageError: a port is taken, a library is not installed, or a token is invalid.
    """

    OPTIONS: ClassVar = {"foxglove": FOXGLOVE, "rosbridge": ROSBRIDGE, "viewer_token": TOKEN, "viewer_origin": ORIGIN}

    @classmethod
    def add(cls, parser: argparse.ArgumentParser) -> None:
        viewers = shared_group(parser, "viewers")
        viewers.add_argument(
            FOXGLOVE,
            metavar="[HOST:]PORT",
            help="serve Foxglove: topics, telemetry, events, parameters and services, both ways; on 127.0.0.1, if no "
            "host is given, and with --realtime at the pace of the wall clock",
        )
        viewers.add_argument(
            ROSBRIDGE,
            metavar="[HOST:]PORT",
            help="serve clients of rosbridge, such as roslibjs and roslibpy: topics, services, parameters, both ways",
        )
        viewers.add_argument(
            ORIGIN,
            action="append",
            default=[],
            metavar="ORIGIN",
            help="let pages of a web site, such as https://example.org, connect without a token; pages of this "
            "computer always may",
        )
        viewers.add_argument(
            TOKEN,
            metavar="TOKEN",
            help="the token that a program must send to connect (default: the variable CFEPY_VIEWER_TOKEN; programs on "
            "other computers always need one, by default a random one, which is printed)",
        )

    def __init__(self, arguments: argparse.Namespace, name: str, tell: Callable[[str], object]) -> None:
        super().__init__(arguments, name, tell)
        self._arguments = arguments
        self._name = name
        self._tell = tell
        self._token: str | None = arguments.viewer_token
        self._open = contextlib.ExitStack()

    def __enter__(self) -> Viewers:
        arguments = self._arguments
        if arguments.foxglove is None and arguments.rosbridge is None:
            field = TOKEN if self._token is not None else ORIGIN if arguments.viewer_origin else None
            if field is not None:
                raise UsageError("requires a viewer port, such as --foxglove 8765", field=field)
        else:
            from cfepy.io import PeerCounts

            counts = PeerCounts()
            with contextlib.ExitStack() as undone:
                undone.enter_context(self._open)
                if arguments.foxglove is not None:
                    self._serve_foxglove(counts)
                if arguments.rosbridge is not None:
                    self._serve_rosbridge(counts)
                self._open = undone.pop_all()
        return self

    def close(self) -> None:
        self._open.close()

    def _serve_foxglove(self, counts: PeerCounts) -> None:
        from cfepy.extra.viewers import FoxgloveViewer

        place, admission = self._who_and_where(self._arguments.foxglove, FOXGLOVE)
        viewer = FoxgloveViewer(place, admission, self._name, counts)
        self._open.callback(viewer.close)
        self.attachments.append(viewer)
        self.guests.append(viewer)
        self._tell(f"Foxglove connects to ws://{viewer.place}")

    def _serve_rosbridge(self, counts: PeerCounts) -> None:
        from cfepy.extra.viewers import RosbridgeServer

        server = RosbridgeServer(*self._who_and_where(self._arguments.rosbridge, ROSBRIDGE), counts)
        self._open.callback(server.close)
        self.attachments.append(server)
        self.guests.append(server)
        self._tell(f"rosbridge clients connect to ws://{server.place}")

    def _who_and_where(self, text: str, option: str) -> tuple[ListenPlace, Admission]:
        """Return the address and the admission of a server."""
        from cfepy.extra.viewers import admission_to, listen_place_of

        try:
            place = listen_place_of(text)
        except ValueError as error:
            raise UsageError(str(error), field=option) from None
        admission = admission_to(place, self._token, self._arguments.viewer_origin, tell=self._tell)
        self._token = admission.token or self._token  # one for all servers
        return place, admission
