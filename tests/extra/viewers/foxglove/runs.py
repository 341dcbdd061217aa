"""Runs that Foxglove looks at: the test advances the mission, not the wall clock."""

from __future__ import annotations

import socket
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from cfepy.attachment import Attachment
from cfepy.extra.viewers.foxglove import FoxgloveViewer
from cfepy.extra.viewers.listen import Admission, ListenPlace
from cfepy.io import PeerCounts
from cfepy.mission import Mission, MissionSpec
from cfepy.writing.console import Console
from rospy_shim.types.config import RosConfig
from tests.extra.viewers.foxglove.client import PATIENCE_S, PROTOCOL, WAIT_S, FoxgloveClient

TALKER = """
    import rospy
    from std_msgs.msg import String
    from std_srvs.srv import SetBool
    rospy.init_node("talker")
    latched = rospy.Publisher("/latched", String, queue_size=10, latch=True)
    latched.publish("once")
    chatter = rospy.Publisher("/chatter", String, queue_size=10)
    def heard(message):
        chatter.publish(message.data.upper() + " of " + message._connection_header["callerid"])
    rospy.Subscriber("/orders", String, heard)
    def switch(request):
        if not request.data:
            raise ValueError("off is not possible")
        return True, "on"
    rospy.Service("/switch", SetBool, switch)
    rospy.loginfo("ready")
    rospy.sleep(1)
    late = rospy.Publisher("/late", String, queue_size=10, latch=True)
    late.publish("now")
    while not rospy.is_shutdown():
        rospy.loginfo("late")
        rospy.sleep(0.5)
    rospy.spin()
"""
PIECE_NS = 10_000_000


class ShownRun:
    """A run with a viewer's server."""

    def __init__(self, mission: Mission, viewer: FoxgloveViewer) -> None:
        self.mission = mission
        self.viewer = viewer

    @property
    def url(self) -> str:
        """Where viewers connect."""
        return f"ws://{self.viewer.place}/"

    def go_on(self) -> None:
        """A piece of the run."""
        self.mission.run_until(self.mission.kernel.now + PIECE_NS)
        self.viewer.exchange()

    def until(self, seconds: float) -> None:
        """The run up to a virtual time."""
        while self.mission.kernel.now < seconds * 1_000_000_000:
            self.go_on()

    def client(self, **options: Any) -> FoxgloveClient:
        """Return a viewer. The run continues while it waits."""
        return FoxgloveClient(self.url, self.go_on, **options)

    def shake_hands(self, peer: socket.socket) -> None:
        """Become the only viewer, without a library that reads input."""
        lines = ("GET / HTTP/1.1", f"Host: {self.viewer.place}", "Upgrade: websocket", "Connection: Upgrade")
        lines += ("Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Version: 13")
        lines += (f"Sec-WebSocket-Protocol: {PROTOCOL}", "", "")
        peer.sendall("\r\n".join(lines).encode())
        while not self.viewer._server.viewers:
            self.go_on()

    def until_it_ends(self, peer: socket.socket) -> None:
        """Continue the run until the server has ended a connection."""
        peer.settimeout(WAIT_S)
        left = int(PATIENCE_S / WAIT_S)
        while left:
            self.go_on()
            try:
                if not peer.recv(65_536):
                    return
            except TimeoutError:
                left -= 1
            except ConnectionError:
                return  # reset, as the server did not want the rest
        raise AssertionError("the connection does not end")

    def rows(self) -> dict[tuple[str, str], dict[str, Any]]:
        """Return the report's rows by name and direction."""
        return {(row["name"], row["direction"]): row for row in self.mission.record.rows("viewer_peers")}


def spec_of(folder: Path, nodes: Mapping[str, str], params: Mapping[str, Any] | None = None) -> MissionSpec:
    """Return a mission of ROS nodes."""
    lines = []
    for name, code in nodes.items():
        (folder / f"{name}.py").write_text(textwrap.dedent(code), encoding="utf-8")
        lines.append(f"CFE_APP, {name}.py, __main__, {name.upper()}, 100, 16384, 0x0, 0;\n")
    (folder / "startup.scr").write_text("".join(lines) + "!\n", encoding="utf-8")
    ros = RosConfig({}, {}, dict(params or {}))
    return MissionSpec("shown", folder, folder / "startup.scr", None, "linux", ros)


@contextmanager
def shown(
    spec: MissionSpec,
    admission: Admission | None = None,
    attachments: Sequence[Attachment] = (),
    before: Callable[[Mission], object] = lambda mission: None,
) -> Iterator[ShownRun]:
    """A run that Foxglove may look at."""
    viewer = FoxgloveViewer(ListenPlace("127.0.0.1", 0), admission or Admission(), "shown", PeerCounts())
    try:
        with Mission(spec, console=Console(quiet=True), attachments=[viewer, *attachments]) as mission:
            before(mission)
            yield ShownRun(mission, viewer)
    finally:
        viewer.close()
