"""Time at the tone: a tone tells when, a message tells which time it was, and the pair sets the clock.

A server with a simulated tone, cFE's default, makes the tone of its local 1 Hz signal and counts MET in tones; one with
an external source takes MET or STCF from the message; a client takes all of the message (CFE_TIME_Tone1HzISR,
CFE_TIME_ToneVerify, CFE_TIME_ToneUpdate, CFE_TIME_Local1HzStateMachine). Without a good pair for some seconds the clock
goes on by itself, which is called flywheel mode. A simulated tone is taken at the instant its interrupt was due, not
when the task got round to it: on a real processor that delay shakes the time and makes flywheel mode come and go.
Imports no other service.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from cfepy.ports import Ports
from cfepy.time.clock import ADD, CLOCK_FLYWHEEL, CLOCK_INVALID, SpacecraftTime
from cfepy.time.events import FLY_OFF_EID, INFORMATION
from cfepy.time.settings import TimeSettings
from cfepy.time.systime import MASK_32

SECOND = 1 << 32
TONE_PERF_ID = 7
SOURCE_INTERNAL, SOURCE_EXTERNAL = 1, 2
"""Where the time comes from (CFE_TIME_SourceSelect_Enum_t)."""

SIGNAL_PRIMARY, SIGNAL_REDUNDANT = 1, 2
"""Where the tone comes from (CFE_TIME_ToneSignalSelect_Enum_t)."""


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


@dataclass(frozen=True, slots=True)
class ToneData:
    """What a message tells of a tone (CFE_TIME_ToneDataCmd_Payload_t); times in ticks."""

    met: int = 0
    stcf: int = 0
    leap_seconds: int = 0
    state: int = CLOCK_INVALID


@dataclass(slots=True)
class Tone:
    """The tone's state.

    Args:
        clock: what it sets.
        settings: who this processor is, and the windows that tones and messages must keep to.
        ports: for its events.
        give_tone: wakes the task that tells everybody about the tone.
        notify: calls those who asked to be told of every tone.

    Attributes:
        source: SOURCE_INTERNAL or SOURCE_EXTERNAL.
        signal: SIGNAL_PRIMARY or SIGNAL_REDUNDANT.
        good: the last tone came a second after the one before.
        virtual_met: seconds of MET, counted in good tones.
        forced_to_fly: a command wants flywheel mode, so that pairs do not set the clock.
        auto_start_fly: flywheel mode began and its event is still to be sent.
        signal_latch: local time of the last tone, in ticks.
        data_latch: local time when the last message about a tone came, in ticks.
    """

    clock: SpacecraftTime
    settings: TimeSettings
    ports: Ports
    give_tone: Callable[[], object]
    notify: Callable[[], object]
    counters: Counters = field(default_factory=Counters)
    adjustments: Adjustments = field(default_factory=Adjustments)
    source: int = field(init=False)
    signal: int = SIGNAL_PRIMARY
    good: bool = False
    virtual_met: int = 0
    forced_to_fly: bool = False
    auto_start_fly: bool = False
    signal_latch: int = 0
    data_latch: int = 0
    _pending: ToneData = field(default_factory=ToneData, init=False)
    _previous: tuple[int, int] = field(default=(0, 0), init=False)

    def __post_init__(self) -> None:
        self.source = SOURCE_EXTERNAL if self.settings.can_select_source else SOURCE_INTERNAL

    def interrupt(self, latch: int) -> None:
        """A tone came (CFE_TIME_Tone1HzISR).

        Args:
            latch: local time of the tone, in ticks.
        """
        self.ports.es.perf_log_entry(TONE_PERF_ID)
        elapsed = latch - self.signal_latch
        self.signal_latch = latch
        self.good = self.settings.tone_under_limit < elapsed < SECOND + self.settings.tone_over_limit
        if self.good:
            self.counters.tone_interrupt += 1
            self.virtual_met = self.virtual_met + 1 & MASK_32
            self.give_tone()
            self.notify()
        else:
            self.counters.tone_interrupt_error += 1
        self.ports.es.perf_log_exit(TONE_PERF_ID)

    def take_signal(self) -> None:
        """The message came that says that there was a tone (CFE_TIME_ToneSignal)."""
        if self.settings.will_be:
            self._verify(self.data_latch, self.signal_latch)
        self.counters.tone_signal += 1

    def take_data(self, data: ToneData) -> None:
        """The message came that tells the time at a tone (CFE_TIME_ToneData)."""
        self.data_latch = self.clock.local()
        self._pending = data
        if not self.settings.will_be:
            self._verify(self.signal_latch, self.data_latch)
        self.counters.tone_data += 1

    def _verify(self, first: int, second: int) -> None:
        """Set the clock when tone and message are both new and close together (CFE_TIME_ToneVerify)."""
        old_first, old_second = self._previous
        self._previous = (first, second)
        is_new = first != old_first and second != old_second
        if not is_new or not self.settings.min_elapsed <= second - first <= self.settings.max_elapsed:
            self.counters.tone_match_error += 1
            return
        self.counters.tone_match += 1
        if not self.forced_to_fly:
            self._update()

    def _update(self) -> None:
        """Set the clock from the pair (CFE_TIME_ToneUpdate)."""
        was_flying = self.clock.reference.flying
        changes = self._client_update() if self.settings.client else self._server_update(was_flying)
        self.clock.update(latch=self.signal_latch, flying=False, **changes)
        if was_flying:
            self.ports.evs.send_event(FLY_OFF_EID, INFORMATION, "Stop FLYWHEEL")

    def _server_update(self, was_flying: bool) -> dict[str, int]:
        """What a server takes from a message: with an internal source nothing, since it wrote the message itself."""
        data = self._pending
        self.clock.server_flying = False
        if self.source == SOURCE_INTERNAL:
            if was_flying:
                self.virtual_met = self.clock.current_met() >> 32  # tones may have been missed
            return {"met": self.virtual_met << 32}
        if self.settings.external == "met":
            self.virtual_met = data.met >> 32
            return {"met": data.met}
        changes = {"met": self.virtual_met << 32, "stcf": data.stcf}
        if self.settings.external == "gps":
            changes["leap_seconds"] = data.leap_seconds
        return changes

    def _client_update(self) -> dict[str, int]:
        """What a client takes from a message: everything."""
        data = self._pending
        self.clock.server_flying = data.state == CLOCK_FLYWHEEL
        return {
            "met": data.met,
            "stcf": data.stcf,
            "leap_seconds": data.leap_seconds,
            "was_set": data.state != CLOCK_INVALID,
        }

    def one_hz(self) -> None:
        """What is to be done every second before its tone (CFE_TIME_Local1HzStateMachine)."""
        clock, adjustments = self.clock, self.adjustments
        if adjustments.one_hz:
            self.adjust(adjustments.one_hz, adjustments.one_hz_direction)
        elapsed, reference = clock.since_tone(), clock.reference
        if not reference.flying and elapsed >> 32 >= self.settings.start_fly_secs:
            self.fly()
            self.auto_start_fly = True
        elif reference.flying and elapsed >> 32 >= self.settings.latch_fly_secs:
            clock.update(met=reference.met + elapsed, latch=reference.latch + elapsed)

    def fly(self) -> None:
        """Go on without a tone."""
        if not self.settings.client:
            self.clock.server_flying = True
        self.clock.update(flying=True)

    def adjust(self, ticks: int, direction: int) -> None:
        """Add to STCF, or take away."""
        self.clock.update(stcf=self.clock.reference.stcf + (ticks if direction == ADD else -ticks))
