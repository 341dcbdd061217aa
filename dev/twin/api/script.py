"""Random scripts of API calls in all groups, with valid and invalid arguments, from a seed.

Arguments come mostly from small sets of names and slots, so that calls meet objects of other calls. Calls that would
block the real cFE forever, or end it, are left out: only one task takes a mutex, a semaphore is taken only after a
give,
and waits for pipes or queues have a time-out.
"""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import TypeVar

from cfepy import msg
from dev.twin.api.ground import buffer_calls, debug_calls, notification_calls
from dev.twin.api.words import quote
from dev.twin.api.wrong_calls import WRONG_GROUPS

T = TypeVar("T")

LONG = "N" * 19
NAMES = ("A", "B", "C", "NAME_OF_19_LETTERS_", LONG, "TOO_LONG_BY_ONE_____", "M" * 40, "x y")
FEW = ("B", "C", "NAME_OF_19_LETTERS_")
"""Names that no mutex gets: NASA's core has mutexes that ours does without, so fewer are left."""
BLOCK_NAMES = ("D", "E", "F", "SIXTEEN_LETTERS+", "SEVENTEEN_LETTERS", "", "M" * 40)
"""Of the CDS; no table has one, since NASA's copies what a block holds, wherever that ends."""
CDS_NAMES = ("A", "B", "C", "SIXTEEN_LETTERS_", "SEVENTEEN_LETTERS", "", "M" * 40)
PATHS = ("/cf/a.txt", "/cf/b.txt", "/cf/d/c.txt", "/ram/a.txt", "/ram/nn.txt", "/cf/none", "/no/a", "a.txt", "", "/cf",
         "/cf/" + "n" * 19, "/cf/" + "n" * 30, "/" + "p" * 70)  # fmt: skip
FILES = tuple(each for each in PATHS if each not in ("/cf", "/cf/none"))
"""Those that are no directories, which differ: rows of docs/reference/differences.md."""
MADE = ("/cf/d", "/cf/d2", "/cf/d3", "/no", "", "x")
FOLDERS = ("/cf", "/ram", "/cf/d", "/cf/none", "/no", "", "x", "/cf/d2")
WRONG = (0, 0x110001, 0x1FFFF, 0x2FFFF, 0x130001, 0x140009, 0x160009, 0xFFFFFFFF, 0x1B0009, 0x150001)
EDGES = (0, 1, 2, 3, 7, 8, 9, 15, 16, 17, 63, 64, 65, 255, 256, 1000)
NUMBERS = (*EDGES, 0x7FFF, 0x8000, 0xFFFF, 0x10000, 999999, 1000000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)
MSG_IDS = (0x1890, 0x1891, 0x890, 0x891, 0x1890, 0x1891, 0, 0x1FFF, 0x2000, 0xFFFF)
STATUSES = (0, -1, -5, -35, -108, 0x48000001, -1040187390, -905969661, 12345, -(2**31))
SLOT_OF = {kind: range(start, start + 4) for start, kind in zip(range(0, 96, 4), (
    "app", "lib", "task", "counter", "pool", "cds", "pipe", "table", "queue", "mutex", "bin", "count", "cond", "rw",
    "timer", "base", "file", "dir", "ostask", "block", "buffer", "any"), strict=False)}  # fmt: skip


class Writer:
    """Makes one script.

    Args:
        seed: seed of the random choices.
    """

    def __init__(self, seed: int) -> None:
        self.random = Random(seed)
        self.lines: list[str] = []
        self.images = 0

    def add(self, call: str, *words: object, task: str = "A") -> None:
        """A line."""
        self.lines.append(" ".join(map(str, (task, call, *words))))

    def one(self, choices: Sequence[T]) -> T:
        """One of some."""
        return self.random.choice(choices)

    def num(self) -> int:
        """Return a number, preferably an edge case."""
        return self.one(NUMBERS) if self.random.random() < 0.7 else self.random.getrandbits(32)

    def id(self, kind: str) -> str:
        """Return an id: mostly one of this kind, sometimes another kind's or an invalid one."""
        if self.random.random() < 0.1:
            other = self.one([each for each in SLOT_OF if each not in ("block", "buffer", "table")])
            return f"${self.one(SLOT_OF[other])}"
        return str(self.one(WRONG)) if self.random.random() < 0.07 else f"${self.one(SLOT_OF[kind])}"

    def slot(self, kind: str) -> str:
        """Return a slot for an id."""
        return f"@{self.one(SLOT_OF[kind])}"

    def name(self) -> str:
        """Return a random name."""
        return quote(self.one(NAMES))

    def bytes(self, size: int) -> str:
        """Return random bytes."""
        return "x" + self.random.randbytes(size).hex()

    def task(self) -> str:
        """Return the calling task: mostly the application."""
        return self.random.choices("ABC", (8, 1, 1))[0]


def es_calls(w: Writer) -> None:
    """Applications, tasks, counters, pools, the CDS, log, CRC."""
    kind = w.one(("app", "lib", "task", "counter", "cds", "pool", "other"))
    if kind == "app":
        names = ("API", "API_AUX", "CFE_ES", "CFE_SB", "SAMPLE_LIB", "NOBODY", "", "M" * 40)
        w.add("ES_GetAppIDByName", w.slot("app"), quote(w.one(names)), task=w.task())
        w.add("ES_GetAppID", w.slot("app"), task=w.task())
        w.add("ES_GetAppName", w.id("app"), 20)
        w.add("ES_GetAppInfo", w.id("app"), task=w.task())
        w.add("ES_AppID_ToIndex", w.id("app"))
        w.add("ES_GetModuleInfo", w.id(w.one(("app", "lib"))))
        w.add(w.one(("ES_RestartApp", "ES_DeleteApp")), w.one((0, 0x110001, 0x110002, 0x11FFFF, 0x130001)))
        w.add("ES_ReloadApp", w.one((0, 0x110001, 0x11FFFF, "$0")), quote("/cf/none.so"))
    elif kind == "lib":
        w.add("ES_GetLibIDByName", w.slot("lib"), quote(w.one(("SAMPLE_LIB", "API", "", "N" * 30))), task=w.task())
        w.add("ES_GetLibName", w.id("lib"), 20)
        w.add("ES_GetLibInfo", w.id("lib"))
        w.add("ES_LibID_ToIndex", w.id("lib"))
    elif kind == "task":
        task_calls(w)
    elif kind == "counter":
        w.add("ES_RegisterGenCounter", w.slot("counter"), w.name(), task=w.task())
        for _ in range(3):
            call = w.one(("ES_IncrementGenCounter", "ES_GetGenCount", "ES_SetGenCount", "ES_DeleteGenCounter",
                          "ES_CounterID_ToIndex"))  # fmt: skip
            w.add(call, w.id("counter"), *((w.num(),) if call == "ES_SetGenCount" else ()), task=w.task())
        w.add("ES_GetGenCounterName", w.id("counter"), 20)
        w.add("ES_GetGenCounterIDByName", w.slot("counter"), w.name())
    elif kind == "cds":
        size = w.one((0, 1, 4, 10, 100, 1000, 5000, 200000, 2**30))
        w.add("ES_RegisterCDS", w.slot("cds"), size, quote(w.one(BLOCK_NAMES)), task=w.task())
        w.add("ES_GetCDSBlockIDByName", w.slot("cds"), quote(w.one(("API.D", "API.E", "API_AUX.D", "D", ""))))
        w.add("ES_GetCDSBlockName", w.id("cds"), 40)
        w.add("ES_RestoreFromCDS", w.id("cds"), 0, task=w.task())
    elif kind == "pool":
        pool_calls(w)
    else:
        other_es_calls(w)


def task_calls(w: Writer) -> None:
    """Child tasks."""
    w.add("ES_CreateChildTask", w.slot("task"), w.name(), w.one((0, 4096, 16384)), w.one((0, 1, 50, 255)), 0,
          task=w.task())  # fmt: skip
    w.add("ES_GetTaskInfo", w.id("task"))
    w.add("ES_GetTaskName", w.id("task"), 20)
    w.add("ES_GetTaskIDByName", w.slot("task"), quote(w.one(("API", "API_CHILD", "API_AUX", "A", "B", "NO", ""))))
    w.add("ES_TaskID_ToIndex", w.id("task"))
    w.add("ES_GetAppInfo", 0x110007)
    if w.random.random() < 0.7:
        w.add("ES_GetTaskIDByName", "@95", w.name())
        w.add("ES_DeleteChildTask", w.one(("$95", "$95", "$95", "$94", "0", "0x1FFFF", "0x110007", "0x20001")),
              task=w.one("AAB"))  # fmt: skip
        w.add("OS_TaskDelay", 20)
        w.add("ES_GetTaskInfo", "$95")


def pool_calls(w: Writer) -> None:
    """Memory pools."""
    arena = w.one(range(4))
    slot, block = SLOT_OF["pool"][arena], w.one(range(8))
    call = w.one(("ES_PoolCreate", "ES_PoolCreateNoSem", "ES_PoolCreateEx"))
    sizes = [w.one((0, 4, 8, 16, 20, 64, 100, 1000)) for _ in range(w.one((0, 1, 2, 3, 17, 18)))]
    size = w.one((0, 1, 8, 15, 16, 17, 23, 24, 25, 31, 32, 33, 100, 1000, 1024, 4096))
    if w.random.random() < 0.6:
        w.add("ES_PoolDelete", f"${slot}")
        w.add(call, f"@{slot}", size, w.one((0, 1)), arena, *(sizes if call == "ES_PoolCreateEx" else ()))
    for _ in range(w.one((1, 2, 5))):
        w.add("ES_GetPoolBuf", f"${slot}", w.one((0, 1, 7, 8, 9, 16, 17, 48, 100, 512, 1001, 80001)), block, arena)
        if w.random.random() < 0.5:
            w.add("ES_GetPoolBufInfo", f"${slot}", block)
            w.add("ES_PutPoolBuf", f"${slot}", block)
    w.add("ES_GetMemPoolStats", w.id("pool"))
    w.add("ES_PoolDelete", w.one((0, 0x140009, 0x110001)))


def other_es_calls(w: Writer) -> None:
    """System log, performance log, CRC, states."""
    w.add("ES_WriteToSysLog", quote("t" * w.one((0, 1, 50, 121, 122, 123, 130, 200))), task=w.task())
    w.add("ES_CalculateCRC", w.bytes(w.one(EDGES)), w.num(), w.one((0, 1, 2, 3, 4)))
    w.add("ES_PerfLogAdd", w.one((0, 1, 127, 128, 129, 5000)), w.one((0, 1)))
    w.add("ES_WaitForSystemState", w.one((0, 1, 2, 3, 4)), w.one((0, 5)))
    w.add("ES_GetResetType")
    w.add("ES_ResetCFE", w.one((0, 3, 99)))
    w.add("ES_StatusToString", w.one(STATUSES))
    w.add("ES_IncrementTaskCounter", task=w.task())
    w.add("ES_ProcessAsyncEvent")
    w.add("ResourceId", w.num(), w.one((0x11, 0x15, 0x16)), w.one((0, 1, 32)))
    if w.random.random() < 0.1:
        w.add("ES_BackgroundWakeup")


def evs_calls(w: Writer) -> None:
    """Events."""
    filters = [number for _ in range(w.one((0, 0, 1, 3, 7))) for number in (w.one((1, 2, 3, 65535)), w.num() & 0xFFFF)]
    if w.random.random() < 0.3:
        w.add("EVS_Register", 0, *filters, task=w.one("AB"))
    if w.random.random() < 0.2:  # while API_AUX is not registered, only API calls this, since the caller's types count
        w.add("EVS_Register", w.one((1, 99)), task="B")
        for _ in range(w.one((1, 2))):
            w.add("EVS_SendEventWithAppID", 1, 2, 0x110006, quote("t"))
        w.add("EVS_Register", 0, task="B")
    for _ in range(4):
        which, kind = w.one((0, 1, 2, 3, 65535)), w.one((1, 2, 3, 4, 2, 3, 0, 5))
        text = quote("t" * w.one((0, 1, 20, 120, 121, 122, 200)))
        w.add("EVS_SendEvent", which, kind, text, task=w.task())
        w.add("EVS_SendTimedEvent", w.num(), w.num(), which, kind, text, task=w.task())
        w.add("EVS_SendEventWithAppID", which, kind, w.id("app"), text)
        w.add("EVS_SendEventWithAppID", which, kind, w.one((0x110006, 0x110007, 0x110001, 0x110020, 0)), text)
    w.add("EVS_ResetFilter", w.one((0, 1, 2, 3, 65535)), task=w.task())
    w.add("EVS_ResetAllFilters", task=w.task())


def packet(w: Writer) -> str:
    """Return a packet with a correct length field."""
    msg_id, size = w.one(MSG_IDS), w.one((7, 8, 11, 12, 16, 17, 100, 1000))
    made = bytearray(w.random.randbytes(size))
    made[0:2] = msg_id.to_bytes(2, "big")
    made[4:6] = (size - 7).to_bytes(2, "big")
    if msg_id & 0x1800 == 0x800 and size > 11:
        made[6:12] = bytes(6)
    return "x" + made.hex()


def sb_calls(w: Writer) -> None:
    """Pipes, subscriptions, packets."""
    w.add("SB_CreatePipe", w.slot("pipe"), w.one((0, 1, 2, 5, 50, 51, 255)), w.name(), task=w.task())
    for _ in range(4):
        msg_id, pipe = w.one(MSG_IDS), w.id("pipe")
        call = w.one(("SB_Subscribe", "SB_SubscribeEx", "SB_SubscribeLocal", "SB_Unsubscribe", "SB_UnsubscribeLocal"))
        more = {"SB_SubscribeEx": (0, 0, w.one((0, 1, 4, 65535))), "SB_SubscribeLocal": (w.one((0, 1, 4, 50)),)}
        w.add(call, msg_id, pipe, *more.get(call, ()), task=w.task())
    for _ in range(3):
        w.add("SB_TransmitMsg", packet(w), 0, task=w.task())
        w.add("SB_ReceiveBuffer", w.id("pipe"), w.one((0, 0, 0, 2, -2)), task=w.task())
    w.add("SB_SetPipeOpts", w.id("pipe"), w.one((0, 1, 2, 255)), task=w.task())
    w.add("SB_GetPipeOpts", w.id("pipe"), task=w.task())
    w.add("SB_GetPipeName", w.id("pipe"))
    w.add("SB_GetPipeIdByName", w.slot("pipe"), w.name())
    w.add("SB_PipeId_ToIndex", w.id("pipe"))
    w.add("SB_IsValidMsgId", w.num())
    if w.random.random() < 0.6:
        w.add("SB_DeletePipe", w.id("pipe"), task=w.task())
    buffer = w.one(SLOT_OF["buffer"])
    w.add("SB_AllocateMessageBuffer", buffer, w.one((1, 20, 1000, 2000, 100000)))
    w.add("SB_ReleaseMessageBuffer", buffer)
    topic = w.one((0, 1, 0x7F, 0x80, 0xFF))
    w.add(w.one(("SB_CmdTopicIdToMsgId", "SB_TlmTopicIdToMsgId")), topic, w.one((1, 2, 3)))
    w.add(w.one(("SB_GlobalCmdTopicIdToMsgId", "SB_LocalTlmTopicIdToMsgId")), topic)


def tbl_calls(w: Writer) -> None:
    """Tables."""
    options = w.one((0, 0, 1, 2, 4, 8, 16, 32, 3, 6))
    size = w.one((0, 1, 4, 16, 100, 16384, 16385, 40000))
    w.add("TBL_Register", w.slot("table"), quote(w.one((*CDS_NAMES[:4], "", "M" * 17))), size, options, w.one((0, 1)),
          task=w.one("AAAB"))  # fmt: skip
    w.add("TBL_Share", w.slot("table"), quote(w.one(("API.A", "API.B", "API_AUX.A", "A", "", "M" * 50))), task=w.task())
    for _ in range(5):
        table = f"${w.one(SLOT_OF['table'])}"
        call = w.one(("LoadAddress", "LoadAddress", "GetAddress", "ReleaseAddress", "Update", "Validate", "Manage",
                      "Modified", "GetStatus", "DumpToBuffer", "NotifyByMessage", "LoadFile"))  # fmt: skip
        more = {
            "LoadAddress": (w.one(("x00112233", "xee", "xdd", "x", "x01")),),
            "GetAddress": (1,),
            "NotifyByMessage": (w.one((0x1890, 0x1891, 0x1FFF)), w.one((0, 1, 127)), w.num()),
            "LoadFile": (quote(w.one(("/cf/none.tbl", "", "x"))),),
        }
        w.add(f"TBL_{call}", table, *more.get(call, ()), task=w.task())
    w.add("TBL_GetInfo", quote(w.one(("API.A", "API.B", "API_AUX.A", "A", "", "API.SIXTEEN_LETTERS_"))))
    if w.random.random() < 0.5:
        w.add("TBL_Unregister", f"${w.one(SLOT_OF['table'])}", task=w.task())


def time_calls(w: Writer) -> None:
    """Times."""
    four = [w.num() for _ in range(4)]
    w.add("TIME_Add", *four)
    w.add("TIME_Subtract", *four)
    w.add("TIME_Compare", *four)
    w.add("TIME_Compare", *four[:2], *four[:2])
    w.add("TIME_MET2SCTime", *four[:2])
    w.add("TIME_Sub2MicroSecs", four[0])
    w.add("TIME_Micro2SubSecs", four[1])
    w.add("TIME_Print", min(four[2], 0xEC000000), four[3])
    w.add("TIME_Settings")
    if w.random.random() < 0.3:
        w.add(w.one(("TIME_RegisterSynchCallback", "TIME_UnregisterSynchCallback")), w.one((0, 1)), task=w.one("AB"))
    if w.random.random() < 0.02:
        w.add("TIME_SynchCallbacksCame")


def msg_calls(w: Writer) -> None:
    """Headers and file names."""
    for _ in range(6):
        data = w.bytes(w.one((16, 17, 40)))
        field = w.one(("Size", "Type", "HeaderVersion", "HasSecondaryHeader", "ApId", "SegmentationFlag",
                       "SequenceCount", "FcnCode", "MsgId"))  # fmt: skip
        w.add(f"MSG_Get{field}", data)
        edges = {"Type": (0, 1, 2, 3), "SegmentationFlag": (0, 1, 0x4000, 0x8000, 0xC000, 0xFFFF, 0x10000),
                 "HasSecondaryHeader": (0, 1), "HeaderVersion": (0, 1, 7, 8, 255),
                 "ApId": (0, 1, 0x7FF, 0x800, 0xFFFF), "SequenceCount": (0, 0x3FFF, 0x4000, 0xFFFF),
                 "FcnCode": (0, 1, 127, 128, 255), "MsgId": MSG_IDS, "Size": (0, 6, 7, 0x10006, 0x10007)}  # fmt: skip
        w.add(f"MSG_Set{field}", data, w.one(edges[field]))
    data = w.bytes(16)
    w.add("MSG_GetMsgTime", data)
    w.add("MSG_SetMsgTime", data, w.num(), w.num())
    w.add("MSG_GetTypeFromMsgId", w.one(MSG_IDS))
    w.add("MSG_GetNextSequenceCount", w.one((0, 1, 0x3FFE, 0x3FFF, 0x4000, 0xFFFF)))
    w.add("MSG_Init", w.one(MSG_IDS), w.one((7, 8, 12, 16, 100, 6)))
    command = bytes(msg.command(0x1890, 3, b"abcdefgh"))
    w.add("MSG_ValidateChecksum", packet(w) + "00" * 8)
    w.add("MSG_GenerateChecksum", w.one((packet(w) + "00" * 8, "x" + command.hex())))
    text, most = "s" * w.one((0, 1, 9, 10, 11)), w.one((1, 5, 10, 11))
    w.add("SB_MessageStringSet", quote(text), most)
    w.add("SB_MessageStringGet", "x" + text.encode().ljust(12, b"\0").hex(), most, *w.one(((), (quote("default"),))))
    names = ("a", "a.b", "/x/a", "/x/a.b", "", "/", "a/", "n" * 70, ".x", "/ram/" + "n" * 60, "/a/b/c.d.e", "//a")
    w.add("FS_ParseInputFileName", quote(w.one(names)), w.one((0, 1, 2, 3, 4, 5, 6, 99)), w.one((64, 10, 1)))
    defaults = quote(w.one(names)), quote(w.one(("", "/ram", "/cf/", "x"))), quote(w.one(("", ".dat", "log")))
    w.add("FS_ParseInputFileNameEx", quote(w.one(names)), *defaults, w.one((64, 10, 1)))
    w.add("FS_ExtractFilenameFromPath", quote(w.one(names)))
    w.add("FS_Defaults", w.one((0, 1, 2, 3, 4, 5, 6, 99)))


def osal_calls(w: Writer) -> None:
    """Objects of OSAL."""
    w.one((queue_calls, semaphore_calls, lock_calls, timer_calls, file_calls, path_calls, clock_calls, os_task_calls))(
        w
    )


def queue_calls(w: Writer) -> None:
    """Add calls of queues. Their names differ from those of pipes."""
    queue = w.one(("Q_A", "Q_B", "Q_C", "Q" * 19, "Q" * 20))
    w.add("OS_QueueCreate", w.slot("queue"), quote(queue), w.one((0, 1, 2, 50, 51)), w.one((0, 1, 4, 100)), 0)
    w.add("OS_QueueGetIdByName", w.slot("queue"), quote(queue))
    for _ in range(3):
        w.add("OS_QueuePut", w.id("queue"), w.bytes(w.one((1, 4, 5, 100))), task=w.task())
        w.add("OS_QueueGet", w.id("queue"), 200, w.one((0, 0, 3)), task=w.task())
    w.add("OS_QueueGetInfo", w.id("queue"))
    w.add("OS_QueueDelete", w.id("queue"))


def semaphore_calls(w: Writer) -> None:
    """Binary and counting semaphores."""
    kind, stem = w.one((("bin", "BinSem"), ("count", "CountSem")))
    w.add(f"OS_{stem}Create", w.slot(kind), w.name(), w.one((0, 1, 2, 5, 0x7FFFFFFF, 0x80000000)), 0)
    w.add(f"OS_{stem}GetIdByName", w.slot(kind), w.name())
    w.add(f"OS_{stem}TimedWait", w.id(kind), w.one((0, 2)), task=w.task())
    same = w.id(kind)
    w.add(f"OS_{stem}Give", same, task=w.task())
    w.add(f"OS_{stem}Take", same)
    w.add(f"OS_{stem}Give", w.id(kind))
    w.add(f"OS_{stem}GetInfo", w.id(kind))
    if kind == "bin":
        w.add("OS_BinSemFlush", w.id(kind))
    w.add(f"OS_{stem}Delete", w.id(kind))


def lock_calls(w: Writer) -> None:
    """Mutexes, condition variables, reader-writer locks."""
    for kind, stem in (("mutex", "MutSem"), ("cond", "CondVar"), ("rw", "RwLock")):
        names = [quote(each) for each in NAMES if kind != "mutex" or each not in FEW]
        w.add(f"OS_{stem}Create", w.slot(kind), w.one(names), 0)
        w.add(f"OS_{stem}GetIdByName", w.slot(kind), w.name())
        w.add(f"OS_{stem}GetInfo", w.id(kind))
        if w.random.random() < 0.5:
            w.add(f"OS_{stem}Delete", w.id(kind))
    same = w.id("mutex")
    w.add("OS_MutSemTake", same)
    w.add("OS_MutSemGive", same, task=w.one("AAC"))
    w.add("OS_MutSemGive", same)
    same = w.id("cond")
    w.add("OS_CondVarSignal", w.id("cond"))
    w.add("OS_CondVarBroadcast", w.id("cond"))
    w.add("OS_CondVarLock", same)
    w.add("OS_CondVarTimedWait", same, w.one((0, 3)))
    w.add("OS_CondVarUnlock", same)
    same, way = w.id("rw"), w.one(("Read", "Write"))
    w.add(f"OS_RwLock{way}Take", same)
    w.add(f"OS_RwLock{way}Give", same)


def timer_calls(w: Writer) -> None:
    """Timers and time bases."""
    w.add("OS_TimeBaseCreate", w.slot("base"), w.name(), 0)
    w.add("OS_TimeBaseSet", w.id("base"), w.one((0, 1000, 10000, 2**31)), w.one((0, 10000, 2**31)))
    w.add("OS_TimeBaseGetIdByName", w.slot("base"), w.name())
    w.add("OS_TimeBaseGetInfo", w.id("base"))
    w.add("OS_TimeBaseGetFreeRun", w.id("base"))
    if w.random.random() < 0.5:
        w.add("OS_TimerCreate", w.slot("timer"), w.name())
    else:
        w.add("OS_TimerAdd", w.slot("timer"), w.name(), w.id("base"))
    w.add("OS_TimerGetIdByName", w.slot("timer"), w.name())
    w.add("OS_TimerSet", w.id("timer"), w.one((0, 100000000, 2**31)), w.one((0, 100000000, 2**31)))
    w.add("OS_TimerGetInfo", w.id("timer"))
    if w.random.random() < 0.1:
        w.add("OS_TimerFires", w.id("timer"), 20000, w.one((0, 20000)))
    w.add("OS_TimerDelete", w.id("timer"))
    w.add("OS_TimeBaseDelete", w.id("base"))


def file_calls(w: Writer) -> None:
    """Files."""
    file = w.slot("file")
    w.add("OS_OpenCreate", file, quote(w.one(FILES)), w.one((0, 1, 2, 3)), w.one((0, 1, 2)))
    for _ in range(4):
        which = w.id("file")
        call = w.one(("OS_read", "OS_write", "OS_lseek", "OS_TimedRead", "OS_TimedWrite", "OS_FileTruncate",
                      "OS_FDGetInfo", "FS_Header", "FS_ReadHeader", "FS_SetTimestamp"))  # fmt: skip
        more = {
            "OS_read": (w.one((0, 1, 10, 100)),),
            "OS_write": (w.bytes(w.one((1, 10, 64))),),
            "OS_lseek": (w.one((0, 1, 10, 100, -1, -1000)), w.one((0, 1, 2, 3))),
            "OS_TimedRead": (w.one((1, 10)), 5),
            "OS_TimedWrite": (w.bytes(10), 5),
            "OS_FileTruncate": (w.one((0, 5, 100)),),
            "FS_Header": (quote("d" * w.one((0, 1, 31, 32, 40))), w.num()),
            "FS_SetTimestamp": (w.num(), w.num()),
        }
        w.add(call, which, *more.get(call, ()))
    w.add("OS_FileOpenCheck", quote(w.one(PATHS)))
    if w.random.random() < 0.8:
        w.add("OS_close", w.id("file"))
    if w.random.random() < 0.1:
        w.add("OS_CloseFileByName", quote(w.one(PATHS)))
    if w.random.random() < 0.05:
        w.add("FS_BackgroundFileDump", quote(w.one(("/ram/dump.dat", "/no/x", ""))), 5)


def path_calls(w: Writer) -> None:
    """Paths and folders."""
    first, second = quote(w.one(PATHS)), quote(w.one(PATHS))
    w.add("OS_stat", first)
    w.add(w.one(("OS_cp", "OS_mv", "OS_rename")), quote(w.one(FILES[:8])), quote(w.one(FILES[:8])))
    w.add("OS_remove", second)
    w.add("OS_chmod", first, 2)  # the real one runs as root, who may read and write despite the permissions
    w.add("OS_mkdir", quote(w.one(MADE)), 2)
    w.add("OS_rmdir", quote(w.one(MADE)))
    w.add("OS_DirectoryOpen", w.slot("dir"), quote(w.one(FOLDERS)))
    w.add("OS_DirectoryRewind", w.id("dir"))
    w.add("OS_DirectoryClose", w.id("dir"))
    w.add("OS_TranslatePath", first)
    w.add("OS_FS_GetPhysDriveName", quote(w.one(FOLDERS)))


def clock_calls(w: Writer) -> None:
    """Arithmetic of times, ids, statuses, texts."""
    w.add(
        "OS_Clock", w.one((0, 1, -1, 99, 100, 10**9, -(10**9), 10**17 + 12345)), w.random.randrange(-(10**15), 10**15)
    )
    w.add("OS_Clock", w.random.randrange(-(10**17), 10**17), w.random.randrange(-(10**15), 10**15))
    w.add("OS_Assemble", w.one((0, 1, -1, 1000, 123456)), w.num())
    w.add("OS_HeapGetInfo")
    kind = w.one(("queue", "mutex", "bin", "timer", "file", "task", "rw"))
    w.add("OS_GetResourceName", w.id(kind))
    w.add("OS_IdentifyObject", w.id(kind))
    w.add("OS_ConvertToArrayIndex", w.id(kind))
    w.add("OS_ObjectIdToArrayIndex", w.one((0, 1, 2, 3, 5, 99)), w.id(kind))
    w.add("OS_ForEachObjectOfType", w.one((3, 4, 0xD, 0xE)))
    w.add("OS_GetErrorName", w.one(STATUSES))
    w.add("OS_StatusToString", w.one(STATUSES))
    w.add("OS_strnlen", quote("s" * w.one(EDGES[:12])), w.one((0, 1, 10, 300)))
    w.add("OS_SelectSingle", w.id("file"), w.one((0, 4, 8, 12)), 2)


def os_task_calls(w: Writer) -> None:
    """Tasks of OSAL."""
    w.add("OS_TaskGetId", task=w.task())
    w.add("OS_TaskGetIdByName", w.slot("ostask"), quote(w.one(("API", "API_CHILD", "NO", "N" * 30))))
    w.add("OS_TaskGetInfo", w.id("ostask"))
    w.add("OS_TaskSetPriority", w.one((0, 0x1FFFF, 0x20001)), w.one((0, 255)))
    w.add("OS_TaskDelete", w.one((0, 0x1FFFF, 0x20001)))
    w.add("OS_TaskCreate", w.slot("ostask"), w.one((quote(LONG + "N"), quote("API"))), 4096, 50, 0)
    w.add("OS_TaskDelay", w.one((0, 1)))


def psp_calls(w: Writer) -> None:
    """The PSP."""
    w.add("PSP_Ids")
    w.add("PSP_Times")
    w.add("PSP_ReadFromCDS", w.num(), w.one((0, 1, 100, 60000)))
    w.add("PSP_GetCDSSize")
    w.add("PSP_Areas")
    w.add("PSP_MemRanges")
    w.add("PSP_MemRangeGet", w.one((0, 1, 10, 99)))
    w.add(
        "PSP_MemRangeSet", w.one((3, 10, 99)), w.one((1, 2, 3, 4)), 0x1000, 64, w.one((1, 2, 3, 4)), w.one((1, 2, 3, 4))
    )
    w.add("PSP_MemValidateRange", 0x1000, 1, w.one((4, 5)))
    w.add("PSP_Exceptions", w.num())
    w.add("PSP_PortRead", w.num())
    w.add("PSP_Eeprom", w.one((0, 1)))
    w.add("PSP_Watchdog", w.num())
    w.add("PSP_StatusToString", w.one(STATUSES))


GROUPS = (es_calls, es_calls, evs_calls, sb_calls, sb_calls, tbl_calls, time_calls, msg_calls, osal_calls, osal_calls,
          osal_calls, psp_calls, debug_calls, buffer_calls, notification_calls)  # fmt: skip


KINDS = {"usual": GROUPS, "wrong": WRONG_GROUPS}
"""The kinds of scripts: programs that are mostly right, and wrong ones."""


def write_script(seed: int, count: int, kind: str = "usual") -> list[str]:
    """Return a script of `count` calls of one of `KINDS`."""
    w = Writer(seed)
    while len(w.lines) < count:
        w.one(KINDS[kind])(w)
    return w.lines[:count]
