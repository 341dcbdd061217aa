"""Time at the tone: a tone marks an instant, a message has its time, and the pair sets the clock.

A server with a simulated tone, cFE's default, makes the tone from its local 1 Hz signal and counts MET in tones. A
server with an external source takes MET or STCF from the message. A client takes all values of the message
(CFE_TIME_Tone1HzISR, CFE_TIME_ToneVerify, CFE_TIME_ToneUpdate, CFE_TIME_Local1HzStateMachine). Without a good pair for
some seconds the clock continues on its own, in flywheel mode. A simulated tone counts at the time its interrupt was
due, not when the task handled it. On a real processor that delay disturbs the time and makes flywheel mode come and go.

A server sends the message itself: with its own time, or the time of an external source (CFE_TIME_ToneSend,
CFE_TIME_ToneSendMET, CFE_TIME_ToneSendGPS, CFE_TIME_ToneSendTime).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from cfepy.ports import Ports
from cfepy.time import packets as pk
from cfepy.time.clock import ADD, CLOCK_FLYWHEEL, CLOCK_INVALID, SpacecraftTime
from cfepy.time.events import FLY_OFF_EID, INFORMATION
from cfepy.time.settings import TimeSettings
from cfepy.time.systime import A_GT_B, A_LT_B, MASK_32, add, compare, fields_of, from_ticks, subtract, to_ticks

SECOND = 1 << 32
TONE_PERF_ID = 7
SOURCE_INTERNAL, SOURCE_EXTERNAL = 1, 2
"""The source of the time (CFE_TIME_SourceSelect_Enum_t)."""

SIGNAL_PRIMARY, SIGNAL_REDUNDANT = 1, 2
"""The source of the tone (CFE_TIME_ToneSignalSelect_Enum_t)."""

SEND_MET_PERF_ID = 9


@dataclass(slots=True)
class ToneCounters:
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
    """The adjustments of STCF by ground commands: once, and at every 1 Hz; in ticks."""

    one_time: int = 0
    one_time_direction: int = ADD
    one_hz: int = 0
    one_hz_direction: int = ADD


@dataclass(frozen=True, slots=True)
class ToneData:
    """The data of a message about a tone (CFE_TIME_ToneDataCmd_Payload_t); times in ticks."""

    met: int = 0
    stcf: int = 0
    leap_seconds: int = 0
    state: int = CLOCK_INVALID


@dataclass(slots=True)
class Tone:
    """The state of the tone.

    Args:
        clock: the clock to set.
        settings: the role of this processor, and the time windows for tones and messages.
        ports: sends its events.
        give_tone: wakes the task that announces the tone.
        notify: calls the functions registered for every tone.

    Attributes:
        source: SOURCE_INTERNAL or SOURCE_EXTERNAL.
        signal: SIGNAL_PRIMARY or SIGNAL_REDUNDANT.
        good: whether the last tone came a second after the one before.
        virtual_met: seconds of MET, counted in good tones.
        forced_to_fly: whether a command requires flywheel mode, so that pairs do not set the clock.
        auto_start_fly: whether flywheel mode began and its event is still to be sent.
        signal_latch: local time of the last tone, in ticks.
        data_latch: local time at which the last message about a tone arrived, in ticks.
    """

    clock: SpacecraftTime
    settings: TimeSettings
    ports: Ports
    give_tone: Callable[[], object]
    notify: Callable[[], object]
    counters: ToneCounters = field(default_factory=ToneCounters)
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
        """Handle a tone (CFE_TIME_Tone1HzISR).

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
        """Handle the message that announces a tone (CFE_TIME_ToneSignal)."""
        if self.settings.will_be:
            self._verify(self.data_latch, self.signal_latch)
        self.counters.tone_signal += 1

    def take_data(self, data: ToneData) -> None:
        """Handle the message with the time at a tone (CFE_TIME_ToneData)."""
        self.data_latch = self.clock.local()
        self._pending = data
        if not self.settings.will_be:
            self._verify(self.signal_latch, self.data_latch)
        self.counters.tone_data += 1

    def _verify(self, first: int, second: int) -> None:
        """Set the clock if tone and message are both new and close together (CFE_TIME_ToneVerify)."""
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
        """Return the values that a server takes from a message; none with an internal source, because it wrote the
        message.
        """
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
        """Return the values that a client takes from a message: all of them."""
        data = self._pending
        self.clock.server_flying = data.state == CLOCK_FLYWHEEL
        return {
            "met": data.met,
            "stcf": data.stcf,
            "leap_seconds": data.leap_seconds,
            "was_set": data.state != CLOCK_INVALID,
        }

    def one_hz(self) -> None:
        """Do the work of every second before its tone (CFE_TIME_Local1HzStateMachine)."""
        clock, adjustments = self.clock, self.adjustments
        if adjustments.one_hz:
            self.adjust(adjustments.one_hz, adjustments.one_hz_direction)
        elapsed, reference = clock.since_tone(), clock.reference
        if not reference.flying and elapsed >> 32 >= self.settings.start_fly_secs:
            self.fly()
            self.auto_start_fly = True
        elif reference.flying and elapsed >> 32 >= self.settings.latch_fly_secs:
            met = reference.met + elapsed if self.settings.safe else clock.current_met()
            clock.update(met=met, latch=reference.latch + elapsed)

    def fly(self) -> None:
        """Switch to flywheel mode."""
        if not self.settings.client:
            self.clock.server_flying = True
        self.clock.update(flying=True)

    def adjust(self, ticks: int, direction: int) -> None:
        """Add to STCF, or subtract from it."""
        self.clock.update(stcf=self.clock.reference.stcf + (ticks if direction == ADD else -ticks))


class ToneDataSender:
    """Sends the message about the tone.

    Args:
        ports: the bus, and the performance log.
        clock: the time.
        tone: counts MET, and has the selected source.
        settings: whether the message is about the next tone, and the limit for external times.
    """

    def __init__(self, ports: Ports, clock: SpacecraftTime, tone: Tone, settings: TimeSettings) -> None:
        self._ports = ports
        self._clock = clock
        self._tone = tone
        self._settings = settings

    def send(self) -> None:
        """Send the server's own time."""
        reference = self._clock.reference
        met = self._clock.current_met() >> 32 if reference.flying else self._tone.virtual_met
        self._transmit(met + self._settings.will_be << 32, reference.stcf, reference.leap_seconds)

    def send_met(self, met: tuple[int, int]) -> None:
        """Send an external MET, or the own time if the MET is not wanted or not plausible."""
        self._ports.es.perf_log_entry(SEND_MET_PERF_ID)
        reference = self._clock.reference
        if self._is_wanted(met, from_ticks(self._met_at_tone())):
            self._transmit(to_ticks(met), reference.stcf, reference.leap_seconds)
        else:
            self.send()
        self._ports.es.perf_log_exit(SEND_MET_PERF_ID)

    def send_time(self, time: tuple[int, int], leap_seconds: int | None = None) -> None:
        """Send an STCF that gives an external spacecraft time, or the own time if that is not wanted or not plausible.

        Args:
            time: the time at the tone.
            leap_seconds: its leap seconds; None keeps the present ones.
        """
        reference = self._clock.reference
        leaps = reference.leap_seconds if leap_seconds is None else leap_seconds
        met = self._met_at_tone()
        stcf = to_ticks(time) - met + (leaps << 32 if self._settings.utc else 0)
        if self._is_wanted(from_ticks(stcf), from_ticks(reference.stcf)):
            self._transmit(met, stcf, leaps)
        else:
            self.send()

    def _met_at_tone(self) -> int:
        """Return the whole seconds of MET at the tone of the message, in ticks."""
        return (self._clock.current_met() >> 32) + self._settings.will_be << 32

    def _is_wanted(self, given: tuple[int, int], expected: tuple[int, int]) -> bool:
        """Return whether an external source is selected, and would not change a set clock by too much."""
        if self._tone.source == SOURCE_INTERNAL:
            return False
        delta = self._settings.max_delta
        is_early = compare(given, subtract(expected, delta)) == A_LT_B
        is_late = compare(given, add(expected, delta)) == A_GT_B
        return not self._clock.reference.was_set or not (is_early or is_late)

    def _transmit(self, met: int, stcf: int, leap_seconds: int) -> None:
        packet = pk.DATA_CMD.packet(
            AtToneMET=fields_of(met),
            AtToneSTCF=fields_of(stcf),
            AtToneLeapSeconds=leap_seconds,
            AtToneState=self._clock.state(),
        )
        self._ports.sb.transmit_msg(packet)
