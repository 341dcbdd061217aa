"""Time Services as applications and the other services call them (cfe_time.h).

MET, STCF, leap seconds, TAI and UTC on the kernel's virtual time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.config.platform import PlatformConfig
from cfepy.ids import ES_APPID_BASE, to_index
from cfepy.ports import Ports
from cfepy.rtos import Kernel, Semaphore
from cfepy.status import (
    CFE_TIME_BAD_ARGUMENT,
    CFE_TIME_CALLBACK_NOT_REGISTERED,
    CFE_TIME_NOT_IMPLEMENTED,
    CFE_TIME_TOO_MANY_SYNCH_CALLBACKS,
    CfeError,
)
from cfepy.time import reset_vars
from cfepy.time import systime as st
from cfepy.time.clock import SpacecraftTime
from cfepy.time.commands import TimeCommands
from cfepy.time.settings import TimeSettings
from cfepy.time.systime import SysTime, from_ticks
from cfepy.time.task import TimeTask
from cfepy.time.telemetry import clock_info
from cfepy.time.tone import Tone, ToneDataSender
from cfepy.units import NS_PER_S

SynchCallback = Callable[[], object]


class TimeServices:
    """The Time Services of one processor.

    Args:
        kernel: its virtual time is the local clock.
        ports: the other services.
        config: the start values and limits.

    Attributes:
        clock: reference state, and the cached telemetry stamp `clock.stamp_now` of `clock.stamp_at`.
        tone: the tone's state and counters.
        task: its tasks, with the local 1 Hz signal.
        commands: counters of the commands.
        now: spacecraft time as SysTime.
        stamp: spacecraft time for a telemetry header, seconds << 16 | upper subseconds.
    """

    now: Callable[[], SysTime]
    stamp: Callable[[], int]

    def __init__(self, kernel: Kernel, ports: Ports, config: PlatformConfig) -> None:
        self._settings = settings = TimeSettings.of(config)
        self.clock = SpacecraftTime(kernel, settings.utc, settings.client)
        self.now = self.clock.now
        self.stamp = self.clock.stamp
        self._kernel = kernel
        self._ports = ports
        self._config = config
        self._callbacks: dict[int, SynchCallback] = {}
        self._kept: dict[str, Any] = {}
        tone_ready = Semaphore(kernel, 0, 1, "TIME_TONE_SEM")
        self.tone = Tone(self.clock, settings, ports, tone_ready.give, self._notify)
        self.commands = TimeCommands(
            ports, self.clock, self.tone, settings, self._save, config.release.text("CFE_TIME")
        )
        self._sender = ToneDataSender(ports, self.clock, self.tone, settings)
        self.task = TimeTask(kernel, ports, config, settings, self.tone, self._sender, self.commands, tone_ready)

    def early_init(self, kept: dict[str, Any]) -> None:
        """Start the clock, before any task exists (CFE_TIME_EarlyInit).

        Args:
            kept: objects that outlive a processor reset; "TIME" has the reset variables. They are saved there again
                with each housekeeping packet.
        """
        clock = self.clock
        self._kept = kept
        self.commands.data_store = reset_vars.start(kept, clock, self.tone, self._settings)
        clock.update(latch=clock.local())
        met = from_ticks(clock.reference.met)
        self.tone.virtual_met = met.seconds
        self.task.whole_second_ns = self._kernel.now - (met.subseconds * NS_PER_S >> 32)

    def task_main(self) -> None:
        """Run the main task of CFE_TIME (CFE_TIME_TaskMain)."""
        self.task.main()

    def cleanup_app(self, app_id: int) -> None:
        """Remove the callback of an ended application (CFE_TIME_CleanUpApp)."""
        self._callbacks.pop(app_id, None)

    def _save(self) -> None:
        reset_vars.save(self._kept, self.clock, self.tone)

    # -- the present time ------------------------------------------------------------------------------------------

    def text(self) -> str:
        """Return the spacecraft time in the format of `print_`."""
        return st.print_(self.clock.now())

    def get_time(self) -> SysTime:
        """Return the spacecraft time: TAI, or UTC if so configured (CFE_TIME_GetTime)."""
        return self.clock.now()

    def get_tai(self) -> SysTime:
        """Return International Atomic Time: MET plus STCF (CFE_TIME_GetTAI)."""
        return from_ticks(self.clock.current_tai())

    def get_utc(self) -> SysTime:
        """Return Coordinated Universal Time: TAI minus leap seconds (CFE_TIME_GetUTC)."""
        return from_ticks(self.clock.current_utc())

    def get_met(self) -> SysTime:
        """Return the mission elapsed time (CFE_TIME_GetMET)."""
        return from_ticks(self.clock.current_met())

    def get_met_seconds(self) -> int:
        """Return the whole seconds of MET (CFE_TIME_GetMETseconds)."""
        return self.get_met().seconds

    def get_met_subsecs(self) -> int:
        """Return the subseconds of MET, in 2**-32 s (CFE_TIME_GetMETsubsecs)."""
        return self.get_met().subseconds

    def get_stcf(self) -> SysTime:
        """Return the spacecraft time correlation factor, which is added to MET (CFE_TIME_GetSTCF)."""
        return from_ticks(self.clock.reference.stcf)

    def get_leap_seconds(self) -> int:
        """Return the seconds by which TAI is ahead of UTC (CFE_TIME_GetLeapSeconds)."""
        return self.clock.reference.leap_seconds

    def get_clock_state(self) -> int:
        """Return -1 if not set, 0 if valid, 1 in flywheel mode (CFE_TIME_GetClockState)."""
        return self.clock.state()

    def get_clock_info(self) -> int:
        """Return the clock state flags, 16 bits (CFE_TIME_GetClockInfo)."""
        return clock_info(self.clock, self.tone)

    # -- arithmetic ------------------------------------------------------------------------------------------------

    add = staticmethod(st.add)
    copy = staticmethod(st.copy)
    subtract = staticmethod(st.subtract)
    compare = staticmethod(st.compare)
    sub2micro_secs = staticmethod(st.sub2micro_secs)
    micro2sub_secs = staticmethod(st.micro2sub_secs)
    print_ = staticmethod(st.print_)

    def met2sc_time(self, met: tuple[int, int]) -> SysTime:
        """Return the spacecraft time of a mission elapsed time (CFE_TIME_MET2SCTime)."""
        tai = st.add(met, self.get_stcf())
        return st.subtract(tai, (self.get_leap_seconds(), 0)) if self._settings.utc else tai

    # -- signals ---------------------------------------------------------------------------------------------------

    def register_synch_callback(self, callback: SynchCallback) -> None:
        """Register a function to call at every good tone, in the task CFE_TIME (CFE_TIME_RegisterSynchCallback).

        Raises:
            CfeError: CFE_TIME_BAD_ARGUMENT (not callable), CFE_TIME_TOO_MANY_SYNCH_CALLBACKS (the application already
                has one).
        """
        app_id = self._callback_owner(callback)
        if app_id in self._callbacks:
            raise CfeError(
                CFE_TIME_TOO_MANY_SYNCH_CALLBACKS, "the application already has a callback; unregister it first"
            )
        self._callbacks[app_id] = callback

    def unregister_synch_callback(self, callback: SynchCallback) -> None:
        """Unregister the function (CFE_TIME_UnregisterSynchCallback).

        Raises:
            CfeError: CFE_TIME_BAD_ARGUMENT (not callable), CFE_TIME_CALLBACK_NOT_REGISTERED.
        """
        app_id = self._callback_owner(callback)
        if self._callbacks.get(app_id) != callback:
            raise CfeError(CFE_TIME_CALLBACK_NOT_REGISTERED, "the calling application did not register this callback")
        del self._callbacks[app_id]

    def _callback_owner(self, callback: SynchCallback) -> int:
        if not callable(callback):
            raise CfeError(CFE_TIME_BAD_ARGUMENT, f"{callback!r} is not a function")
        return self._ports.es.get_app_id()

    def _notify(self) -> None:
        """Call the callbacks in the order of the applications' slots (CFE_TIME_NotifyTimeSynchApps)."""
        slots = self._config.es_max_applications
        for app_id in sorted(self._callbacks, key=lambda app_id: to_index(app_id, ES_APPID_BASE, slots)):
            callback = self._callbacks.get(app_id)
            if callback is not None:  # an earlier callback may have ended this application
                callback()

    def local1hz_isr(self) -> None:
        """Handle a local 1 Hz signal of a board without timers (CFE_TIME_Local1HzISR)."""
        self.task.interrupt(self.clock.local())

    def external_tone(self) -> None:
        """Handle an external tone at this instant (CFE_TIME_ExternalTone)."""
        self.tone.interrupt(self.clock.local())

    def external_met(self, new_met: tuple[int, int]) -> None:
        """Receive the MET at the tone, as seconds and subseconds (CFE_TIME_ExternalMET).

        Raises:
            CfeError: CFE_TIME_NOT_IMPLEMENTED without `time_cfg_src_met`; NASA's code does not compile then.
        """
        self._need_source("met")
        self._sender.send_met(new_met)

    def external_gps(self, new_time: tuple[int, int], new_leaps: int) -> None:
        """Receive the spacecraft time at the tone and its leap seconds (CFE_TIME_ExternalGPS).

        Raises:
            CfeError: CFE_TIME_NOT_IMPLEMENTED without `time_cfg_src_gps`.
        """
        self._need_source("gps")
        self._sender.send_time(new_time, new_leaps)

    def external_time(self, new_time: tuple[int, int]) -> None:
        """Receive the spacecraft time at the tone (CFE_TIME_ExternalTime).

        Raises:
            CfeError: CFE_TIME_NOT_IMPLEMENTED without `time_cfg_src_time`.
        """
        self._need_source("time")
        self._sender.send_time(new_time)

    def _need_source(self, source: str) -> None:
        if self._settings.external != source:
            text = f"requires the board limits time_cfg_source: true, time_cfg_src_{source}: true"
            raise CfeError(CFE_TIME_NOT_IMPLEMENTED, text)
