"""The system log of Executive Services (cfe_es_syslog.c): a small text buffer that survives a processor reset."""

from __future__ import annotations

from cfepy.config.platform import PlatformConfig
from cfepy.es.reset_data import DISCARD, OVERWRITE, SysLogData
from cfepy.ports import Ports
from cfepy.reading.texts import to_bytes, without_addresses
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_SYS_LOG_FULL,
    CFE_ES_ERR_SYS_LOG_TRUNCATED,
    CFE_SUCCESS,
    CfeError,
)
from cfepy.writing.console import Console

TIME_TEXT_SIZE = 24  # CFE_TIME_PRINTED_STRING_SIZE: a printed time and its NUL


class SystemLog:
    """Lines with a time stamp in a buffer of fixed size, also shown on the console.

    Args:
        ports: provides the time.
        console: prints the lines.
        config: sizes.
    """

    def __init__(self, ports: Ports, console: Console, config: PlatformConfig) -> None:
        self._ports = ports
        self._console = console
        self._max_line = config.evs_max_message_length + TIME_TEXT_SIZE
        self.data = SysLogData(bytearray(config.es_system_log_size))

    @property
    def size(self) -> int:
        """Bytes of the buffer."""
        return len(self.data.memory)

    def write_to_sys_log(self, text: str) -> int:
        """Add a line (CFE_ES_WriteToSysLog).

        If the line does not fit, OVERWRITE continues at the start of the buffer, over the oldest lines. DISCARD
        truncates the line, and refuses lines once there is no room for a time stamp. At most 146 bytes of a line are
        kept, including the stamp.

        Returns:
            CFE_SUCCESS, or CFE_ES_ERR_SYS_LOG_TRUNCATED or CFE_ES_ERR_SYS_LOG_FULL if the line is not complete.
        """
        line = to_bytes(f"{self._ports.time.text()} {without_addresses(text)}")[: self._max_line].rstrip()
        status = self._append(line + b"\n")
        self._console.write(line.decode("utf-8", "replace"))
        return status

    def _append(self, line: bytes) -> int:
        log, size = self.data, len(self.data.memory)
        length, begin, status = len(line), log.write_index, CFE_SUCCESS
        if length > size // 2:
            length, status = size // 2, CFE_ES_ERR_SYS_LOG_TRUNCATED
        if begin + length > size:
            if log.mode == OVERWRITE:
                log.end_index, begin = begin, 0
            elif begin < size - TIME_TEXT_SIZE:
                length, status = size - begin, CFE_ES_ERR_SYS_LOG_TRUNCATED
            else:
                return CFE_ES_ERR_SYS_LOG_FULL
        log.write_index = begin + length
        log.memory[begin : log.write_index] = line[: length - 1] + b"\n"
        log.end_index = max(log.end_index, log.write_index)
        log.entries += 1
        return status

    def set_mode(self, mode: int) -> None:
        """Set the mode, OVERWRITE or DISCARD (CFE_ES_SysLogSetMode); raises CFE_ES_BAD_ARGUMENT for any other."""
        if mode not in (OVERWRITE, DISCARD):
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"invalid system log mode {mode}")
        self.data.mode = mode

    def clear(self) -> None:
        """Remove all lines (CFE_ES_SysLogClear)."""
        self.data.write_index = self.data.end_index = self.data.entries = 0

    def read(self) -> bytes:
        """Return the text, the oldest line first, without a line that was partly overwritten."""
        log = self.data
        rest = bytes(log.memory[log.write_index : log.end_index])
        whole = rest.partition(b"\n")[2]
        return whole + bytes(log.memory[: log.write_index])
