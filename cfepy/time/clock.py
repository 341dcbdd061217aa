"""The spacecraft clock: the values at the last tone, and the present time that follows from them.

MET is the MET at the tone plus what the processor's own clock counted since, on a client also the delay of the tone on
its way; TAI is MET plus STCF, and UTC is TAI less the leap seconds. The processor's clock is the kernel's virtual
time. Spacecraft time is one integer that is added to that clock, so asking for it is an addition, and the telemetry
stamp is kept for as long as the clock stands still. Stands for the reference state of CFE_TIME_GetReference; the ring
of versions that NASA's readers need on a preemptive processor is not needed where a task is only interrupted inside
kernel calls.
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
    """What the time is computed from (CFE_TIME_ReferenceState_t); times in ticks of 2**-32 s.

    `met` and `latch` are MET and local clock at the last tone; `stcf` is added to MET to get TAI; `delay` is what the
    tone needs to reach a client; `flying` means that no time was received lately, `was_set` that the time was declared
    right.
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

    Until the first `update` all of it is zero, so that the time is the processor's own clock counted from the epoch.

    Args:
        kernel: its virtual time is the local clock.
        utc: spacecraft time is UTC instead of TAI.
        client: this processor follows a server's time.

    Attributes:
        reference: what the time is computed from; changed by `update` only.
        server_flying: the time server is in flywheel mode (CFE_TIME_Global.ServerFlyState).
        stamp_now: spacecraft time at `stamp_at` for a telemetry header: seconds << 16 | upper subseconds.
        stamp_at: the virtual time in ns that `stamp_now` belongs to; -1 when the clock was set since.
        on_jump: called when the clock was set, so that others drop a time they remembered.
        version: how often the reference changed.
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
        """The local clock in ticks (CFE_TIME_LatchClock)."""
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
        """Ticks since the last tone."""
        return self.local() - self.reference.latch

    def current_met(self) -> int:
        """MET in ticks."""
        return self._met_offset + self.local() & MASK_64

    def current_tai(self) -> int:
        """TAI in ticks."""
        return self.current_met() + self.reference.stcf & MASK_64

    def current_utc(self) -> int:
        """UTC in ticks."""
        return self.current_tai() - (self.reference.leap_seconds << 32) & MASK_64

    def now(self) -> SysTime:
        """Spacecraft time: TAI, or UTC when so configured."""
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
        if not self.reference.was_set:
            return CLOCK_INVALID
        is_flying = self.reference.flying or (self._client and self.server_flying)
        return CLOCK_FLYWHEEL if is_flying else CLOCK_VALID


def _nobody_listens() -> None:
    """No one remembers a time."""
