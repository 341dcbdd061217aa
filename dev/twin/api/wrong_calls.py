"""Script calls of wrong programs: after a deletion, twice, in the wrong order, of the wrong mode, size, kind or task.

`script` has calls that programs make rightly, among some wrong ones. Here each sequence does something wrong. Calls
that hang or end NASA's cFE are left out.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from dev.twin.api.in_timer import CALLS
from dev.twin.api.words import quote

if TYPE_CHECKING:
    from dev.twin.api.script import Writer

IN_TIMER = tuple(each for each in range(CALLS))
ODD_FILES = ("/ram/w", "/ram/w/", "/ram/w/.", "/ram//w", "/ram/./w", "/ram/x/w", "/ram/x", "/ram/x/", "/ram", "/ram/",
             "/cf/w", "/cf/w/", "/ram/" + "w" * 19, "/ram/" + "w" * 20, "/ram/x/../w", "ram/w", "//ram/w")  # fmt: skip
SIZES = (0, 1, 5, 100, 0x7FFFFFFF, 0x80000000, -1)
OFFSETS = (0, 1, -1, 7, 1000, -1000, 2**31 - 1, 2**31, 2**62)
SHARED = ("$90", "$91", "$92")
"""Ids that these sequences use after the end of their object."""


def after_deletion(w: Writer) -> None:
    """An object is used, found and deleted again after its deletion."""
    which = w.one(("queue", "bin", "count", "mutex", "cond", "rw", "timer", "base", "pipe", "counter"))
    name, gone = quote(w.one(("GONE", "GONE_2"))), w.one((90, 91, 92))
    if which == "pipe":
        w.add("SB_CreatePipe", f"@{gone}", 5, name, task=w.task())
        w.add("SB_Subscribe", 0x1890, f"${gone}")
        w.add("SB_DeletePipe", f"${gone}", task=w.task())
        after = ["SB_DeletePipe", "SB_GetPipeName", "SB_GetPipeOpts", "SB_PipeId_ToIndex"]
        for _ in range(3):
            w.add(w.one(after), f"${gone}", task=w.task())
        w.add("SB_Subscribe", 0x1890, f"${gone}")
        w.add("SB_Unsubscribe", 0x1890, f"${gone}")
        w.add("SB_ReceiveBuffer", f"${gone}", 0)
        w.add("SB_SetPipeOpts", f"${gone}", 1)
        w.add("SB_GetPipeIdByName", "@93", name)
        return
    if which == "counter":
        w.add("ES_RegisterGenCounter", f"@{gone}", name, task=w.task())
        w.add("ES_RegisterGenCounter", "@93", name, task=w.task())
        w.add("ES_DeleteGenCounter", f"${gone}", task=w.task())
        for call in ("IncrementGenCounter", "GetGenCount", "DeleteGenCounter", "CounterID_ToIndex"):
            w.add(f"ES_{call}", f"${gone}", task=w.task())
        w.add("ES_SetGenCount", f"${gone}", 5)
        w.add("ES_GetGenCounterName", f"${gone}", 20)
        return
    stem, create, calls = {
        "queue": ("Queue", (5, 4, 0), ()),
        "bin": ("BinSem", (1, 0), ("Give", "Flush", "Take")),
        "count": ("CountSem", (1, 0), ("Give", "Take")),
        "mutex": ("MutSem", (0,), ("Give", "Take")),
        "cond": ("CondVar", (0,), ("Lock", "Unlock", "Signal", "Broadcast")),
        "rw": ("RwLock", (0,), ("ReadTake", "WriteTake", "ReadGive", "WriteGive")),
        "timer": ("Timer", (), ()),
        "base": ("TimeBase", (0,), ("GetFreeRun",)),
    }[which]
    w.add(f"OS_{stem}Create", f"@{gone}", name, *create, task=w.task())
    w.add(f"OS_{stem}Create", "@93", name, *create, task=w.task())
    w.add(f"OS_{stem}Delete", f"${gone}", task=w.task())
    for call in w.random.sample(calls, min(2, len(calls))):
        w.add(f"OS_{stem}{call}", f"${gone}", task=w.task())
    if which == "queue":
        w.add("OS_QueuePut", f"${gone}", w.bytes(4))
        w.add("OS_QueueGet", f"${gone}", 10, 0)
    if which in ("timer", "base"):
        w.add(f"OS_{stem}Set", f"${gone}", 100000000, 0)
    if which == "base":
        w.add("OS_TimerAdd", "@93", quote("GONE_3"), f"${gone}")
    w.add(f"OS_{stem}GetInfo", f"${gone}")
    w.add(f"OS_{stem}GetIdByName", "@93", name)
    w.add("OS_GetResourceName", f"${gone}")
    w.add("OS_ConvertToArrayIndex", f"${gone}")
    w.add(f"OS_{stem}Delete", f"${gone}", task=w.task())


def odd_files(w: Writer) -> None:
    """Files are opened, read and written in the wrong mode, with odd sizes, after their removal and their end."""
    file = w.one((90, 91, 92))
    w.add("OS_mkdir", quote(w.one(("/ram/x", "/ram/x/", "/ram/w", "/ram/x/."))), 2)
    w.add("OS_OpenCreate", f"@{file}", quote(w.one(ODD_FILES)), w.one((0, 1, 2, 3)), w.one((0, 1, 2, 3)))
    for _ in range(5):
        which = f"${w.one((90, 91, 92))}"
        call = w.one(("OS_read", "OS_write", "OS_lseek", "OS_FileTruncate", "OS_FileAllocate", "OS_FDGetInfo",
                      "OS_TimedRead", "OS_TimedWrite", "path", "path"))  # fmt: skip
        if call == "path":
            w.add(w.one(("OS_remove", "OS_rmdir", "OS_stat", "OS_FileOpenCheck")), quote(w.one(ODD_FILES)))
            continue
        more = {
            "OS_read": (w.one((0, 1, 10)),),
            "OS_write": (w.bytes(w.one((1, 20))),),
            "OS_lseek": (w.one(OFFSETS), w.one((0, 1, 2, 3))),
            "OS_FileTruncate": (w.one((0, 3, 50, -1)),),
            "OS_FileAllocate": (w.one((0, 3, -1)), w.one((0, 20, -5))),
            "OS_TimedRead": (w.one((1, 10)), w.one((0, -1))),
            "OS_TimedWrite": (w.bytes(3), w.one((0, -1))),
        }
        if call == "OS_lseek":  # a write far behind the end is a row of docs/reference/differences.md
            w.add("OS_lseek", which, *more[call])
            w.add("OS_read", which, 10)
            w.add("OS_lseek", which, 0, w.one((0, 2)))
            continue
        w.add(call, which, *more.get(call, ()), task=w.task())
    w.add("OS_close", f"${file}", task=w.task())
    if w.random.random() < 0.5:
        w.add("OS_close", f"${file}")
        w.add("OS_read", f"${file}", 5)
        w.add("OS_FDGetInfo", f"${file}")


def odd_paths(w: Writer) -> None:
    """Files are copied and moved onto themselves, onto folders, and to paths that cannot be."""
    first, second = w.one(ODD_FILES), w.one(ODD_FILES)
    if w.random.random() < 0.3:
        second = first
    w.add("OS_OpenCreate", "@90", quote(w.one(("/ram/w", "/cf/w"))), 3, 1)
    w.add("OS_write", "$90", w.bytes(12))
    if w.random.random() < 0.7:
        w.add("OS_close", "$90")
    call = w.one(("OS_cp", "OS_mv", "OS_rename"))
    w.add(call, quote(first), quote(second))
    w.add("OS_stat", quote(first))
    w.add("OS_stat", quote(second))
    w.add("OS_FDGetInfo", "$90")
    w.add("OS_DirectoryOpen", "@91", quote(w.one(("/ram/x", "/ram/x/", "/ram/w", "/ram/x/.", "/ram/none"))))
    w.add("OS_rmdir", quote(w.one(ODD_FILES[:9])))
    w.add("OS_DirectoryRewind", "$91")
    w.add("OS_DirectoryClose", "$91")
    w.add("OS_DirectoryClose", "$91")
    w.add("OS_close", "$90")
    w.add("OS_chmod", quote(w.one(ODD_FILES)), 2)
    w.add("OS_remove", quote(first))


def wrong_order(w: Writer) -> None:
    """Locks are given back untaken, and by another task; timers outlive their time base."""
    which = w.one(("mutex", "base", "timer", "queue", "table", "buffer"))
    if which == "mutex":
        w.add("OS_MutSemCreate", "@90", quote("ORDER"), 0)
        w.add("OS_MutSemGive", "$90", task=w.task())
        w.add("OS_MutSemTake", "$90")
        w.add("OS_MutSemTake", "$90")
        w.add("OS_MutSemGive", "$90", task=w.one("BC"))
        for _ in range(3):
            w.add("OS_MutSemGive", "$90")
        w.add("OS_MutSemDelete", "$90", task=w.task())
    elif which == "base":
        w.add("OS_TimeBaseCreate", "@90", quote("ORDER"), 0)
        w.add("OS_TimerAdd", "@91", quote("ORDER"), "$90")
        w.add("OS_TimeBaseDelete", "$90")
        w.add("OS_TimerSet", "$91", 100000000, 0)
        w.add("OS_TimerGetInfo", "$91")
        w.add("OS_TimerDelete", "$91")
        w.add("OS_TimeBaseDelete", "$90")
    elif which == "timer":
        w.add("OS_TimerCreate", "@91", quote("ORDER"))
        for start, interval in ((0, 0), (1, -1), (-1, 0), (0, 2**31), (2**31, 0), (100000000, 0)):
            w.add("OS_TimerSet", "$91", start, interval, task=w.task())
        w.add("OS_TimerDelete", "$91", task=w.task())
        w.add("OS_TimerSet", "$91", 100000000, 0)
    elif which == "queue":
        w.add("OS_QueueCreate", "@90", quote("ORDER"), 2, 4, w.one((0, 1, 99)))
        for size in (5, 4, 0, 3, 1):
            w.add("OS_QueuePut", "$90", w.bytes(size), task=w.task())
        for timeout in (0, 0, 0, 2):
            w.add("OS_QueueGet", "$90", 200, timeout)
        w.add("OS_QueueDelete", "$90", task=w.task())
    elif which == "table":
        wrong_tables(w)
    else:
        w.add("SB_AllocateMessageBuffer", 7, 20)
        w.add("SB_ReleaseMessageBuffer", 7)
        w.add("SB_ReleaseMessageBuffer", 7)


def wrong_tables(w: Writer) -> None:
    """Tables are loaded through the wrong hands, and used without a load, twice, and after their end."""
    name = quote(w.one(("WRONG", "WRONG_2")))
    w.add("TBL_Register", "@60", name, w.one((8, 0, 16)), w.one((0, 1, 2)), w.one((0, 1)), task=w.one("AB"))
    w.add("TBL_Register", "@61", name, w.one((8, 16)), w.one((0, 2)), 0, task=w.one("AB"))
    for _ in range(6):
        call = w.one(("GetAddress", "ReleaseAddress", "Update", "Validate", "Manage", "Modified", "GetStatus",
                      "DumpToBuffer", "LoadAddress", "Unregister"))  # fmt: skip
        more = {"GetAddress": (1,), "LoadAddress": (w.one(("x00112233", "xee")),)}.get(call, ())
        w.add(f"TBL_{call}", w.one(("$60", "$61")), *more, task=w.task())
    w.add("TBL_Unregister", "$60", task=w.one("AB"))
    w.add("TBL_GetInfo", quote(w.one(("API.WRONG", "API_AUX.WRONG", "WRONG", ""))))


def strangers(w: Writer) -> None:
    """Pipes and subscriptions of another application, and of none."""
    owner, other = w.one((("A", "B"), ("B", "A"), ("C", "B")))
    w.add("SB_CreatePipe", "@90", 3, quote("OWNED"), task=owner)
    for call, more in (
        ("SB_Subscribe", ()),
        ("SB_SubscribeLocal", (4,)),
        ("SB_Unsubscribe", ()),
        ("SB_Unsubscribe", ()),
        ("SB_UnsubscribeLocal", ()),
        ("SB_SubscribeEx", (0, 0, 2)),
        ("SB_SubscribeEx", (0, 0, 2)),
    ):
        w.add(call, w.one((0x1890, 0x1890, 0x2000, 0)), "$90", *more, task=w.one((owner, other)))
    for size in (8, 7, 12):
        data = bytes.fromhex("1890c000") + (size - 7).to_bytes(2, "big") + bytes(size - 6)
        w.add("SB_TransmitMsg", "x" + data.hex(), 0, task=w.task())
    w.add("SB_TransmitMsg", "x1890c000ffff0000", 0)
    w.add("SB_ReceiveBuffer", "$90", 0, task=other)
    w.add("SB_ReceiveBuffer", "$90", w.one((0, -2, 2)), task=owner)
    w.add("SB_SetPipeOpts", "$90", 1, task=other)
    w.add("SB_DeletePipe", "$90", task=other)
    w.add("SB_DeletePipe", "$90", task=owner)
    w.add("SB_DeletePipe", "$90", task=owner)


def wrong_events(w: Writer) -> None:
    """Events before, after and in spite of a registration that fails."""
    who = w.one("ABC")
    for _ in range(3):
        scheme, filters = w.one((0, 0, 1, 255)), w.one(((), (1, 0), (1, 0xFFFF, 1, 0), (0, 0)))
        w.add("EVS_Register", scheme, *filters, task=who)
        w.add("EVS_SendEvent", w.one((0, 1, 65535)), w.one((0, 1, 2, 3, 4, 5)), quote("w"), task=w.task())
        w.add("EVS_SendEventWithAppID", 1, 2, w.one((0, 0x110006, 0x110007, 0x11000F, 0x120001)), quote("w"),
              task=w.task())  # fmt: skip
        w.add("EVS_SendTimedEvent", 2**32 - 1, 0, 1, 3, quote("w"), task=w.task())
        w.add("EVS_ResetFilter", w.one((0, 1, 77)), task=w.task())
    w.add("EVS_Register", 0, task="A")
    w.add("EVS_Register", 0, task="B")


def wrong_services(w: Writer) -> None:
    """Executive Services, pools, the CDS and files of cFE with ids of others and odd numbers."""
    w.add("ES_PoolDelete", w.one(SHARED))
    w.add("ES_GetAppInfo", w.one(SHARED))
    w.add("ES_GetTaskInfo", w.one(SHARED))
    w.add("ES_GetLibInfo", w.one(SHARED))
    w.add("ES_RegisterCDS", "@94", w.one((4, 8)), quote("WRONG"), task=w.task())
    w.add("ES_RegisterCDS", "@95", w.one((4, 8, 0)), quote("WRONG"), task=w.task())
    w.add("ES_RestoreFromCDS", w.one(("$94", "$95", *SHARED)), 0, task=w.task())
    w.add("ES_PerfLogAdd", w.one((127, 128, -1)), w.one((0, 1)))
    w.add("ES_CalculateCRC", w.bytes(w.one((0, 1, 16))), w.num(), w.one((0, 3, 4, 99)))
    w.add("OS_OpenCreate", "@92", quote("/ram/h"), 3, w.one((0, 1, 2)))
    w.add("FS_ReadHeader", "$92")
    w.add("FS_Header", "$92", quote("h"), 1)
    w.add("FS_SetTimestamp", "$92", 1, 2)
    w.add("FS_ReadHeader", "$92")
    w.add("OS_close", "$92")
    w.add("FS_Header", "$92", quote("h"), 1)
    w.add("TIME_RegisterSynchCallback", 0, task=w.one("AB"))
    w.add("TIME_RegisterSynchCallback", 0, task=w.one("AB"))
    w.add("TIME_UnregisterSynchCallback", w.one((0, 1)), task=w.one("AB"))
    w.add("TIME_UnregisterSynchCallback", 0, task=w.one("AB"))


def in_timers(w: Writer) -> None:
    """Calls that a timer's callback should not make."""
    stem, more = w.one((("BinSem", (0, 0)), ("CountSem", (0, 0)), ("Queue", (2, 4, 0)), ("MutSem", (0,))))
    w.add(f"OS_{stem}Create", "@90", quote("TIMED"), *more)
    for _ in range(2):
        w.add("OS_InTimer", w.one(IN_TIMER), w.one(("$90", "$90", "$91", "0")))
    w.add(f"OS_{stem}Delete", "$90")


WRONG_GROUPS = (after_deletion, after_deletion, odd_files, odd_files, odd_paths, odd_paths, wrong_order, wrong_order,
                wrong_tables, strangers, wrong_events, wrong_services, in_timers)  # fmt: skip
