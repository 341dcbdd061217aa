"""Time at the tone: each second a tone tells when, a message tells which time it was, and the pair sets the clock.

This is a time server with a simulated tone and an internal source, cFE's default: the local 1 Hz interrupt makes the
tone, and MET counts tones (CFE_TIME_Tone1HzISR, CFE_TIME_ToneVerify, CFE_TIME_Local1HzStateMachine). Without a good
pair for some seconds the clock goes on by itself, which is called flywheel mode. A tone is taken at the instant its
interrupt was due, not when the task got round to it: on a real processor that delay shakes the time and makes flywheel
mode come and go. Imports no other service.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from cfepy.ports import Ports
from cfepy.time.clock import SpacecraftTime
from cfepy.time.events import CFE_TIME_FLY_OFF_EID, INFORMATION
from cfepy.time.systime import MASK_32, micro2sub_secs

SECOND = 1 << 32
ADD, SUBTRACT = 1, 2
"""Directions of an adjustment (CFE_TIME_AdjustDirection_Enum_t)."""

MIN_ELAPSED = 0
MAX_ELAPSED = micro2sub_secs(200_000)
"""How long after the tone its message may come, in ticks (CFE_MISSION_TIME_MIN_ELAPSED, _MAX_ELAPSED)."""

TONE_OVER_LIMIT = micro2sub_secs(20_000)
TONE_UNDER_LIMIT = micro2sub_secs(1_000_000 - 20_000)
"""How far from a second after the last one a tone may come (CFE_PLATFORM_TIME_CFG_TONE_LIMIT)."""

LATCH_FLY_SECS = 8
"""In flywheel mode the reference is renewed when it is this old (CFE_PLATFORM_TIME_CFG_LATCH_FLY)."""


@dataclass(slots=True)
class Counters:
    """Counts of the diagnostic packet that the reset command clears."""

    tone_match: int = 0
    tone_match_error: int = 0
    tone_signal: int = 0
    tone_data: int = 0
    tone_interrupt: int = 0
    tone_interrupt_error: int = 0
    tone_task: int = 0
    local_interrupt: int = 0
    local_task: int = 0


@dataclass(slots=True)
class Adjustments:
    """What ground commands add to STCF: once, and at every 1 Hz; in ticks."""

    one_time: int = 0
    one_time_direction: int = ADD
    one_hz: int = 0
    one_hz_direction: int = ADD


@dataclass(slots=True)
class Tone:
    """The tone's state.

    Args:
        clock: what it sets.
        ports: for its events.
        start_fly_secs: flywheel mode starts so many seconds after the last good pair.
        give_tone: wakes the task that tells everybody about the tone.
        notify: calls those who asked to be told of every tone.

    Attributes:
        good: the last tone came a second after the one before.
        virtual_met: seconds of MET, counted in good tones.
        forced_to_fly: a command wants flywheel mode, so that pairs do not set the clock.
        auto_start_fly: flywheel mode began and its event is still to be sent.
        signal_latch: local time of the last tone, in ticks.
        data_latch: local time when the last message about a tone came, in ticks.
    """

    clock: SpacecraftTime
    ports: Ports
    start_fly_secs: int
    give_tone: Callable[[], object]
    notify: Callable[[], object]
    counters: Counters = field(default_factory=Counters)
    adjustments: Adjustments = field(default_factory=Adjustments)
    good: bool = False
    virtual_met: int = 0
    forced_to_fly: bool = False
    server_flying: bool = True
    auto_start_fly: bool = False
    signal_latch: int = 0
    data_latch: int = 0
    _previous: tuple[int, int] = field(default=(0, 0), init=False)

    def interrupt(self, latch: int) -> None:
        """A tone came (CFE_TIME_Tone1HzISR).

        Args:
            latch: local time of the tone, in ticks.
        """
        elapsed = latch - self.signal_latch
        self.signal_latch = latch
        self.good = TONE_UNDER_LIMIT < elapsed < SECOND + TONE_OVER_LIMIT
        if self.good:
            self.counters.tone_interrupt += 1
            self.virtual_met = self.virtual_met + 1 & MASK_32
            self.give_tone()
            self.notify()
        else:
            self.counters.tone_interrupt_error += 1

    def data(self) -> None:
        """The message came that tells the time at the last tone (CFE_TIME_ToneData).

        Its content is this server's own, so only its coming counts.
        """
        self.data_latch = self.clock.local()
        if self._is_pair():
            self.counters.tone_match += 1
            if not self.forced_to_fly:
                self._update()
        else:
            self.counters.tone_match_error += 1
        self.counters.tone_data += 1

    def _is_pair(self) -> bool:
        """Whether tone and message are both new and close together (CFE_TIME_ToneVerify)."""
        signal, data = self._previous
        self._previous = (self.signal_latch, self.data_latch)
        is_new = signal != self.signal_latch and data != self.data_latch
        return is_new and MIN_ELAPSED <= self.data_latch - self.signal_latch <= MAX_ELAPSED

    def _update(self) -> None:
        """Set the clock from the pair (CFE_TIME_ToneUpdate)."""
        clock = self.clock
        was_flying = clock.flying
        if was_flying:
            self.virtual_met = clock.current_met() >> 32  # tones may have been missed
            clock.flying = self.server_flying = False
        clock.set(met=self.virtual_met << 32, latch=self.signal_latch)
        if was_flying:
            self.ports.evs.send_event(CFE_TIME_FLY_OFF_EID, INFORMATION, "Stop FLYWHEEL")

    def one_hz(self) -> None:
        """What is to be done every second before its tone (CFE_TIME_Local1HzStateMachine)."""
        clock, adjustments = self.clock, self.adjustments
        if adjustments.one_hz:
            self.adjust(adjustments.one_hz, adjustments.one_hz_direction)
        elapsed = clock.since_tone() >> 32
        if not clock.flying and elapsed >= self.start_fly_secs:
            self.fly()
            self.auto_start_fly = True
        elif clock.flying and elapsed >= LATCH_FLY_SECS:
            clock.set(met=clock.current_met(), latch=clock.local())

    def fly(self) -> None:
        """Go on without a tone."""
        self.clock.flying = self.server_flying = True
        self.clock.note_change()

    def adjust(self, ticks: int, direction: int) -> None:
        """Add to STCF, or take away."""
        self.clock.set(stcf=self.clock.stcf + (ticks if direction == ADD else -ticks))
