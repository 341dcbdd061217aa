"""The commands of Time Services and their replies (cfe_time_task.c).

A server refuses commands for clients, and a client those for servers. Both refuse to switch source or tone signal if
they are not configured for it. The replies have NASA's texts.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from cfepy.core_app import Replies
from cfepy.msg import BAD_CODE, BAD_LENGTH, BAD_MSG_ID, Command, CommandTable, Dispatch
from cfepy.ports import Ports
from cfepy.time import events as ev
from cfepy.time import packets as pk
from cfepy.time.clock import ADD, CLOCK_FLYWHEEL, CLOCK_INVALID, CLOCK_VALID, SUBTRACT, SpacecraftTime
from cfepy.time.reset_vars import RESET_AREA_NEW
from cfepy.time.settings import TimeSettings
from cfepy.time.systime import MASK_32, micro2sub_secs, to_ticks
from cfepy.time.telemetry import diagnostic, housekeeping
from cfepy.time.tone import (
    SIGNAL_PRIMARY,
    SIGNAL_REDUNDANT,
    SOURCE_EXTERNAL,
    SOURCE_INTERNAL,
    Tone,
    ToneCounters,
)
from cfepy.units import US_PER_S

_STATES = {CLOCK_INVALID: "INVALID", CLOCK_VALID: "VALID", CLOCK_FLYWHEEL: "FLYWHEEL"}
_SOURCES = {SOURCE_INTERNAL: "INTERNAL", SOURCE_EXTERNAL: "EXTERNAL"}
_SIGNALS = {SIGNAL_PRIMARY: "PRIMARY", SIGNAL_REDUNDANT: "REDUNDANT"}


class TimeCommands:
    """Handles the packets of Time Services' pipe, except those about the tone.

    Args:
        ports: the other services.
        clock: the clock that commands set.
        tone: the tone that commands set.
        settings: the commands that this processor accepts.
        on_housekeeping: called before each housekeeping packet, when NASA's code saves the reset variables.

    Attributes:
        table: message ids and function codes with their handlers; the task adds those of the tone.
        replies: the command counters.
        data_store: the source of the start values, for the diagnostic packet.
    """

    def __init__(
        self,
        ports: Ports,
        clock: SpacecraftTime,
        tone: Tone,
        settings: TimeSettings,
        on_housekeeping: Callable[[], object],
        version_text: str,
    ) -> None:
        self.table = CommandTable(
            (pk.NOOP, self._noop),
            (pk.RESET_COUNTERS, self._reset_counters),
            (pk.SEND_DIAGNOSTIC, self._send_diagnostic),
            (pk.SET_STATE, self._set_state),
            (pk.SET_SOURCE, self._set_source),
            (pk.SET_SIGNAL, self._set_signal),
            (pk.ADD_DELAY, partial(self._set_delay, ADD)),
            (pk.SUB_DELAY, partial(self._set_delay, SUBTRACT)),
            (pk.SET_TIME, self._set_time),
            (pk.SET_MET, self._set_met),
            (pk.SET_STCF, self._set_stcf),
            (pk.SET_LEAP_SECONDS, self._set_leap_seconds),
            (pk.ADD_ADJUST, partial(self._adjust, ADD)),
            (pk.SUB_ADJUST, partial(self._adjust, SUBTRACT)),
            (pk.ADD_ONE_HZ_ADJUSTMENT, partial(self._one_hz, ADD)),
            (pk.SUB_ONE_HZ_ADJUSTMENT, partial(self._one_hz, SUBTRACT)),
        )
        self.table.handle(pk.SEND_HK, self._send_housekeeping, any_length=True)  # NASA's code does not check it
        self.replies = Replies(ports)
        self.data_store = RESET_AREA_NEW
        self._ports = ports
        self._clock = clock
        self._tone = tone
        self._settings = settings
        self._on_housekeeping = on_housekeeping
        self._version_text = version_text
        self._version_at_reset = 0

    def process(self, packet: bytes) -> None:
        """Handle a packet of the pipe (CFE_TIME_TaskPipe)."""
        done = self.table.dispatch(packet)
        if done.outcome in (BAD_MSG_ID, BAD_CODE, BAD_LENGTH):
            self._reject(done)

    def reject_length(self, packet: bytes, command: Command) -> None:
        """Count and report a packet that is too short for its command."""
        self._reject(Dispatch(BAD_LENGTH, command.msg_id, 0, len(packet), command.length))

    def _reject(self, done: Dispatch) -> None:
        if done.outcome == BAD_MSG_ID:
            event_id, text = ev.ID_ERR_EID, f"Invalid message ID -- ID = 0x{done.msg_id:X}"
        elif done.outcome == BAD_CODE:
            event_id = ev.CC_ERR_EID
            text = f"Invalid command code -- ID = 0x{done.msg_id:X}, CC = {done.fcn_code}"
        else:
            event_id, text = ev.LEN_ERR_EID, done.length_text()
        self.replies.error_counter += done.outcome != BAD_MSG_ID
        self.replies.send(event_id, text, ev.ERROR)

    def _is_allowed(self, allowed: bool, event_id: int, what: str, option: str) -> bool:
        """Return whether the configuration allows a command; send an event if not."""
        if not allowed:
            self.replies.reject(event_id, f"{what} commands invalid without CFE_PLATFORM_TIME_CFG_{option} set to TRUE")
        return allowed

    def _for_server(self, event_id: int, what: str) -> bool:
        return self._is_allowed(not self._settings.client, event_id, what, "SERVER")

    # -- counters and telemetry ------------------------------------------------------------------------------------

    def _noop(self, packet: bytes) -> None:
        self.replies.accept(ev.NOOP_EID, f"No-op Cmd Rcvd: {self._version_text}")

    def _reset_counters(self, packet: bytes) -> None:
        self.replies.reset()
        self._tone.counters = ToneCounters()
        self._version_at_reset = self._clock.version
        self.replies.send(ev.RESET_EID, "Reset Counters command", ev.DEBUG)

    def _send_housekeeping(self, packet: bytes) -> None:
        self._on_housekeeping()
        fields = housekeeping(self._clock, self._tone, self.replies)
        self._ports.sb.transmit_msg(pk.HK_TLM.packet(fields))

    def _send_diagnostic(self, packet: bytes) -> None:
        self.replies.command_counter += 1
        fields = diagnostic(self._clock, self._tone, self._version_at_reset, self.data_store)
        self._ports.sb.transmit_msg(pk.DIAG_TLM.packet(fields))
        self.replies.send(ev.DIAG_EID, "Request diagnostics command", ev.DEBUG)

    # -- selections ------------------------------------------------------------------------------------------------

    def _set_state(self, packet: bytes) -> None:
        state = pk.SET_STATE.read(packet)["ClockState"]
        if state not in _STATES:
            self.replies.reject(ev.STATE_ERR_EID, f"Invalid Clock State = 0x{state & MASK_32:X}")
            return
        self._tone.forced_to_fly = state == CLOCK_FLYWHEEL
        if state == CLOCK_FLYWHEEL:
            self._tone.fly()
        else:
            self._clock.update(was_set=state == CLOCK_VALID)
        self.replies.accept(ev.STATE_EID, f"Set Clock State = {_STATES[state]}")

    def _set_source(self, packet: bytes) -> None:
        source = pk.SET_SOURCE.read(packet)["TimeSource"]
        if source not in _SOURCES:
            self.replies.reject(ev.SOURCE_ERR_EID, f"Invalid Time Source = 0x{source & MASK_32:X}")
        elif self._is_allowed(self._settings.can_select_source, ev.SOURCE_CFG_EID, "Set Source", "SOURCE"):
            self._tone.source = source
            self.replies.accept(ev.SOURCE_EID, f"Set Time Source = {_SOURCES[source]}")

    def _set_signal(self, packet: bytes) -> None:
        signal = pk.SET_SIGNAL.read(packet)["ToneSource"]
        if signal not in _SIGNALS:
            self.replies.reject(ev.SIGNAL_ERR_EID, f"Invalid Tone Source = 0x{signal & MASK_32:X}")
        elif self._is_allowed(self._settings.can_select_signal, ev.SIGNAL_CFG_EID, "Set Signal", "SIGNAL"):
            self._tone.signal = signal
            self.replies.accept(ev.SIGNAL_EID, f"Set Tone Source = {_SIGNALS[signal]}")

    # -- setting the clock -----------------------------------------------------------------------------------------

    def _set_delay(self, direction: int, packet: bytes) -> None:
        ticks = self._time(packet, "Tone Delay", ev.DELAY_ERR_EID)
        if ticks is not None and self._is_allowed(self._settings.client, ev.DELAY_CFG_EID, "Set Delay", "CLIENT"):
            self._clock.update(delay=ticks, delay_direction=direction)
            self.replies.accept(ev.DELAY_EID, f"Set Tone Delay -- {_amount(packet)}, dir = {direction}")

    def _set_time(self, packet: bytes) -> None:
        ticks = self._time(packet, "Time", ev.TIME_ERR_EID)
        if ticks is not None and self._for_server(ev.TIME_CFG_EID, "Set Time"):
            leaps = self._clock.reference.leap_seconds << 32 if self._settings.utc else 0
            self._clock.update(stcf=ticks - self._clock.current_met() + leaps)
            self.replies.accept(ev.TIME_EID, f"Set Time -- {_amount(packet)}")

    def _set_met(self, packet: bytes) -> None:
        ticks = self._time(packet, "MET", ev.MET_ERR_EID)
        if ticks is not None and self._for_server(ev.MET_CFG_EID, "Set MET"):
            self._tone.virtual_met = ticks >> 32
            self._clock.update(met=ticks, latch=self._clock.local())
            self.replies.accept(ev.MET_EID, f"Set MET -- {_amount(packet)}")

    def _set_stcf(self, packet: bytes) -> None:
        ticks = self._time(packet, "STCF", ev.STCF_ERR_EID)
        if ticks is not None and self._for_server(ev.STCF_CFG_EID, "Set STCF"):
            self._clock.update(stcf=ticks)
            self.replies.accept(ev.STCF_EID, f"Set STCF -- {_amount(packet)}")

    def _set_leap_seconds(self, packet: bytes) -> None:
        if self._for_server(ev.LEAPS_CFG_EID, "Set Leaps"):
            leaps = pk.SET_LEAP_SECONDS.read(packet)["LeapSeconds"]
            self._clock.update(leap_seconds=leaps)
            self.replies.accept(ev.LEAPS_EID, f"Set Leap Seconds = {leaps}")

    def _adjust(self, direction: int, packet: bytes) -> None:
        ending = f", dir[1=Pos, 2=Neg] = {direction}"
        ticks = self._time(packet, "STCF Adjust", ev.DELTA_ERR_EID, ending)
        if ticks is not None and self._for_server(ev.DELTA_CFG_EID, "STCF Adjust"):
            adjustments = self._tone.adjustments
            adjustments.one_time, adjustments.one_time_direction = ticks, direction
            self._tone.adjust(ticks, direction)
            self.replies.accept(ev.DELTA_EID, f"STCF Adjust -- {_amount(packet)}{ending}")

    def _one_hz(self, direction: int, packet: bytes) -> None:
        if not self._for_server(ev.ONEHZ_CFG_EID, "1Hz Adjust"):
            return
        fields = pk.ADD_ONE_HZ_ADJUSTMENT.read(packet)
        seconds, subseconds = fields["Seconds"], fields["Subseconds"]
        adjustments = self._tone.adjustments
        adjustments.one_hz, adjustments.one_hz_direction = to_ticks((seconds, subseconds)), direction
        shown = seconds - (seconds >> 31 << 32)  # the event shows signed seconds
        text = f"STCF 1Hz Adjust -- secs = {shown}, ssecs = 0x{subseconds:X}, dir[1=Pos, 2=Neg] = {direction}"
        self.replies.accept(ev.ONEHZ_EID, text)

    def _time(self, packet: bytes, what: str, invalid: int, ending: str = "") -> int | None:
        """Return the time in a command, in ticks; None after an error event if its microseconds are a second
        or more.
        """
        seconds, micros = _seconds_and_micros(packet)
        if micros >= US_PER_S:
            self.replies.reject(invalid, f"Invalid {what} -- secs = {seconds}, usecs = {micros}{ending}")
            return None
        return to_ticks((seconds, micro2sub_secs(micros)))


def _seconds_and_micros(packet: bytes) -> tuple[int, int]:
    """Return the payload of a command with a time, which is the same for all these commands."""
    fields = pk.SET_TIME.read(packet)
    return fields["Seconds"], fields["MicroSeconds"]


def _amount(packet: bytes) -> str:
    seconds, micros = _seconds_and_micros(packet)
    return f"secs = {seconds}, usecs = {micros}, ssecs = 0x{micro2sub_secs(micros):X}"
