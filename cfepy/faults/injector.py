"""`FaultInjector`: injects the faults of a plan into a mission, as an attachment unknown to the mission.

A run without a plan has no injector and no cost. With a plan, only the parts that its faults need are wrapped: the bus
for messages, the kernel's calls for applications that hang, one function for calls that fail.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from random import Random
from typing import Any

from cfepy.attachment import Attachment
from cfepy.faults.app_faults import APP_FAULTS, AppFault, Hang, Slow, Strain, Work
from cfepy.faults.bus_faults import MessageSwitchboard, faulty
from cfepy.faults.call_faults import QUEUE_PUT, call_name
from cfepy.faults.failing_calls import CallFault, Fill, Puts, failing, refusing, why_not_called
from cfepy.faults.fault_names import MissionNames
from cfepy.faults.fault_plan import DATAGRAMS, Fault, FaultPlan
from cfepy.faults.fault_report import FaultReport
from cfepy.faults.kinds import APP, APP_OPTIONS, KINDS
from cfepy.faults.message_faults import DATAGRAM_FAULTS, MESSAGE_FAULTS, MessageFault, Setting, strike_datagrams
from cfepy.faults.processor_faults import MEMORY_FAULTS, Drift, Jump, LostSignal, ProcessorFault
from cfepy.faults.timing import Agenda, Gate, OpenCalls, asker
from cfepy.mission import Mission, Processor
from cfepy.rtos import Kernel, WaitList
from cfepy.sb import Pipe, SoftwareBus

Strike = Callable[[Processor], object]


class FaultInjector(Attachment):
    """Injects the faults of a plan.

    Give it to `Mission(attachments=[...])` as the last attachment. Scripts and bags before it then see each message
    after the faults that change it for all receivers.

    Args:
        plan: the faults.

    Attributes:
        report: the report on the faults, once the mission has started.
    """

    def __init__(self, plan: FaultPlan) -> None:
        self.plan = plan
        self.report: FaultReport
        self._board = MessageSwitchboard()
        self._puts = Puts()
        self._power_ups: list[Strike] = []
        self._first: list[Strike] = []
        self._strain = Strain()
        self._calls = OpenCalls()
        self._works: dict[str, Work] = {}
        self._failing: dict[str, CallFault] = {}
        self._gates: dict[str, Gate] = {}
        self._faults: list[Fault] = []  # faults of the plan, with applications by their cFE names
        self._processor: Processor

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        if any(_is_put(fault) for fault in self.plan.faults):
            base = refusing(base, self._puts)
        if any(_needs_bus(fault) for fault in self.plan.faults):
            base = faulty(base, self._board)
        for fault in self.plan.faults:
            service, _, method = call_name(fault.target[0]).partition(".") if fault.kind == "fail" else ("", "", "")
            if service == "sb":
                base = failing(base, method, partial(self._strike_call, fault.name))
        return base

    def _strike_call(self, name: str, args: tuple[Any, ...]) -> None:
        """Return a bus with functions that a fault may make fail."""
        self._failing[name].strike(args)

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        """Later faults of the plan are wrapped around earlier ones."""
        self._strain, self._calls, self._works = Strain(), OpenCalls(), {}
        hooks: dict[Strain | OpenCalls | Work, None] = {}
        for fault in self.plan.faults:
            if fault.kind in ("slow", "hang"):
                hooks[self._strain] = None
            if fault.kind == "compute":
                self._works[fault.name] = Work(fault)
                hooks[self._works[fault.name]] = None
            if _is_at_calls(fault):
                hooks[self._calls] = None
        for hook in hooks:
            base = hook.kernel(base)
        return base

    def begin(self, mission: Mission) -> None:
        kernel = self._kernel = mission.kernel
        self.report = FaultReport(self.plan.faults, lambda: kernel.now, mission.console.write, mission.trace.note)
        mission.record.tables["faults"] = self.rows
        self._agenda = Agenda(kernel)
        self._power_ups, self._first = [], []
        self._gates = {
            fault.name: Gate(fault.when, Random(f"{mission.seed}:{fault.name}"), asker(kernel, fault.name))
            for fault in self.plan.faults
        }
        names = MissionNames()
        names.begin(mission)
        setting = Setting(kernel, self._agenda, self.report, names)
        self._faults = [_by_app(fault, names) for fault in self.plan.faults]
        on_bus = [self._message(fault, MESSAGE_FAULTS, setting) for fault in self._faults if _is_message(fault)]
        self._board.begin(on_bus, names)
        datagrams = [self._message(f, DATAGRAM_FAULTS, setting) for f in self._faults if _is_datagram(f)]
        if datagrams:
            strike_datagrams(mission.network, datagrams)
        calls = self._failing = {fault.name: self._call(fault) for fault in self._faults if fault.kind == "fail"}
        self._puts.begin([calls[fault.name] for fault in self._faults if _is_put(fault)])
        for fault in self._faults:
            if not _is_message(fault) and not _is_datagram(fault) and fault.name not in calls:
                self._prepare(fault)

    def power_up(self, processor: Processor) -> None:
        self._processor = processor
        for strike in self._power_ups:
            strike(processor)
        for strike in self._first:
            strike(processor)
        self._first = []
        self._agenda.power_up()

    def _message(self, fault: Fault, classes: dict[str, type[MessageFault]], setting: Setting) -> MessageFault:
        return classes[fault.kind](fault, self._gates[fault.name], setting)

    def _call(self, fault: Fault) -> CallFault:
        """Make a call fail on each processor."""
        call = CallFault(fault, self._gates[fault.name], self.report, self._kernel)
        self._power_ups.append(call.power_up)
        return call

    def _prepare(self, fault: Fault) -> None:
        """Schedule a fault that does not affect messages, at its times."""
        gate, report, kernel = self._gates[fault.name], self.report, self._kernel
        if fault.kind == "lose_1hz":
            self._power_ups.append(LostSignal(fault, gate, report, kernel).power_up)
        elif fault.kind == "drift_clock":
            self._at(fault.when.after_ns, Drift(fault, gate, report, self._at).strike)
        elif fault.kind == "slow":
            self._strain.burdens.append(Slow(fault, gate, report, kernel).burden)
        elif fault.kind == "compute":
            self._prepare_work(fault)
        elif fault.kind in MEMORY_FAULTS:
            self._at_times(fault, MEMORY_FAULTS[fault.kind](fault, gate.random, report).strike)
        elif fault.kind in ("crash", "hang", "stop", "restart"):
            self._prepare_app(fault)
        elif _is_at_calls(fault):
            self._at_calls(fault, None, self._once(fault))
        else:
            self._at_times(fault, self._once(fault))

    def _once(self, fault: Fault) -> Strike:
        """Return the action for each of a fault's times."""
        if fault.kind == "fill":
            return Fill(fault, self._agenda, self.report).strike
        return (Jump if fault.kind == "jump_clock" else ProcessorFault)(fault, self.report).strike

    def _prepare_app(self, fault: Fault) -> None:
        """Schedule it at its times, or when the application has taken certain messages out of its pipes."""
        for name in fault.target:
            strike = self._app_fault(fault, name).strike
            if _is_at_calls(fault):
                self._at_calls(fault, name, strike)
            elif not _counts_messages(fault):
                self._at_times(fault, strike)
            else:
                self._board.on_take.append(partial(self._on_take, fault, name, strike))

    def _prepare_work(self, fault: Fault) -> None:
        """Schedule it where a wait ends, a message is taken, or a task gives its computing time."""
        work = self._works[fault.name]
        work.begin(fault, self._gates[fault.name], self.report, self._kernel)
        if "message" in fault.options:
            self._board.on_take.append(lambda packet, pipe: work.on_take(packet, pipe, self._board.is_called))

    def _app_fault(self, fault: Fault, name: str) -> AppFault:
        if fault.kind == "hang":
            return Hang(fault, name, self.report, self._strain)
        return APP_FAULTS[fault.kind](fault, name, self.report)

    def _on_take(self, fault: Fault, app_name: str, strike: Strike, packet: bytes, pipe: Pipe) -> None:
        """An application takes a message: execute the fault now, if it waits for this message."""
        if pipe.app_name != app_name:
            return
        wanted = fault.options.get("message")
        if wanted is not None and not self._board.is_called(packet, wanted):
            return
        if self._gates[fault.name].opens(self._kernel.now):
            self._strike_now(fault, strike)

    def _at_calls(self, fault: Fault, app_name: str | None, strike: Strike) -> None:
        """Schedule it before the call, of one application or any, that the schedule chooses."""
        self._calls.add(app_name, self._gates[fault.name], partial(self._strike_now, fault, strike))

    def _strike_now(self, fault: Fault, strike: Strike) -> None:
        """Execute a fault now. In an application that crashes the calling task ends here."""
        record = self.report.records[fault.name]
        before = record.times
        self._agenda.add(self._kernel.now, lambda: strike(self._processor))
        if fault.kind == "crash" and record.times > before:
            self._kernel.wait_on(WaitList("the end of its application, which has crashed"))

    def _at_times(self, fault: Fault, strike: Strike) -> None:
        """Schedule it at its times; without times it happens before the boot, as does a change of memory at 0."""
        for when_ns in fault.when.at_ns or (0,):
            if when_ns == 0 and fault.kind in MEMORY_FAULTS:
                self._first.append(strike)
            else:
                self._at(when_ns, strike)

    def _at(self, when_ns: int, strike: Strike) -> None:
        self._agenda.add(when_ns, lambda: strike(self._processor), survives=True)

    # -- the report ----------------------------------------------------------------------------------------------------

    def rows(self) -> list[dict[str, Any]]:
        """Return the result of each fault; see `FaultReport.rows`."""
        for name, gate in self._gates.items():
            record = self.report.records[name]
            if not record.times and not gate.fired and not _is_timed(record.fault):
                had_occasions = gate.seen or gate.when.explored
                record.why_not = gate.why_not() if had_occasions else _without_occasion(record.fault, gate)
        return self.report.rows()


def _without_occasion(fault: Fault, gate: Gate) -> str:
    """Return why a fault that waits for occasions had none."""
    if _is_message(fault):
        return "no matching message was delivered"
    return why_not_called(fault) if fault.kind == "fail" else gate.why_not()


def _by_app(fault: Fault, names: MissionNames) -> Fault:
    """Return a fault with cFE names of applications instead of names of nodes."""
    options = {key: names.app(value) if key in APP_OPTIONS else value for key, value in fault.options.items()}
    is_app = KINDS[fault.kind].strikes == APP
    return replace(fault, target=tuple(map(names.app, fault.target)) if is_app else fault.target, options=options)


def _is_datagram(fault: Fault) -> bool:
    return fault.kind in MESSAGE_FAULTS and fault.target[0].startswith(DATAGRAMS)


def _is_message(fault: Fault) -> bool:
    return fault.kind in MESSAGE_FAULTS and not _is_datagram(fault)


def _is_put(fault: Fault) -> bool:
    """Return whether it also makes the Software Bus's puts into pipes fail."""
    return fault.kind == "fail" and call_name(fault.target[0]) == QUEUE_PUT


def _is_at_calls(fault: Fault) -> bool:
    """Return whether the schedule may choose any call for it."""
    is_of_apps = fault.kind in ("crash", "hang", "stop", "restart") and "message" not in fault.options
    return bool(fault.when.explored) and (is_of_apps or fault.kind == "reset")


def _counts_messages(fault: Fault) -> bool:
    """Return whether an application's fault waits for messages, and not only for a time."""
    return not _is_at_calls(fault) and (not fault.when.at_ns or "message" in fault.options)


def _needs_bus(fault: Fault) -> bool:
    if fault.kind == "compute":
        return "message" in fault.options
    return _is_message(fault) or (fault.kind in ("crash", "hang", "stop", "restart") and _counts_messages(fault))


def _is_timed(fault: Fault) -> bool:
    """Return whether it happens at a time, independent of other events."""
    if _is_at_calls(fault):
        return False
    if fault.kind in ("crash", "hang", "stop", "restart"):
        return not _counts_messages(fault)
    return fault.kind in ("fill", "jump_clock", "reset", "drift_clock", *MEMORY_FAULTS)
