"""Download files by CFDP, class 1 and class 2, in virtual time, and upload one: `python downlink.py MY_COPY FOLDER`.

With --udp it talks to a mission that runs beside it: `cfepy run MY_COPY --realtime`.
"""

from __future__ import annotations

import argparse
import socket
import struct
import sys
import time
from collections.abc import Callable
from pathlib import Path

from cfepy.apps.to_lab import packets as to_lab
from cfepy.ground.cfdp import CLASS_1, CLASS_2, GroundEntity, Transfer, pdu_in, uplinked
from cfepy.ground.link import CI_PORT, TO_PORT, GroundLink
from cfepy.mission import Mission
from cfepy.msg import command

CF_CMD, TX_FILE = 0x18B3, 2
KEEP, CHANNEL, PRIORITY, GROUND = 1, 0, 0, 23
TURN_S = 0.2
ENABLED_S = 2.0
LIMIT_S = 60.0


class UdpLink:
    """Connects to a mission that runs in real time on this computer."""

    def __init__(self) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", TO_PORT))
        self._socket.settimeout(TURN_S)

    def send(self, packet: bytes) -> None:
        """Send a packet to the spacecraft."""
        self._socket.sendto(packet, ("127.0.0.1", CI_PORT))

    def turn(self) -> list[bytes]:
        """Return the packets that arrive within a short time."""
        found = []
        end = time.monotonic() + TURN_S
        while time.monotonic() < end:
            try:
                found.append(self._socket.recv(65536))
            except TimeoutError:
                break
        return found


class VirtualLink:
    """Connects to a mission in this process."""

    def __init__(self, mission: Mission) -> None:
        self._mission, self._link = mission, GroundLink(mission)

    def send(self, packet: bytes) -> None:
        """Send a packet to the spacecraft."""
        self._link.send(packet)

    def turn(self) -> list[bytes]:
        """Run the mission for a short time. Returns its packets."""
        self._mission.run_for(TURN_S)
        return [data for _, data in self._link.received()]


def transmit(source: str, target: str, cfdp_class: int) -> bytes:
    """Return CF's command to download a file."""
    names = source.encode().ljust(64, b"\0") + target.encode().ljust(64, b"\0")
    head = struct.pack("<BBBBI", cfdp_class, KEEP, CHANNEL, PRIORITY, GROUND)
    return bytes(command(CF_CMD, TX_FILE, head + names))


def settle(link: UdpLink | VirtualLink, ground: GroundEntity, clock: Callable[[], float]) -> Transfer:
    """Exchange PDUs until a transfer ends. Returns the transfer."""
    before, end = len(ground.transfers), clock() + LIMIT_S
    while len(ground.transfers) == before:
        if clock() > end:
            raise TimeoutError(f"no end of a transfer within {LIMIT_S:.0f} s")
        up = [answer for packet in link.turn() if (pdu := pdu_in(packet)) for answer in ground.take(pdu)]
        for pdu in [*up, *ground.turn()]:
            link.send(uplinked(pdu))
    return ground.transfers[-1]


def fly(link: UdpLink | VirtualLink, folder: Path, clock: Callable[[], float]) -> list[Transfer]:
    """Download a file by both classes, and upload it again under another name."""
    ground = GroundEntity(folder, clock)
    link.send(to_lab.OUTPUT_ENABLE.packet(dest_IP="127.0.0.1"))
    begin = clock()
    while clock() < begin + ENABLED_S:
        link.turn()
    ends = []
    for name, cfdp_class in (("class_1.tbl", CLASS_1), ("class_2.tbl", CLASS_2)):
        link.send(transmit("/cf/lc_def_adt.tbl", name, cfdp_class))
        ends.append(settle(link, ground, clock))
    ground.put("class_2.tbl", "/ram/back.tbl")
    ends.append(settle(link, ground, clock))
    return ends


def main() -> int:
    """Fly, and print the result of each transfer."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mission", help="folder of the mission; with --udp it runs already")
    parser.add_argument("folder", type=Path, help="where files come to")
    parser.add_argument("--udp", action="store_true", help="talk to a mission in real time")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    if given.udp:
        ends = fly(UdpLink(), given.folder, time.monotonic)
    else:
        with Mission(given.mission) as mission:
            mission.run_for(8)
            ends = fly(VirtualLink(mission), given.folder, lambda: mission.kernel.now / 1e9)
    for end in ends:
        print(end)
    return 0 if all(end.complete and not end.condition for end in ends) else 1


if __name__ == "__main__":
    sys.exit(main())
