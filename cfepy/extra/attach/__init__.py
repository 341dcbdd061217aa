"""A flight in real time for a second terminal: `cfepy rostopic`, `tlm` and `cmd` with the source `live:`.

The flight's side belongs here. Where flights are found, and the messages of both sides, is in `cfepy.io.live_flights`.
Input enters through `cfepy.mission.outside` between two parts of the run, so a journal records it. The central file is
`cfepy/extra/attach/attach_server.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.attach.attach_server import AttachServer

__all__ = ["AttachServer"]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(__name__, {".attach_server": ("AttachServer",)})
