"""The tasks of Time Services: CFE_TIME itself, one that tells of every tone, and one that tells of every second.

A timer gives the local 1 Hz signal at the whole seconds of MET. Stands for CFE_TIME_TaskMain, CFE_TIME_Tone1HzTask,
CFE_TIME_Local1HzTask and the timer "cFS-1Hz". Imports no other service.
"""

from __future__ import annotations

from cfepy.config import PlatformConfig
from cfepy.msg import CMD_HEADER_SIZE, command
from cfepy.ports import PEND_FOREVER, SYSTEM_CORE_READY, Ports
from cfepy.rtos import Kernel, Semaphore
from cfepy.rtos.units import NS_PER_S
from cfepy.time import events as ev
from cfepy.time import packets as pk
from cfepy.time.clock import SpacecraftTime
from cfepy.time.commands import TimeCommands
from cfepy.time.systime import ticks_of_ns
from cfepy.time.telemetry import fields_of
from cfepy.time.tone import SECOND, Tone
from cfepy.versions import version_string

PIPE_DEPTH = 12
PIPE_NAME = "TIME_CMD_PIPE"
TONE_TASK = ("TIME_TONE_TASK", 4096, 25)
ONE_HZ_TASK = ("TIME_ONEHZ_TASK", 8192, 25)
"""Name, stack in bytes, priority of the child tasks."""

TIMER_NAME = "cFS-1Hz"
TIMER_PRIORITY = 0


class TimeTask:
    """The tasks.

    Args:
        kernel: the processor.
        ports: the other services.
        config: limits.
        clock: the clock.
        tone: the tone.
        commands: handles the pipe; the tone's messages are added to its table.

    Attributes:
        tone_ready: given at each good tone.
        one_hz_ready: given at each local 1 Hz signal.
        whole_second_ns: a virtual time at which MET had no subseconds; the 1 Hz signal keeps to it.
    """

    def __init__(
        self,
        kernel: Kernel,
        ports: Ports,
        config: PlatformConfig,
        clock: SpacecraftTime,
        tone: Tone,
        commands: TimeCommands,
        tone_ready: Semaphore,
    ) -> None:
        self.tone_ready = tone_ready
        self.one_hz_ready = Semaphore(kernel, 0, 1, "TIME_ONEHZ_SEM")
        self.whole_second_ns = 0
        self._kernel = kernel
        self._ports = ports
        self._config = config
        self._clock = clock
        self._tone = tone
        self._commands = commands
        self._one_hz_latch = 0
        self._signals = [bytes(command(mid, 0)) for mid in (pk.CFE_TIME_TONE_CMD_MID, pk.CFE_TIME_SEND_CMD_MID)]
        self._one_hz_signal = bytes(command(pk.CFE_TIME_ONEHZ_CMD_MID, 0))
        for mid, size, handler in (
            (pk.CFE_TIME_ONEHZ_CMD_MID, CMD_HEADER_SIZE, self._one_hz_command),
            (pk.CFE_TIME_TONE_CMD_MID, CMD_HEADER_SIZE, self._tone_command),
            (pk.CFE_TIME_SEND_CMD_MID, CMD_HEADER_SIZE, self._send_command),
            (pk.CFE_TIME_DATA_CMD_MID, CMD_HEADER_SIZE + pk.TONE_DATA.size, self._data_command),
        ):
            commands.table.add_message(mid, size, handler)

    # -- tasks -----------------------------------------------------------------------------------------------------

    def main(self) -> None:
        """The task CFE_TIME (CFE_TIME_TaskMain)."""
        pipe = self._init()
        self._ports.es.wait_for_system_state(SYSTEM_CORE_READY, self._config.es_core_max_startup_ms)
        while True:
            self._ports.es.increment_task_counter()
            packet = self._ports.sb.receive_buffer(pipe, PEND_FOREVER)
            if packet is not None:
                self._commands.process(packet)

    def _init(self) -> int:
        ports = self._ports
        ports.evs.register()
        ports.es.create_child_task(TONE_TASK[0], self._tone_task, TONE_TASK[1], TONE_TASK[2])
        ports.es.create_child_task(ONE_HZ_TASK[0], self._one_hz_task, ONE_HZ_TASK[1], ONE_HZ_TASK[2])
        pipe = ports.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        ports.sb.subscribe(pk.CFE_TIME_SEND_HK_MID, pipe)
        for mid in (pk.CFE_TIME_TONE_CMD_MID, pk.CFE_TIME_DATA_CMD_MID, pk.CFE_TIME_ONEHZ_CMD_MID):
            ports.sb.subscribe_local(mid, pipe, self._config.sb_default_msg_limit)
        ports.sb.subscribe(pk.CFE_TIME_SEND_CMD_MID, pipe)
        ports.sb.subscribe(pk.CFE_TIME_CMD_MID, pipe)
        text = f"cFE TIME Initialized: {version_string('CFE_TIME')}"
        ports.evs.send_event(ev.CFE_TIME_INIT_EID, ev.INFORMATION, text)
        self._kernel.spawn(TIMER_NAME, self._timer, TIMER_PRIORITY)
        return pipe

    def _tone_task(self) -> None:
        while True:
            self._ports.es.increment_task_counter()
            self.tone_ready.take()
            for signal in self._signals:
                self._ports.sb.transmit_msg(signal)
            self._tone.counters.tone_task += 1

    def _one_hz_task(self) -> None:
        while True:
            self._ports.es.increment_task_counter()
            self.one_hz_ready.take()
            if self._tone.auto_start_fly:
                self._tone.auto_start_fly = False
                self._ports.evs.send_event(ev.CFE_TIME_FLY_ON_EID, ev.INFORMATION, "Start FLYWHEEL")
            self._ports.sb.transmit_msg(self._one_hz_signal)
            self._tone.counters.local_task += 1

    def _timer(self) -> None:
        """The timer: it keeps to the instants at which MET is whole, so that a tone never moves the clock."""
        kernel = self._kernel
        due = kernel.now + NS_PER_S - (kernel.now - self.whole_second_ns) % NS_PER_S
        self._tone.signal_latch = ticks_of_ns(due) - SECOND
        while True:
            kernel.delay(due - kernel.now)
            self.interrupt(ticks_of_ns(due))
            due += NS_PER_S

    def interrupt(self, latch: int) -> None:
        """The local 1 Hz signal (CFE_TIME_Local1HzISR).

        Args:
            latch: local time of the signal, in ticks.
        """
        self._one_hz_latch = latch
        self._tone.counters.local_interrupt += 1
        self.one_hz_ready.give()

    # -- messages about the tone -----------------------------------------------------------------------------------

    def _one_hz_command(self, packet: bytes) -> None:
        """A second is over; it also makes the simulated tone (CFE_TIME_OneHzCmd)."""
        self._tone.one_hz()
        self._tone.interrupt(self._one_hz_latch)

    def _tone_command(self, packet: bytes) -> None:
        self._tone.counters.tone_signal += 1

    def _data_command(self, packet: bytes) -> None:
        self._tone.data()

    def _send_command(self, packet: bytes) -> None:
        """Somebody asks for the time at the tone (CFE_TIME_ToneSend)."""
        clock = self._clock
        met = clock.current_met() >> 32 if clock.flying else self._tone.virtual_met
        payload = pk.TONE_DATA.pack(
            AtToneMET={"Seconds": met},
            AtToneSTCF=fields_of(clock.stcf),
            AtToneLeapSeconds=clock.leap_seconds,
            AtToneState=clock.state(),
        )
        self._ports.sb.transmit_msg(bytes(command(pk.CFE_TIME_DATA_CMD_MID, 0, payload)))
