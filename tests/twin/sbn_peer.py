"""A processor that consists of its SBN messages, as a peer of NASA's cFE or of a mission in virtual time.

As the server of the time, it sends a client's tones, and requests the client's results.
"""

from __future__ import annotations

import select
import socket
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from time import monotonic

from apps.sbn import protocol as pr
from apps.sbn.udp import ANNOUNCE_MSG
from cfepy.mission import Mission
from cfepy.msg import get_msg_id
from cfepy.osal import Datagram, Place
from cfepy.time import packets as time
from cfepy.units import NS_PER_MS, NS_PER_S

HERE, THERE = 2234, 2235
SPACECRAFT = 0x42
LIMIT_S = 30.0
AFTER_TONE_S = 0.05
HK_OF_CLIENT = 0x0825  # as the remapping table of missions/pair has it


class SbnPeer(ABC):
    """A processor, by default number 1, as the other one sees it.

    Attributes:
        processor: its id.
    """

    processor = 1

    @abstractmethod
    def send_bytes(self, data: bytes) -> None:
        """Send a datagram to the other processor."""

    @abstractmethod
    def receive(self, within_s: float) -> bytes | None:
        """Return the next datagram of the other processor, or None if there is none in that time."""

    @abstractmethod
    def pause(self, seconds: float) -> None:
        """Do nothing for some seconds."""

    def send(self, kind: int, payload: bytes = b"") -> None:
        """Send a message."""
        self.send_bytes(pr.pack(pr.NetMsg(kind, self.processor, SPACECRAFT, payload)))

    def join(self, msg_ids: Sequence[int]) -> None:
        """Have the other processor connect, and subscribe to its messages."""
        while True:
            self.send(ANNOUNCE_MSG)
            if self.receive(1.0) is not None:
                break
        self.send(pr.SUB_MSG, pr.pack_subscriptions([pr.Sub(msg_id) for msg_id in msg_ids], pr.IDENT))

    def packet(self, msg_id: int) -> bytes:
        """Return the next packet of a MsgId. Packets before it, and all other messages, are dropped."""
        for _ in range(1000):
            data = self.receive(LIMIT_S)
            if data is None:
                break
            message = pr.unpack(data, 32_768)
            if message.kind == pr.APP_MSG and get_msg_id(message.payload) == msg_id:
                return message.payload
        raise TimeoutError(f"no packet 0x{msg_id:04X}")


class RealPeer(SbnPeer):
    """The peer of a process, with a real socket; made inside of its network.

    Args:
        processor: which of the two it is.
    """

    def __init__(self, processor: int = 1) -> None:
        self.processor = processor
        here, self._there = (HERE, THERE) if processor == 1 else (THERE, HERE)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", here))

    def send_bytes(self, data: bytes) -> None:
        self._socket.sendto(data, ("127.0.0.1", self._there))

    def receive(self, within_s: float) -> bytes | None:
        return self._socket.recv(65536) if select.select([self._socket], [], [], within_s)[0] else None

    def pause(self, seconds: float) -> None:
        end = monotonic() + seconds
        while (rest := end - monotonic()) > 0:
            select.select([], [], [], rest)

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


class VirtualPeer(SbnPeer):
    """The peer of a mission in virtual time."""

    def __init__(self, mission: Mission) -> None:
        self._mission = mission
        self._heard: list[bytes] = []
        mission.network.outlets.append(self._hear)

    def _hear(self, datagram: Datagram) -> None:
        if datagram.target.port == HERE:
            self._heard.append(datagram.data)

    def send_bytes(self, data: bytes) -> None:
        self._mission.outside.datagram(THERE, Place("127.0.0.1", HERE), data)

    def receive(self, within_s: float) -> bytes | None:
        end_ns = self._mission.kernel.now + round(within_s * NS_PER_S)
        while not self._heard and self._mission.kernel.now < end_ns:
            self._mission.run_until(self._mission.kernel.now + NS_PER_MS)
        return self._heard.pop(0) if self._heard else None

    def pause(self, seconds: float) -> None:
        self._mission.run_for(seconds)


def tone_data(met: int, state: int, stcf: int, leaps: int) -> bytes:
    """Return a server's data of a tone."""
    return time.DATA_CMD.packet(
        AtToneMET={"Seconds": met}, AtToneSTCF={"Seconds": stcf}, AtToneLeapSeconds=leaps, AtToneState=state
    )


def serve_time(peer: SbnPeer, tones: Sequence[tuple[int, int, int] | None]) -> Iterator[dict[str, object]]:
    """Act as the server of a client's time.

    Args:
        peer: the server.
        tones: for each tone of the client the state of the server's clock, STCF, leap seconds; None sends nothing.

    Yields:
        The client's housekeeping of its time in the middle of the second after each tone, without the parts that vary
        between runs: counters, and subseconds.
    """
    peer.join([time.ONEHZ_CMD.msg_id, HK_OF_CLIENT])
    for number, tone in enumerate(tones):
        peer.packet(time.ONEHZ_CMD.msg_id)
        peer.pause(AFTER_TONE_S)
        if tone is not None:
            state, stcf, leaps = tone
            peer.send(pr.APP_MSG, tone_data(5000 + number, state, stcf, leaps))
        peer.pause(0.3)
        peer.send(pr.APP_MSG, time.SEND_HK.packet())
        told = time.HK_TLM.read(peer.packet(HK_OF_CLIENT))
        names = ("ClockStateFlags", "ClockStateAPI", "LeapSeconds")
        met = told["MET"]["Seconds"]
        yield {
            **{name: told[name] for name in names},
            "MET": met - 5000 - number if tone is not None else "own",
            "STCF": told["STCF"]["Seconds"],
        }
