"""A paced run with real sockets is replayed without them, in virtual time, to the same digest.

No test looks at the clock: the pacer runs until the expected result is there.
"""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from cfepy.io.host_network import TCP, HostNetwork
from cfepy.journal import Journal, JournalRecorder, read_journal, replay
from cfepy.mission import Mission, outside
from cfepy.pilot.pilot import Flown
from cfepy.pilot.plan import RunPlan
from cfepy.pilot.run_loop import BROKEN_OFF, INTERRUPTED, Course
from cfepy.units import NS_PER_S
from cfepy.writing.console import Console
from tests.io.echo import ECHO, FAST, LOOPBACK, PATIENCE_NS, pacer
from tests.journal.replays import assert_same_again, plan_for

STARTUP = """\
CFE_APP, ci_lab, CI_LAB_AppMain, CI_LAB, 60, 16384, 0x0, 0;
CFE_APP, apps, Echo, ECHO, 80, 16384, 0x0, 0;
CFE_APP, caller, __main__, CALLER, 90, 16384, 0x0, 0;
!
"""
CALLER = """
import socket, time
for _ in range(2000):
    caller = socket.socket()
    try:
        caller.connect(("127.0.0.1", 9))
    except OSError:
        time.sleep(0.1)
        continue
    caller.sendall(b"who is there?")
    print("answered:", caller.recv(100).decode())
    break
"""


class Session:
    """A paced mission with real ports that is recorded."""

    def __init__(self, course: Course, bridge: HostNetwork, recorder: JournalRecorder) -> None:
        self.course = course
        self.mission = course.mission
        self.bridge = bridge
        self._recorder = recorder
        self._pacer = pacer(self.mission.kernel, self._run_until, bridge.wait)

    def run_while(self, missing: Callable[[], bool]) -> None:
        """Let the run go on until nothing is missing any more."""
        while missing():
            assert self.mission.kernel.now < PATIENCE_NS, "what was expected never came"
            self._pacer.step(PATIENCE_NS)

    def console_has(self, text: str) -> bool:
        return any(text in line for line in self.mission.console.lines)

    def _run_until(self, until_ns: int) -> None:
        self.mission.run_until(until_ns)
        self.bridge.exchange()
        self._recorder.mark()


@contextmanager
def session(folder: Path, schedule: str = "fifo", board: str = "linux", port: int = 0) -> Iterator[Session]:
    """A mission that is recorded into run.cfepy, and then interrupted."""
    for name, text in (("startup.scr", STARTUP), ("apps.py", ECHO), ("caller.py", CALLER)):
        (folder / name).write_text(text, encoding="utf-8")
    plan = plan_for(str(folder), schedule=schedule, board=board)
    with JournalRecorder(folder / "run.cfepy", plan, paced=FAST) as recorder:
        mission = Mission(
            plan.spec(), board=board, console=Console(quiet=True), policy=recorder.policy, attachments=[recorder]
        )
        with mission, HostNetwork(mission, {1234: 0, 7: 0, 9: port}) as bridge:
            course = Course(mission, PATIENCE_NS / NS_PER_S)
            yield Session(course, bridge, recorder)
            course.end()
            mission.shut_down_nodes()
            digest = mission.finish()
        recorder.end(Flown(mission, course.at, digest, None, INTERRUPTED))


@pytest.mark.parametrize(("schedule", "board"), [("fifo", "linux"), ("random:3", "rx64m"), ("pct:1:3:500", "linux")])
def test_datagrams_and_connections_are_replayed(tmp_path: Path, schedule: str, board: str) -> None:
    with (
        socket.create_server((LOOPBACK, 0)) as server,
        session(tmp_path, schedule, board, server.getsockname()[1]) as run,
    ):
        server.setblocking(False)
        run.run_while(lambda: run.bridge.host_port(1234) is None or run.bridge.host_port(7, TCP) is None)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ground:
            for _ in range(3):
                ground.sendto(bytes.fromhex("1884c000000100a2"), (LOOPBACK, run.bridge.host_port(1234) or 0))
            run.run_while(lambda: not run.console_has("CI: NOOP command"))
        text = b"a long story; " * 9_000
        back = echoed(run, text)
        assert back == text.upper()
        answer(run, server)
        run.run_while(lambda: not run.console_has("answered: nobody"))
    journal = read_journal(tmp_path / "run.cfepy")
    kinds = {event.kind for pause in journal.pauses for event in pause.events}
    assert kinds == {outside.DATAGRAM, outside.CALL, outside.BYTES, outside.TAKEN, outside.ENDED, outside.CLOSED}
    assert journal.answers[-1].values[-1] is True
    assert journal.end is not None
    assert_same_again(journal, journal.end.trace)


def test_replay_can_end_between_two_inputs(tmp_path: Path) -> None:
    with session(tmp_path) as run:
        run.run_while(lambda: run.bridge.host_port(1234) is None)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ground:
            for count in (1, 2):
                ground.sendto(bytes.fromhex("1884c000000100a2"), (LOOPBACK, run.bridge.host_port(1234) or 0))
                run.run_while(lambda count=count: _noops(run.mission) < count)  # type: ignore[misc]
    journal = read_journal(tmp_path / "run.cfepy")
    second = journal.pauses[-1].until_ns
    early = replay(journal, until_ns=second - 1)
    assert early.verdict.same
    assert not early.verdict.whole
    assert _noops(early.flown.mission) == 1


def _noops(mission: Mission) -> int:
    return sum("CI: NOOP command" in line for line in mission.console.lines)


def echoed(run: Session, text: bytes) -> bytes:
    """Send a text to the echo and get it back, with a socket that takes little at a time."""
    back = bytearray()
    with socket.create_connection((LOOPBACK, run.bridge.host_port(7, TCP) or 0)) as client:
        client.setblocking(False)
        left = memoryview(text)

        def missing() -> bool:
            nonlocal left
            try:
                left = left[client.send(left[:20_000]) :] if left else left
            except BlockingIOError:
                pass
            try:
                back.extend(client.recv(3_000))
            except BlockingIOError:
                pass
            return len(back) < len(text)

        run.run_while(missing)
        client.shutdown(socket.SHUT_WR)
        run.run_while(lambda: not _is_at_its_end(client))
    return bytes(back)


def _is_at_its_end(client: socket.socket) -> bool:
    try:
        return not client.recv(100)
    except BlockingIOError:
        return False


def answer(run: Session, server: socket.socket) -> None:
    """Take the call of the mission's own node, and answer it."""
    found: list[socket.socket] = []

    def missing() -> bool:
        try:
            found.append(server.accept()[0])
        except BlockingIOError:
            return True
        return False

    run.run_while(missing)
    found[0].sendall(b"nobody")
    found[0].close()


def broken_off(folder: Path, plan: RunPlan, at_ns: int, paced: float | None = None) -> Journal:
    """Return the journal of a run that ends with Ctrl-C in the middle of a task."""
    (folder / "startup.scr").write_text("CFE_APP, spin, __main__, SPIN, 100, 16384, 0, 0;!", encoding="utf-8")
    (folder / "spin.py").write_text("import time\ntime.sleep(20)\n", encoding="utf-8")
    path = folder.with_suffix(".cfepy")
    with JournalRecorder(path, plan, paced=paced) as recorder:
        mission = Mission(plan.spec(), console=Console(quiet=True), attachments=[recorder])
        with mission:
            course = Course(mission, plan.seconds)
            mission.run_until(at_ns)
            course.end()
            digest = mission.finish()
        recorder.end(Flown(mission, course.at, digest, None, BROKEN_OFF))
    return read_journal(path)


@pytest.mark.parametrize(
    ("seconds", "paced", "at_ns"),
    [(3, None, 1_400_000_000), (None, FAST, 1_400_000_000), (None, FAST, 12_000_000_000)],
    ids=["alone", "joined", "joined for longer than a run that has no time takes alone"],
)
def test_interrupted_run_is_replayed_up_to_its_end(
    tmp_path: Path, seconds: float | None, paced: float | None, at_ns: int
) -> None:
    again = replay(broken_off(tmp_path, plan_for(str(tmp_path), seconds), at_ns, paced))
    assert again.verdict.same
    assert not again.verdict.whole
    assert again.flown.results.virtual_s == pytest.approx(at_ns / NS_PER_S)
