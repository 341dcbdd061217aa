"""Real sockets of this computer, with which a run and a ground system reach other programs.

Code that opens a real socket, or waits for input from outside, belongs here: the bridge of a paced run to the loopback
interface (`host_network`), datagrams of a ground system (`udp`), typed lines (`typed_lines`), changed files
(`changed_files`), non-blocking connections with programs (`peer_socket`), running flights (`live_flights`), counts
(`peer_counts`) and limits (`peer_places`) of connections, and the names by which programs address this computer
(`own_names`). The simulation does not know this package; the command that runs a mission connects the bridge to it.
When input from outside comes in is decided in `cfepy.mission`. The central file is `cfepy/io/host_network.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.io.changed_files import WatchedFiles
    from cfepy.io.host_network import Guest, HostNetwork
    from cfepy.io.live_flights import (
        LIVE,
        LiveFlight,
        LiveFrames,
        LiveTopic,
        flight_folder,
        framed,
        live_flight,
        live_name,
    )
    from cfepy.io.own_names import OwnNames, is_this_computer
    from cfepy.io.peer_counts import INTO, OUT_OF, PeerCount, PeerCounts
    from cfepy.io.peer_places import InputRoom, InputTurn, PeerPlaces
    from cfepy.io.peer_socket import ENDED, Listening, PeerSocket, listening_socket
    from cfepy.io.typed_lines import TypedLines
    from cfepy.io.udp import UdpListener, own_address, send

__all__ = [
    "ENDED",
    "INTO",
    "LIVE",
    "OUT_OF",
    "Guest",
    "HostNetwork",
    "InputRoom",
    "InputTurn",
    "Listening",
    "LiveFlight",
    "LiveFrames",
    "LiveTopic",
    "OwnNames",
    "PeerCount",
    "PeerCounts",
    "PeerPlaces",
    "PeerSocket",
    "TypedLines",
    "UdpListener",
    "WatchedFiles",
    "flight_folder",
    "framed",
    "is_this_computer",
    "listening_socket",
    "live_flight",
    "live_name",
    "own_address",
    "send",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".changed_files": ("WatchedFiles",),
            ".host_network": (
                "Guest",
                "HostNetwork",
            ),
            ".live_flights": (
                "LIVE",
                "LiveFrames",
                "LiveFlight",
                "LiveTopic",
                "flight_folder",
                "framed",
                "live_flight",
                "live_name",
            ),
            ".own_names": (
                "OwnNames",
                "is_this_computer",
            ),
            ".peer_counts": (
                "INTO",
                "OUT_OF",
                "PeerCount",
                "PeerCounts",
            ),
            ".peer_places": (
                "InputRoom",
                "PeerPlaces",
                "InputTurn",
            ),
            ".peer_socket": (
                "ENDED",
                "Listening",
                "PeerSocket",
                "listening_socket",
            ),
            ".typed_lines": ("TypedLines",),
            ".udp": (
                "UdpListener",
                "own_address",
                "send",
            ),
        },
    )
