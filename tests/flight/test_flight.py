"""`Flight` alone: its actions on a mission, its waits, and its report after a wait in vain."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.ground import Dictionary, MessageDecoder
from cfepy.pilot.pilot import fly
from cfepy.pilot.plan import RunPlan
from cfepy.schedules.schedule import Schedule
from cfepy.status import CfeError, UsageError
from cfepy.testing import ExpectationError, Flight
from tests.testing.conftest import TALKER, write_mission

BIG = """
import rospy
from std_msgs.msg import String
rospy.init_node("big")
rospy.Subscriber("long", String, lambda message: print(len(message.data)))
rospy.spin()
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_mission(tmp_path_factory.mktemp("flights") / "talk", talker=TALKER, big=BIG)


@pytest.fixture
def flight(folder: Path) -> Iterator[Flight]:
    with Flight(RunPlan((str(folder),), tasks="greenlet")) as flight:
        flight.run_until_operational()
        yield flight


def test_run_equals_the_run_of_the_command(folder: Path) -> None:
    plan = RunPlan((str(folder),), seconds=2.0, seed=4, schedule=Schedule.parse("random:3"))
    with Flight(plan) as flight:
        flight.run_until_operational()
        flight.run_until(2.0)
        assert flight.results.trace == fly(plan).trace
        assert flight.command() == f"cfepy run --for 2 --seed 4 --schedule random:3 {folder}"


def test_actions_of_a_test_give_one_trace_on_threads_and_greenlets(folder: Path) -> None:
    digests = set()
    for tasks in ("thread", "greenlet"):
        with Flight(RunPlan((str(folder),), tasks=tasks, schedule=Schedule.parse("random:1"))) as flight:
            flight.run_until_operational()
            flight.send("CFE_ES_NOOP")
            flight.publish("/jump", data=5)
            flight.set_param("/talker/step", 3)
            assert flight.call_service("/reset").message == "from 0"
            flight.run_for(1)
            digests.add(flight.results.trace)
    assert len(digests) == 1


def test_expectation_includes_events_since_the_last_action(flight: Flight) -> None:
    flight.send("CFE_ES_NOOP")
    flight.run_for(3)
    assert flight.expect_event("CFE_ES", 3, re.compile("^No-op"), within=0).type_name == "INFORMATION"
    flight.mark()
    with pytest.raises(ExpectationError, match="instead: no event at all"):
        flight.expect_event("CFE_ES", 3, within=0.1)


def test_unexpected_event_or_message_fails_the_expectation(flight: Flight) -> None:
    flight.expect_no_event("CFE_ES", 3, within=0.2)
    flight.send("CFE_ES_NOOP")
    with pytest.raises(ExpectationError, match="expected no event CFE_ES 3 within 1 s\ninstead: CFE_ES 3 INFORMATION"):
        flight.expect_no_event("CFE_ES", 3, within=1)
    with pytest.raises(ExpectationError, match="expected no message on /count"):
        flight.expect_no_message("/count", data=lambda number: number > 0)


def test_telemetry_is_matched_by_its_values(flight: Flight) -> None:
    flight.send("CFE_ES_SEND_HK")
    packet = flight.expect_telemetry("CFE_ES_HK_TLM", lambda hk: hk["SysLogEntries"] > 3, RegisteredExternalApps=3)
    assert packet.sender == "CFE_ES"
    assert flight.telemetry("0x0800").data == packet.data
    assert [each.data for each in flight.packets("CFE_ES_HK_TLM")][-1] == packet.data
    assert flight.packets("CFE_TBL_HK_TLM") == []
    with pytest.raises(ExpectationError, match=r"CommandCounter was 0 in the last of 1 packet, at 0\.\d+"):
        flight.expect_telemetry("CFE_ES_HK_TLM", CommandCounter=7, within=0.1)
    with pytest.raises(ExpectationError, match="expected telemetry CFE_TBL_HK_TLM until now"):
        flight.telemetry("CFE_TBL_HK_TLM")


def test_anything_can_be_waited_for(flight: Flight) -> None:
    assert flight.expect(lambda: len(flight.messages("/count")) > 4 and "enough", "five messages") == "enough"
    with pytest.raises(ExpectationError, match=r"expected five more within 0\.1 s"):
        flight.expect(lambda: False, "five more", within=0.1)
    assert "talking" in flight.expect_console(re.compile(r"talk\w+$"), within=0)


def test_history_has_times_and_senders(flight: Flight) -> None:
    flight.run_for(0.5)
    history = flight.history("/count")
    assert [each.msg.data for each in history[:3]] == [1, 2, 3]
    assert history[1].t - history[0].t == pytest.approx(0.1, abs=0.001)
    assert {each.sender for each in history} == {"/talker"}


def test_long_messages_go_out_in_segments(flight: Flight) -> None:
    flight.publish("/long", data="x" * 100_000)
    flight.run_for(0.1)
    assert flight.stdout("/big") == ["100000"]


def test_flight_continues_after_a_reset(flight: Flight) -> None:
    flight.send("CFE_ES_RESTART", RestartType=1)
    flight.expect_event("CFE_ES", 1, within=2)
    assert len(flight.mission.record.resets) == 1
    flight.run_for(1)
    flight.publish("/jump", data=900)
    assert flight.expect_message("/count", data=900, within=0.1).data == 900


def test_mistakes_are_reported_at_once(flight: Flight) -> None:
    with pytest.raises(ExpectationError, match=r"unknown topic /jum \(so far\); did you mean /jump"):
        flight.publish("/jum", data=1)
    with pytest.raises(ExpectationError, match=r"/count has no subscriber at 0\.6"):
        flight.publish("/count", data=1)
    with pytest.raises(UsageError, match="/jump has type std_msgs/Int32, not std_msgs/String"):
        flight.publish("/jump", flight.message_class("std_msgs/String")())
    with pytest.raises(UsageError, match="number: unknown field of std_msgs/Int32; expected data"):
        flight.publish("/jump", number=1)
    with pytest.raises(ExpectationError, match="unknown service /rest; did you mean /reset"):
        flight.call_service("/rest")
    with pytest.raises(UsageError, match="number: unknown field; it has data"):
        flight.expect_message("/count", number=3)
    with pytest.raises(UsageError, match="invalid event type 'INFO'"):
        flight.expect_event(type="INFO")
    with pytest.raises(CfeError):
        flight.send(b"\x18\x06\xc0\x00\x00\x10\x00\x00")


def test_service_that_fails_or_does_not_answer_fails_the_expectation(flight: Flight, tmp_path: Path) -> None:
    with pytest.raises(ExpectationError, match="expected the answer of /reset within 0 s"):
        flight.call_service("/reset", within=0)
    failing = TALKER.replace('return TriggerResponse(success=True, message="from 0")', "raise ValueError('no way')")
    folder = write_mission(tmp_path / "failing", talker=failing)
    with Flight(RunPlan((str(folder),))) as other:
        other.run_until_operational()
        with pytest.raises(ExpectationError, match="no way"):
            other.call_service("/reset")


def test_an_exception_in_a_callback_is_a_problem(tmp_path: Path) -> None:
    raising = BIG.replace("lambda message: print(len(message.data))", "lambda message: 1 // len(message.data)")
    folder = write_mission(tmp_path / "raising", big=raising)
    with Flight(RunPlan((str(folder),))) as flight:
        flight.run_until_operational()
        assert flight.problems == []
        for _ in range(2):
            flight.publish("/long", data="")
            flight.run_for(0.1)
        assert len(flight.problems) == 1
        assert re.fullmatch(r"unhandled exception: big: ZeroDivisionError: .* \(big\.py:5\)", flight.problems[0])


SAMPLE = "CFE_APP, sample_app, SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;\n!\n"


def test_a_table_of_an_application_that_waits_for_housekeeping_requests(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text(SAMPLE, encoding="utf-8")
    rows = {"Int1": 3, "Int2": 4}
    with Flight(RunPlan((str(tmp_path),))) as flight:
        flight.run_until_operational()
        flight.load_table("SAMPLE_APP.ExampleTable", rows, wake="SAMPLE_APP_SEND_HK", within=0.1)
        with pytest.raises(ExpectationError, match="its owner has not called CFE_TBL_Manage: wake= names"):
            flight.load_table("SAMPLE_APP.ExampleTable", rows)


def test_before_there_are_nodes_and_after_the_end(folder: Path) -> None:
    with Flight(RunPlan((str(folder),))) as flight:
        with pytest.raises(ExpectationError, match="no ROS node has started yet"):
            flight.publish("/jump", data=1)
        assert flight.results.virtual_s == 0
        with pytest.raises(ExpectationError, match="the flight is over"):
            flight.run_for(1)


def test_last_message_of_a_topic_is_decoded_alone(flight: Flight, monkeypatch: pytest.MonkeyPatch) -> None:
    """A look at a topic or a packet takes the same time in a long run."""
    decoded: list[str] = []
    for kind, method in ((MessageDecoder, "decode"), (Dictionary, "decode")):
        real = getattr(kind, method)
        monkeypatch.setattr(kind, method, lambda *args, real=real: decoded.append("") or real(*args))
    flight.run_for(3)
    flight.send("CFE_ES_SEND_HK")
    flight.run_for(0.1)
    assert len(flight.topic("/count")) == len(flight.messages("/count")) == len(flight.history("/count")) > 30
    looks = [
        lambda: flight.topic("/count").messages[-1].data,
        lambda: flight.messages("/count")[-1].data,
        lambda: flight.history("/count")[-1].msg.data,
        lambda: flight.topic("CFE_EVS_LONG_EVENT_MSG").messages[-1]["Message"],
        lambda: flight.packets("CFE_EVS_LONG_EVENT_MSG")[-1]["Message"],
    ]
    for look in looks:
        decoded.clear()
        assert look()
        assert len(decoded) <= 1
    assert len(flight.topic("CFE_EVS_LONG_EVENT_MSG")) == len(flight.events) > 10


def test_commands_and_packets_that_share_a_msgid_are_series_of_their_own(flight: Flight) -> None:
    flight.run_for(1)
    for _ in range(2):
        flight.send("CFE_ES_NOOP")
        flight.send("CFE_ES_RESET_COUNTERS")
        flight.run_for(0.1)
        noops = flight.topic("CFE_ES_NOOP")
        assert (len(noops), noops.type) == (len(flight.topic("CFE_ES_RESET_COUNTERS")), "command")
    assert (len(noops), noops.count) == (2, 2)
    assert {"CFE_ES_NOOP", "CFE_ES_RESET_COUNTERS", "/count", "CFE_EVS_LONG_EVENT_MSG"} <= {*flight.series.names}
    with pytest.raises(UsageError, match="unknown topic or packet"):
        flight.topic("CFE_ES_NOPE")


def test_messages_of_an_earlier_request_stay(flight: Flight) -> None:
    flight.run_for(0.5)
    before, history = flight.messages("/count"), flight.history("/count")
    counts = len(before), len(history)
    flight.run_for(1)
    assert (len(before), len(history)) == counts
    assert flight.messages("/nothing") == flight.history("/nothing") == []
    assert flight.messages("/count")[: counts[0]] == before
