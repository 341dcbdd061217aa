"""CI_LAB through its socket: accepted and refused datagrams, commands and counters."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from apps.ci_lab import packets as pk
from apps.to_lab import packets as to_lab
from cfepy.ground.link import GroundLink
from cfepy.status import CFE_SB_BAD_ARGUMENT, CFE_STATUS_WRONG_MSG_LENGTH
from tests.apps.lab import Lab, lab
from tests.layouts import assert_same

DATA = Path(__file__).parents[1] / "data"
NOOP = pk.NOOP.packet()
NOOP_EVENT = "CI_LAB 5: CI: NOOP command. Version 7.0.0.0"
ENABLE = to_lab.OUTPUT_ENABLE.packet(dest_IP="127.0.0.1")


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Lab]:
    with lab(tmp_path) as made:
        yield made


def counters(session: Lab, *packets: bytes) -> tuple[int, int, int, int]:
    """Accepted, rejected, packets and errors of CI_LAB's housekeeping, which is asked for over the socket too."""
    fields = session.latest(pk.HK_TLM, *packets, pk.SEND_HK.packet())
    assert fields["SocketConnected"] == 1
    return tuple(fields[name] for name in ("CommandCounter", "CommandErrorCounter", "IngestPackets", "IngestErrors"))


def test_layouts() -> None:
    assert_same(pk.HOUSEKEEPING, "CI_LAB_HkTlm_Payload_t")


def test_start(tmp_path: Path) -> None:
    with lab(tmp_path) as session:
        lines = session.mission.console.lines
        version = "CI Lab App v7.0.0+dev0 (Draco) v7.0.0 Official Release, EDS disabled"
        assert any(line.endswith("CI_LAB listening on UDP port: 1234") for line in lines)
        assert any(line.endswith(f"CI_LAB 3: CI Lab Initialized.{version}") for line in lines)


@pytest.mark.parametrize(
    "command",
    [row for row in json.loads((DATA / "command_events.json").read_text(encoding="utf-8")) if "_LAB" in row["desc"]],
    ids=lambda row: row["desc"][:25],
)
def test_recorded_commands_cause_the_recorded_events(session: Lab, command: dict[str, object]) -> None:
    events = session.events(bytes.fromhex(str(command["hex"])))
    recorded = [str(event).partition("66/1/")[2] or event for event in command["events"]]  # type: ignore[attr-defined]
    assert [event for event in events if event[:6] in ("CI_LAB", "TO_LAB")] == recorded


def test_counters_and_their_reset(session: Lab) -> None:
    session.events(ENABLE)
    assert counters(session, NOOP, NOOP) == (2, 0, 4, 0)
    assert session.events(pk.RESET_COUNTERS.packet(), app="CI_LAB") == ["CI_LAB 6: CI: RESET command"]
    assert counters(session) == (0, 0, 1, 0)


def test_a_command_of_the_wrong_length(session: Lab) -> None:
    session.events(ENABLE)
    longer = NOOP[:4] + b"\0\3" + NOOP[6:] + b"xx"
    text = "Invalid msg length: ID = 0x1884,  CC = 0, Len = 10, Expected = 8"
    assert session.events(longer, app="CI_LAB") == [f"CI_LAB 16: {text}"]
    assert counters(session) == (0, 1, 3, 0)


@pytest.mark.parametrize(
    ("datagram", "text"),
    [
        (NOOP[:7], "bad packet length=7"),
        (NOOP[:4] + b"\0\2" + NOOP[6:], "length mismatch, 9 (hdr) / 8 (packet)"),
        (NOOP[:4] + b"\3\xff" + bytes(1024), "length mismatch, 1030 (hdr) / 768 (packet)"),
    ],
)
def test_a_datagram_that_is_shorter_than_its_packet(session: Lab, datagram: bytes, text: str) -> None:
    session.events(ENABLE)
    events = session.events(datagram, app="CI_LAB")
    dropped = "CI: cmd dropped, " if text.startswith("bad") else "CI: cmd dropped - "
    failed = f"CI_LAB 10: CI_LAB: Ingest failed, status={CFE_STATUS_WRONG_MSG_LENGTH}"
    assert [event.strip() for event in events] == [f"CI_LAB 8: {dropped}{text}", failed]
    assert counters(session) == (0, 0, 2, 1)


def test_bytes_after_a_packet_are_ignored(session: Lab) -> None:
    assert session.events(NOOP + b"tail", app="CI_LAB") == [NOOP_EVENT]


def test_a_packet_that_the_bus_refuses(session: Lab) -> None:
    session.events(ENABLE)
    events = session.events(b"\x3f" + NOOP[1:], app="CI_LAB")
    assert [event.strip() for event in events] == [f"CI_LAB 10: CI_LAB: Ingest failed, status={CFE_SB_BAD_ARGUMENT}"]
    assert counters(session) == (0, 0, 3, 0)


def test_unusual_headers_are_forwarded_unchanged(session: Lab) -> None:
    seen = []
    sb = session.mission.cfe.sb
    pipe = sb.create_pipe(4, "SPY")
    sb.subscribe(0x18F0, pipe)
    packet = bytes.fromhex("18f0c1230003fe11aabb")  # wrong checksum, a sequence count of its own
    session.events(packet)
    seen.append(sb.receive_buffer(pipe, 0))
    assert seen == [packet]


def test_eleven_datagrams_in_a_pass(session: Lab) -> None:
    sb = session.mission.cfe.sb
    pipe = sb.create_pipe(50, "SPY")
    sb.subscribe_ex(0x18F0, pipe, msg_limit=50)
    for _ in range(30):
        session.ground.send(bytes.fromhex("18f0c0000001fe11"))
    passes = []
    for _ in range(4):
        session.mission.run_for(0.5)
        count = 0
        while sb.receive_buffer(pipe, 0) is not None:
            count += 1
        passes.append(count)
    assert passes == [11, 11, 8, 0]


def test_an_empty_datagram_ends_a_pass(session: Lab) -> None:
    session.ground.send(b"")
    session.ground.send(NOOP)
    assert session.events(seconds=0.5, app="CI_LAB") == []
    assert session.events(seconds=0.5, app="CI_LAB") == [NOOP_EVENT]


def test_after_read_uplink_the_socket_is_read_on_request_only(session: Lab) -> None:
    read = pk.READ_UPLINK.packet()
    session.events(read)
    session.ground.send(NOOP)
    assert session.events(app="CI_LAB") == []
    session.mission.cfe.sb.transmit_msg(read, is_origination=False)
    assert session.events(app="CI_LAB") == [NOOP_EVENT]


def test_unknown_function_code_causes_no_event(session: Lab) -> None:
    session.events(ENABLE)
    assert session.events(NOOP[:6] + b"\x05" + NOOP[7:], app="CI_LAB") == []
    assert counters(session) == (0, 0, 3, 0)


def test_a_restart_frees_the_port(session: Lab) -> None:
    restart = bytes.fromhex("1806c00000150600") + b"CI_LAB".ljust(20, b"\0")
    session.mission.cfe.sb.transmit_msg(restart[:5] + bytes([len(restart) - 7]) + restart[6:], is_origination=False)
    session.mission.run_for(9)
    lines = session.mission.console.lines
    assert lines.count("CI delete callback -- Closing CI Network socket.") == 1
    assert sum(line.endswith("CI_LAB listening on UDP port: 1234") for line in lines) == 2
    assert session.events(NOOP, app="CI_LAB") == [NOOP_EVENT]


SQUATTER = """
def Squat(cfe):
    address = cfe.os.socket_addr_init(1)
    cfe.os.socket_addr_set_port(address, 1234)
    cfe.os.socket_bind(cfe.os.socket_open(1, 1), address)
    while cfe.es.run_loop():
        cfe.os.task_delay(1000)
"""


def test_port_that_another_app_took_before_is_shared_and_the_app_receives(tmp_path: Path) -> None:
    (tmp_path / "squat.py").write_text(SQUATTER, encoding="utf-8")
    with lab(tmp_path, before="CFE_APP, squat, Squat, SQUAT, 50, 16384, 0x0, 0;\n") as session:
        assert session.events(NOOP, app="CI_LAB") == [NOOP_EVENT]


def test_without_a_pipe_the_app_ends(tmp_path: Path) -> None:
    body = "def Squat(cfe):\n    cfe.sb.create_pipe(1, 'CI_LAB_CMD_PIPE')\n    cfe.os.task_delay(1 << 30)\n"
    (tmp_path / "squat.py").write_text(body, encoding="utf-8")
    with lab(tmp_path, before="CFE_APP, squat, Squat, SQUAT, 50, 16384, 0x0, 0;\n") as session:
        session.mission.run_for(3)
        lines = session.mission.console.lines
        assert any("CI_LAB 11: Error creating SB Command Pipe, RC = 0xCA000005" in line for line in lines)
        assert "CI_LAB" not in [app.name for app in session.mission.cfe.es.apps]


def test_both_kinds_of_tasks_give_one_trace(tmp_path: Path) -> None:
    digests = set()
    for tasks in ("thread", "greenlet"):
        with lab(tmp_path, tasks) as session:
            session.events(ENABLE, NOOP, b"nonsense", NOOP)
            digests.add(session.mission.trace.digest())
    assert len(digests) == 1


def test_sent_command_is_part_of_the_trace(tmp_path: Path) -> None:
    digests = []
    for number in range(2):
        with lab(tmp_path) as session:
            session.events(pk.NOOP.packet()[:7] + bytes([number]))
            digests.append(session.mission.trace.digest())
    assert digests[0] != digests[1]


def test_closed_link_receives_nothing(session: Lab) -> None:
    second = GroundLink(session.mission)
    session.events(ENABLE)
    assert second.received()
    second.close()
    session.events(to_lab.NOOP.packet())
    assert second.received() == []
    assert session.ground.received()
    assert not session.ground.send(NOOP, port=4321)
