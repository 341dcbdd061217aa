"""A CFDP entity on the ground: the other end of CF, made with the library cfdp-py (extra `cfepy[cfdp]`).

It knows nothing of how PDUs travel. Whoever flies it hands in what came down, takes what is to go up, and says what
time it is, so it serves a mission in virtual time and one over UDP alike. Only this module imports the library.
CFDP: CCSDS 727.0-B-5.
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
"""Where CF's channel 0 takes PDUs, and where it sends them, in missions/cfs."""
CLASS_1, CLASS_2 = 0, 1
"""Unacknowledged and acknowledged, as in CF's commands; without and with repeats of what was lost."""
LONGEST_PACKET = 512
"""Bytes of a PDU, at most."""
MOST_IN_A_TURN = 100

Result = TypeVar("Result")


class Transfer(NamedTuple):
    """The end of a file's way.

    Attributes:
        direction: "down" or "up".
        name: of the file on the ground, if it was told.
        condition: CFDP's condition code: 0 is no error.
        complete: whether all data arrived.
    """

    direction: str
    name: str
    condition: int
    complete: bool


def library() -> SimpleNamespace:
    """What is needed of cfdp-py.

    Raises:
        UsageError: it is not installed.
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
    """The PDU in a packet of CF's channel 0; None in another packet."""
    is_pdu = int.from_bytes(packet[:2], "big") == CF_OUT_MID and len(packet) > TLM_HEADER_SIZE
    return packet[TLM_HEADER_SIZE:] if is_pdu else None


def uplinked(pdu: bytes) -> bytes:
    """The packet that takes a PDU to CF's channel 0."""
    packet = bytes(command(CF_IN_MID, 0, pdu))
    assert len(packet) == CMD_HEADER_SIZE + len(pdu)
    return packet


class GroundEntity:
    """A CFDP entity that receives files into a folder, and sends files of it.

    Args:
        folder: where its files are; it exists.
        clock: says what time it is, in s from any beginning: the run's virtual time, or the host's.
        entity: its own id.
        spacecraft: CF's id.

    Attributes:
        transfers: what came to its end, in order.

    Raises:
        UsageError: cfdp-py is not installed.
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
        """Begin to send a file up; `turn` gives its PDUs.

        Args:
            name: of the file in the folder.
            target: where it goes, such as "/ram/new.tbl".
            cfdp_class: CLASS_1 or CLASS_2.
        """
        modes = self._library.pdus.TransmissionMode
        mode = modes.ACKNOWLEDGED if cfdp_class == CLASS_2 else modes.UNACKNOWLEDGED
        request = self._library.cfdp.PutRequest(
            self._library.EntityId(self._spacecraft), Path(name), Path(target), mode, False
        )
        self._in_time(lambda: self._up.put_request(request))

    def take(self, pdu: bytes) -> list[bytes]:
        """A PDU came down; the PDUs that go up for it."""
        packet = self._library.PduFactory.from_raw(pdu)
        where = self._library.cfdp.get_packet_destination(packet)
        is_ours = where == self._library.cfdp.PacketDestination.DEST_HANDLER
        return self._in_time(lambda: self._advance(self._down if is_ours else self._up, packet))

    def turn(self) -> list[bytes]:
        """Time has passed; the PDUs that go up now: more of a file, or what is repeated."""
        return self._in_time(lambda: [*self._advance(self._down, None), *self._advance(self._up, None)])

    def _advance(self, handler: Any, packet: Any) -> list[bytes]:
        sent: list[bytes] = []
        for _ in range(MOST_IN_A_TURN):
            with suppress(*self._library.ignored):  # of a transfer that is over, or whose beginning was lost
                handler.state_machine(packet)
            packet = None
            before = len(sent)
            while (holder := handler.get_next_packet()) is not None:
                sent.append(bytes(holder.pdu.pack()))
            if len(sent) == before:
                break
        return sent

    def _in_time(self, work: Callable[[], Result]) -> Result:
        """Do something while the library's count-downs go by this entity's clock."""
        module, before = self._library.countdown, self._library.countdown.time_ms
        module.time_ms = lambda: round(self._clock() * 1000)
        try:
            return work()
        finally:
            module.time_ms = before

    def _user(self, direction: str, files: Any) -> Any:
        """What the library tells: only the ends of transfers matter, and the names of files."""
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
    """An indication that nobody needs."""


def _silent(base: Any) -> Any:
    """Faults are in the ends of transfers."""
    return type("Faults", (base,), dict.fromkeys(base.__abstractmethods__, _nothing))()


def _timers(given: SimpleNamespace) -> Any:
    def provide(self: Any, local_entity_id: Any, remote_entity_id: Any, entity_type: Any) -> Any:
        return given.countdown.Countdown.from_seconds(5.0)

    return type("Timers", (given.CheckTimerProvider,), {"provide_check_timer": provide})()
