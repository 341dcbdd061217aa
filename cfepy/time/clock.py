"""The spacecraft clock: the values at the last tone, and the present time computed from them.

MET is the MET at the tone plus the time that the processor's own clock has counted since, and on a client also the
delay of the tone. TAI is MET plus STCF. UTC is TAI minus the leap seconds. The processor's clock is the kernel's
virtual time.

Spacecraft time is an integer added to that clock, so reading it is an addition. The telemetry stamp is cached while the
clock stands still. The module replaces the reference state of CFE_TIME_GetReference. NASA's readers need a ring of
versions on a preemptive processor. Here a task is only interrupted inside kernel calls, so the ring is not needed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from cfepy.rtos import Kernel
from cfepy.time.systime import MASK_64, SysTime, from_ticks, ticks_of_ns
from cfepy.units import NS_PER_S

CLOCK_INVALID, CLOCK_VALID, CLOCK_FLYWHEEL = -1, 0, 1
"""Clock states (CFE_TIME_ClockState_Enum_t)."""

ADD, SUBTRACT = 1, 2
"""Directions of an adjustment (CFE_TIME_AdjustDirection_Enum_t)."""


@dataclass(frozen=True, slots=True)
class Reference:
    """The reference values of the time (CFE_TIME_ReferenceState_t); times in ticks of 2**-32 s.

    `met` and `latch` are MET and local clock at the last tone. `stcf` is added to MET to get TAI. `delay` is the delay
    of the tone to a client. `flying` means that no time was received recently. `was_set` means that the time was
    declared valid.
    """

    met: int = 0
    latch: int = 0
    stcf: int = 0
    leap_seconds: int = 0
    delay: int = 0
    delay_direction: int = ADD
    flying: bool = True
    was_set: bool = False


class SpacecraftTime:
    """The reference and the time computed from it.

    Until the first `update` all values are zero, so the time is the processor's own clock counted from the epoch.

    Args:
        kernel: its virtual time is the local clock.
        utc: whether spacecraft time is UTC instead of TAI.
        client: whether this processor follows a server's time.

    Attributes:
        reference: the reference values; only `update` changes them.
        server_flying: whether the time server is in flywheel mode (CFE_TIME_Global.ServerFlyState).
        stamp_now: spacecraft time at `stamp_at` for a telemetry header: seconds << 16 | upper subseconds.
        stamp_at: the virtual time of `stamp_now` in ns; -1 if the clock was set since.
        on_jump: called when the clock was set, so that other parts drop a cached time.
        version: number of changes of the reference.
    """

    __slots__ = (
        "_client",
        "_kernel",
        "_met_offset",
        "_offset",
        "_utc",
        "on_jump",
        "reference",
        "server_flying",
        "stamp_at",
        "stamp_now",
        "version",
    )

    def __init__(self, kernel: Kernel, utc: bool = False, client: bool = False) -> None:
        self._kernel = kernel
        self._utc = utc
        self._client = client
        self._offset = self._met_offset = 0
        self.reference = Reference()
        self.server_flying = True
        self.version = 0
        self.stamp_now = 0
        self.stamp_at = -1
        self.on_jump: Callable[[], object] = _nobody_listens

    def local(self) -> int:
        """Return the local clock in ticks (CFE_TIME_LatchClock)."""
        return ticks_of_ns(self._kernel.now)

    def update(self, **changes: int | bool) -> None:
        """Change fields of the reference, all at once (CFE_TIME_FinishReferenceUpdate)."""
        now = self.reference = replace(self.reference, **changes)  # type: ignore[arg-type]  # of the fields' types
        self.version += 1
        delay = now.delay if now.delay_direction == ADD else -now.delay
        self._met_offset = now.met + delay - now.latch
        offset = self._met_offset + now.stcf - (now.leap_seconds << 32 if self._utc else 0)
        if offset != self._offset:
            self._offset = offset
            self.stamp_at = -1
            self.on_jump()

    def since_tone(self) -> int:
        """Return the ticks since the last tone."""
        return self.local() - self.reference.latch

    def current_met(self) -> int:
        """Return MET in ticks."""
        return self._met_offset + self.local() & MASK_64

    def current_tai(self) -> int:
        """Return TAI in ticks."""
        return self.current_met() + self.reference.stcf & MASK_64

    def current_utc(self) -> int:
        """Return UTC in ticks."""
        return self.current_tai() - (self.reference.leap_seconds << 32) & MASK_64

    def now(self) -> SysTime:
        """Return the spacecraft time: TAI, or UTC if so configured."""
        return from_ticks(self._offset - (-(self._kernel.now << 32) // NS_PER_S))

    def stamp(self) -> int:
        """Return the spacecraft time as the 48-bit integer of a telemetry header; an attribute lookup while time stands
        still.
        """
        now = self._kernel.now
        if now != self.stamp_at:
            self.stamp_at = now
            self.stamp_now = (self._offset - (-(now << 32) // NS_PER_S) & MASK_64) >> 16
        return self.stamp_now

    def state(self) -> int:
        """Return CLOCK_INVALID, CLOCK_VALID or CLOCK_FLYWHEEL (CFE_TIME_CalculateState)."""
        if not self.reference.was_set:
            return CLOCK_INVALID
        is_flying = self.reference.flying or (self._client and self.server_flying)
        return CLOCK_FLYWHEEL if is_flying else CLOCK_VALID


def _nobody_listens() -> None:
    """Do nothing: no part caches a time."""
