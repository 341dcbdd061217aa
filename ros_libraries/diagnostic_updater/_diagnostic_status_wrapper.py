"""`DiagnosticStatusWrapper`: the message DiagnosticStatus with functions that fill it in."""

from __future__ import annotations

from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

OK: int = DiagnosticStatus.OK
WARN: int = DiagnosticStatus.WARN
ERROR: int = DiagnosticStatus.ERROR


class DiagnosticStatusWrapper(DiagnosticStatus):  # type: ignore[misc]  # the message class is made at run time
    """A DiagnosticStatus; takes the same arguments and can be published as one."""

    def summary(self, *args: Any) -> None:
        """Set level and message: `summary(status)` or `summary(level, message)`."""
        self.level, self.message = _level_and_text(args)

    def clearSummary(self) -> None:
        """Set level OK and an empty message."""
        self.summary(OK, "")

    def mergeSummary(self, *args: Any) -> None:
        """Merge another level and message, given as in `summary`.

        The worse level stays. If both levels are good or both are bad, their messages are joined by "; ". Otherwise the
        bad one's message stays.
        """
        level, text = _level_and_text(args)
        if (level > OK) == (self.level > OK):
            self.message = f"{self.message}; {text}" if self.message else text
        elif level > self.level:
            self.message = text
        self.level = max(self.level, level)

    def add(self, key: str, val: Any) -> None:
        """Add a value, converted to text by `str`."""
        self.values.append(KeyValue(key, str(val)))


def _level_and_text(args: tuple[Any, ...]) -> tuple[int, str]:
    if len(args) == 1:
        return args[0].level, args[0].message
    level, text = args
    return level, str(text)
