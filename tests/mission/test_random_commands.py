"""Thousands of commands with arbitrary fields to every application: none dies of an exception, nothing leaks."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from random import Random

import pytest

from cfepy import msg
from cfepy.ground.dictionary import dictionary_of
from cfepy.ground.link import GroundLink
from cfepy.ids import OS_STREAM_BASE
from cfepy.mission import Mission, read_mission
from cfepy.msg import Command
from cfepy.msg.layout import Cell
from cfepy.rtos.context import drain
from cfepy.sb import SoftwareBus
from cfepy.writing.console import Console

APPS = {
    "SAMPLE_APP": ("SAMPLE_APP_Main", "/cf/sample_app.so"),
    "CI_LAB": ("CI_LAB_AppMain", "/cf/ci_lab.so"),
    "TO_LAB": ("TO_LAB_AppMain", "/cf/to_lab.so"),
    "SCH_LAB": ("SCH_LAB_AppMain", "/cf/sch_lab.so"),
    "SCH": ("SCH_AppMain", "/cf/sch.so"),
    "HK": ("HK_AppMain", "/cf/hk.so"),
}
NAMES = [*APPS, "CFE_ES", "CFE_EVS", "CFE_TBL", "NOBODY", "", "X" * 20]
TABLES = ["HK.CopyTable", "HK.RuntimeTable", "TO_LAB.TO_LAB_Subs", "SCH.SCHED_DEF", "CFE_TBL.CritReg", "NO.Table", ""]
FILES = ["/ram/a.log", "/ram/b.tbl", "/cf/new.log", "", "/ram", "/nowhere/x", "/ram/" + "y" * 40]
LOADS = [*FILES, "/cf/hk_cpy_tbl.tbl", "/cf/to_lab_sub.tbl", "/cf/sample_app_tbl.tbl"]
NUMBERS = [0, 1, 2, 3, 5, 0x7F, 0xFFFF, 0xFFFFFFFF, 0x0800, 0x0808, 0x1806, 0x1882, 0x110005, 0x160003]
STOPPED = 0.3  # how many of the commands that stop an application are sent


class Commander:
    """Makes commands of a mission's dictionary."""

    def __init__(self, mission: str, seed: int) -> None:
        self.random = Random(seed)
        self.commands = list(dictionary_of(read_mission(mission)).commands.values())

    def __iter__(self) -> Iterator[bytes]:
        random = self.random
        while True:
            command = random.choice(self.commands)
            if command.name != "CFE_ES_STOP_APP" or random.random() < STOPPED:
                yield self._packet(command)

    def _packet(self, command: Command) -> bytes:
        random = self.random
        if command.name == "CFE_ES_START_APP" and random.random() < 0.9:
            name = random.choice(list(APPS))
            symbol, file = APPS[name]
            return command.packet(
                Application=name, AppEntryPoint=symbol, AppFileName=file, Priority=random.randrange(30, 200)
            )
        if command.name == "CFE_ES_RESTART":
            return command.packet(RestartType=random.randint(0, 3))
        payload = bytearray(command.payload.size)
        for cell in command.payload.cells():
            payload[cell.offset : cell.offset + cell.size] = self._value(command, cell)
        if random.random() < 0.03:
            payload = payload[: random.randrange(len(payload) + 1)] + random.randbytes(random.randrange(4))
        return bytes(msg.command(command.msg_id, command.code or 0, bytes(payload)))

    def _value(self, command: Command, cell: Cell) -> bytes:
        random = self.random
        if random.random() < 0.1:
            return random.randbytes(cell.size)
        if not cell.type.startswith("char"):
            return (random.choice(NUMBERS) % (1 << 8 * cell.size)).to_bytes(cell.size, "little")
        field = cell.path.lower()
        texts = NAMES
        if "file" in field:
            texts = LOADS if command.name == "CFE_TBL_LOAD" else FILES
        elif "table" in field or "cds" in field:
            texts = TABLES
        return random.choice(texts).encode()[: cell.size].ljust(cell.size, b"\0")


def survive(name: str, seed: int, count: int, board: str | None = None) -> int:
    """Send commands, assert that no application dies, stop all applications, and assert that nothing of them remains.

    Returns:
        The number of resets.
    """
    random = Random(seed)
    drain()
    threads = threading.active_count()
    with Mission(name, console=Console(quiet=True), board=board) as mission, GroundLink(mission) as ground:
        mission.run_for(2)
        for number, packet in zip(range(count), Commander(name, seed), strict=False):
            if random.random() < 0.9:
                mission.cfe.sb.transmit_msg(packet, is_origination=False)
            else:
                ground.send(packet)
            if random.random() < 0.5:
                mission.run_for(random.choice((0.001, 0.1, 0.5, 1, 3)))
                ground.received()
            dead = [line for line in mission.console.lines if "died of an exception" in line]
            assert not dead, f"command {number}, {packet.hex()}: {mission.console.lines[-20:]}"
            mission.console.lines.clear()
        _stop_all(mission)
        resets = mission.record.resets
        assert not any(reset.fault for reset in resets)
        assert left(mission) == _left_of_core(name, board)
    drain()
    assert threading.active_count() <= threads
    return len(resets)


def _stop_all(mission: Mission) -> None:
    mission.run_for(30)  # all pending work ends
    for app in list(mission.cfe.es.apps):
        if not app.is_core:
            mission.cfe.es.delete_app(app.app_id)
    mission.run_for(30)


def left(mission: Mission) -> dict[str, object]:
    """Return the objects that exist with only the core running."""
    sb: SoftwareBus = mission.cfe.sb
    tables = {table.kind: len(table) for table in mission.processor.osal._tables.values() if table.kind != "module"}
    tables["file"] -= len(left_by_loads(mission))
    return {
        "osal": tables,
        "apps": [app.name for app in mission.cfe.es.apps],
        "pipes": len(sb.pipes),
        "subscriptions": sb.subscriptions,
        "tasks": len(mission.kernel.tasks),
        "owners": sorted({owner for owner, _ in mission.memory.totals()}),
        "ports": [*mission.network.datagrams.bound, *mission.network.streams.bound],
    }


def left_by_loads(mission: Mission) -> list[int]:
    """Return the files of good LOAD commands, which CFE_TBL never closes, as in NASA's code."""
    osal, (services,) = mission.processor.osal, (app for app in mission.cfe.es.apps if app.name == "CFE_TBL")
    opened: list[int] = []
    osal.for_each_object_of_type(OS_STREAM_BASE, services.main_task_id, lambda number, _: opened.append(number))
    return opened


def _left_of_core(name: str, board: str | None) -> dict[str, object]:
    with Mission(name, console=Console(quiet=True), board=board) as mission:
        mission.run_for(2)
        _stop_all(mission)
        return left(mission)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "board", "count"),
    [
        ("lab", None, 400),
        ("lab", "rx64m", 400),
        ("sched", None, 400),
    ],
)
def test_hundreds_of_commands(name: str, board: str | None, count: int) -> None:
    assert survive(name, 1, count, board) > 0


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2, 4))
@pytest.mark.parametrize(("name", "board"), [("lab", None), ("lab", "rx64m"), ("sched", None), ("sched", "rx64m")])
def test_thousands_of_commands(name: str, board: str | None, seed: int) -> None:
    assert survive(name, seed, 2000, board) > 0
