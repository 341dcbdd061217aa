"""Real sockets: a ground system on this computer talks to a paced mission, and to sockets of its own applications.

Every test has ports that the computer chose. No test looks at the clock: the pacer runs until the expected result is
there, and a run without it ends at a virtual time.
"""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path

import pytest

from apps.to_lab import packets as to_lab
from cfepy.io.host_network import TCP, HostNetwork
from cfepy.mission import Mission
from cfepy.msg import command
from cfepy.status import UsageError
from cfepy.trace import Trace
from cfepy.writing.console import Console
from tests.io.echo import ECHO, LOOPBACK, PATIENCE_NS, pacer

LAB = """\
CFE_APP, ci_lab, CI_LAB_AppMain, CI_LAB, 60, 16384, 0x0, 0;
CFE_APP, to_lab, TO_LAB_AppMain, TO_LAB, 70, 16384, 0x0, 0;
!
"""
APPS = (
    ECHO
    + '''

def Stranger(cfe):
    """Sends a datagram to a host that is not here, twice, then one to a port of this one."""
    sender = cfe.os.socket_open(1, 1)
    address = cfe.os.socket_addr_init(1)
    cfe.os.socket_addr_set_port(address, 1235)
    for host in ("10.0.0.7", "10.0.0.7", "127.0.0.1"):
        cfe.os.socket_addr_from_string(address, host)
        cfe.os.socket_send_to(sender, host.encode(), address)
    cfe.os.task_delay(1 << 30)
'''
)


class Session:
    """A paced mission with real ports, and a ground system's UDP socket."""

    def __init__(
        self, mission: Mission, told: list[str], records: list[bytes], ground: socket.socket, bridge: HostNetwork
    ) -> None:
        self.mission = mission
        self.told = told
        self.records = records
        self.ground = ground
        self.bridge = bridge
        self._pacer = pacer(mission.kernel, self._run_until, bridge.wait)

    def run_while(self, missing: Callable[[], bool]) -> None:
        """Let the run go on until nothing is missing any more."""
        while missing():
            assert self.mission.kernel.now < PATIENCE_NS, "what was expected never came"
            self._pacer.step(PATIENCE_NS)

    def run_until_told(self, text: str) -> None:
        """Let the run go on until the console has a text."""
        self.run_while(lambda: not self.console_has(text))

    def command(self, packet: bytes) -> None:
        """Send a command to CI_LAB."""
        self.ground.sendto(packet, (LOOPBACK, self.bridge.host_port(1234) or 0))

    def console_has(self, text: str) -> bool:
        return any(text in line for line in self.mission.console.lines)

    def packet(self) -> bytes | None:
        """Return the ground's next packet, if there is one."""
        try:
            return self.ground.recv(70_000)
        except BlockingIOError:
            return None

    def _run_until(self, until_ns: int) -> None:
        self.mission.run_until(until_ns)
        self.bridge.exchange()


@contextmanager
def session(folder: Path, script: str, ci_port: int = 0, ports: Mapping[int, int] | None = None) -> Iterator[Session]:
    (folder / "startup.scr").write_text(script, encoding="utf-8")
    (folder / "apps.py").write_text(APPS, encoding="utf-8")
    told: list[str] = []
    records: list[bytes] = []
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ground,
        Mission(str(folder), console=Console(quiet=True), trace=Trace(records.extend)) as mission,
    ):
        ground.bind((LOOPBACK, 0))
        ground.setblocking(False)
        numbers = {1234: ci_port, 7: 0, 1235: ground.getsockname()[1], **(ports or {})}
        with HostNetwork(mission, numbers, told.append) as bridge:
            yield Session(mission, told, records, ground, bridge)


def test_noop_over_udp_causes_its_event_and_telemetry(tmp_path: Path) -> None:
    with session(tmp_path, LAB) as lab:
        lab.run_while(lambda: not lab.console_has("Awaiting enable command"))
        lab.command(to_lab.OUTPUT_ENABLE.packet(dest_IP=LOOPBACK))
        lab.run_while(lambda: not lab.console_has("telemetry output enabled"))
        lab.command(bytes.fromhex("1880c001000100a7"))
        received: list[bytes] = []

        def missing() -> bool:
            packet = lab.packet()
            received.extend([] if packet is None else [packet])
            return not any(packet[:2] == b"\x08\x08" and b"TO: NOOP command" in packet for packet in received)

        lab.run_while(missing)
        assert lab.console_has("66/1/TO_LAB 18: TO: NOOP command")
        assert lab.told == [f"UDP port 1234 is open at {LOOPBACK}:{lab.bridge.host_port(1234)}"]


def test_three_spacecraft_side_by_side(tmp_path: Path) -> None:
    """Each has its own ports and id: a command reaches one of them, and its telemetry its own ground."""
    numbers = (66, 67, 68)
    with ExitStack() as stack:
        crafts: list[Session] = []
        for number in numbers:
            folder = tmp_path / str(number)
            folder.mkdir()
            (folder / "mission.yaml").write_text(f"limits: {{spacecraft_id: {number}}}\n", encoding="utf-8")
            crafts.append(stack.enter_context(session(folder, LAB)))
        assert len({craft.ground.getsockname() for craft in crafts}) == len(crafts)
        for craft in crafts:
            craft.run_until_told("Awaiting enable command")
            craft.command(to_lab.OUTPUT_ENABLE.packet(dest_IP=LOOPBACK))
        for craft in crafts:
            craft.run_until_told("telemetry output enabled")
        crafts[1].command(bytes.fromhex("1884c000000100a2"))
        crafts[1].run_until_told("67/1/CI_LAB 5: CI: NOOP command")
        for craft, number in zip(crafts, numbers, strict=True):
            events: list[bytes] = []
            craft.run_while(partial(has_no_event, craft, events))
            assert {int.from_bytes(event[40:44], "little") for event in events} == {number}
            assert craft.console_has("CI: NOOP command") == (number == 67)


def has_no_event(craft: Session, events: list[bytes]) -> bool:
    """Return whether no event has reached the ground yet. Reads the waiting ones."""
    while packet := craft.packet():
        events.extend([packet] if packet.startswith(b"\x08\x08") else [])
    return not events


def test_each_arrival_is_recorded_with_its_time(tmp_path: Path) -> None:
    with session(tmp_path, LAB) as lab:
        lab.run_while(lambda: lab.bridge.host_port(1234) is None)
        lab.command(bytes.fromhex("1884c000000100a2"))
        lab.run_while(lambda: not lab.console_has("CI: NOOP command"))
        lab.mission.trace.flush()
    uplinks = [record for record in lab.records if record.startswith(b"Nuplink to 1234 at ")]
    assert [record.rpartition(b" ")[2] for record in uplinks] == [b"1884c000000100a2"]


def test_input_ends_the_wait(tmp_path: Path) -> None:
    with session(tmp_path, LAB) as lab:
        lab.run_while(lambda: lab.bridge.host_port(1234) is None)
        lab.command(b"wake up")
        lab.bridge.wait(1_000_000)  # days, if it did not end


def test_streams_both_ways_with_back_pressure(tmp_path: Path) -> None:
    sent, received = bytes(range(97, 123)) * 20_000, bytearray()
    with session(tmp_path, "CFE_APP, apps, Echo, ECHO, 60, 16384, 0x0, 0;\n!\n") as echo:
        echo.run_while(lambda: echo.bridge.host_port(7, TCP) is None)
        with socket.create_connection((LOOPBACK, echo.bridge.host_port(7, TCP) or 0)) as client:
            client.setblocking(False)
            unsent = memoryview(sent)

            def missing() -> bool:
                nonlocal unsent
                if unsent:
                    unsent = unsent[_send(client, unsent) :]
                    if not unsent:
                        client.shutdown(socket.SHUT_WR)
                received.extend(_receive(client))
                return len(received) < len(sent)

            echo.run_while(missing)
        assert bytes(received) == sent.upper()


def test_datagrams_to_other_computers_are_dropped(tmp_path: Path) -> None:
    with session(tmp_path, "CFE_APP, apps, Stranger, STRANGER, 60, 16384, 0x0, 0;\n!\n") as stranger:
        received: list[bytes] = []

        def missing() -> bool:
            packet = stranger.packet()
            received.extend([] if packet is None else [packet])
            return not received

        stranger.run_while(missing)
        assert received == [LOOPBACK.encode()]
        assert stranger.told == ["datagrams for 10.0.0.7 are dropped, because only 127.0.0.1 is connected"]


def test_taken_port_is_reported(tmp_path: Path) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind((LOOPBACK, 0))
        port = other.getsockname()[1]
        with session(tmp_path, LAB, port) as lab, pytest.raises(UsageError, match=f"UDP port {port} .* 1234=NUMBER"):
            lab.run_while(lambda: True)


def test_reset_keeps_the_port_open(tmp_path: Path) -> None:
    with session(tmp_path, LAB) as lab:
        lab.run_while(lambda: lab.bridge.host_port(1234) is None)
        port = lab.bridge.host_port(1234)
        lab.command(bytes(command(0x1806, 2, b"\1\0")))  # ES's RESTART, a processor reset
        lab.run_while(lambda: sum("Awaiting enable command" in line for line in lab.mission.console.lines) < 2)
        assert lab.bridge.host_port(1234) == port
        lab.command(bytes.fromhex("1884c000000100a2"))
        lab.run_while(lambda: not lab.console_has("CI: NOOP command"))


def _send(client: socket.socket, data: memoryview) -> int:
    try:
        return client.send(data)
    except BlockingIOError:
        return 0


def _receive(client: socket.socket) -> bytes:
    try:
        return client.recv(100_000)
    except BlockingIOError:
        return b""
