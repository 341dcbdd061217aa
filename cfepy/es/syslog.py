"""The system log of Executive Services (cfe_es_syslog.c): a small text buffer that survives a processor reset."""

from __future__ import annotations

from cfepy.console import Console
from cfepy.ports import Ports

OVERWRITE = 0
DISCARD = 1


class SystemLog:
    """Lines with a time stamp in a buffer of fixed size, also shown on the console.

    Args:
        ports: for the time.
        console: where lines are shown.
        size: bytes of the buffer.
    """

    def __init__(self, ports: Ports, console: Console, size: int) -> None:
        self.ports = ports
        self.console = console
        self.size = size
        self.mode = OVERWRITE
        self.entries: list[str] = []
        self.bytes_used = 0

    def write_to_sys_log(self, text: str) -> None:
        """Add a line (CFE_ES_WriteToSysLog).

        When the buffer is full, OVERWRITE gives up the oldest lines, DISCARD the new one. A line longer than half the
        buffer is cut.
        """
        line = f"{self.ports.time.text()} {text.rstrip()}"[: self.size // 2]
        self.console.write(line)
        self.append(line + "\n")

    def append(self, line: str) -> None:
        """Put a finished line into the buffer."""
        length = _size(line)
        if self.mode == DISCARD and self.bytes_used + length > self.size:
            return
        self.entries.append(line)
        self.bytes_used += length
        while self.bytes_used > self.size:
            self.bytes_used -= _size(self.entries.pop(0))

    def clear(self) -> None:
        """Forget all lines (CFE_ES_SysLogClear)."""
        self.entries.clear()
        self.bytes_used = 0

    def text(self) -> str:
        """Everything in the buffer."""
        return "".join(self.entries)


def _size(line: str) -> int:
    return len(line.encode("utf-8", "backslashreplace"))
