"""Programs that look at a run while it goes on, and take part in it: viewers and their servers.

What belongs here listens on a real socket, shows what the mission's graph has, and lets what comes in enter through the
door that a journal has. ROS's own protocols between nodes are `cfepy.extra.ros_host`; pictures of a run that is over,
`cfepy.extra.reports`. The central file is `cfepy/extra/viewers/websocket_listener.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.viewers.foxglove import FoxgloveViewer
    from cfepy.extra.viewers.listen import Admission, ListenPlace, admission_to, listen_place_of
    from cfepy.extra.viewers.rosbridge import RosbridgeServer

__all__ = ["Admission", "FoxgloveViewer", "ListenPlace", "RosbridgeServer", "admission_to", "listen_place_of"]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
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
