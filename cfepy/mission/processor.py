"""`Processor`: the parts that live between two resets of the simulated computer: OSAL, PSP, the services, ROS, and the
boot.

A reset drops a processor and creates a new one on the same machine, just as a real one loses its RAM.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cfepy.app import Cfe
from cfepy.config.config_api import ConfigServices
from cfepy.config.platform import PlatformConfig
from cfepy.es import Boot, CoreApp, EsTask, ExecutiveServices, ObjectTable
from cfepy.evs import EventServices
from cfepy.fs import FileServices
from cfepy.mission.compiled_code import CodeLoader, CompiledFiles, CompiledRuntime
from cfepy.mission.loader import BuiltInApps, Finder, ModuleLoader
from cfepy.mission.python_code import NodeScripts, PythonLoader, python_finders
from cfepy.mission.record import Leak, RunRecord
from cfepy.mission.spec import MissionSpec
from cfepy.nodes import Accesses, AppModules, make_app_universe, turn_hook
from cfepy.osal import (
    OS_FILE_FLAG_CREATE,
    OS_FILE_FLAG_TRUNCATE,
    OS_READ_ONLY,
    OS_WRITE_ONLY,
    FileSystem,
    Network,
    Osal,
)
from cfepy.plugins import Hook
from cfepy.ports import Ports
from cfepy.psp import BoardProfile, MemoryBudget, Psp, Retained, object_sizes
from cfepy.rtos import Kernel, StallWatch
from cfepy.sb import SbTask, SoftwareBus
from cfepy.status import UsageError
from cfepy.tbl import TableServices
from cfepy.time import TimeServices
from cfepy.writing.console import Console

if TYPE_CHECKING:
    from cfepy.mission.holdings import Holdings
    from cfepy.nodes import Overlay, Universe
    from rospy_shim.graph.graph import TopicRow
    from rospy_shim.runtime import Ros2, RosRuntime

BOOT_PRIORITY = 0
EVS_PRIORITY, SB_PRIORITY, ES_PRIORITY, TIME_PRIORITY, TBL_PRIORITY = 61, 64, 68, 60, 70
CORE_APPS = ("CFE_EVS", "CFE_SB", "CFE_ES", "CFE_TIME", "CFE_TBL")
ROS_FILE = "/cf/roscore.so"
"""The virtual path for the code of ROS's own application (`rospy_shim.parameters.app`)."""


@dataclass(frozen=True, slots=True)
class Machine:
    """The parts of the computer that a reset does not change, from which a processor is made.

    `retained` is the memory that outlives a processor reset. `network` connects the sockets. `bus` is the class of the
    Software Bus. The PSP calls `on_restart` for a reset: (type, reason, fault). `run_files` are the files of apps and
    nodes. `accesses` collects accesses of their code to shared data. `stall_watch` ends a run that does not advance.
    `on_bad_end` is called with the application of a node whose program has just ended with an error.
    """

    spec: MissionSpec
    seed: int
    board: BoardProfile
    config: PlatformConfig
    kernel: Kernel
    console: Console
    files: FileSystem
    network: Network
    retained: Retained
    record: RunRecord
    bus: type[SoftwareBus]
    on_restart: Callable[[int, str, bool], object]
    run_files: RunFiles
    accesses: Accesses
    stall_watch: StallWatch
    on_bad_end: Callable[[str], object]

    @property
    def epoch_ns(self) -> int:
        """The Unix time at virtual time 0 in ns: the spacecraft's clock, as ROS nodes read it."""
        return self.spec.start_ns(self.config)


class RunFiles:
    """The files of apps and nodes, created on demand, because a mission without nodes must not load the code for them.

    Attributes:
        made: the files; None before.
    """

    def __init__(self) -> None:
        self.made: Overlay | None = None

    def of(self, machine: Machine) -> Overlay:
        """Return the files of a machine."""
        if self.made is None:
            from cfepy.nodes import Overlay, below_root

            epoch_ns, kernel = machine.epoch_ns, machine.kernel
            self.made = Overlay(
                lambda: epoch_ns + kernel.now, below_root(machine.spec.ros.root, machine.spec.ros.absent)
            )
        return self.made

    def close(self) -> None:
        """Close the files at the end of the mission."""
        if self.made is not None:
            self.made.close()


class Processor:
    """One power cycle of the processor; its boot task is ready to run after construction.

    Args:
        machine: the parts that outlive a reset.
        start_ns: time from now until the board starts, in ns.

    Attributes:
        cfe: the services.
        handle: the services for apps and nodes.
        ports, osal, psp, memory, loader, es_task, sb_task: the parts.
        ros: the ROS side, created when the first node starts; None before.
        booted: virtual ns at which it became OPERATIONAL; None before.
        holdings: resources that applications took and did not give back; None without the guard.
    """

    def __init__(self, machine: Machine, start_ns: int = 0) -> None:
        self.machine = machine
        self.ros: RosRuntime | None = None
        self.booted: int | None = None
        self.holdings: Holdings | None = None
        self._start_ns = start_ns
        self._scripts = machine.spec.scripts
        self._costs = machine.board.cpu_costs()
        self._build()
        machine.kernel.spawn("CFE_ES_Main", self._boot, BOOT_PRIORITY)

    def _build(self) -> None:
        machine = self.machine
        self.ports = Ports()
        self.memory = self.ports.memory = MemoryBudget(machine.board)
        self.osal = self.ports.queues = self._make_osal()
        self.osal.add_core_objects()
        self.psp = Psp(
            machine.kernel,
            machine.board,
            machine.config,
            machine.console,
            self.osal,
            retained=machine.retained,
            on_restart=machine.on_restart,
        )
        self.loader = ModuleLoader(machine.console, self._finders())
        self.osal.modules = self.loader
        self.cfe = self._make_services()
        self.handle = self._handle_for_apps()
        self.sb_task = SbTask(self.cfe.sb)
        checksum = zlib.crc32(machine.config.release.cfe_version.source.encode()) & 0xFFFF
        self.es_task = EsTask(self.cfe.es, machine.spec.name, self._build_text(), checksum)

    def _finders(self) -> list[Finder]:
        """Return the finders of application code, in the order of the search."""
        machine, folder = self.machine, self.machine.spec.folder
        self._compiled = CompiledFiles(machine.files, self._make_compiled_loader, machine.spec.built_files)
        turns = turn_hook(machine.kernel, self._costs.polling_ns, self._current_app, machine.record.traps)
        modules = AppModules(self._app_universe, machine.accesses, turns)
        python = PythonLoader(machine.console, lambda: self.handle, modules)
        return [
            BuiltInApps({ROS_FILE: self._ros_main}),
            NodeScripts(machine.files, folder, self._script_of, self._node_main),
            self._compiled,
            *python_finders(python, machine.files, folder),
        ]

    def _current_app(self) -> str:
        """Return the name of the application whose task is running."""
        return str(getattr(self.machine.kernel.current.owner, "name", ""))

    def _app_universe(self) -> Universe:
        """Return the provider of the modules with which apps open files."""
        machine = self.machine
        return make_app_universe(
            kernel=machine.kernel,
            name="apps",
            seed=machine.seed,
            epoch_ns=machine.epoch_ns,
            root=machine.spec.ros.root,
            overlay=machine.run_files.of(machine),
        )

    def _make_osal(self) -> Osal:
        machine = self.machine
        return Osal(
            machine.kernel,
            machine.config,
            machine.console,
            files=machine.files,
            network=machine.network,
            memory=self.memory,
            sizes=object_sizes(machine.board),
            costs=self._costs,
            epoch_ns=machine.epoch_ns,
        )

    def _make_services(self) -> Cfe:
        """Return the services, connected by their ports and with the parts that outlive the processor."""
        machine, ports = self.machine, self.ports
        kernel, config, console = machine.kernel, machine.config, machine.console
        es = self._executive()(kernel, ports, config, self.osal, self.psp, console, self.loader)
        fs = ports.fs = FileServices(self.osal, ports, config, es.background_wakeup)
        sb = machine.bus(kernel, ports, config, self._costs, object_sizes(machine.board))
        evs = EventServices(kernel, ports, config, console, self.osal)
        time = TimeServices(kernel, ports, config)
        tbl = TableServices(kernel, ports, config, _TableFiles(self.osal))
        ports.es, ports.syslog, ports.sb, ports.evs, ports.time, ports.tbl = es, es.syslog, sb, evs, time, tbl
        time.clock.on_jump = sb.forget_time
        record = machine.record
        es.history, evs.counts, evs.errors_by_app = record.history, record.event_counts, record.errors_by_app
        evs.first_errors = record.first_errors
        return Cfe(es, sb, evs, time, tbl, self.osal, self.psp, fs, ConfigServices(config, machine.spec.name))

    def _executive(self) -> type[ExecutiveServices]:
        """Return the class of Executive Services; the guard's has the ledger."""
        machine = self.machine
        if not machine.spec.compiled.guard:
            return ExecutiveServices
        from cfepy.mission.holdings import Holdings, noting_executive

        kernel, leaks = machine.kernel, machine.record.leaks
        kernel.frames_wanted = True  # the ledger has the lines of compiled code
        self.holdings = Holdings(kernel, lambda app, text: leaks.append(Leak(kernel.now, app, text)))
        return noting_executive(self.holdings)

    def _handle_for_apps(self) -> Cfe:
        """Return the services themselves; with call points if a policy decides, and with the ledger of the guard. Only
        such runs load the code for them.
        """
        kernel, handle = self.machine.kernel, self.cfe
        if kernel.policy is not None:
            from cfepy.mission.call_points import with_call_points

            handle = with_call_points(handle, kernel)
        if self.holdings is not None:
            from cfepy.mission.holdings import noting

            handle = noting(handle, self.cfe, kernel, self.holdings)
        return handle

    def _build_text(self) -> str:
        machine = self.machine
        who = f"cfepy@{machine.config.processor_name}"
        return f"Build cfepy {machine.config.release.cfe_version.source} by {who}, config {machine.board.name}"

    def _boot(self) -> None:
        """Run the processor's main task: PSP first, then the executive."""
        if self._start_ns:
            self.machine.kernel.delay(self._start_ns)
        self.psp.boot()
        self._compiled.prepare(self.machine.spec.entries)
        Boot(self.cfe.es, self._object_table(), self.machine.spec.startup_script, self._operational).main()

    def _object_table(self) -> ObjectTable:
        """Return the calls and tasks that CFE_ES_Main starts before the startup script (CFE_ES_ObjectTable)."""
        cfe, kept = self.cfe, self.machine.retained.kept
        calls: dict[str, Callable[[], object]] = {
            "CONFIG": _set_up_already,
            "ES": cfe.es.cds_early_init,
            "EVS": lambda: cfe.evs.early_init(kept),
            "SB": cfe.sb.early_init,
            "TIME": lambda: cfe.time.early_init(kept),
            "TBL": cfe.tbl.early_init,
            "FS": _set_up_already,
        }
        apps = {
            "EVS": CoreApp("CFE_EVS", cfe.evs.task_main, EVS_PRIORITY),
            "SB": CoreApp("CFE_SB", self.sb_task.task_main, SB_PRIORITY),
            "ES": CoreApp("CFE_ES", self.es_task.task_main, ES_PRIORITY),
            "TIME": CoreApp("CFE_TIME", cfe.time.task_main, TIME_PRIORITY),
            "TBL": CoreApp("CFE_TBL", cfe.tbl.task_main, TBL_PRIORITY),
        }
        release = self.machine.config.release
        return ObjectTable(
            calls=tuple((text, calls[_module_in(text)]) for text in release.early_inits),
            core_apps=tuple(apps[name] for name in release.core_apps),
            failed=release.early_init_failed,
        )

    def _operational(self) -> None:
        self.booted = self.machine.kernel.now

    def _ros_main(self) -> None:
        """Run ROS's own application, which starts with the first node."""
        assert self.ros is not None
        self.ros.parameters.main()

    def _node_main(self, script: Path, app_name: str) -> Callable[[], object]:
        """Return the main function of a node; ROS itself starts before the first one."""
        ros = self._start_ros()
        return lambda: ros.run_node(script, app_name)

    def begin_ros(self) -> RosRuntime:
        """Return the ROS side, and create it if there was no node yet; its application starts with the first node."""
        ros = self.ros
        if ros is None:
            ros = self.ros = self._make_ros()
        return ros

    def _start_ros(self) -> RosRuntime:
        """Start ROS before the first node, compiled or not, and return it."""
        ros = self.begin_ros()
        ros.parameters.ensure()
        return ros

    def _make_ros(self) -> RosRuntime:
        """Return a new ROS side; a mission without nodes does not load it."""
        from rospy_shim.runtime import RosRuntime

        machine = self.machine
        return RosRuntime(
            self.handle,
            machine.kernel,
            machine.spec.ros,
            seed=machine.seed,
            epoch_ns=machine.epoch_ns,
            node_call_ns=self._costs.polling_ns,
            max_publish_hz=machine.board.max_publish_hz,
            console=machine.console,
            network=machine.network,
            files=machine.run_files.of(machine),
            accesses=machine.accesses,
            traps=machine.record.traps,
            on_bad_end=machine.on_bad_end,
            make_ros2=make_ros2,
        )

    @property
    def compiled(self) -> CompiledRuntime | None:
        """The C side of the processor; None if no compiled code was loaded."""
        return self._compiled.runtime

    def _make_compiled_loader(self) -> CodeLoader:
        """Return a loader of compiled code; a mission without any does not load it."""
        return COMPILED_CODE.need("compiled code")(self, self._costs.polling_ns, self._start_ros)

    def _script_of(self, file: str) -> Path | None:
        """Return the script of a node from a launch file, or of one that another node has started."""
        started = None if self.ros is None else self.ros.script_of(file)
        return self._scripts.get(file) or started

    def topics(self) -> list[TopicRow]:
        """Return the rows of ROS's topics."""
        return [] if self.ros is None else self.ros.topics()

    def end(self) -> None:
        """End every task and object, and release the applications' code; the results stay readable."""
        kernel = self.machine.kernel
        for app in self.cfe.es.apps:
            history = self.cfe.es.history_of(app.name)
            history.cpu_ns += sum(task.cpu_ns for task in kernel.tasks if task.owner is app)
        self.osal.register_event_handler(_ignore)  # an application's handler has ended together with the application
        with kernel.unwinding():
            self.osal.delete_all_objects()  # first, because it calls the tasks' delete handlers
        kernel.unwind()
        # objects that `finally` blocks have created meanwhile, such as a socket on the network
        self.osal.delete_all_objects()
        self.loader.forget()


def make_ros2() -> Ros2:
    """Return the world of nodes of ROS 2; a mission without any does not load it.

    Raises:
        UsageError: this installation has no rclpy_shim.
    """
    try:
        from rclpy_shim.ros2_world import Ros2World
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != "rclpy_shim":
            raise
        raise UsageError("nodes of ROS 2 require rclpy_shim, which is missing in this installation") from None
    return Ros2World()


def _set_up_already() -> None:
    """Do nothing; the Python objects are ready when constructed, unlike in C."""


def _ignore(event: int, object_id: int, data: object) -> int:
    """Ignore an OSAL event."""
    return 0


def _module_in(text: str) -> str:
    """Return the module in the name of a call, "EVS" in "CFE_EVS_EarlyInit"."""
    return text.partition("CFE_")[2].split("_")[0].upper()


class _TableFiles:
    """The file system as Table Services use it (`cfepy.tbl.table_file.TableStorage`), with a descriptor for each file.

    They leave the file of every load from the ground open, so after fifty table loads a processor cannot open files any
    more.

    Args:
        osal: the OSAL of the processor.
    """

    def __init__(self, osal: Osal) -> None:
        self._osal = osal

    def read_file(self, path: str) -> bytes:
        """Return the whole content of a file."""
        self._osal.close(self._osal.open_create(path, access_mode=OS_READ_ONLY))
        node = self._osal.files.find(path)
        return bytes(node.data) if node is not None else b""  # a folder can be opened, but not read

    def leave_open(self, path: str) -> None:
        """Open a file and lose its descriptor."""
        self._osal.open_create(path, access_mode=OS_READ_ONLY)

    def write_file(self, path: str, data: bytes) -> None:
        """Create or replace a file."""
        flags = OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE
        self._osal.close(self._osal.open_create(path, flags, OS_WRITE_ONLY))
        self._osal.files.write_file(path, data)

    def exists(self, path: str) -> bool:
        """Return whether a file exists."""
        return self._osal.files.exists(path)


COMPILED_CODE: Hook[Callable[[Processor, int, Callable[[], RosRuntime]], CodeLoader]] = Hook("compiled_code")
"""Makes the loader of compiled code. It gets the processor, the time of a polling call in ns, and a function that
starts ROS before the first node.
"""
