"""Memory that outlives a reset: the boot record, the reset area, the CDS, the user reserved area, and the EEPROM.

The mission keeps one `Retained` for each simulated processor and passes it to the `Psp` of every boot. It models the
shared memory segments of NASA's Linux PSP (cfe_psp_memory.c).
"""

from __future__ import annotations

from typing import Any

from cfepy.psp.exceptions import ExceptionStorage

RESET_AREA_BYTES = 16384
CDS_BYTES = 131072
USER_RESERVED_BYTES = 1048576
EEPROM_BYTES = 0x80000


class Retained:
    """Areas of bytes, and objects of services whose reset data are not bytes here.

    Args:
        reset_bytes: size of the reset area.
        cds_bytes: size of the critical data store.
        user_bytes: size of the user reserved area.
        eeprom_bytes: size of the EEPROM, which outlives a power-on reset too.
    """

    def __init__(
        self,
        reset_bytes: int = RESET_AREA_BYTES,
        cds_bytes: int = CDS_BYTES,
        user_bytes: int = USER_RESERVED_BYTES,
        eeprom_bytes: int = EEPROM_BYTES,
    ) -> None:
        self.reset_area: bytearray | memoryview = bytearray(reset_bytes)
        self.cds = bytearray(cds_bytes)
        self.user_reserved: bytearray | memoryview = bytearray(user_bytes)
        self.eeprom: bytearray | memoryview = bytearray(eeprom_bytes)
        self.exceptions = ExceptionStorage()
        self.kept: dict[str, Any] = {}  # by service: system log, event log, reset counters
        self.next_reset_type = 0  # 0 if no reset type was recorded
        self.next_subtype = 0  # subtype of a hardware reset, 0 if software caused the reset
        self.exited = False  # whether the last run ended by a restart

    def clear(self) -> None:
        """Clear all areas except the EEPROM for a power-on reset, in place, for code that holds references to them."""
        for area in (self.reset_area, self.cds, self.user_reserved):
            blank = bytes(len(area))
            if bytes(area) != blank:  # an area that was never written uses no memory of the host and should stay so
                area[:] = blank
        self.exceptions.clear()
        self.kept.clear()
