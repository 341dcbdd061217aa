"""What a simulated board does not have, like NASA's Linux PSP: I/O ports, caches, write protection, a recorder.

The names are there, and say CFE_PSP_ERROR_NOT_IMPLEMENTED, so that an app that handles this there handles it here. May
import cfepy.status only.
"""

from __future__ import annotations

from cfepy.status import CFE_PSP_ERROR_NOT_IMPLEMENTED, OsalError


def _absent(*_: object) -> int:
    """Not on this board.

    Raises:
        OsalError: CFE_PSP_ERROR_NOT_IMPLEMENTED, always.
    """
    raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "this board has no such hardware")


class AbsentHardware:
    """The functions of the PSP that end in CFE_PSP_ERROR_NOT_IMPLEMENTED."""

    port_read8 = port_read16 = port_read32 = staticmethod(_absent)
    port_write8 = port_write16 = port_write32 = staticmethod(_absent)
    eeprom_write_enable = eeprom_write_disable = staticmethod(_absent)
    get_kernel_text_segment_info = get_cfe_text_segment_info = get_volatile_disk_mem = staticmethod(_absent)
    flush_caches = init_ssr = staticmethod(_absent)

    def eeprom_power_up(self, bank: int) -> None:
        """The EEPROM is always powered (CFE_PSP_EepromPowerUp)."""

    def eeprom_power_down(self, bank: int) -> None:
        """The EEPROM stays powered, as on NASA's Linux PSP (CFE_PSP_EepromPowerDown)."""
