"""`Mission`: the one place that knows everything, and wires it: board, kernel, OSAL, PSP, the five services, ROS.

Nothing else creates these objects for a run, and nothing in them knows of this module.
"""

from __future__ import annotations

import importlib
import zlib
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any

from cfepy import versions
from cfepy.app import Cfe
from cfepy.console import Console
from cfepy.es import Boot, CoreApp, EsTask, ExecutiveServices, ObjectTable
from cfepy.es.startup_script import entries
from cfepy.evs import EventServices
from cfepy.mission.loader import NODE_SYMBOL, ModuleLoader, find_code
from cfepy.mission.spec import MissionSpec, read_mission
from cfepy.mission.tracebacks import app_traceback, reason
from cfepy.osal import FileSystem, Osal
from cfepy.ports import Ports
from cfepy.psp import Psp
from cfepy.psp.cpu import CpuCosts
from cfepy.psp.memory import MemoryBudget, object_sizes
from cfepy.psp.profile import BoardProfile, load_profile
from cfepy.rtos import Kernel, Task
from cfepy.rtos.policy import Policy
from cfepy.rtos.units import NS_PER_S
from cfepy.rtos.watchdog import StallWatch
from cfepy.sb import BusCosts, SbTask, SoftwareBus
from cfepy.tbl import TableServices
from cfepy.time import TimeServices
from cfepy.trace import Trace

BOOT_PRIORITY = 0
EVS_PRIORITY, SB_PRIORITY, ES_PRIORITY, TIME_PRIORITY, TBL_PRIORITY = 61, 64, 68, 60, 70
UNIX_AT_CFE_EPOCH = 315_532_800  # 1980-01-01 in seconds since 1970-01-01
SHUTDOWN_NS = 2_000_000_000  # virtual time that nodes get at the end of a run for their shutdown hooks


class Mission:
    """One mission on one simulated processor.

    Args:
        mission: a startup script, a mission's folder, the name of a shipped mission, or a `MissionSpec`.
        seed: of everything random in the mission.
        board: name or file of a board profile; None takes the mission's own.
        tasks: "thread" or "greenlet".
        console: where lines go; None prints them.
        policy: who runs next among equals; see `cfepy.rtos.policy`.
        trace_sink: gets the trace's records in batches.
        bus: the class of the Software Bus, for tools that look on.

    Attributes:
        cfe: the handle that apps get.
        kernel, trace, ports, memory, console: the parts below it.
        booted: virtual ns at which the mission became OPERATIONAL, None before.
        reset_reason: why the processor was to be reset, None when it was not; the run ends there.
    """

    def __init__(
        self,
        mission: str | MissionSpec,
        *,
        seed: int = 0,
        board: str | BoardProfile | None = None,
        tasks: str = "thread",
        console: Console | None = None,
        policy: Policy | None = None,
        trace_sink: Callable[[list[bytes]], None] | None = None,
        bus: type[SoftwareBus] = SoftwareBus,
    ) -> None:
        self.spec = mission if isinstance(mission, MissionSpec) else read_mission(mission)
        self.seed = seed
        self.tasks = tasks
        self.board = board if isinstance(board, BoardProfile) else load_profile(board or self.spec.board)
        self.config = self.board.config()
        self.console = console if console is not None else Console()
        self.trace = Trace(trace_sink)
        self.console.record = self.trace.note
        self.booted: int | None = None
        self.reset_reason: str | None = None
        self._script = self.spec.script.read_bytes()
        self._ros: Any = None
        costs = CpuCosts.of_board(self.board)
        self.kernel = Kernel(
            tasks, self.trace, policy, tick_ns=self.board.tick_ns, switch_cost_ns=costs.switch_ns, seed=seed
        )
        self.kernel.on_task_error = self._task_failed
        self._watch = StallWatch(self.kernel)
        self.memory = MemoryBudget(self.board)
        self.files = FileSystem(self.spec.folder)
        self._build(costs, bus)
        self._provide_tables()
        self.kernel.spawn("CFE_ES_Main", self._boot, BOOT_PRIORITY)

    def _build(self, costs: CpuCosts, bus: type[SoftwareBus]) -> None:
        kernel, config, console = self.kernel, self.config, self.console
        self.ports = ports = Ports()
        ports.memory = self.memory
        self.osal = Osal(
            kernel,
            config,
            console,
            files=self.files,
            memory=self.memory,
            sizes=object_sizes(self.board),
            call_ns=costs.call_ns,
            byte_ps=costs.byte_ps,
            epoch_ns=self.epoch_ns,
        )
        self.psp = Psp(kernel, self.board, config, console, self.osal, on_restart=self._restart)
        self.loader = ModuleLoader(self.files, self.spec.folder, console, lambda: self.cfe, self._run_node)
        es = ExecutiveServices(kernel, ports, config, self.osal, console, self.loader)
        es.on_reset = self._reset
        sb = bus(kernel, ports, config, BusCosts(costs.call_ns, costs.byte_ps))
        evs = EventServices(kernel, ports, config, console, self.files.write_file)
        time = TimeServices(kernel, ports, config)
        tbl = TableServices(kernel, ports, config, self.files)
        ports.es, ports.syslog, ports.sb, ports.evs, ports.time, ports.tbl = es, es.syslog, sb, evs, time, tbl
        time.clock.on_jump = sb.forget_time
        self.cfe = Cfe(es, sb, evs, time, tbl, self.osal, self.psp)
        self.sb_task = SbTask(sb)
        self.es_task = EsTask(
            es, self.spec.name, self._build_text(), zlib.crc32(versions.CFE_VERSION.encode()) & 0xFFFF
        )

    @property
    def epoch_ns(self) -> int:
        """Unix time in ns at virtual time 0: the spacecraft's clock, as ROS nodes read it."""
        return (UNIX_AT_CFE_EPOCH + self.config.time_def_met_secs + self.config.time_def_stcf_secs) * NS_PER_S

    def _build_text(self) -> str:
        return f"Build cfepy {versions.CFE_VERSION} by cfepy@{self.config.processor_name}, config {self.board.name}"

    # -- boot ------------------------------------------------------------------------------------------------------

    def _boot(self) -> None:
        """The processor's main task: PSP first, then the executive."""
        self.psp.boot()
        cfe = self.cfe
        nothing = bool  # what C does here, Python did when it made the objects
        table = ObjectTable(
            calls=(
                ("CFE_Config_Init", nothing),
                ("CFE_ES_CDSEarlyInit", nothing),
                ("CFE_EVS_EarlyInit", cfe.evs.early_init),
                ("CFE_SB_EarlyInit", cfe.sb.early_init),
                ("CFE_TIME_EarlyInit", cfe.time.early_init),
                ("CFE_TBL_EarlyInit", cfe.tbl.early_init),
                ("CFE_FS_EarlyInit", nothing),
            ),
            core_apps=(
                CoreApp("CFE_EVS", cfe.evs.task_main, EVS_PRIORITY),
                CoreApp("CFE_SB", self.sb_task.task_main, SB_PRIORITY),
                CoreApp("CFE_ES", self.es_task.task_main, ES_PRIORITY),
                CoreApp("CFE_TIME", cfe.time.task_main, TIME_PRIORITY),
                CoreApp("CFE_TBL", cfe.tbl.task_main, TBL_PRIORITY),
            ),
        )
        Boot(cfe.es, table, self._script, self._operational).main()

    def _operational(self) -> None:
        self.booted = self.kernel.now

    def _provide_tables(self) -> None:
        """Put the default tables of shipped apps into /cf, where the mission has none of its own."""
        for entry in entries(self._script):
            if entry.symbol == NODE_SYMBOL:
                continue
            code = find_code(entry.path, self.spec.folder)
            if isinstance(code, Path) and code.name == "__init__.py":
                for table in sorted(code.parent.glob("tables/*.tbl")):
                    if self.files.find(f"/cf/{table.name}") is None:
                        self.files.write_file(f"/cf/{table.name}", table.read_bytes())

    # -- ROS -------------------------------------------------------------------------------------------------------

    @property
    def ros(self) -> Any:
        """The ROS side (`rospy_shim.runtime.RosRuntime`), made when the first node starts; None before."""
        return self._ros

    def _run_node(self, script: Path, app_name: str) -> None:
        if self._ros is None:
            runtime = importlib.import_module("rospy_shim.runtime")
            self._ros = runtime.RosRuntime(
                self.cfe,
                self.kernel,
                self.spec.ros,
                seed=self.seed,
                epoch_ns=self.epoch_ns,
                node_call_ns=self.board.node_call_ns,
                max_publish_hz=self.board.max_publish_hz,
                console=self.console,
            )
        self._ros.run_node(script, app_name)

    # -- running ---------------------------------------------------------------------------------------------------

    def run(self, seconds: float) -> None:
        """Run for some virtual seconds more.

        Raises:
            KeyboardInterrupt: and what a task outside any app raised.
        """
        self.run_until(self.kernel.now + round(seconds * NS_PER_S))

    def run_until(self, until_ns: int) -> None:
        """Run until a virtual time in ns, or until the processor is reset."""
        if self.reset_reason is None:
            self._watch.begin()
            self.kernel.run(until_ns)

    def shut_down_nodes(self) -> None:
        """Ask all ROS nodes to end, and give them a little virtual time for their shutdown hooks."""
        if self._ros is None or self.reset_reason is not None:
            return
        self._ros.begin_shutdown("the run is over")
        end = self.kernel.now + SHUTDOWN_NS
        while not self._ros.all_finished() and self.kernel.now < end and self.reset_reason is None:
            self.kernel.run(min(end, self.kernel.now + SHUTDOWN_NS // 20))

    def close(self) -> None:
        """End every task; the numbers stay readable."""
        for app in self.cfe.es.apps:
            history = self.cfe.es.history_of(app.name)
            history.cpu_ns += sum(task.cpu_ns for task in self.kernel.tasks if task.owner is app)
        self.kernel.shutdown()
        self._watch.end()
        self.loader.forget()

    def __enter__(self) -> Mission:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.close()

    # -- failures --------------------------------------------------------------------------------------------------

    def _task_failed(self, task: Task, error: BaseException) -> bool:
        """An exception came out of a task: say so, and let ES act as the startup script asks."""
        if task.owner is None:
            return False
        self.console.write(f"{task.owner.name}: task {task.name} died of an exception")
        self.console.write(app_traceback(error))
        return self.cfe.es.take_fault(task, error, reason(error))

    def _reset(self, reset_type: int, why: str) -> None:
        self.psp.restart(reset_type, why)

    def _restart(self, reset_type: int, why: str) -> None:
        """The PSP restarts the processor: in this release the run ends there."""
        self.reset_reason = why
        self.kernel.stop()
