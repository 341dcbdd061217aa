"""`--foxglove` and what goes with it: servers for programs that look at a run, from before it until after its end."""

from __future__ import annotations

import argparse
import contextlib
import sys
from typing import TYPE_CHECKING, Any

from cfepy.attachment import Attachment
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.io import Guest

FOXGLOVE = "--foxglove"


def _to_stderr(line: str) -> None:
    print(f"cfepy: {line}", file=sys.stderr, flush=True)


class Viewers:
    """The servers that a command line asks for; use as a context manager around the run.

    Args:
        arguments: of a command line with `add_viewers`.
        name: of the mission.

    Attributes:
        attachments: what watches the run for them.
        guests: what brings in what they send.

    Raises:
        UsageError: a port is taken, a library is not installed, or a token is none.
    """

    def __init__(self, arguments: argparse.Namespace, name: str) -> None:
        self.attachments: list[Attachment] = []
        self.guests: list[Guest] = []
        self._arguments = arguments
        self._name = name
        self._open = contextlib.ExitStack()

    def __enter__(self) -> Viewers:
        if self._arguments.foxglove is not None:
            with contextlib.ExitStack() as undone:
                undone.enter_context(self._open)
                self._serve_foxglove()
                self._open = undone.pop_all()
        return self

    def __exit__(self, *error: Any) -> None:
        self.close()

    def close(self) -> None:
        """The run is over: all connections end."""
        self._open.close()

    def _serve_foxglove(self) -> None:
        from cfepy.io import PeerCounts
        from cfepy.viewers import FoxgloveViewer, admission_to, listen_place_of

        try:
            place = listen_place_of(self._arguments.foxglove)
        except ValueError as error:
            raise UsageError(str(error), field=FOXGLOVE) from None
        admission = admission_to(place, self._arguments.viewer_token, tell=_to_stderr)
        viewer = FoxgloveViewer(place, admission, self._name, PeerCounts())
        self._open.callback(viewer.close)
        self.attachments.append(viewer)
        self.guests.append(viewer)
        _to_stderr(f"Foxglove connects to ws://{viewer.place}")
