"""A mission with SBN and another processor on its network, in real time: a mission, or NASA's cFE with NASA's SBN.

NASA's SBN (github.com/nasa/SBN, main) builds with cFE 7.0.0 as an application, with `sbn_udp` and `sbn_f_remap`. Its
CMakeLists.txt must also have a folder with a header cfe_sb_events.h that includes cfe_sb_eventids.h, and
`add_definitions(-DCFE_SB_SUB_ENTRIES_PER_PKT=CFE_MISSION_SB_SUB_ENTRIES_PER_PKT)`. git must have checked it out, so
that SBN_IDENT has its value. For a client of the time, cfe_time_internal_cfg.h selects it in place of a server.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from apps.sbn.definition import TASKS, configuration, peer, remapping
from cfepy.io import HostNetwork
from cfepy.mission import Arrival, Mission
from cfepy.mission.packet_watch import PacketWatch, Seen
from cfepy.reading.resources import shipped
from cfepy.rtos import Pacer
from cfepy.tbl import build
from cfepy.units import NS_PER_S
from cfepy.writing.console import Console
from dev.twin.real import RealCfe

SBN_VARIABLE, CLIENT_VARIABLE = "CFEPY_REAL_SBN", "CFEPY_REAL_SBN_CLIENT"
"""Folders of NASA's cFE with NASA's SBN: a server of the time, and a client."""

PATIENCE_NS = 90 * NS_PER_S
PAIR = shipped("missions") / "pair"
NO_GROUND = 9, 10
REAL_STARTUP = b"""\
CFE_LIB, sample_lib, SAMPLE_LIB_Init, SAMPLE_LIB, 0,  0,      0x0, 0;
CFE_APP, sample_app, SAMPLE_APP_Main, SAMPLE_APP, 50, 16384,  0x0, 0;
CFE_APP, sbn,        SBN_AppMain,     SBN,        90, 100000, 0x0, 0;
!
"""
CONF = build(configuration([peer(1, "127.0.0.1:2234", tasks=TASKS), peer(2, "127.0.0.1:2235", tasks=TASKS)]))


class Paced:
    """A mission in real time with its ports open.

    Args:
        mission: the mission to fly.
        ports: numbers of this computer in place of the mission's.

    Attributes:
        mission: the mission.
        seen: packets on its bus, in order.
        heard: received datagrams.
    """

    def __init__(self, mission: str, ports: Mapping[int, int] | None = None) -> None:
        self.seen: list[Seen] = []
        self.heard: list[bytes] = []
        self.mission = Mission(mission, console=Console(quiet=True), attachments=[PacketWatch(self.seen.append)])
        self.mission.outside.listener = self._listen
        self._bridge = HostNetwork(self.mission, ports)
        self._pacer = Pacer(self.mission.kernel, self._run_until, 1.0, self._bridge.wait)

    def _listen(self, arrival: Arrival) -> None:
        if arrival.kind == "datagram":
            self.heard.append(arrival.values[-1])

    def step(self) -> None:
        """Go on for some milliseconds."""
        self._pacer.step(PATIENCE_NS)

    def run_while(self, missing: Callable[[], Any]) -> None:
        """Go on until nothing is missing any more."""
        while missing():
            if self.mission.kernel.now >= PATIENCE_NS:
                raise TimeoutError("\n".join(self.mission.console.lines[-30:]))
            self.step()

    def run_for(self, seconds: float) -> None:
        """Go on for so many seconds."""
        end_ns = self.mission.kernel.now + round(seconds * NS_PER_S)
        self.run_while(lambda: self.mission.kernel.now < end_ns)

    def packets(self, msg_id: int) -> list[bytes]:
        """Return the packets of a MsgId so far."""
        return [each.packet for each in self.seen if each.msg_id == msg_id]

    def says(self, text: str) -> bool:
        """Return whether a line of the console has a text."""
        return any(text in line for line in self.mission.console.lines)

    def send(self, packet: bytes) -> None:
        """Put a packet on its bus."""
        self.mission.outside.act("packet", packet)

    def close(self) -> None:
        """End it."""
        self._bridge.close()
        self.mission.close()

    def _run_until(self, until_ns: int) -> None:
        self.mission.run_until(until_ns)
        self._bridge.exchange()


@contextmanager
def paced(mission: str, ports: Mapping[int, int] | None = None) -> Iterator[Paced]:
    """A mission in real time, to be closed."""
    flight = Paced(mission, ports)
    try:
        yield flight
    finally:
        flight.close()


def real_sbn(built: Path, folder: Path, processor: int, dropped: tuple[tuple[int, int, int], ...]) -> RealCfe:
    """NASA's cFE with NASA's SBN and SAMPLE_APP.

    Args:
        built: where it was built.
        folder: for its copy.
        processor: its id.
        dropped: entries of its remapping table.
    """
    files = {
        "/cf/cfe_es_startup.scr": REAL_STARTUP,
        "/cf/sbn_conf_tbl.tbl": CONF,
        "/cf/sbn_remap_tbl.tbl": build(remapping(dropped)),
    }
    return RealCfe(built, folder, files, NO_GROUND, ("--cpuid", str(processor)))
