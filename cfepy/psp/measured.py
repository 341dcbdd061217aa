"""A board profile from three times measured on the board.

    round trip   two tasks wake each other by binary semaphores: four calls of OSAL, two changes of task
    short, long  one task sends a message to its own pipe and takes it out: two calls, and each byte copied once

The simulation charges the same times for these actions. So an application that measures them under the profile gets the
times that the profile was made from. boards/board_times is such an application in C.
"""

from __future__ import annotations

from dataclasses import dataclass

from cfepy.status import UsageError
from cfepy.units import NS_PER_S

SHORT_BYTES, LONG_BYTES = 32, 2048
CALLS_OF_ROUND_TRIP, SWITCHES_OF_ROUND_TRIP, CALLS_OF_MESSAGE = 4, 2, 2


@dataclass(frozen=True, slots=True)
class Measured:
    """Times measured on a board.

    Attributes:
        cpu_hz: processor clock in Hz.
        round_trip_ns: time of the round trip of two tasks that wake each other, in ns.
        short_ns, long_ns: time to send and receive a message of 32 and of 2048 bytes, in ns.
    """

    cpu_hz: int
    round_trip_ns: float
    short_ns: float
    long_ns: float

    def cycles(self) -> dict[str, int]:
        """Return the costs of a profile, in processor cycles, by the names of its fields.

        Raises:
            UsageError: if the times are inconsistent.
        """
        byte_ns = (self.long_ns - self.short_ns) / (LONG_BYTES - SHORT_BYTES)
        call_ns = (self.short_ns - SHORT_BYTES * byte_ns) / CALLS_OF_MESSAGE
        switch_ns = (self.round_trip_ns - CALLS_OF_ROUND_TRIP * call_ns) / SWITCHES_OF_ROUND_TRIP
        if byte_ns < 0:
            raise UsageError("must not be shorter than the time of a short message; measure again", field="--long")
        if call_ns < 0:
            raise UsageError("must not be shorter than the time of its bytes; measure again", field="--short")
        if switch_ns < 0:
            text = (
                "must not be less than the time of its four calls, "
                f"{CALLS_OF_ROUND_TRIP * call_ns / 1000:.3g} us; measure again"
            )
            raise UsageError(text, field="--round-trip")
        return {
            "context_switch_cycles": self._cycles(switch_ns),
            "syscall_cycles": self._cycles(call_ns),
            "copy_cycles_per_byte": self._cycles(byte_ns),
        }

    def _cycles(self, time_ns: float) -> int:
        return round(time_ns * self.cpu_hz / NS_PER_S)
