"""The spacecraft clock: what was true at the last tone, and the time now that follows from it.

MET is the MET at the tone plus what the processor's own clock counted since; TAI is MET plus STCF, and UTC is TAI less
the leap seconds. The processor's clock is the kernel's virtual time. All of it is one integer that is added to that
clock, so asking for the time is an addition, and the telemetry stamp is kept for as long as the clock stands still.
Stands for the reference state of CFE_TIME_GetReference; the ring of versions that NASA's readers need on a preemptive
processor is not needed where a task is only interrupted inside kernel calls.
"""

from __future__ import annotations

from collections.abc import Callable

from cfepy.rtos import Kernel
from cfepy.rtos.units import NS_PER_S
from cfepy.time.systime import MASK_64, SysTime, from_ticks, ticks_of_ns

CLOCK_INVALID, CLOCK_VALID, CLOCK_FLYWHEEL = -1, 0, 1
"""Clock states (CFE_TIME_ClockState_Enum_t)."""


class SpacecraftTime:
    """Reference state and the time computed from it.

    Until `start` all of it is zero, so that the time is the processor's own clock counted from the epoch.

    Args:
        kernel: its virtual time is the local clock.

    Attributes:
        stamp_now: spacecraft time at `stamp_at` for a telemetry header: seconds << 16 | upper subseconds.
        stamp_at: the virtual time in ns that `stamp_now` belongs to; -1 when the clock was set since.
        on_jump: called when the clock was set, so that others drop a time they remembered.
        flying: nobody told the time lately (CFE_TIME_FlywheelState_IS_FLY).
        was_set: somebody said that the time is right (CFE_TIME_SetState_WAS_SET).
        version: how often the reference changed.
    """

    __slots__ = (
        "_kernel",
        "_offset",
        "delay",
        "flying",
        "latch",
        "leap_seconds",
        "met",
        "on_jump",
        "stamp_at",
        "stamp_now",
        "stcf",
        "version",
        "was_set",
    )

    def __init__(self, kernel: Kernel) -> None:
        self._kernel = kernel
        self._offset = 0
        self.met = self.stcf = self.delay = self.latch = 0  # ticks, at the last tone
        self.leap_seconds = 0
        self.flying = True
        self.was_set = False
        self.version = 0
        self.stamp_now = 0
        self.stamp_at = -1
        self.on_jump: Callable[[], object] = _nobody_listens

    def local(self) -> int:
        """The local clock in ticks (CFE_TIME_LatchClock)."""
        return ticks_of_ns(self._kernel.now)

    def set(self, *, met: int | None = None, latch: int | None = None, stcf: int | None = None) -> None:
        """Change the reference; what is not given stays.

        Args:
            met: MET at the tone, in ticks.
            latch: local clock at the tone, in ticks.
            stcf: what is added to MET to get TAI, in ticks.
        """
        if met is not None:
            self.met = met & MASK_64
        if latch is not None:
            self.latch = latch
        if stcf is not None:
            self.stcf = stcf & MASK_64
        self.version += 1
        offset = self.met + self.stcf - self.latch
        if offset != self._offset:
            self._offset = offset
            self.stamp_at = -1
            self.on_jump()

    def note_change(self) -> None:
        """Count a change of a state that the time itself does not depend on."""
        self.version += 1

    def since_tone(self) -> int:
        """Ticks since the last tone."""
        return self.local() - self.latch

    def current_met(self) -> int:
        """MET in ticks."""
        return self.met + self.since_tone() & MASK_64

    def current_tai(self) -> int:
        """TAI in ticks."""
        return self._offset + self.local() & MASK_64

    def current_utc(self) -> int:
        """UTC in ticks."""
        return self.current_tai() - (self.leap_seconds << 32) & MASK_64

    def now(self) -> SysTime:
        """Spacecraft time, which is TAI."""
        return from_ticks(self._offset - (-(self._kernel.now << 32) // NS_PER_S))

    def stamp(self) -> int:
        """Spacecraft time as the 48-bit integer of a telemetry header; costs an attribute look-up while time stands."""
        now = self._kernel.now
        if now != self.stamp_at:
            self.stamp_at = now
            self.stamp_now = (self._offset - (-(now << 32) // NS_PER_S) & MASK_64) >> 16
        return self.stamp_now

    def state(self) -> int:
        """CLOCK_INVALID, CLOCK_VALID or CLOCK_FLYWHEEL (CFE_TIME_CalculateState)."""
        if not self.was_set:
            return CLOCK_INVALID
        return CLOCK_FLYWHEEL if self.flying else CLOCK_VALID


def _nobody_listens() -> None:
    """No one remembers a time."""
