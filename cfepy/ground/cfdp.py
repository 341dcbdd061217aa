"""A CFDP entity on the ground: the other side of CF, implemented with the library cfdp-py (extra `cfepy[cfdp]`).

It does not transfer PDUs itself: its user passes in received PDUs, sends those it returns, and gives the time, so it
works with a mission in virtual time as well as over UDP. Only this module loads the library. CFDP: CCSDS 727.0-B-5.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple, TypeVar

from cfepy.msg import CMD_HEADER_SIZE, TLM_HEADER_SIZE, command
from cfepy.status import UsageError

CF_IN_MID, CF_OUT_MID = 0x18C8, 0x08C2
"""MsgIds from which CF's channel 0 takes PDUs, and to which it sends them, in missions/cfs."""
CLASS_1, CLASS_2 = 0, 1
"""Unacknowledged and acknowledged class, as in CF's commands; without and with retransmission."""
LONGEST_PACKET = 512
"""Maximum number of bytes of a PDU."""
MOST_IN_A_TURN = 100

Result = TypeVar("Result")


class Transfer(NamedTuple):
    """End of a file transfer.

    Attributes:
        direction: "down" or "up".
        name: name of the file on the ground, if known.
        condition: CFDP's condition code: 0 is no error.
        complete: whether all data arrived.
    """

    direction: str
    name: str
    condition: int
    complete: bool


def library() -> SimpleNamespace:
    """Return the needed parts of cfdp-py.

    Raises:
        UsageError: if it is not installed.
    """
    try:
        import cfdppy
        import spacepackets.cfdp as pdus
        import spacepackets.countdown as countdown
        from cfdppy.exceptions import PduIgnoredForDest, PduIgnoredForSource
        from cfdppy.handler.dest import DestHandler
        from cfdppy.handler.source import SourceHandler
        from cfdppy.mib import CheckTimerProvider, DefaultFaultHandlerBase
        from spacepackets.cfdp.pdu.helper import PduFactory
        from spacepackets.seqcount import SeqCountProvider
        from spacepackets.util import ByteFieldU8
    except ImportError as error:
        raise UsageError(f"CFDP on the ground requires cfdp-py ({error}): pip install 'cfepy[cfdp]'") from error
    return SimpleNamespace(
        cfdp=cfdppy,
        pdus=pdus,
        countdown=countdown,
        ignored=(PduIgnoredForDest, PduIgnoredForSource),
        DestHandler=DestHandler,
        SourceHandler=SourceHandler,
        CheckTimerProvider=CheckTimerProvider,
        FaultHandler=DefaultFaultHandlerBase,
        PduFactory=PduFactory,
        SeqCountProvider=SeqCountProvider,
        EntityId=ByteFieldU8,
    )


def pdu_in(packet: bytes) -> bytes | None:
    """Return the PDU in a packet of CF's channel 0; None for other packets."""
    is_pdu = int.from_bytes(packet[:2], "big") == CF_OUT_MID and len(packet) > TLM_HEADER_SIZE
    return packet[TLM_HEADER_SIZE:] if is_pdu else None


def uplinked(pdu: bytes) -> bytes:
    """Return the packet with a PDU for CF's channel 0."""
    packet = bytes(command(CF_IN_MID, 0, pdu))
    assert len(packet) == CMD_HEADER_SIZE + len(pdu)
    return packet


class GroundEntity:
    """A CFDP entity that receives files into a folder, and sends files from it.

    Args:
        folder: folder of its files; it must exist.
        clock: returns the time in s from any start: the run's virtual time, or the host's.
        entity: its own id.
        spacecraft: CF's id.

    Attributes:
        transfers: finished transfers, in order.

    Raises:
        UsageError: if cfdp-py is not installed.
    """

    def __init__(self, folder: Path, clock: Callable[[], float], entity: int = 23, spacecraft: int = 25) -> None:
        self._library, self._clock = library(), clock
        self._folder, self._spacecraft = folder, spacecraft
        self.transfers: list[Transfer] = []
        cfdp, pdus = self._library.cfdp, self._library.pdus
        remote = cfdp.RemoteEntityConfig(
            entity_id=self._library.EntityId(spacecraft),
            max_file_segment_len=None,
            max_packet_len=LONGEST_PACKET,
            closure_requested=False,
            crc_on_transmission=False,
            default_transmission_mode=pdus.TransmissionMode.ACKNOWLEDGED,
            crc_type=pdus.ChecksumType.MODULAR,
        )
        remotes = cfdp.RemoteEntityConfigTable()
        remotes.add_config(remote)
        local = cfdp.LocalEntityConfig(
            self._library.EntityId(entity), cfdp.IndicationConfig(), _silent(self._library.FaultHandler)
        )
        files = cfdp.RestrictedFilestore(folder)
        timers = _timers(self._library)
        self._down = self._library.DestHandler(local, self._user("down", files), remotes, timers)
        self._up = self._library.SourceHandler(
            local, self._user("up", files), remotes, timers, self._library.SeqCountProvider(16)
        )

    def put(self, name: str, target: str, cfdp_class: int = CLASS_2) -> None:
        """Start to send a file; `turn` returns its PDUs.

        Args:
            name: name of the file in the folder.
            target: target path, such as "/ram/new.tbl".
            cfdp_class: CLASS_1 or CLASS_2.
        """
        modes = self._library.pdus.TransmissionMode
        mode = modes.ACKNOWLEDGED if cfdp_class == CLASS_2 else modes.UNACKNOWLEDGED
        request = self._library.cfdp.PutRequest(
            self._library.EntityId(self._spacecraft), Path(name), Path(target), mode, False
        )
        self._in_time(lambda: self._up.put_request(request))

    def take(self, pdu: bytes) -> list[bytes]:
        """Process a received PDU; returns the PDUs to send for it."""
        packet = self._library.PduFactory.from_raw(pdu)
        where = self._library.cfdp.get_packet_destination(packet)
        is_ours = where == self._library.cfdp.PacketDestination.DEST_HANDLER
        return self._in_time(lambda: self._advance(self._down if is_ours else self._up, packet))

    def turn(self) -> list[bytes]:
        """Process the passage of time; returns the PDUs to send now: more of a file, or retransmissions."""
        return self._in_time(lambda: [*self._advance(self._down, None), *self._advance(self._up, None)])

    def _advance(self, handler: Any, packet: Any) -> list[bytes]:
        sent: list[bytes] = []
        for _ in range(MOST_IN_A_TURN):
            with suppress(*self._library.ignored):  # PDU of a transfer that has ended, or whose start was lost
                handler.state_machine(packet)
            packet = None
            before = len(sent)
            while (holder := handler.get_next_packet()) is not None:
                sent.append(bytes(holder.pdu.pack()))
            if len(sent) == before:
                break
        return sent

    def _in_time(self, work: Callable[[], Result]) -> Result:
        """Context in which the library's timers use this entity's clock."""
        module, before = self._library.countdown, self._library.countdown.time_ms
        module.time_ms = lambda: round(self._clock() * 1000)
        try:
            return work()
        finally:
            module.time_ms = before

    def _user(self, direction: str, files: Any) -> Any:
        """Events of the library: only the ends of transfers and the names of files are used."""
        names: dict[Any, str] = {}
        transfers, base = self.transfers, self._library.cfdp.CfdpUserBase
        complete = self._library.pdus.DeliveryCode.DATA_COMPLETE

        def metadata(user: Any, params: Any) -> None:
            names[params.transaction_id] = params.dest_file_name or ""

        def finished(user: Any, params: Any) -> None:
            end = params.finished_params
            name = names.pop(params.transaction_id, "")
            transfers.append(Transfer(direction, name, int(end.condition_code), end.delivery_code == complete))

        methods: dict[str, Any] = dict.fromkeys(base.__abstractmethods__, _nothing)
        methods |= {"metadata_recv_indication": metadata, "transaction_finished_indication": finished}
        return type("User", (base,), methods)(vfs=files)


def _nothing(*_: Any) -> None:
    """Ignore an indication."""


def _silent(base: Any) -> Any:
    """Ignore faults: they are included in the ends of transfers."""
    return type("Faults", (base,), dict.fromkeys(base.__abstractmethods__, _nothing))()


def _timers(given: SimpleNamespace) -> Any:
    def provide(self: Any, local_entity_id: Any, remote_entity_id: Any, entity_type: Any) -> Any:
        return given.countdown.Countdown.from_seconds(5.0)

    return type("Timers", (given.CheckTimerProvider,), {"provide_check_timer": provide})()
