"""Allowed differences between a recorded packet of the real cFE and ours: fields and reasons. All other bits are equal.

The time in a packet's header is masked everywhere. So is the sequence count of event packets, because the recorded
TIME kept entering and leaving flywheel mode, with two events each.
"""

from __future__ import annotations

TIME = "a time or a latch of one; a real processor needs time for its work"
ADDRESS = "an address in a C process"
BUILD = "made from the C build"
FLYWHEEL = "the recorded TIME fell into flywheel mode again and again, with two events each"
START = (
    "the recorded applications started on several processor cores, so TO_LAB subscribed to events before two of them"
)
PHASE = "counts the tones so far; the recorded clock stepped back at the first one, and lost some to flywheel mode"
MEMORY = "waiting messages are counted here, the packet that is being worked on and CI_LAB's empty buffer are not"
WAITING = "how many packets waited at an instant that is not the recorded one to the microsecond"
MASK = "the real housekeeping copies one bit of a word and forgets the others; that fault is not copied"

BUILD_EVENT = "Build "
"""How the only masked event text begins."""

LATCHES = ("AtToneLatch", "CurrentLatch", "ToneSignalLatch", "ToneDataLatch")
CLOCKS = ("CurrentMET", "CurrentTAI", "CurrentUTC")

MASKED: dict[str, dict[str, str]] = {
    "CFE_TBL_HK_TLM": {"LastUpdateTime.Subseconds": TIME},
    "CFE_EVS_HK_TLM": {
        "MessageSendCounter": FLYWHEEL,
        "LogOverflowCounter": FLYWHEEL,
        "AppData[3].AppMessageSentCounter": FLYWHEEL,
    },
    "CFE_SB_HK_TLM": {"NoSubscribersCounter": START, "MemInUse": MEMORY, "UnmarkedMem": MEMORY},
    "CFE_TIME_HK_TLM": {"ClockStateFlags": FLYWHEEL, "MET.Seconds": TIME, "MET.Subseconds": TIME},
    "CFE_ES_HK_TLM": {"CFECoreChecksum": BUILD, **{f"PerfFilterMask[{word}]": MASK for word in range(4)}},
    "CFE_ES_APP_TLM": {"StartAddress": ADDRESS},
    "CFE_SB_STATS_TLM": {
        "MemInUse": MEMORY,
        "PeakMemInUse": MEMORY,
        "PeakSBBuffersInUse": MEMORY,
        "PipeDepthStats[8].CurrentQueueDepth": WAITING,
        "PipeDepthStats[8].PeakQueueDepth": WAITING,
    },
    "CFE_TBL_REG_TLM": {
        "ActiveBufferAddr": ADDRESS,
        "ValidationFuncPtr": ADDRESS,
        "TimeOfLastUpdate.Subseconds": TIME,
    },
    "CFE_TIME_DIAG_TLM": {
        **{f"{name}.Seconds": TIME for name in ("AtToneMET", *LATCHES, *CLOCKS)},
        **{f"{name}.Subseconds": TIME for name in ("TimeSinceTone", *LATCHES, *CLOCKS)},
        **{f"Tone{name}Counter": PHASE for name in ("Match", "Signal", "Data", "Int", "IntError", "Task")},
        "VersionCounter": PHASE,
        "VirtualMET": PHASE,
    },
}
