"""What computing costs on a board, in virtual time; derived from its profile once, so that hot paths only add.

May import cfepy.psp.profile and cfepy.rtos.units only.
"""

from __future__ import annotations

from dataclasses import dataclass

from cfepy.psp.profile import BoardProfile
from cfepy.rtos.units import NS_PER_S, PS_PER_NS


@dataclass(frozen=True, slots=True)
class CpuCosts:
    """Virtual CPU time of the things that a kernel does; all 0 on a board without a clock rate.

    Attributes:
        call_ns: a call into the operating system.
        byte_ps: copying one byte, in picoseconds (a byte a cycle at 120 MHz is 8333).
        switch_ns: a change of task, the kernel's `switch_cost_ns`.
    """

    call_ns: int = 0
    byte_ps: int = 0
    switch_ns: int = 0

    @classmethod
    def of_board(cls, profile: BoardProfile) -> CpuCosts:
        """The costs on a board; the time of a byte is rounded up to a picosecond."""
        cycles = profile.copy_cycles_per_byte
        byte_ps = -(-cycles * PS_PER_NS * NS_PER_S // profile.cpu_hz) if profile.cpu_hz else 0
        return cls(profile.cycles_ns(profile.syscall_cycles), byte_ps, profile.cycles_ns(profile.context_switch_cycles))
