"""Programs that watch a running mission, and take part in it: viewers and their servers.

A module belongs here if it listens on a real socket, shows the mission's graph, and enters input as outside events that
a journal records. ROS's own protocols between nodes belong to `cfepy.extra.ros_host`; pictures of a finished run belong
to `cfepy.extra.reports`. The central file is `cfepy/extra/viewers/websocket_listener.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.viewers.foxglove import FoxgloveViewer
    from cfepy.extra.viewers.listen import Admission, ListenPlace, admission_to, listen_place_of
    from cfepy.extra.viewers.rosbridge import RosbridgeServer

__all__ = ["Admission", "FoxgloveViewer", "ListenPlace", "RosbridgeServer", "admission_to", "listen_place_of"]

if not TYPE_CHECKING:  # a type checker sees only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".foxglove": ("FoxgloveViewer",),
            ".listen": (
                "Admission",
                "ListenPlace",
                "admission_to",
                "listen_place_of",
            ),
            ".rosbridge": ("RosbridgeServer",),
        },
    )
