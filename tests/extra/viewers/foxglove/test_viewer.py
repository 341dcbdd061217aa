"""A mission in Foxglove: a client's view of a run, and its effects on the run."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from cfepy.ground import dictionary_of
from cfepy.mission import Arrival, Mission
from rospy_shim.types.config import BridgedPacket, RosBridge
from rospy_shim.types.msgs import from_full_text, message_class, service_class
from tests.extra.viewers.foxglove.runs import TALKER, ShownRun, shown, spec_of

STRING = message_class("std_msgs/String")
SET_BOOL = service_class("std_srvs/SetBool")
EPOCH_NS = 316_533_800_000_000_000  # of the mission's clock at power-on


def text(value: str) -> bytes:
    """Return a std_msgs/String as ROS serialises it."""
    return bytes(STRING(value).__pack__())


@pytest.fixture
def run(tmp_path: Path) -> Iterator[ShownRun]:
    with shown(spec_of(tmp_path, {"talker": TALKER}, {"speed": 1.5, "gains": {"p": 3, "names": ["a", "b"]}})) as run:
        yield run


def test_topics_are_channels_in_the_encoding_of_ros(run: ShownRun) -> None:
    with run.client() as client:
        client.subscribe("/latched", "/late", "/rosout")
        client.wait_for(lambda: client.of("/late"))
        channel = client.channels["/latched"]
        assert (channel["encoding"], channel["schemaEncoding"]) == ("ros1", "ros1msg")
        assert (channel["schemaName"], channel["schema"]) == ("std_msgs/String", STRING._full_text)
        assert client.of("/latched") == [text("once")]
        assert client.of("/late") == [text("now")]
        stamp = next(time for topic, time, _ in client.messages if topic == "/late")
        assert 0 < stamp - EPOCH_NS < run.mission.kernel.now
        client.wait_for(lambda: client.of("/rosout"))
        log = message_class("rosgraph_msgs/Log")().deserialize(client.of("/rosout")[-1])
        assert (log.name, log.msg) == ("/talker", "late")


def test_late_subscriber_gets_the_latched_message_and_others_do_not_get_it_again(run: ShownRun) -> None:
    with run.client() as first, run.client() as second:
        first.subscribe("/latched")
        first.wait_for(lambda: first.of("/latched"))
        second.subscribe("/latched", "/late")
        second.wait_for(lambda: second.of("/late"))
        assert second.of("/latched") == [text("once")]
        first.subscribe("/late")
        first.wait_for(lambda: first.of("/late"))
        assert first.of("/latched") == [text("once")]


def test_telemetry_is_json_that_matches_its_schema(run: ShownRun) -> None:
    with run.client() as client:
        client.subscribe("/cfe/CFE_ES_HK_TLM", "/cfe/CFE_EVS_LONG_EVENT_MSG", "/cfe/CFE_TIME_TONE_CMD")
        client.advertise(1, "/cfe/CFE_ES_NOOP", "", "json")
        client.publish(1, b"{}")
        client.wait_for(lambda: client.of("/cfe/CFE_EVS_LONG_EVENT_MSG") and client.of("/cfe/CFE_TIME_TONE_CMD"))
        for topic, _, data in client.messages:
            channel = client.channels[topic]
            assert (channel["encoding"], channel["schemaEncoding"]) == ("json", "jsonschema")
            schema, values = json.loads(channel["schema"]), json.loads(data)
            Draft202012Validator(schema).validate(values)
            assert set(values) <= set(schema["properties"])
        event = json.loads(client.of("/cfe/CFE_EVS_LONG_EVENT_MSG")[0])
        assert event["PacketID"]["AppName"]
        assert event["_header"]["msg_id"] == 0x0808


def test_events_are_a_log(run: ShownRun) -> None:
    with run.client() as client:
        client.subscribe("/cfe/events")
        assert client.channels["/cfe/events"]["schemaName"] == "foxglove.Log"
        client.advertise(1, "/cfe/CFE_ES_NOOP", "CFE_ES_NOOP", "json")
        client.publish(1, b"{}")
        client.wait_for(lambda: any(b"No-op" in each for each in client.of("/cfe/events")))
        log = next(json.loads(each) for each in client.of("/cfe/events") if b"No-op" in each)
        assert (log["name"], log["line"], log["level"]) == ("CFE_ES", 3, 2)


def test_clock_is_mission_time(run: ShownRun) -> None:
    with run.client() as client:
        run.viewer._look_at_s = 0.0
        client.wait_for(lambda: len(client.times) > 1)
        assert all(EPOCH_NS <= each <= EPOCH_NS + run.mission.kernel.now for each in client.times)
        assert client.times == sorted(client.times)


def test_parameters_are_read_and_set(run: ShownRun) -> None:
    run.until(0.7)
    with run.client() as client:
        client.send(op="getParameters", parameterNames=[], id="all")
        client.wait_for(lambda: client.told("parameterValues"))
        values = {each["name"]: each["value"] for each in client.told("parameterValues")[0]["parameters"]}
        assert values["/speed"] == 1.5
        assert (values["/gains/p"], values["/gains/names"]) == (3, ["a", "b"])
        client.send(op="subscribeParameterUpdates", parameterNames=["/speed", "/gains/p", "/new"])
        client.send(op="setParameters", parameters=[{"name": "/new", "value": [1.5, 2.5], "type": "float64_array"}])
        client.send(op="setParameters", parameters=[{"name": "/gains/p"}])
        ros = run.mission.ros
        assert ros is not None
        params = ros.graph.params
        client.wait_for(lambda: params.find("/gains/p") is params.MISSING)
        assert params.find("/new") == [1.5, 2.5]
        run.mission.outside.act("param", "/speed", 2.5)
        client.wait_for(lambda: {"name": "/speed", "type": "float64", "value": 2.5} in _parameters(client))


def _parameters(client: Any) -> list[dict[str, Any]]:
    return [each for told in client.told("parameterValues") for each in told["parameters"]]


def test_parameter_that_cannot_be_set_is_reported(run: ShownRun) -> None:
    run.until(0.7)
    with run.client() as client:
        client.send(op="setParameters", parameters=[{"name": "/huge", "value": 2**40}])
        client.wait_for(lambda: client.told("status"))
        assert "parameter /huge cannot be set" in client.told("status")[0]["message"]


def test_services_are_called(run: ShownRun) -> None:
    with run.client() as client:
        client.call("/switch", 5, SET_BOOL._request_class(True).__pack__())
        client.wait_for(lambda: client.answers)
        number, encoding, body = client.answers[0]
        assert (number, encoding) == (5, "ros1")
        answer = SET_BOOL._response_class().deserialize(body)
        assert (answer.success, answer.message) == (True, "on")
        service = client.services["/switch"]
        assert (service["type"], service["request"]["schema"]) == ("std_srvs/SetBool", "bool data\n")
        client.call("/switch", 6, SET_BOOL._request_class(False).__pack__())
        client.wait_for(lambda: client.told("serviceCallFailure"))
        assert "off is not possible" in client.told("serviceCallFailure")[0]["message"]


def test_too_short_request_fails_and_the_run_continues(run: ShownRun) -> None:
    with run.client() as client:
        for number, request in enumerate((b"", b"\xff\xff\xff\xff")):
            client.call("/talker/set_logger_level", number, request)
        client.call("/switch", 7, b"")
        client.wait_for(lambda: len(client.told("serviceCallFailure")) == 3)
        for failed in client.told("serviceCallFailure"):
            assert failed["message"].startswith("service cannot process request: ")
        client.call("/switch", 8, SET_BOOL._request_class(True).__pack__())
        client.wait_for(lambda: client.answers)
        assert client.answers[0][0] == 8


def test_a_client_publishes(run: ShownRun) -> None:
    run.until(0.7)
    with run.client() as client:
        client.subscribe("/chatter")
        client.advertise(1, "/orders", "std_msgs/String")
        client.advertise(2, "/orders", "std_msgs/String", "json")
        client.wait_for(lambda: run.rows().get(("/orders", "in"), {"connections": 0})["connections"] == 2)
        run.until(run.mission.kernel.now / 1e9 + 0.1)
        client.publish(2, b'{"data": "in json"}')
        client.publish(1, text("in ros"))
        client.wait_for(lambda: len(client.of("/chatter")) == 2)
        assert client.of("/chatter") == [text("IN JSON of /foxglove_1"), text("IN ROS of /foxglove_1")]
    client_left = run.rows()["/orders", "in"]
    assert (client_left["messages"], client_left["dropped"]) == (2, 0)


@pytest.mark.parametrize(
    ("topic", "kind", "encoding", "why"),
    [
        ("/orders", "std_msgs/Int32", "ros1", "it is std_msgs/Int32"),
        ("/orders", "std_msgs/String", "cdr", "unknown encoding 'cdr'"),
        ("/new", "no_such/Type", "ros1", "cannot be published: "),
        ("/new", "", "ros1", "cannot be published: "),
        ("not a topic", "std_msgs/String", "ros1", "invalid topic name"),
        ("/cfe/CFE_ES_NOOP", "std_msgs/String", "ros1", "a command must have the encoding json"),
    ],
)
def test_invalid_advertisement_is_reported(run: ShownRun, topic: str, kind: str, encoding: str, why: str) -> None:
    run.until(0.7)
    with run.client() as client:
        client.advertise(1, topic, kind, encoding)
        client.wait_for(lambda: client.told("status"))
        assert why in client.told("status")[0]["message"]
        client.publish(1, b"anything")
        run.go_on()


@pytest.mark.parametrize(
    ("kind", "encoding", "data", "why"),
    [
        ("std_msgs/String", "ros1", b"\xff\xff\xff\xffx", "invalid std_msgs/String"),
        ("std_msgs/String", "json", b'{"data": 5}', "5 is not a text"),
        ("std_msgs/String", "json", b'{"date": ""}', "unknown field 'date'"),
        ("std_msgs/String", "json", b"nothing", "invalid std_msgs/String"),
        ("std_msgs/String", "json", b"\xff", "invalid std_msgs/String"),
    ],
)
def test_malformed_message_of_a_client_is_dropped_and_counted(
    run: ShownRun, kind: str, encoding: str, data: bytes, why: str
) -> None:
    run.until(0.7)
    with run.client() as client:
        client.advertise(1, "/orders", kind, encoding)
        client.publish(1, data)
        client.wait_for(lambda: client.told("status"))
        assert why in client.told("status")[0]["message"]
    row = run.rows()["/orders", "in"]
    assert (row["messages"], row["dropped"]) == (1, 1)


def test_viewer_does_not_change_the_run(tmp_path: Path) -> None:
    spec = spec_of(tmp_path, {"talker": TALKER})
    with Mission(spec) as mission:
        mission.run_for(2)
        alone = mission.trace.digest()
    with shown(spec) as run:
        with run.client() as client:
            client.subscribe("/latched", "/late", "/rosout", "/cfe/events")
            client.send(op="getParameters", parameterNames=[], id="all")
            run.until(2)
        assert run.mission.trace.digest() == alone


def test_recorded_arrivals_reproduce_the_run(tmp_path: Path) -> None:
    spec = spec_of(tmp_path, {"talker": TALKER})
    arrivals: list[tuple[int, Arrival]] = []

    def listen(mission: Mission) -> None:
        mission.outside.listener = lambda each: arrivals.append((mission.outside.until_ns, each))

    with shown(spec, before=listen) as run:
        run.until(0.7)
        with run.client() as client:
            client.subscribe("/chatter")
            client.advertise(1, "/orders", "std_msgs/String")
            client.publish(1, text("first"))
            client.send(op="setParameters", parameters=[{"name": "/speed", "value": 3}])
            client.call("/switch", 1, SET_BOOL._request_class(True).__pack__())
            client.wait_for(lambda: client.answers and run.rows()["/orders", "in"]["messages"])
        run.until(2)
        end_ns, digest = run.mission.kernel.now, run.mission.trace.digest()
    with Mission(spec) as again:
        for until_ns, arrival in arrivals:
            if until_ns > again.outside.until_ns:
                again.run_until(until_ns)
            again.outside.repeat(arrival)
        again.run_until(end_ns)
        assert again.trace.digest() == digest
    assert len(arrivals) > 3


def test_viewers_get_all_messages_before_the_end(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {"talker": TALKER})) as run:
        client = run.client()
        client.subscribe("/cfe/events")
        client.wait_for(lambda: run.viewer._channels._events.is_heard)
        run.until(2)
        run.viewer.close()
        client.take_rest()
        row = run.rows()["/cfe/events", "out"]
        assert (row["messages"], row["dropped"]) == (len(client.messages), 0)
        row = run.rows()["(connections)", "out"]
        assert (row["connections"], row["ended"], row["refused"]) == (1, 1, 0)


def test_a_processor_reset_leaves_viewers_connected(run: ShownRun) -> None:
    run.until(1.5)
    with run.client() as client:
        client.subscribe("/chatter")
        client.advertise(1, "/orders", "std_msgs/String")
        client.wait_for(lambda: ("/orders", "in") in run.rows())
        client.advertise(2, "/cfe/CFE_ES_RESTART", "", "json")
        client.publish(2, b'{"RestartType": 1}')
        client.wait_for(lambda: run.mission.record.resets)
        client.subscribe("/latched")
        client.wait_for(lambda: len(client.of("/latched")) == 1)
        run.until(run.mission.kernel.now / 1e9 + 1.5)
        client.publish(1, text("again"))
        client.wait_for(lambda: client.of("/chatter"))
        assert client.of("/chatter") == [text("AGAIN of /foxglove_1")]


def test_packets_of_the_ros_bridge_section_are_ros_messages_too(tmp_path: Path) -> None:
    """With the types that ROS nodes outside see."""
    spec = spec_of(tmp_path, {"talker": TALKER})
    bridge = RosBridge({"/cfs/es_hk": BridgedPacket("CFE_ES_HK_TLM"), "/cfs/raw": BridgedPacket("0x0800", True)})
    with shown(replace(spec, ros=replace(spec.ros, bridge=bridge))) as run, run.client() as client:
        client.subscribe("/cfs/es_hk", "/cfs/raw")
        channel = client.channels["/cfs/es_hk"]
        assert (channel["encoding"], channel["schemaEncoding"]) == ("ros1", "ros1msg")
        assert channel["schemaName"] == "cfe_tlm/CFE_ES_HK_TLM"
        client.advertise(1, "/cfe/CFE_ES_SEND_HK", "", "json")
        client.publish(1, b"{}")
        client.wait_for(lambda: client.of("/cfs/es_hk") and client.of("/cfs/raw"))
        kind = from_full_text(channel["schemaName"], channel["schema"]).message_class(channel["schemaName"])
        message = kind().deserialize(client.of("/cfs/es_hk")[-1])
        packet = client.of("/cfs/raw")[-1][12:]
        assert message.CFECoreChecksum == dictionary_of(run.mission.spec).decode(packet).values["CFECoreChecksum"] > 0
