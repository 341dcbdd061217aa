"""The message that tells the time at the tone, as a server sends it: its own time, or that of an external source.

Stands for CFE_TIME_ToneSend, CFE_TIME_ToneSendMET, CFE_TIME_ToneSendGPS and CFE_TIME_ToneSendTime. Imports no other
service.
"""

from __future__ import annotations

from cfepy.ports import Ports
from cfepy.time import packets as pk
from cfepy.time.clock import SpacecraftTime
from cfepy.time.settings import TimeSettings
from cfepy.time.systime import A_GT_B, A_LT_B, add, compare, from_ticks, subtract, to_ticks
from cfepy.time.telemetry import fields_of
from cfepy.time.tone import SOURCE_INTERNAL, Tone

SEND_MET_PERF_ID = 9


class ToneDataSender:
    """Sends the message.

    Args:
        ports: the bus, and the performance log.
        clock: the time.
        tone: counts MET, and knows which source is selected.
        settings: whether the message is about the next tone, and how far off an external time may be.
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
        """Send an external MET, or the own time when the MET is not wanted or not to be believed."""
        self._ports.es.perf_log_entry(SEND_MET_PERF_ID)
        reference = self._clock.reference
        if self._is_wanted(met, from_ticks(self._met_at_tone())):
            self._transmit(to_ticks(met), reference.stcf, reference.leap_seconds)
        else:
            self.send()
        self._ports.es.perf_log_exit(SEND_MET_PERF_ID)

    def send_time(self, time: tuple[int, int], leap_seconds: int | None = None) -> None:
        """Send what makes an external spacecraft time come true, or the own time when that is not wanted or believed.

        Args:
            time: at the tone.
            leap_seconds: that go with it; None keeps the own ones.
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
        """Whole seconds of MET at the tone that the message is about, in ticks."""
        return (self._clock.current_met() >> 32) + self._settings.will_be << 32

    def _is_wanted(self, given: tuple[int, int], expected: tuple[int, int]) -> bool:
        """Whether an external source is selected, and a set clock would not be changed by too much."""
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
