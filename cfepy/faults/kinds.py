"""The kinds of faults: their targets, their options, and the required options."""

from __future__ import annotations

from dataclasses import dataclass

WINDOW = ("after", "until", "number", "every", "probability", "count", "explored")
OCCASIONS = ("at", *WINDOW)

MESSAGE, APP, PIPE, SECONDS, PPM, SIGNAL, FILE, TABLE, MEMORY, CALL, RESET = (
    "message",
    "app",
    "pipe",
    "seconds",
    "ppm",
    "signal",
    "file",
    "table",
    "memory",
    "call",
    "reset",
)
"""Target of a fault."""

SIGNALS = ("1hz", "tone")
MEMORIES = ("cds", "eeprom", "reset_area", "user_reserved")
RESETS = ("processor", "poweron", "exception", "watchdog")
CLOCKS = ("all", "cfe", "ros")
UNITS = ("message", "segment")
CHECKSUMS = ("keep", "fix")

APP_OPTIONS = ("from", "to", "app")
"""Options that name an application; `to` may also be a pipe."""


@dataclass(frozen=True, slots=True)
class FaultKind:
    """A kind of fault.

    Attributes:
        strikes: kind of its target.
        options: options it takes in addition to `name`.
        needed: options of which it needs at least one.
        text: its description.
    """

    strikes: str
    options: tuple[str, ...]
    text: str
    needed: tuple[str, ...] = ()


_MESSAGE = (*OCCASIONS, "from", "to", "unit")
_APP = (*OCCASIONS, "message")

KINDS: dict[str, FaultKind] = {
    "drop": FaultKind(MESSAGE, _MESSAGE, "a message gets lost"),
    "duplicate": FaultKind(MESSAGE, (*_MESSAGE, "copies"), "a message comes more than once"),
    "delay": FaultKind(MESSAGE, (*_MESSAGE, "by"), "a message comes later", ("by",)),
    "reorder": FaultKind(MESSAGE, (*_MESSAGE, "past", "within"), "a message comes after later ones"),
    "corrupt": FaultKind(MESSAGE, (*_MESSAGE, "bits", "bytes", "fields", "checksum"), "a message comes changed"),
    "crash": FaultKind(APP, _APP, "an exception comes out of the application's next call", OCCASIONS),
    "hang": FaultKind(APP, (*_APP, "for"), "the application does not come back from its next call", OCCASIONS),
    "slow": FaultKind(APP, ("after", "until", "times", "extra"), "its calls take more CPU time", ("times", "extra")),
    "compute": FaultKind(APP, (*_APP, "task", "for", "times"), "its work takes longer", ("for", "times")),
    "stop": FaultKind(APP, _APP, "the application is ended", OCCASIONS),
    "restart": FaultKind(APP, _APP, "the application is started anew", OCCASIONS),
    "fill": FaultKind(PIPE, ("at", "for"), "the pipe takes no message", ("at",)),
    "jump_clock": FaultKind(SECONDS, ("at", "clock"), "the spacecraft clock jumps by so many seconds", ("at",)),
    "drift_clock": FaultKind(PPM, ("after", "until", "clock"), "the spacecraft clock runs wrong by so many ppm"),
    "lose_1hz": FaultKind(SIGNAL, OCCASIONS, "the 1 Hz signal or the tone does not come"),
    "corrupt_file": FaultKind(FILE, ("at", "bits", "bytes"), "a file of the virtual file system is changed"),
    "corrupt_table": FaultKind(TABLE, ("at", "bits", "bytes"), "the active image of a table is changed", ("at",)),
    "corrupt_memory": FaultKind(MEMORY, ("at", "block", "bits", "bytes"), "retained memory is changed", ("at",)),
    "fail": FaultKind(CALL, (*OCCASIONS, "app", "object", "status"), "a call of cFE, OSAL or PSP fails"),
    "reset": FaultKind(RESET, ("at", "after", "until", "explored"), "the processor is reset", ("at", "explored")),
}
