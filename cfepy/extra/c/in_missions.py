"""Compiled code in a mission: the C side of a processor with its services, and a watch for messages of its nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from cfepy.extra.c.devices import Device, DevicePorts, TopicDevice
from cfepy.extra.c.loading import CompiledLoader
from cfepy.extra.c.runtime import CRuntime
from cfepy.mission import DataRace, DeviceConfig, Overwrite
from cfepy.sb import SoftwareBus
from cfepy.trace import UNSENT

if TYPE_CHECKING:
    from cfepy.mission.processor import Processor
    from rospy_shim.graph.compiled import CompiledSender
    from rospy_shim.runtime import RosRuntime


def compiled_loader(processor: Processor, polling_ns: int, start_ros: Callable[[], object]) -> CompiledLoader:
    """Make the loader of compiled code for a processor.

    Args:
        processor: its services are called by the code.
        polling_ns: time that a polling call takes.
        start_ros: called before a node runs.
    """
    machine, cfe = processor.machine, processor.cfe
    watch = machine.stall_watch

    def topic_device(config: DeviceConfig) -> Device:
        return TopicDevice(config, lambda: processor.begin_ros().outside)

    with watch.paused():  # the engine may have to be compiled first
        runtime = CRuntime(
            cfe,
            processor.handle,
            machine.kernel,
            polling_ns,
            machine.console,
            lambda: watch.limit_s,
            omit_deprecated=machine.spec.compiled.omit_deprecated,
            guard=machine.spec.compiled.guard,
            on_race=lambda race: machine.record.data_races.append(DataRace(*race.told())),
            on_overwrite=lambda app, text: machine.record.overwrites.append(Overwrite(machine.kernel.now, app, text)),
            on_stack=machine.record.note_stack,
            nodes={app: each.name for app, each in machine.spec.built.items()},
            publication_watch=CompiledWatch(cfe.sb, lambda: processor.ros),
            devices=DevicePorts(machine.spec.devices, machine.network, lambda: machine.kernel.now, topic_device),
        )
    cfe.es.core_memory = runtime.core_memory
    if runtime.tables is not None:
        cfe.tbl.place_buffers(runtime.tables)
    return CompiledLoader(runtime, machine.console, start_ros)


class CompiledWatch:
    """Takes the messages of compiled nodes that reach no subscriber, as a rospy publisher does with its own.

    They go into the trace (`SoftwareBus.unsent`), and to the watches of the bus (`SoftwareBus.on_unsent`).

    Args:
        bus: the Software Bus.
        ros: the ROS side of the processor, once there is one.
    """

    def __init__(self, bus: SoftwareBus, ros: Callable[[], RosRuntime | None]) -> None:
        self._bus = bus
        show: Any = bus.on_unsent  # a static method, which binds no bus
        self._show: Callable[[Any, bytes], object] | None = show
        self._ros = ros

    def unsent(self, app: str, msg_id: int, message: bytes) -> None:
        sender = self._sender(app, msg_id)
        name = f"0x{msg_id:04X}" if sender is None else sender.name
        self._bus.unsent(UNSENT + name.encode() + b"\0" + message)
        if sender is not None and self._show is not None:
            self._show(sender, message)

    def latches(self, app: str, msg_id: int) -> None:
        sender = self._sender(app, msg_id)
        if sender is not None:
            sender.latch()

    def _sender(self, app: str, msg_id: int) -> CompiledSender | None:
        ros = self._ros()
        return None if ros is None else ros.compiled_sender(app, msg_id)
