"""Script calls that involve ground commands: DEBUG events, notifications of tables; and zero-copy buffers.

The script itself sends commands to services. The services have higher priority, so they answer before its next call.
On NASA's cFE, this requires a single processor.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.evs import packets as evs
from cfepy.tbl import packets as tbl
from dev.twin.api.words import quote

if TYPE_CHECKING:
    from dev.twin.api.script import Writer

SERVICES = ("CFE_EVS", "CFE_SB", "CFE_ES", "CFE_TBL", "CFE_TIME")
TABLES = ("API.A", "API.B", "API.C", "API.N", "API_AUX.A", "API.SIXTEEN_LETTERS_", "NO", "")
NOTICE, NOTICE_CODE = 0x1891, 5


def command(w: Writer, packet: bytes) -> None:
    """Send a command."""
    w.add("SB_TransmitMsg", "x" + bytes(packet).hex(), 0)


def debug_calls(w: Writer) -> None:
    """Event types of single applications, DEBUG among them, and events of all types."""
    app = w.one(("API", "API_AUX", *SERVICES))
    switch = w.one((evs.ENABLE_APP_EVENT_TYPE, evs.ENABLE_APP_EVENT_TYPE, evs.DISABLE_APP_EVENT_TYPE))
    command(w, switch.packet(AppName=app, BitMask=w.one((1, 1, 15, 2))))
    for _ in range(3):
        which, kind, text = w.one((1, 2, 3)), w.one((1, 1, 2, 3, 4)), quote("t" * w.one((1, 50, 122)))
        w.add("EVS_SendEvent", which, kind, text, task=w.task())
        w.add("EVS_SendEventWithAppID", which, kind, w.one((0x110001, 0x110003, 0x110006, 0x110007)), text)
    w.add("SB_CreatePipe", w.slot("pipe"), w.one((0, 1, 5)), w.name())
    w.add("SB_Subscribe", w.one((0x1890, 0x1891, 0x890)), w.id("pipe"))
    w.add("SB_Unsubscribe", w.one((0x1890, 0x1891, 0x890)), w.id("pipe"))
    if w.random.random() < 0.3:
        command(w, w.one((evs.NOOP, evs.RESET_COUNTERS)).packet())
    if w.random.random() < 0.5:
        command(w, evs.ENABLE_APP_EVENT_TYPE.packet(AppName=app, BitMask=14))
        command(w, evs.DISABLE_APP_EVENT_TYPE.packet(AppName=app, BitMask=1))


def buffer_calls(w: Writer) -> None:
    """Zero-copy buffers: sent, sent twice, released, or left alone, while others pass through a pipe."""
    slot, pipe = w.one(range(80, 84)), w.id("pipe")
    msg_id = w.one((0x1890, 0x1891, 0x890, 0x891))
    w.add("SB_SubscribeEx", msg_id, pipe, 0, 0, w.one((1, 4)))
    for _ in range(w.one((1, 2, 3))):
        data = _packet(w, msg_id)
        if w.random.random() < 0.9:
            w.add("SB_AllocateMessageBuffer", slot, len(data) + w.one((0, 0, 1, 100)))
        is_command = msg_id >= 0x1000
        w.add("SB_TransmitBuffer", slot, "x" + data.hex(), w.one((0, 1)) if is_command else 0, task=w.task())
        if w.random.random() < 0.3:
            w.add("SB_ReleaseMessageBuffer", slot)
    w.add("SB_ReceiveBuffer", pipe, 0)
    w.add("SB_ReceiveBuffer", pipe, 0)
    w.add("SB_ReleaseMessageBuffer", slot)


def _packet(w: Writer, msg_id: int) -> bytes:
    """Return a packet. Some have an invalid length field or MsgId."""
    size = w.one((8, 12, 16, 40, 100, 1000))
    data = bytearray(w.random.randbytes(size))
    data[0:2] = w.one((msg_id, msg_id, msg_id, 0x1FFF, 0x892)).to_bytes(2, "big")
    data[2:4] = b"\xc0\0"
    data[4:6] = (size - 7).to_bytes(2, "big")
    if data[0] < 0x10:
        data[6:12] = bytes(len(data[6:12]))
    return bytes(data)


def notification_calls(w: Writer) -> None:
    """A table whose owner requests notifications, and ground commands for it."""
    slot, pipe = w.one(range(28, 32)), "$27"
    w.add("SB_CreatePipe", "@27", 10, quote("NOTICES"))
    w.add("SB_SubscribeEx", NOTICE, pipe, 0, 0, 10)
    name, options = w.one((("N", 0), ("N", 0), ("A", 0), ("B", 1), ("C", 2), ("SIXTEEN_LETTERS_", 0)))
    w.add("TBL_Register", f"@{slot}", quote(name), 16, options, w.one((0, 1, 1)))
    w.add("TBL_LoadAddress", f"${slot}", w.one(("x0011", "x0122334455", "xee")))
    w.add("TBL_NotifyByMessage", f"${slot}", NOTICE, NOTICE_CODE, w.num())
    full = w.one((f"API.{name}", f"API.{name}", w.one(TABLES)))
    for _ in range(w.one((1, 2, 3))):
        asked = w.one((
            tbl.VALIDATE.packet(TableName=full, ActiveTableFlag=w.one((0, 1, 1, 2))),
            tbl.VALIDATE.packet(TableName=full, ActiveTableFlag=1),
            tbl.DUMP.packet(TableName=full, ActiveTableFlag=w.one((0, 1, 1)), DumpFilename="/ram/dump.tbl"),
            tbl.ACTIVATE.packet(TableName=full),
            tbl.ABORT_LOAD.packet(TableName=full),
        ))  # fmt: skip
        command(w, asked)
        w.add("SB_ReceiveBuffer", pipe, 0)
        w.add("TBL_GetStatus", f"${slot}")
        w.add(w.one(("TBL_Manage", "TBL_Manage", "TBL_Validate", "TBL_Update", "TBL_DumpToBuffer")), f"${slot}")
        command(w, tbl.SEND_HK.packet())
    w.add("TBL_Unregister", f"${slot}")
