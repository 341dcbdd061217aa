"""The virtual CPU time of calls into cFE and the operating system: one object for all code that charges for calls.

A board profile creates it (`cfepy.psp.BoardProfile.cpu_costs`). OSAL, the Software Bus, nodes and all other code that
calls cFE take from it the times that they charge with `Kernel.charge`.
"""

from __future__ import annotations

from dataclasses import dataclass

from cfepy.units import PS_PER_NS


@dataclass(frozen=True, slots=True)
class CpuCosts:
    """Virtual CPU times; all 0 on a computer whose speed does not matter.

    Attributes:
        call_ns: time of a call into the operating system or the Software Bus, in ns.
        byte_ps: time of copying a byte, in picoseconds (a byte per cycle at 120 MHz is 8333).
        switch_ns: time of a task switch, the kernel's `switch_cost_ns`, in ns.
        polling_ns: time, in ns, of a call that code may repeat to poll: reading a clock, an empty pipe, or whether to
            run on. It applies to ROS nodes and compiled applications. Boards whose other calls cost nothing have it
            too, so that such a loop ends; it is 1 us unless the profile sets it.
    """

    call_ns: int = 0
    byte_ps: int = 0
    switch_ns: int = 0
    polling_ns: int = 0

    def of(self, size: int) -> int:
        """Return the time of a call that copies `size` bytes, in ns."""
        return self.call_ns + size * self.byte_ps // PS_PER_NS

    def of_copying(self, size: int) -> int:
        """Return the time of copying `size` bytes, in ns."""
        return size * self.byte_ps // PS_PER_NS
