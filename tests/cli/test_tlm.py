"""`cfepy tlm`: telemetry of a mission in virtual time, and of a flight computer over UDP."""

from __future__ import annotations

import json
from pathlib import Path
from types import TracebackType

import pytest

from cfepy.cli.ground import tlm
from cfepy.cli.main import main
from cfepy.evs.packets import LONG_EVENT
from cfepy.io.udp import UdpListener
from cfepy.msg import get_fcn_code, get_msg_id, telemetry
from tests.cli.conftest import Write
from tests.cli.ros_missions import robot
from tests.ground.measured import write_thermal

EVENT = bytes(
    telemetry(0x0808, LONG_EVENT.pack(PacketID={"AppName": "APP", "EventID": 3, "EventType": 2}, Message="all is well"))
)


class Datagrams:
    """A port that receives these datagrams, and then no more."""

    def __init__(self, *datagrams: bytes) -> None:
        self.left = list(datagrams)
        self.place = ("", 0)

    def __call__(self, host: str, port: int) -> Datagrams:
        self.place = (host, port)
        return self

    def receive(self, timeout_s: float | None = None) -> bytes | None:
        if not self.left:
            raise KeyboardInterrupt
        return self.left.pop(0)

    def __enter__(self) -> Datagrams:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        pass


def arrives(monkeypatch: pytest.MonkeyPatch, *datagrams: bytes) -> Datagrams:
    found = Datagrams(*datagrams)
    monkeypatch.setattr(tlm.udp, "UdpListener", found)
    return found


def test_what_arrives_is_shown_by_name(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    port = arrives(monkeypatch, b"no packet", EVENT, bytes(telemetry(0x0999, b"\x01\x02")))
    assert main(["tlm", "--count", "2"]) == 0
    event, unknown = capsys.readouterr().out.splitlines()
    assert " CFE_EVS_LONG_EVENT_MSG PacketID.AppName=APP PacketID.EventID=3 PacketID.EventType=INFORMATION " in event
    assert 'Message="all is well"' in event
    assert unknown.endswith(f" 0x0999 {bytes(telemetry(0x0999, bytes([1, 2]))).hex()} (its layout is not known)")
    assert port.place == ("0.0.0.0", 1235)


def test_only_what_was_asked_for(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    port = arrives(monkeypatch, EVENT, bytes(telemetry(0x0999, b"x")), EVENT)
    assert main(["tlm", "127.0.0.1:7000", "0x0999", "--count", "1"]) == 0
    assert "0x0999" in capsys.readouterr().out
    assert port.place == ("127.0.0.1", 7000)


def test_ctrl_c_ends_it(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    arrives(monkeypatch, EVENT)
    assert main(["tlm"]) == 130
    assert "all is well" in capsys.readouterr().out


def test_json_lines(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    arrives(monkeypatch, EVENT, bytes(telemetry(0x0999, b"x")))
    assert main(["tlm", "--json", "-", "--count", "2"]) == 0
    event, unknown = map(json.loads, capsys.readouterr().out.splitlines())
    assert (event["name"], event["msg_id"], event["sequence"]) == ("CFE_EVS_LONG_EVENT_MSG", 0x0808, 0)
    assert event["values"]["PacketID"]["AppName"] == "APP"
    assert (unknown["values"], unknown["packet"]) == ({}, bytes(telemetry(0x0999, b"x")).hex())


def test_to_lab_is_asked_to_send(monkeypatch: pytest.MonkeyPatch) -> None:
    with UdpListener("127.0.0.1", 0) as ci_lab:
        arrives(monkeypatch, EVENT)
        assert main(["tlm", "--enable", f"127.0.0.1:{ci_lab.port}", "--count", "1"]) == 0
        packet = ci_lab.receive(5)
    assert packet is not None
    assert (get_msg_id(packet), get_fcn_code(packet)) == (0x1880, 6)
    assert packet[8:].rstrip(b"\0") == b"127.0.0.1"


def test_a_table_on_a_terminal(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    import io
    import sys

    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    arrives(monkeypatch, EVENT, EVENT, EVENT)
    shown = Terminal()
    monkeypatch.setattr(sys, "stdout", shown)
    assert main(["tlm", "--count", "3"]) == 0
    assert "CFE_EVS_LONG" in shown.getvalue()
    assert "3" in shown.getvalue()


# -- in virtual time ---------------------------------------------------------------------------------------------------


def test_a_missions_telemetry_has_virtual_times(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = str(make_mission("Chatty"))
    assert main(["tlm", folder, "CFE_EVS_LONG_EVENT_MSG", "0x0890", "--for", "1"]) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert {line[1] for line in lines} == {"CFE_EVS_LONG_EVENT_MSG", "0x0890"}
    times = [float(line[0]) for line in lines]
    assert times == sorted(times)
    assert 0 < times[0] < times[-1] <= 1


def test_it_ends_after_so_many_packets(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = str(make_mission("Chatty"))
    assert main(["tlm", folder, "0x0890", "--count", "3"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 3


def test_nothing_came(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = str(make_mission("Quiet"))
    assert main(["tlm", folder, "CFE_ES_HK_TLM", "--for", "1"]) == 1
    assert capsys.readouterr().err == "cfepy: no matching packet was sent in 1 virtual seconds\n"


def test_nothing_arrived(capsys: pytest.CaptureFixture[str]) -> None:
    with UdpListener("127.0.0.1", 0) as free:
        place = f"127.0.0.1:{free.port}"
    assert main(["tlm", place, "--for", "0.01"]) == 1
    assert "no matching packet arrived at port" in (said := capsys.readouterr().err)
    assert "see --enable" in said


def test_an_app_that_died_is_told(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tlm", str(make_mission("Dies")), "--for", "2"]) == 0
    assert "cfepy: DIES died: ValueError: boom" in capsys.readouterr().err


def test_nobody_is_there_to_be_asked(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    with UdpListener("127.0.0.1", 0) as closed:
        place = f"127.0.0.1:{closed.port}"
    arrives(monkeypatch, EVENT)
    assert main(["tlm", "--enable", place]) == 2
    assert f"{place}: no receiver is listening" in capsys.readouterr().err


def test_a_mission_in_virtual_time_is_not_asked_to_send(
    make_mission: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["tlm", str(make_mission("Quiet")), "--enable", "127.0.0.1"]) == 2
    assert "--enable: only valid for a remote target" in capsys.readouterr().err


@pytest.mark.parametrize("count", ["0", "-1", "x"])
def test_a_count_that_is_none(count: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["tlm", "--count", count])
    assert "invalid count" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["CFE_ES_HK"], "unknown telemetry packet CFE_ES_HK; did you mean CFE_ES_HK_TLM"),
        (["--mission", "no_such_mission"], "no_such_mission: unknown mission"),
        (["127.0.0.1:0"], "invalid port 0"),
    ],
)
def test_bad_usage(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tlm", *words]) == 2
    assert said in capsys.readouterr().err


def test_a_topic_without_a_subscriber(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tlm", str(robot(tmp_path)), "/odom", "--for", "1"]) == 1
    assert "a topic is sent only while it has a subscriber; `cfepy rostopic echo`" in capsys.readouterr().err


def test_measurements_have_units_and_marks_or_raw_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["tlm", write_thermal(tmp_path), "THERMAL_HK_TLM", "--for", "2.1"]
    assert main(words) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "0.550 THERMAL_HK_TLM Temp=32degC Volts=28V Samples=1"
    assert lines[2:] == [
        "1.550 THERMAL_HK_TLM Temp=56degC[yellow>50] Volts=28V Samples=3",
        "2.050 THERMAL_HK_TLM Temp=68degC[red>60] Volts=28V Samples=4",
    ]
    assert main([*words, "--raw"]) == 0
    assert capsys.readouterr().out.splitlines()[0] == "0.550 THERMAL_HK_TLM Temp=720 Volts=140 Samples=1"
    assert main([*words, "--json", "-"]) == 0
    record = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert record["values"]["Temp"] == 1080
    assert record["measurements"]["Temp"] == {"value": 68.0, "unit": "degC", "violated": "red"}
