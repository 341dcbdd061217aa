"""TO_LAB's commands (to_lab_cmds.c, to_lab_dispatch.c).

NASA's code does not check a command's length. If a command is too short, its missing bytes count as zeros here.
"""

from __future__ import annotations

from typing import Any

from cfepy.app import Cfe
from cfepy.msg import BAD_CODE, BAD_MSG_ID, Command, CommandTable
from cfepy.status import CfeError

from . import events as ev
from . import packets as pk
from .downlink import Downlink

SAMPLE = {
    "synch": 0x6969,
    "bl2": 1,
    "b1": 16,
    "b2": 127,
    "b3": 0x7F,
    "b4": 0x45,
    "w1": 0x2468,
    "w2": 0x7FFF,
    "dw1": 0x12345678,
    "dw2": 0x87654321 - (1 << 32),
    "f1": 90.01,
    "f2": 0.0000045,
    "df1": 99.9,
    "df2": 0.4444,
    "str": "ABCDEFGHIJ",
}
"""What the packet of all data types holds."""


class ToLabCommands:
    """TO_LAB's ground commands.

    Args:
        cfe: the app's handle.
        downlink: sends the packets.
        pipe: the pipe of packets for the ground.
        table: the image of the table.
        version: for the answer to NOOP.
    """

    def __init__(self, cfe: Cfe, downlink: Downlink, pipe: int, table: memoryview, version: str) -> None:
        self._cfe = cfe
        self._downlink = downlink
        self._pipe = pipe
        self._table = table
        self._version = version
        self._accepted = self._rejected = 0
        self._commands = CommandTable()
        for command, handler in (
            (pk.NOOP, self._noop),
            (pk.RESET_STATUS, self._reset_status),
            (pk.ADD_PKT, self._add_packet),
            (pk.SEND_DATA_TYPES, self._send_data_types),
            (pk.REMOVE_PKT, self._remove_packet),
            (pk.REMOVE_ALL_PKT, self._remove_all),
            (pk.OUTPUT_ENABLE, self._enable_output),
            (pk.SEND_HK, self._send_hk),
        ):
            self._commands.handle(command, handler, any_length=True)

    def handle(self, packet: bytes) -> None:
        """Execute a command, or report the reason for refusing it to the ground."""
        done = self._commands.dispatch(packet)
        if done.outcome == BAD_CODE:
            self._rejected += 1
            where = f"L{ev.FUNCTION_CODE_LINE} TO"
            text = f"{where}: Invalid Function Code Rcvd In Ground Command 0x{done.fcn_code:x}"
            self._cfe.evs.send_err(ev.FNCODE_ERR_EID, text)
        elif done.outcome == BAD_MSG_ID:
            text = f"L{ev.MSG_ID_LINE} TO: Invalid Msg ID Rcvd 0x{done.msg_id:x}"
            self._cfe.evs.send_err(ev.MID_ERR_EID, text)

    def _noop(self, packet: bytes) -> None:
        self._cfe.evs.send_info(ev.NOOP_INF_EID, f"TO: NOOP command. {self._version}")
        self._accepted += 1

    def _reset_status(self, packet: bytes) -> None:
        self._accepted = self._rejected = 0
        self._cfe.evs.send_info(ev.RESET_INF_EID, "Reset counters command")

    def _send_hk(self, packet: bytes) -> None:
        counters = {"CommandCounter": self._accepted & 0xFF, "CommandErrorCounter": self._rejected & 0xFF}
        self._cfe.sb.transmit_msg(pk.HK_TLM.packet(counters))

    def _send_data_types(self, packet: bytes) -> None:
        self._cfe.sb.transmit_msg(pk.DATA_TYPES_TLM.packet(SAMPLE))
        self._accepted += 1

    def _enable_output(self, packet: bytes) -> None:
        host = read(pk.OUTPUT_ENABLE, packet)["dest_IP"]
        self._cfe.evs.send_info(ev.TLMOUTENA_INF_EID, f"TO telemetry output enabled for IP {host}")
        self._downlink.enable(host)
        self._accepted += 1

    def _add_packet(self, packet: bytes) -> None:
        evs, given = self._cfe.evs, read(pk.ADD_PKT, packet)
        stream, limit, flags = given["Stream"], given["BufLimit"], given["Flags"]
        try:
            self._cfe.sb.subscribe_ex(stream, self._pipe, qos_of(given), limit)
        except CfeError as error:
            text = f"L{ev.ADD_ERROR_LINE} TO Can't subscribe 0x{stream:x} status {error.status}"
            evs.send_err(ev.ADDPKT_ERR_EID, text)
        else:
            quality = f"QoS {flags['Priority']}.{flags['Reliability']}"
            text = f"L{ev.ADD_LINE} TO AddPkt 0x{stream:x}, {quality}, limit {limit}"
            evs.send_info(ev.ADDPKT_INF_EID, text)
        self._accepted += 1

    def _remove_packet(self, packet: bytes) -> None:
        evs, stream = self._cfe.evs, read(pk.REMOVE_PKT, packet)["Stream"]
        try:
            self._cfe.sb.unsubscribe(stream, self._pipe)
        except CfeError as error:
            text = f"L{ev.REMOVE_ERROR_LINE} TO Can't Unsubscribe to Stream 0x{stream:x}, status {error.status}"
            evs.send_err(ev.REMOVEPKT_ERR_EID, text)
        else:
            evs.send_info(ev.REMOVEPKT_INF_EID, f"L{ev.REMOVE_LINE} TO RemovePkt 0x{stream:x}")
        self._accepted += 1

    def _remove_all(self, packet: bytes) -> None:
        for row in pk.SUBSCRIPTIONS.unpack(self._table):
            if self._cfe.sb.is_valid_msg_id(row["Stream"]):
                self._remove_row(row["Stream"])
        text = f"L{ev.REMOVE_ALL_LINE} TO Unsubscribed to all Commands and Telemetry"
        self._cfe.evs.send_info(ev.REMOVEALLPKTS_INF_EID, text)
        self._accepted += 1

    def _remove_row(self, stream: int) -> None:
        try:
            self._cfe.sb.unsubscribe(stream, self._pipe)
        except CfeError as error:
            where = f"L{ev.REMOVE_ALL_ERROR_LINE} TO"
            text = f"{where} Can't Unsubscribe to stream 0x{stream:x} status {error.status}"
            self._cfe.evs.send_err(ev.REMOVEALLPTKS_ERR_EID, text)


def read(command: Command, packet: bytes) -> dict[str, Any]:
    """Return the fields of a command, zeros where it is too short."""
    return command.read(packet.ljust(command.length, b"\0"))


def qos_of(fields: dict[str, Any]) -> int:
    """Return the quality of service of a row or a command, as one number."""
    return int(fields["Flags"]["Priority"] | fields["Flags"]["Reliability"] << 8)
