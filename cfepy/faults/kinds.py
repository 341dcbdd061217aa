"""The kinds of faults: what each strikes, which options it takes, and which it needs. Imports nothing of cfepy."""

from __future__ import annotations

from dataclasses import dataclass

WINDOW = ("after", "until", "number", "every", "probability", "count")
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
"""What a fault strikes."""

SIGNALS = ("1hz", "tone")
MEMORIES = ("cds", "eeprom", "reset_area", "user_reserved")
RESETS = ("processor", "poweron", "exception", "watchdog")
CLOCKS = ("all", "cfe", "ros")
UNITS = ("message", "segment")
CHECKSUMS = ("keep", "fix")

APP_OPTIONS = ("from", "to", "app")
"""Options that name an application; `to` may be a pipe, too."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of fault.

    Attributes:
        strikes: what its target is.
        options: the options it takes beside `name`.
        needed: those of which it needs at least one.
        text: what it does.
    """

    strikes: str
    options: tuple[str, ...]
    text: str
    needed: tuple[str, ...] = ()


_MESSAGE = (*OCCASIONS, "from", "to", "unit")
_APP = (*OCCASIONS, "message")

KINDS: dict[str, Kind] = {
    "drop": Kind(MESSAGE, _MESSAGE, "a message gets lost"),
    "duplicate": Kind(MESSAGE, (*_MESSAGE, "copies"), "a message comes more than once"),
    "delay": Kind(MESSAGE, (*_MESSAGE, "by"), "a message comes later", ("by",)),
    "reorder": Kind(MESSAGE, (*_MESSAGE, "past", "within"), "a message comes after later ones"),
    "corrupt": Kind(MESSAGE, (*_MESSAGE, "bits", "bytes", "fields", "checksum"), "a message comes changed"),
    "crash": Kind(APP, _APP, "an exception comes out of the application's next call", OCCASIONS),
    "hang": Kind(APP, (*_APP, "for"), "the application does not come back from its next call", OCCASIONS),
    "slow": Kind(APP, ("after", "until", "times", "extra"), "its calls take more CPU time", ("times", "extra")),
    "stop": Kind(APP, _APP, "the application is ended", OCCASIONS),
    "restart": Kind(APP, _APP, "the application is started anew", OCCASIONS),
    "fill": Kind(PIPE, ("at", "for"), "the pipe takes no message", ("at",)),
    "jump_clock": Kind(SECONDS, ("at", "clock"), "the spacecraft clock jumps by so many seconds", ("at",)),
    "drift_clock": Kind(PPM, ("after", "until", "clock"), "the spacecraft clock runs wrong by so many ppm"),
    "lose_1hz": Kind(SIGNAL, OCCASIONS, "the 1 Hz signal or the tone does not come"),
    "corrupt_file": Kind(FILE, ("at", "bits", "bytes"), "a file of the virtual file system is changed"),
    "corrupt_table": Kind(TABLE, ("at", "bits", "bytes"), "the active image of a table is changed", ("at",)),
    "corrupt_memory": Kind(MEMORY, ("at", "block", "bits", "bytes"), "retained memory is changed", ("at",)),
    "fail": Kind(CALL, (*OCCASIONS, "app", "object", "status"), "a call of cFE, OSAL or PSP fails"),
    "reset": Kind(RESET, ("at",), "the processor is reset", ("at",)),
}
