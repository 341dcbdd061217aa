"""Attaching to a running flight: its socket, `live:` of commands (docs/how_to/ground_tools.md), and their limits."""

from __future__ import annotations

import json
import os
import socket
import stat
import tempfile
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import pytest

from cfepy.cli.main import main
from cfepy.extra.attach.attach_server import MOST_PROGRAMS, AttachServer
from cfepy.ground import EVENT_IDS, dictionary_of
from cfepy.io import LiveFlight, flight_folder, framed, live_flight, live_name
from cfepy.mission import Mission, TopicMessage
from cfepy.mission.outside import ACT, Arrival
from cfepy.status import UsageError
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

T = TypeVar("T")
NODE = """
import rospy
from std_msgs.msg import Header, Int32
rospy.init_node("counter")
rospy.Subscriber("jump", Int32, lambda message: print(f"jumped {message.data}"))
rospy.Subscriber("count", Header, lambda message: None)
publisher = rospy.Publisher("count", Header, queue_size=1)
rate, number = rospy.Rate(100), 0
while not rospy.is_shutdown():
    number += 1
    publisher.publish(Header(seq=number, stamp=rospy.Time.now(), frame_id="c"))
    rate.sleep()
"""
STARTUP = "CFE_APP, counter.py, __main__, COUNTER, 50, 16384, 0, 0;\n!\n"


class Flown:
    """A flight that goes on while a program in another thread attaches to it."""

    def __init__(self, folder: Path) -> None:
        self.server = AttachServer()
        mission = write_mission(folder, STARTUP, counter=NODE, mission_yaml="name: demo")
        self.mission = Mission(mission, console=Console(quiet=True), attachments=[self.server], tasks="greenlet")
        self.mission.run_for(1)

    def attended(self, act: Callable[[], T]) -> T:
        """Return the result of a function, which runs beside the flight."""
        found: list[T | BaseException] = []

        def work() -> None:
            try:
                found.append(act())
            except (Exception, SystemExit) as error:
                found.append(error)

        worker = threading.Thread(target=work)
        worker.start()
        while worker.is_alive():
            self.mission.run_for(0.01)
            self.server.exchange()
        (result,) = found
        if isinstance(result, BaseException):
            raise result
        return result

    def commanded(self, *words: str) -> int:
        """Return the exit status of a command in the other terminal."""
        return self.attended(lambda: main([*words]))


@pytest.fixture
def runtime(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Return the folder of this user's sockets; its path is short, as a socket's must be."""
    with tempfile.TemporaryDirectory(prefix="cf") as folder:
        monkeypatch.setenv("XDG_RUNTIME_DIR", folder)
        yield Path(folder) / "cfepy"


@pytest.fixture
def flown(runtime: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Flown]:
    flight = Flown(tmp_path)

    class VirtualWatch:
        """Measures the time of the flight, so that a slow computer changes nothing."""

        def __init__(self) -> None:
            self._since = flight.mission.kernel.now

        def elapsed_ns(self) -> int:
            return flight.mission.kernel.now - self._since

    monkeypatch.setattr("cfepy.io.live_flights.Stopwatch", VirtualWatch)
    yield flight
    flight.mission.close()
    flight.server.close()


def test_socket_is_for_its_user_alone_and_goes_with_the_flight(flown: Flown, runtime: Path) -> None:
    assert stat.S_IMODE(runtime.stat().st_mode) == 0o700
    assert stat.S_IMODE(flown.server.path.stat().st_mode) == 0o600
    flown.server.close()
    flown.server.close()
    assert [*runtime.iterdir()] == []


def test_folder_that_others_may_enter_is_refused(runtime: Path) -> None:
    flight_folder().chmod(0o750)
    with pytest.raises(UsageError, match="must be a folder that only you may enter"):
        AttachServer()
    runtime.rmdir()
    other = runtime.with_name("other")
    other.mkdir(mode=0o700)
    runtime.symlink_to(other)
    with pytest.raises(UsageError, match="must be a folder that only you may enter"):
        flight_folder()


def test_attached_program_sees_messages_and_the_trace_stays(flown: Flown, tmp_path: Path) -> None:
    def listen() -> list[Any]:
        with live_flight("demo") as flight:
            assert (flight.pid, Path(flight.script).name) == (os.getpid(), "startup.scr")
            flight.listen(["/cou*"], [0x0800, *EVENT_IDS])
            messages = flight.messages()
            return [next(messages) for _ in range(30)]

    seen = flown.attended(listen)
    topics = [each for each in seen if isinstance(each, TopicMessage)]
    assert {each.topic for each in topics} == {"/count"}
    assert topics[0].header["type"] == "std_msgs/Header"
    stamps = [(each.stamp_ns or 0) - each.at_ns for each in topics]
    assert {*stamps} == {flown.mission.processor.machine.epoch_ns}
    end_ns = flown.mission.kernel.now
    with Mission(flown.mission.spec, console=Console(quiet=True), tasks="greenlet") as alone:
        alone.run_until(end_ns)
        assert alone.finish() == flown.mission.finish()


def test_flight_without_listeners_looks_at_no_message(flown: Flown) -> None:
    taken: list[object] = []
    flown.server._topic_watch.take_packet = taken.append  # type: ignore[method-assign]
    flown.mission.run_for(0.5)
    assert taken == []


def test_command_goes_in_as_recorded_input(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    arrivals: list[Arrival] = []
    flown.mission.outside.listener = arrivals.append
    assert flown.commanded("cmd", "live:", "CFE_ES_NOOP", "--for", "0.3") == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].endswith(" CFE_ES_NOOP sent to CFE_ES")
    assert any(" CFE_ES 3 INFORMATION: No-op" in line for line in lines)
    packet = dictionary_of(None).command("CFE_ES_NOOP").packet()
    assert arrivals == [Arrival(ACT, ("packet", packet))]


def test_telemetry_of_a_flight_is_shown_by_name(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    assert flown.commanded("tlm", "live:demo", "/count", "--count", "2", "--json", "-") == 0
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert len(rows) == 2
    assert flown.commanded("tlm", "live:", "CFE_EVS_LONG_EVENT_MSG", "--for", "0.05") == 1
    assert capsys.readouterr().err == "cfepy: no matching packet was sent\n"


def test_rostopic_shows_a_flight(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    for words, said in (
        (["list", "live:"], "/count\n/jump\n"),
        (["type", "live:", "/count"], "std_msgs/Header\n"),
        (["find", "live:", "std_msgs/Int32"], "/jump\n"),
        (["echo", "live:", "/count/frame_id", "-n", "2"], '"c"\n---\n"c"\n---\n'),
    ):
        assert flown.commanded("rostopic", *words) == 0
        assert capsys.readouterr().out.replace("/rosout\n", "") == said
    assert flown.commanded("rostopic", "info", f"live:{os.getpid()}", "/count") == 0
    assert " * /counter (http://" in capsys.readouterr().out
    assert flown.commanded("rostopic", "hz", "live:", "/count", "-n", "20") == 0
    assert capsys.readouterr().out.startswith("average rate: 100.0")


def test_rostopic_publishes_in_a_flight(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    assert flown.commanded("rostopic", "pub", "live:", "/jump", "std_msgs/Int32", "data: 7") == 0
    assert capsys.readouterr().out == "published 1 message on /jump\n"
    flown.mission.run_for(0.1)
    assert "[counter] jumped 7" in flown.mission.console.lines
    for words, said in (
        (["/jump", "std_msgs/String", "data: x"], "/jump has type std_msgs/Int32, not std_msgs/String"),
        (["/jump", "std_msgs/Int32", "data: x"], "field data must be an integer type"),
        (["/jump", "std_msgs/Int32", "7"], "expected fields, such as 'data: hi'"),
        (["/jump", "std_msgs/Int32", "nr: 7"], "unknown field"),
        (["/jmp", "std_msgs/Int32", "data: 7"], "did you mean /jump"),
        (["/jump", "std_msgs/Int32", "data: 7", "-r", "5"], "--rate: only valid for a mission to be run"),
    ):
        assert flown.commanded("rostopic", "pub", "live:", *words) == 2
        assert said in capsys.readouterr().err


def test_options_of_a_run_are_refused(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    for words in (["rostopic", "list", "live:"], ["tlm", "live:"], ["cmd", "live:", "CFE_ES_NOOP"]):
        assert flown.commanded(*words, "--seed", "3") == 2
        assert "--seed: only valid for a mission to be run" in capsys.readouterr().err


def test_flight_is_chosen_by_name_or_process(flown: Flown, tmp_path: Path) -> None:
    (tmp_path / "more").mkdir()
    assert live_name("live:demo") == "demo"
    assert live_name("lab") is None
    with pytest.raises(UsageError, match=rf"live:lab: does not run; running are live:{os.getpid()} \(demo\)"):
        flown.attended(lambda: live_flight("lab"))
    other = AttachServer()
    other.begin(flown.mission)
    done = threading.Event()
    helper = threading.Thread(target=lambda: [other.exchange() for _ in iter(done.is_set, True)])
    helper.start()
    try:
        with pytest.raises(UsageError, match="several flights run: live:"):
            flown.attended(lambda: live_flight(""))
    finally:
        done.set()
        helper.join()
        other.close()


def test_flight_that_was_killed_is_not_found(runtime: Path) -> None:
    dead = flight_folder() / "1-2.sock"
    with socket.socket(socket.AF_UNIX) as left:
        left.bind(str(dead))
    with pytest.raises(UsageError, match="live:: no flight runs; start one with `cfepy run MISSION --realtime`"):
        live_flight("")
    assert not dead.exists()


def test_end_of_the_flight_ends_the_messages(flown: Flown) -> None:
    def listen() -> int:
        with live_flight("") as flight:
            flight.listen(["/count"])
            messages = flight.messages()
            next(messages)
            listening.set()
            return sum(1 for _ in messages)

    listening = threading.Event()
    counts: list[int] = []
    worker = threading.Thread(target=lambda: counts.append(listen()))
    worker.start()
    while not listening.is_set():
        flown.mission.run_for(0.01)
        flown.server.exchange()
    flown.server.close()
    worker.join()
    assert len(counts) == 1


def attached(flown: Flown) -> socket.socket:
    """Return a connection with the flight that has sent nothing yet."""
    plug = socket.socket(socket.AF_UNIX)
    plug.connect(str(flown.server.path))
    flown.server.exchange()
    return plug


@pytest.mark.parametrize(
    "sent",
    [
        framed({"op": "stop"}),
        framed({"op": ["hello"]}),
        framed({"op": "listen"}),
        framed({"op": "listen", "topics": [], "telemetry": ["x"]}),
        framed({"op": "send", "packet": 2**40}),
        b"\xff\xff\xff\xff",
        (1).to_bytes(4, "big") + b"\x05",
        (1).to_bytes(4, "big") + b"\xc1",
    ],
)
def test_wrong_request_ends_its_own_connection_only(flown: Flown, sent: bytes) -> None:
    plug = attached(flown)
    plug.sendall(sent)
    flown.server.exchange()
    assert plug.recv(10) == b""
    plug.close()
    flown.mission.run_for(0.1)
    with flown.attended(lambda: live_flight("")) as flight:
        assert flight.mission == "demo"


def test_packet_that_the_bus_refuses_is_an_error(flown: Flown) -> None:
    with flown.attended(lambda: live_flight("")) as flight:
        with pytest.raises(UsageError):
            flown.attended(lambda: flight.ask({"op": "send", "packet": b"\x18\x06"}))
        assert flown.attended(flight.topics)


def test_program_that_does_not_read_loses_messages(flown: Flown) -> None:
    with flown.attended(lambda: live_flight("")) as flight:
        flown.attended(lambda: flight.listen(["/count"], []))
        (program,) = flown.server._programs
        while not program.peer.dropped:
            flown.mission.run_for(1)
        lost = flown.attended(lambda: last_of(flight))
        assert 0 < lost <= program.peer.dropped


def last_of(flight: LiveFlight) -> int:
    """Read until the flight reports losses; return their number."""
    for _ in flight.messages():
        if flight.lost:
            break
    return flight.lost


def test_too_many_programs_are_turned_away(flown: Flown) -> None:
    plugs = [attached(flown) for _ in range(MOST_PROGRAMS + 1)]
    assert plugs[-1].recv(1) == b""
    for plug in plugs:
        plug.close()
    flown.server.exchange()
    assert flown.attended(lambda: live_flight("")).mission == "demo"


def test_console_commands_a_flight(
    flown: Flown, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    typed = tmp_path / "typed.txt"
    typed.write_text("CFE_ES_NOOP\nexpect event CFE_ES 3\nrun 0.1\nquit\n", encoding="utf-8")
    with open(typed, encoding="utf-8") as lines:
        monkeypatch.setattr("sys.stdin", lines)
        assert flown.commanded("console", "live:demo", "--plain", "--save-script", str(tmp_path / "s.txt")) == 0
    shown = capsys.readouterr().out
    assert "attached to demo; commands go to its Software Bus" in shown
    assert "CFE_ES 3 INFORMATION: No-op" in shown
    assert "send CFE_ES_NOOP" in (tmp_path / "s.txt").read_text(encoding="utf-8")


def test_console_refuses_options_of_other_targets(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    for option in (["--listen", "1235"], ["--enable"], ["--seed", "3"], ["--realtime"]):
        assert flown.commanded("console", "live:", "--plain", *option) == 2
        assert f"{option[0]}: only valid " in capsys.readouterr().err
