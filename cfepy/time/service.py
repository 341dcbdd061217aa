"""Time Services as applications and the other services call them (cfe_time.h).

MET, STCF, leap seconds, TAI and UTC on the kernel's virtual time; spacecraft time is TAI. Imports no other service.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cfepy.config import PlatformConfig
from cfepy.ids import ES_APPID_BASE, to_index
from cfepy.ports import Ports
from cfepy.rtos import Kernel, Semaphore
from cfepy.rtos.units import NS_PER_S
from cfepy.status import (
    CFE_TIME_BAD_ARGUMENT,
    CFE_TIME_CALLBACK_NOT_REGISTERED,
    CFE_TIME_TOO_MANY_SYNCH_CALLBACKS,
    CfeError,
)
from cfepy.time import systime as st
from cfepy.time.clock import SpacecraftTime
from cfepy.time.commands import TimeCommands
from cfepy.time.systime import SysTime, from_ticks, to_ticks
from cfepy.time.task import TimeTask
from cfepy.time.telemetry import RESET_AREA_EXISTING, clock_info
from cfepy.time.tone import Tone

SynchCallback = Callable[[], object]


class ResetVars(NamedTuple):
    """What outlives a processor reset (CFE_TIME_ResetVars_t)."""

    met: SysTime
    stcf: SysTime
    delay: SysTime
    leap_seconds: int


class TimeServices:
    """Time of one processor.

    Args:
        kernel: its virtual time is the local clock.
        ports: the other services.
        config: the start values and limits.

    Attributes:
        clock: reference state, and the cached telemetry stamp `clock.stamp_now` of `clock.stamp_at`.
        tone: the tone's state and counters.
        commands: counters of the commands.
        reset_vars: as of the last housekeeping packet, to be given to `early_init` after a processor reset.
        now: spacecraft time as SysTime.
        stamp: spacecraft time for a telemetry header, seconds << 16 | upper subseconds.
    """

    now: Callable[[], SysTime]
    stamp: Callable[[], int]

    def __init__(self, kernel: Kernel, ports: Ports, config: PlatformConfig) -> None:
        self.clock = SpacecraftTime(kernel)
        self.now = self.clock.now
        self.stamp = self.clock.stamp
        self.reset_vars: ResetVars | None = None
        self._kernel = kernel
        self._ports = ports
        self._config = config
        self._callbacks: dict[int, SynchCallback] = {}
        tone_ready = Semaphore(kernel, 0, 1, "TIME_TONE_SEM")
        self.tone = Tone(self.clock, ports, config.time_start_fly_secs, tone_ready.give, self._notify)
        self.commands = TimeCommands(ports, self.clock, self.tone, self._save)
        self._task = TimeTask(kernel, ports, config, self.clock, self.tone, self.commands, tone_ready)

    def early_init(self, saved: ResetVars | None = None) -> None:
        """Start the clock, before any task exists (CFE_TIME_EarlyInit).

        Args:
            saved: what `reset_vars` was before a processor reset; None starts with the configured values.
        """
        config, clock = self._config, self.clock
        start = saved or ResetVars(
            SysTime(config.time_def_met_secs, 0),
            SysTime(config.time_def_stcf_secs, 0),
            SysTime(0, 0),
            config.time_def_leaps,
        )
        if saved is not None:
            self.commands.reset_area = RESET_AREA_EXISTING
        clock.leap_seconds = start.leap_seconds
        clock.delay = to_ticks(start.delay)
        clock.set(met=to_ticks(start.met), stcf=to_ticks(start.stcf), latch=clock.local())
        self.tone.virtual_met = start.met.seconds
        self._task.whole_second_ns = self._kernel.now - (start.met.subseconds * NS_PER_S >> 32)

    def task_main(self) -> None:
        """The main task of CFE_TIME (CFE_TIME_TaskMain)."""
        self._task.main()

    def cleanup_app(self, app_id: int) -> None:
        """Forget the callback of an application that ended (CFE_TIME_CleanUpApp)."""
        self._callbacks.pop(app_id, None)

    def _save(self) -> None:
        clock = self.clock
        self.reset_vars = ResetVars(
            from_ticks(clock.current_met()), from_ticks(clock.stcf), from_ticks(clock.delay), clock.leap_seconds
        )

    # -- what time it is -------------------------------------------------------------------------------------------

    def text(self) -> str:
        """Spacecraft time as `print_` writes it."""
        return st.print_(self.clock.now())

    def get_time(self) -> SysTime:
        """Spacecraft time, which is TAI (CFE_TIME_GetTime)."""
        return self.clock.now()

    def get_tai(self) -> SysTime:
        """International Atomic Time: MET plus STCF (CFE_TIME_GetTAI)."""
        return from_ticks(self.clock.current_tai())

    def get_utc(self) -> SysTime:
        """Coordinated Universal Time: TAI less leap seconds (CFE_TIME_GetUTC)."""
        return from_ticks(self.clock.current_utc())

    def get_met(self) -> SysTime:
        """Mission elapsed time (CFE_TIME_GetMET)."""
        return from_ticks(self.clock.current_met())

    def get_met_seconds(self) -> int:
        """Whole seconds of MET (CFE_TIME_GetMETseconds)."""
        return self.get_met().seconds

    def get_met_subsecs(self) -> int:
        """Subseconds of MET, in 2**-32 s (CFE_TIME_GetMETsubsecs)."""
        return self.get_met().subseconds

    def get_stcf(self) -> SysTime:
        """Spacecraft time correlation factor, what is added to MET (CFE_TIME_GetSTCF)."""
        return from_ticks(self.clock.stcf)

    def get_leap_seconds(self) -> int:
        """Seconds that TAI is ahead of UTC (CFE_TIME_GetLeapSeconds)."""
        return self.clock.leap_seconds

    def get_clock_state(self) -> int:
        """-1 not set, 0 valid, 1 flywheel (CFE_TIME_GetClockState)."""
        return self.clock.state()

    def get_clock_info(self) -> int:
        """The clock state flags, 16 bits (CFE_TIME_GetClockInfo)."""
        return clock_info(self.clock, self.tone)

    # -- arithmetic ------------------------------------------------------------------------------------------------

    add = staticmethod(st.add)
    subtract = staticmethod(st.subtract)
    compare = staticmethod(st.compare)
    sub2micro_secs = staticmethod(st.sub2micro_secs)
    micro2sub_secs = staticmethod(st.micro2sub_secs)
    print_ = staticmethod(st.print_)

    def met2sc_time(self, met: tuple[int, int]) -> SysTime:
        """The spacecraft time that a mission elapsed time is (CFE_TIME_MET2SCTime)."""
        return st.add(met, self.get_stcf())

    # -- signals ---------------------------------------------------------------------------------------------------

    def register_synch_callback(self, callback: SynchCallback) -> None:
        """Have a function called at every good tone, in the task CFE_TIME (CFE_TIME_RegisterSynchCallback).

        Raises:
            CfeError: CFE_TIME_BAD_ARGUMENT (not callable), CFE_TIME_TOO_MANY_SYNCH_CALLBACKS (the application has one).
        """
        app_id = self._callback_owner(callback)
        if app_id in self._callbacks:
            raise CfeError(
                CFE_TIME_TOO_MANY_SYNCH_CALLBACKS, "an application may have one callback; unregister it first"
            )
        self._callbacks[app_id] = callback

    def unregister_synch_callback(self, callback: SynchCallback) -> None:
        """Call it no more (CFE_TIME_UnregisterSynchCallback).

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
            self._callbacks[app_id]()

    def local1hz_isr(self) -> None:
        """A local 1 Hz signal from a board without timers (CFE_TIME_Local1HzISR)."""
        self._task.interrupt(self.clock.local())

    def external_tone(self) -> None:
        """A tone from outside (CFE_TIME_ExternalTone)."""
        self.tone.interrupt(self.clock.local())
