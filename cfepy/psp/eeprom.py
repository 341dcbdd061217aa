"""The EEPROM (CFE_PSP_Eeprom*): memory that is written by its own functions, protected and switched off by bank.

On a board with data flash both work, and it starts protected, as such a part does after a reset; on others they are
what they are on NASA's Linux. May import cfepy.status and cfepy.psp.addresses only.
"""

from __future__ import annotations

from cfepy.psp.addresses import MEM_EEPROM, AddressSpace
from cfepy.status import CFE_PSP_ERROR, CFE_PSP_ERROR_NOT_IMPLEMENTED, CFE_PSP_ERROR_TIMEOUT, OsalError

NUM_EEPROM_BANKS = 1


class EepromSpace(AddressSpace):
    """An address space whose EEPROM can be protected.

    Attributes:
        has_eeprom_control: whether there is hardware that protects it and switches it off.
        is_writable, is_powered: its state; always true without that hardware.
    """

    def __init__(self) -> None:
        super().__init__()
        self.has_eeprom_control = False
        self.is_writable = self.is_powered = True

    def protect_eeprom(self) -> None:
        """The board has hardware that protects the EEPROM; it does so from the start."""
        self.has_eeprom_control = True
        self.is_writable = False

    def eeprom_write8(self, address: int, value: int) -> None:
        """Change a byte of EEPROM (CFE_PSP_EepromWrite8).

        Raises:
            OsalError: CFE_PSP_INVALID_MEM_*; CFE_PSP_ERROR_TIMEOUT while it is protected or switched off.
        """
        self._write(address, value, 1, MEM_EEPROM)

    def eeprom_write16(self, address: int, value: int) -> None:
        """Change a 16-bit word of EEPROM (CFE_PSP_EepromWrite16); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        self._write(address, value, 2, MEM_EEPROM)

    def eeprom_write32(self, address: int, value: int) -> None:
        """Change a 32-bit word of EEPROM (CFE_PSP_EepromWrite32); also CFE_PSP_ERROR_ADDRESS_MISALIGNED."""
        self._write(address, value, 4, MEM_EEPROM)

    def eeprom_write_enable(self, bank: int) -> None:
        """Let it be written (CFE_PSP_EepromWriteEnable).

        Args:
            bank: 0, there is one.

        Raises:
            OsalError: CFE_PSP_ERROR for another bank; CFE_PSP_ERROR_NOT_IMPLEMENTED on a board that cannot protect it.
        """
        self._check_control(bank)
        self.is_writable = True

    def eeprom_write_disable(self, bank: int) -> None:
        """Protect it (CFE_PSP_EepromWriteDisable); errors as `eeprom_write_enable`."""
        self._check_control(bank)
        self.is_writable = False

    def eeprom_power_up(self, bank: int) -> None:
        """Switch it on (CFE_PSP_EepromPowerUp); without effect on a board that cannot."""
        if self.has_eeprom_control:
            self._check_control(bank)
            self.is_powered = True

    def eeprom_power_down(self, bank: int) -> None:
        """Switch it off (CFE_PSP_EepromPowerDown); without effect on a board that cannot."""
        if self.has_eeprom_control:
            self._check_control(bank)
            self.is_powered = False

    def _check_control(self, bank: int) -> None:
        if not self.has_eeprom_control:
            raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "the EEPROM of this board cannot be protected")
        if not 0 <= bank < NUM_EEPROM_BANKS:
            raise OsalError(CFE_PSP_ERROR, f"there is no EEPROM bank {bank}")

    def _check_access(self, memory_type: int, is_write: bool) -> None:
        if memory_type != MEM_EEPROM:
            return
        if not self.is_powered:
            raise OsalError(CFE_PSP_ERROR_TIMEOUT, "the EEPROM is switched off")
        if is_write and not self.is_writable:
            raise OsalError(CFE_PSP_ERROR_TIMEOUT, "the EEPROM is protected; see CFE_PSP_EepromWriteEnable")
