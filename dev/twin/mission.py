"""The mission that both fly: NASA's lab applications, with tables that make the link fast and complete.

SCH_LAB makes CI_LAB read its socket twenty times a second. TO_LAB takes every compared message, with as many of a MsgId
as fit into its pipe.
"""

from __future__ import annotations

from apps import sch_lab, to_lab
from apps.ci_lab import packets as ci_lab
from apps.sample_app import packets as sample_app
from cfepy.tbl import image
from dev.twin.commands import BAD_TABLE, GOOD_TABLE, SHORT_TABLE

STARTUP = """\
CFE_LIB, sample_lib, SAMPLE_LIB_Init, SAMPLE_LIB, 0, 0, 0x0, 0;
CFE_APP, sample_app, SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;
CFE_APP, ci_lab, CI_LAB_AppMain, CI_LAB, 60, 16384, 0x0, 0;
CFE_APP, to_lab, TO_LAB_AppMain, TO_LAB, 70, 16384, 0x0, 0;
CFE_APP, sch_lab, SCH_LAB_AppMain, SCH_LAB, 80, 16384, 0x0, 0;
!
"""
DOWN = (0x800, 0x801, 0x803, 0x804, 0x805, 0x806, 0x808, 0x809, 0x80A, 0x80B, 0x80C, 0x80D, 0x80E, 0x810)
LAB_DOWN = (0x880, 0x881, 0x883, 0x884)
LOOKS_PER_S = 20


def _table(name: str, data: bytes, offset: int = 0) -> bytes:
    return image.build(image.TableImage(name, data, offset=offset))


def files() -> dict[str, bytes]:
    """Return the files in /cf other than the applications, by virtual path."""
    subscription = to_lab.packets.SUBSCRIPTION
    rows = b"".join(subscription.pack(Stream=each, BufLimit=50) for each in (*DOWN, *LAB_DOWN))
    look = {"MessageID": ci_lab.READ_UPLINK.msg_id, "PacketRate": 1}
    schedule = sch_lab.schedule.TABLE.pack(TickRate=LOOKS_PER_S, Config=[look])
    example = "SAMPLE_APP.ExampleTable"
    size = sample_app.EXAMPLE_TABLE.size
    return {
        "/cf/cfe_es_startup.scr": STARTUP.encode(),
        "/cf/to_lab_sub.tbl": _table("TO_LAB.TO_LAB_Subs", rows.ljust(32 * subscription.size, b"\0")),
        "/cf/sch_lab_table.tbl": _table("SCH_LAB.ScheduleTable", schedule),
        GOOD_TABLE: _table(example, b"\1\0\2\0".ljust(size, b"\0")[:size]),
        BAD_TABLE: _table(example, b"\xff" * size),
        SHORT_TABLE: _table(example, b"\1\0\2\0".ljust(size, b"\0")[:size])[:-1],
        "/cf/part.tbl": _table(example, b"\3\0", 2),
        "/cf/other.tbl": _table("NO.Table", b"\3\0"),
    }
