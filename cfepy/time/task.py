"""The tasks of Time Services: CFE_TIME itself, a task that announces every tone, and a task that announces every
second.

A timer gives the local 1 Hz signal at the whole seconds of MET. The module replaces CFE_TIME_TaskMain,
CFE_TIME_Tone1HzTask, CFE_TIME_Local1HzTask and the timer "cFS-1Hz".
"""

from __future__ import annotations

from functools import partial

from cfepy.config.platform import PlatformConfig
from cfepy.core_app import serve
from cfepy.ports import Ports
from cfepy.rtos import Kernel, Semaphore
from cfepy.time import events as ev
from cfepy.time import packets as pk
from cfepy.time.commands import TimeCommands
from cfepy.time.settings import TimeSettings
from cfepy.time.systime import ticks_of, ticks_of_ns
from cfepy.time.tone import SECOND, Tone, ToneData, ToneDataSender
from cfepy.units import NS_PER_S

PIPE_DEPTH = 12
PIPE_NAME = "TIME_CMD_PIPE"
TONE_TASK = ("TIME_TONE_TASK", 4096, 25)
ONE_HZ_TASK = ("TIME_ONEHZ_TASK", 8192, 25)
"""Name, stack in bytes, priority of the child tasks."""

MAIN_PERF_ID, ONE_HZ_PERF_ID, ONE_HZ_TASK_PERF_ID, TONE_TASK_PERF_ID = 6, 8, 10, 11
TIMER_NAME = "cFS-1Hz"
TIMER_PRIORITY = 0


class TimeTask:
    """The tasks of Time Services.

    Args:
        kernel: the kernel of the processor.
        ports: the other services.
        config: limits.
        settings: server or client, simulated tone or not.
        tone: the tone.
        sender: sends the time at the tone.
        commands: handles the pipe; the tone's messages are added to its table.
        tone_ready: given at each good tone.

    Attributes:
        one_hz_ready: given at each local 1 Hz signal.
        whole_second_ns: a virtual time in ns at which MET had no subseconds; the 1 Hz signal is aligned to it.
    """

    def __init__(
        self,
        kernel: Kernel,
        ports: Ports,
        config: PlatformConfig,
        settings: TimeSettings,
        tone: Tone,
        sender: ToneDataSender,
        commands: TimeCommands,
        tone_ready: Semaphore,
    ) -> None:
        self.one_hz_ready = Semaphore(kernel, 0, 1, "TIME_ONEHZ_SEM")
        self.whole_second_ns = 0
        self._kernel = kernel
        self._ports = ports
        self._config = config
        self._settings = settings
        self._tone = tone
        self._commands = commands
        self._tone_ready = tone_ready
        self._one_hz_latch: int | None = None  # of the signal whose message is still to arrive
        told = [pk.TONE_CMD, pk.SEND_CMD] if settings.fake_tone else [pk.TONE_CMD]
        self._signals = [command.packet() for command in told]
        self._one_hz_signal = pk.ONEHZ_CMD.packet()
        handle = partial(commands.table.handle, any_length=True)  # NASA's code does not check the lengths of these
        handle(pk.ONEHZ_CMD, self._one_hz_command)
        handle(pk.TONE_CMD, lambda packet: tone.take_signal())
        handle(pk.DATA_CMD, self._data_command)
        if not settings.client:
            handle(pk.SEND_CMD, lambda packet: sender.send())

    # -- tasks -----------------------------------------------------------------------------------------------------

    def main(self) -> None:
        """Run the task CFE_TIME (CFE_TIME_TaskMain)."""
        self._ports.es.perf_log_entry(MAIN_PERF_ID)
        pipe = self._init()
        serve(self._ports, self._config, pipe, MAIN_PERF_ID, self._commands.process)

    def _init(self) -> int:
        ports = self._ports
        ports.evs.register()
        ports.es.create_child_task(TONE_TASK[0], self._tone_task, TONE_TASK[1], TONE_TASK[2])
        ports.es.create_child_task(ONE_HZ_TASK[0], self._one_hz_task, ONE_HZ_TASK[1], ONE_HZ_TASK[2])
        pipe = ports.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        ports.sb.subscribe(pk.SEND_HK_MID, pipe)
        for mid in (pk.TONE_CMD_MID, pk.DATA_CMD_MID, pk.ONEHZ_CMD_MID):
            if self._settings.client:
                ports.sb.subscribe(mid, pipe)
            else:
                ports.sb.subscribe_local(mid, pipe, self._config.sb_default_msg_limit)
        if not self._settings.client:
            ports.sb.subscribe(pk.SEND_CMD_MID, pipe)
        ports.sb.subscribe(pk.CMD_MID, pipe)
        text = f"cFE TIME Initialized: {self._config.release.text('CFE_TIME')}"
        ports.evs.send_event(ev.INIT_EID, ev.INFORMATION, text)
        self._kernel.spawn(TIMER_NAME, self._timer, TIMER_PRIORITY)
        return pipe

    def _tone_task(self) -> None:
        ports = self._ports
        while True:
            ports.es.increment_task_counter()
            self._tone_ready.take()
            ports.es.perf_log_entry(TONE_TASK_PERF_ID)
            for signal in self._signals:
                ports.sb.transmit_msg(signal)
            self._tone.counters.tone_task += 1
            ports.es.perf_log_exit(TONE_TASK_PERF_ID)

    def _one_hz_task(self) -> None:
        ports = self._ports
        while True:
            ports.es.increment_task_counter()
            self.one_hz_ready.take()
            ports.es.perf_log_entry(ONE_HZ_TASK_PERF_ID)
            if self._tone.auto_start_fly:
                self._tone.auto_start_fly = False
                ports.evs.send_event(ev.FLY_ON_EID, ev.INFORMATION, "Start FLYWHEEL")
            ports.sb.transmit_msg(self._one_hz_signal)
            self._tone.counters.local_task += 1
            ports.es.perf_log_exit(ONE_HZ_TASK_PERF_ID)

    def _timer(self) -> None:
        """Run the timer, aligned to the times at which MET is whole, so that a tone never moves the clock."""
        kernel = self._kernel
        due = kernel.now + NS_PER_S - (kernel.now - self.whole_second_ns) % NS_PER_S
        if self._settings.fake_tone:
            self._tone.signal_latch = ticks_of_ns(due) - SECOND  # this makes the first tone a good one
        while True:
            kernel.delay(due - kernel.now)
            self.interrupt(ticks_of_ns(due))
            due += NS_PER_S

    def interrupt(self, latch: int) -> None:
        """Handle the local 1 Hz signal (CFE_TIME_Local1HzISR).

        Args:
            latch: local time of the signal, in ticks.
        """
        self._one_hz_latch = latch
        self._tone.counters.local_interrupt += 1
        self.one_hz_ready.give()

    def take_tone(self, latch: int) -> None:
        """Handle a simulated tone (CFE_TIME_Tone1HzISR); see `Tone.interrupt`."""
        self._tone.interrupt(latch)

    # -- messages about the tone -----------------------------------------------------------------------------------

    def _one_hz_command(self, packet: bytes) -> None:
        """Handle the end of a second, and generate the simulated tone (CFE_TIME_OneHzCmd).

        A message that does not come from the local signal, such as one from the ground, generates a tone at the present
        time.
        """
        self._ports.es.perf_log_entry(ONE_HZ_PERF_ID)
        self._tone.one_hz()
        self._ports.es.perf_log_exit(ONE_HZ_PERF_ID)
        if self._settings.fake_tone:
            latch, self._one_hz_latch = self._one_hz_latch, None
            self.take_tone(self._tone.clock.local() if latch is None else latch)

    def _data_command(self, packet: bytes) -> None:
        if len(packet) < pk.DATA_CMD.length:  # NASA's code reads the bytes behind the packet in memory
            self._commands.reject_length(packet, pk.DATA_CMD)
            return
        fields = pk.DATA_CMD.read(packet)
        met, stcf = (ticks_of(fields[name]) for name in ("AtToneMET", "AtToneSTCF"))
        self._tone.take_data(ToneData(met, stcf, fields["AtToneLeapSeconds"], fields["AtToneState"]))
