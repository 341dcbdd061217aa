"""What a call into cFE or the operating system costs in virtual time: one object for all code that charges for calls.

A board's profile makes it (`cfepy.psp.BoardProfile.cpu_costs`); OSAL, the Software Bus and nodes take from it the
times that they charge with `Kernel.charge`, and so does any further kind of code that calls cFE.
"""

from __future__ import annotations

from dataclasses import dataclass

from cfepy.units import PS_PER_NS


@dataclass(frozen=True, slots=True)
class CpuCosts:
    """Virtual CPU time; all 0 on a computer whose speed does not matter.

    Attributes:
        call_ns: a call into the operating system or the Software Bus.
        byte_ps: copying one byte, in picoseconds (a byte a cycle at 120 MHz is 8333).
        switch_ns: a change of task, the kernel's `switch_cost_ns`.
        polling_ns: a call of code that may wait by asking again and again, such as a ROS node or a compiled
            application: reading a clock, an empty pipe, whether to run on. A board has it also when its other calls
            cost nothing, 1 us unless its profile says otherwise, so that such a loop comes to its end.
    """

    call_ns: int = 0
    byte_ps: int = 0
    switch_ns: int = 0
    polling_ns: int = 0

    def of(self, size: int) -> int:
        """ns of a call that copies `size` bytes."""
        return self.call_ns + size * self.byte_ps // PS_PER_NS

    def of_copying(self, size: int) -> int:
        """ns of copying `size` bytes."""
        return size * self.byte_ps // PS_PER_NS
