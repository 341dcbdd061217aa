"""What a simulated board does not have: a segment of machine code, caches, a recorder.

The functions are there and fail as on NASA's Linux PSP, so that an app that handles this there handles it here. May
import cfepy.console and cfepy.status only.
"""

from __future__ import annotations

from cfepy.console import Console
from cfepy.status import CFE_PSP_ERROR, CFE_PSP_ERROR_NOT_IMPLEMENTED, OsalError


class AbsentHardware:
    """The functions of the PSP that find nothing."""

    console: Console

    def flush_caches(self, cache_type: int, address: int, size: int) -> None:
        """Say that there are none (CFE_PSP_FlushCaches)."""
        self.console.write("CFE_PSP_FlushCaches called -- Currently no Linux/OSX/Cygwin implementation")

    def init_ssr(self, bus: int, device: int, device_name: str) -> None:
        """There is no solid state recorder (CFE_PSP_InitSSR).

        Raises:
            OsalError: CFE_PSP_ERROR, always.
        """
        raise OsalError(CFE_PSP_ERROR, f"there is no recorder {device_name} on bus {bus}, device {device}")

    def get_volatile_disk_mem(self) -> memoryview:
        """The memory of the RAM disk, of size 0: its files are no bytes at addresses (CFE_PSP_GetVolatileDiskMem)."""
        return memoryview(b"")

    def get_kernel_text_segment_info(self) -> memoryview:
        """The code of the operating system (CFE_PSP_GetKernelTextSegmentInfo).

        Raises:
            OsalError: CFE_PSP_ERROR_NOT_IMPLEMENTED, always.
        """
        raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "the kernel has no text segment")

    def get_cfe_text_segment_info(self) -> memoryview:
        """The machine code of the cFE core (CFE_PSP_GetCFETextSegmentInfo): Python has none, unlike NASA's Linux.

        Raises:
            OsalError: CFE_PSP_ERROR_NOT_IMPLEMENTED, always.
        """
        raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "the cFE has no text segment")
