"""The commands of Time Services: what the ground may ask for, and what each answers (cfe_time_task.c).

This processor is a time server whose source and tone signal cannot be switched, so commands for time clients and for
external sources are refused in NASA's words. Imports no other service.
"""

from __future__ import annotations

from collections.abc import Callable

from cfepy.msg import CMD_HEADER_SIZE, CommandTable, Dispatch, Layout, telemetry
from cfepy.msg.dispatch import BAD_CODE, BAD_LENGTH, BAD_MSG_ID
from cfepy.ports import Ports
from cfepy.time import events as ev
from cfepy.time import packets as pk
from cfepy.time.clock import CLOCK_FLYWHEEL, CLOCK_INVALID, CLOCK_VALID, SpacecraftTime
from cfepy.time.systime import MASK_32, micro2sub_secs, to_ticks
from cfepy.time.telemetry import RESET_AREA_NEW, diagnostic, housekeeping
from cfepy.time.tone import ADD, SUBTRACT, Counters, Tone
from cfepy.versions import version_string

_STATES = {CLOCK_INVALID: "INVALID", CLOCK_VALID: "VALID", CLOCK_FLYWHEEL: "FLYWHEEL"}
_MICROS_PER_SECOND = 1_000_000
_SELECTIONS = (1, 2)
"""Internal or external source, primary or redundant signal."""


class TimeCommands:
    """Handles the packets of Time Services' pipe that are not about the tone.

    Args:
        ports: the other services.
        clock: what commands set.
        tone: likewise.
        on_housekeeping: called before each housekeeping packet (NASA saves the reset variables then).

    Attributes:
        table: message ids and function codes with their handlers; the tone's own are added by the task.
        count: commands that were done.
        errors: commands that were refused.
        reset_area: where the start values came from, for the diagnostic packet.
    """

    def __init__(self, ports: Ports, clock: SpacecraftTime, tone: Tone, on_housekeeping: Callable[[], object]) -> None:
        self.table = CommandTable()
        self.count = 0
        self.errors = 0
        self.reset_area = RESET_AREA_NEW
        self._ports = ports
        self._clock = clock
        self._tone = tone
        self._on_housekeeping = on_housekeeping
        self._version_at_reset = 0
        self._fill_table()

    def _fill_table(self) -> None:
        for code, layout, handler in (
            (pk.CFE_TIME_NOOP_CC, None, self._noop),
            (pk.CFE_TIME_RESET_COUNTERS_CC, None, self._reset_counters),
            (pk.CFE_TIME_SEND_DIAGNOSTIC_CC, None, self._send_diagnostic),
            (pk.CFE_TIME_SET_SOURCE_CC, pk.SOURCE_COMMAND, self._set_source),
            (pk.CFE_TIME_SET_SIGNAL_CC, pk.SIGNAL_COMMAND, self._set_signal),
            (pk.CFE_TIME_SET_STATE_CC, pk.STATE_COMMAND, self._set_state),
            (pk.CFE_TIME_SET_LEAP_SECONDS_CC, pk.LEAPS_COMMAND, self._set_leap_seconds),
            (pk.CFE_TIME_ADD_DELAY_CC, pk.TIME_COMMAND, self._set_delay),
            (pk.CFE_TIME_SUB_DELAY_CC, pk.TIME_COMMAND, self._set_delay),
            (pk.CFE_TIME_SET_TIME_CC, pk.TIME_COMMAND, self._set_time),
            (pk.CFE_TIME_SET_MET_CC, pk.TIME_COMMAND, self._set_met),
            (pk.CFE_TIME_SET_STCF_CC, pk.TIME_COMMAND, self._set_stcf),
            (pk.CFE_TIME_ADD_ADJUST_CC, pk.TIME_COMMAND, lambda packet: self._adjust(packet, ADD)),
            (pk.CFE_TIME_SUB_ADJUST_CC, pk.TIME_COMMAND, lambda packet: self._adjust(packet, SUBTRACT)),
            (pk.CFE_TIME_ADD_ONE_HZ_ADJUSTMENT_CC, pk.ONE_HZ_COMMAND, lambda packet: self._one_hz(packet, ADD)),
            (pk.CFE_TIME_SUB_ONE_HZ_ADJUSTMENT_CC, pk.ONE_HZ_COMMAND, lambda packet: self._one_hz(packet, SUBTRACT)),
        ):
            self.table.add(pk.CFE_TIME_CMD_MID, code, CMD_HEADER_SIZE + (layout.size if layout else 0), handler)
        self.table.add_message(pk.CFE_TIME_SEND_HK_MID, CMD_HEADER_SIZE, self._send_housekeeping)

    def process(self, packet: bytes) -> None:
        """Handle one packet of the pipe (CFE_TIME_TaskPipe)."""
        done = self.table.dispatch(packet)
        if done.outcome in (BAD_MSG_ID, BAD_CODE, BAD_LENGTH):
            self._reject(done)

    def _reject(self, done: Dispatch) -> None:
        if done.outcome == BAD_MSG_ID:
            event_id, text = ev.CFE_TIME_ID_ERR_EID, f"Invalid message ID -- ID = 0x{done.msg_id:X}"
        elif done.outcome == BAD_CODE:
            event_id = ev.CFE_TIME_CC_ERR_EID
            text = f"Invalid command code -- ID = 0x{done.msg_id:X}, CC = {done.fcn_code}"
        else:
            event_id, text = ev.CFE_TIME_LEN_ERR_EID, done.length_text()
        self.errors += done.outcome != BAD_MSG_ID
        self._ports.evs.send_event(event_id, ev.ERROR, text)

    def _done(self, event_id: int, text: str) -> None:
        self.count += 1
        self._ports.evs.send_event(event_id, ev.INFORMATION, text)

    def _refuse(self, event_id: int, text: str) -> None:
        self.errors += 1
        self._ports.evs.send_event(event_id, ev.ERROR, text)

    # -- counters and telemetry ------------------------------------------------------------------------------------

    def _noop(self, packet: bytes) -> None:
        self._done(ev.CFE_TIME_NOOP_EID, f"No-op Cmd Rcvd: {version_string('CFE_TIME')}")

    def _reset_counters(self, packet: bytes) -> None:
        self.count = self.errors = 0
        self._tone.counters = Counters()
        self._version_at_reset = self._clock.version
        self._ports.evs.send_event(ev.CFE_TIME_RESET_EID, ev.DEBUG, "Reset Counters command")

    def _send_housekeeping(self, packet: bytes) -> None:
        self._on_housekeeping()
        fields = housekeeping(self._clock, self._tone, self.count, self.errors)
        self._transmit(pk.CFE_TIME_HK_TLM_MID, pk.HOUSEKEEPING.pack(fields))

    def _send_diagnostic(self, packet: bytes) -> None:
        self.count += 1
        fields = diagnostic(self._clock, self._tone, self._version_at_reset, self.reset_area)
        self._transmit(pk.CFE_TIME_DIAG_TLM_MID, pk.DIAGNOSTIC.pack(fields))
        self._ports.evs.send_event(ev.CFE_TIME_DIAG_EID, ev.DEBUG, "Request diagnostics command")

    def _transmit(self, msg_id: int, payload: bytes) -> None:
        self._ports.sb.transmit_msg(bytes(telemetry(msg_id, payload)))

    # -- setting the clock -----------------------------------------------------------------------------------------

    def _set_time(self, packet: bytes) -> None:
        ticks = self._time(packet, "Time", ev.CFE_TIME_TIME_ERR_EID)
        if ticks is not None:
            self._clock.set(stcf=ticks - self._clock.current_met())
            self._tell_set(packet, "Time", ev.CFE_TIME_TIME_EID)

    def _set_met(self, packet: bytes) -> None:
        ticks = self._time(packet, "MET", ev.CFE_TIME_MET_ERR_EID)
        if ticks is not None:
            self._tone.virtual_met = ticks >> 32
            self._clock.set(met=ticks, latch=self._clock.local())
            self._tell_set(packet, "MET", ev.CFE_TIME_MET_EID)

    def _set_stcf(self, packet: bytes) -> None:
        ticks = self._time(packet, "STCF", ev.CFE_TIME_STCF_ERR_EID)
        if ticks is not None:
            self._clock.set(stcf=ticks)
            self._tell_set(packet, "STCF", ev.CFE_TIME_STCF_EID)

    def _set_leap_seconds(self, packet: bytes) -> None:
        leaps = _only(pk.LEAPS_COMMAND, packet)
        self._clock.leap_seconds = leaps
        self._clock.note_change()
        self._done(ev.CFE_TIME_LEAPS_EID, f"Set Leap Seconds = {leaps}")

    def _adjust(self, packet: bytes, direction: int) -> None:
        ending = f", dir[1=Pos, 2=Neg] = {direction}"
        ticks = self._time(packet, "STCF Adjust", ev.CFE_TIME_DELTA_ERR_EID, ending)
        if ticks is not None:
            adjustments = self._tone.adjustments
            adjustments.one_time, adjustments.one_time_direction = ticks, direction
            self._tone.adjust(ticks, direction)
            self._done(ev.CFE_TIME_DELTA_EID, f"STCF Adjust -- {_amount(packet)}{ending}")

    def _one_hz(self, packet: bytes, direction: int) -> None:
        fields = pk.ONE_HZ_COMMAND.unpack(packet, CMD_HEADER_SIZE)
        seconds, subseconds = fields["Seconds"], fields["Subseconds"]
        adjustments = self._tone.adjustments
        adjustments.one_hz, adjustments.one_hz_direction = to_ticks((seconds, subseconds)), direction
        text = f"STCF 1Hz Adjust -- secs = {seconds}, ssecs = 0x{subseconds:X}, dir[1=Pos, 2=Neg] = {direction}"
        self._done(ev.CFE_TIME_ONEHZ_EID, text)

    def _set_state(self, packet: bytes) -> None:
        state = _only(pk.STATE_COMMAND, packet)
        if state not in _STATES:
            self._refuse(ev.CFE_TIME_STATE_ERR_EID, f"Invalid Clock State = 0x{state & MASK_32:X}")
            return
        self._tone.forced_to_fly = state == CLOCK_FLYWHEEL
        if state == CLOCK_FLYWHEEL:
            self._tone.fly()
        else:
            self._clock.was_set = state == CLOCK_VALID
            self._clock.note_change()
        self._done(ev.CFE_TIME_STATE_EID, f"Set Clock State = {_STATES[state]}")

    def _time(self, packet: bytes, what: str, invalid: int, ending: str = "") -> int | None:
        """The time in a command, in ticks; None after an event when its microseconds make a second or more."""
        fields = pk.TIME_COMMAND.unpack(packet, CMD_HEADER_SIZE)
        seconds, micros = fields["Seconds"], fields["MicroSeconds"]
        if micros >= _MICROS_PER_SECOND:
            self._refuse(invalid, f"Invalid {what} -- secs = {seconds}, usecs = {micros}{ending}")
            return None
        return to_ticks((seconds, micro2sub_secs(micros)))

    def _tell_set(self, packet: bytes, what: str, event_id: int) -> None:
        self._done(event_id, f"Set {what} -- {_amount(packet)}")

    # -- what this configuration cannot do -------------------------------------------------------------------------

    def _set_source(self, packet: bytes) -> None:
        source = _only(pk.SOURCE_COMMAND, packet)
        if source in _SELECTIONS:
            self._refuse(ev.CFE_TIME_SOURCE_CFG_EID, _not_configured("Source", "SOURCE"))
        else:
            self._refuse(ev.CFE_TIME_SOURCE_ERR_EID, f"Invalid Time Source = 0x{source & MASK_32:X}")

    def _set_signal(self, packet: bytes) -> None:
        signal = _only(pk.SIGNAL_COMMAND, packet)
        if signal in _SELECTIONS:
            self._refuse(ev.CFE_TIME_SIGNAL_CFG_EID, _not_configured("Signal", "SIGNAL"))
        else:
            self._refuse(ev.CFE_TIME_SIGNAL_ERR_EID, f"Invalid Tone Source = 0x{signal & MASK_32:X}")

    def _set_delay(self, packet: bytes) -> None:
        if self._time(packet, "Tone Delay", ev.CFE_TIME_DELAY_ERR_EID) is not None:
            self._refuse(ev.CFE_TIME_DELAY_CFG_EID, _not_configured("Delay", "CLIENT"))


def _only(layout: Layout, packet: bytes) -> int:
    """The value of a payload with a single field."""
    value: int = next(iter(layout.unpack(packet, CMD_HEADER_SIZE).values()))
    return value


def _amount(packet: bytes) -> str:
    fields = pk.TIME_COMMAND.unpack(packet, CMD_HEADER_SIZE)
    seconds, micros = fields["Seconds"], fields["MicroSeconds"]
    return f"secs = {seconds}, usecs = {micros}, ssecs = 0x{micro2sub_secs(micros):X}"


def _not_configured(what: str, option: str) -> str:
    return f"Set {what} commands invalid without CFE_PLATFORM_TIME_CFG_{option} set to TRUE"
