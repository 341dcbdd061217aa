"""Lines that are typed or piped in, read without blocking the caller."""

from __future__ import annotations

import queue
import threading
from typing import TextIO


class TypedLines:
    """Reads a stream in a thread of its own, which ends with the process.

    Args:
        stream: stream of lines.

    Attributes:
        at_end: whether all lines have been taken, and no more will come.
    """

    def __init__(self, stream: TextIO) -> None:
        self.at_end = False
        self._stream = stream
        self._queue: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        threading.Thread(target=self._read, name="cfepy typed lines", daemon=True).start()

    def next(self, timeout_s: float) -> str | None:
        """Return the next line without its newline; None if none came in so many s of wall time, or none will come."""
        if self.at_end:
            return None
        try:
            line = self._queue.get(timeout=timeout_s)
        except queue.Empty:
            return None
        self.at_end = line is None
        return line

    def _read(self) -> None:
        try:
            for line in self._stream:
                self._queue.put(line.rstrip("\r\n"))
        except (OSError, ValueError):  # there is nothing to read from
            pass
        self._queue.put(None)
