"""Accepted clients of the server, and its reports of refused ones."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest
from websockets.exceptions import InvalidStatus

from cfepy.extra.viewers.foxglove import FoxgloveViewer, graph_mirror
from cfepy.extra.viewers.foxglove.protocol import WARNING, status
from cfepy.extra.viewers.listen import Admission, ListenPlace
from cfepy.io import PeerCounts
from cfepy.status import UsageError
from rospy_shim.graph.graph import Graph
from tests.extra.viewers.foxglove.client import FoxgloveClient
from tests.extra.viewers.foxglove.runs import TALKER, ShownRun, shown, spec_of

TOKEN = "a-long-enough-token"


def refused(run: ShownRun, path: str = "/", origin: str | None = None) -> int:
    """Return the status of a refused connection, or 101 if it is accepted."""
    headers = {} if origin is None else {"Origin": origin}
    try:
        FoxgloveClient(f"ws://{run.viewer.place}{path}", run.go_on, additional_headers=headers).close()
    except InvalidStatus as error:
        return error.response.status_code
    return 101


def test_strange_pages_are_refused_and_foxglove_is_accepted(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {})) as run:
        for origin in (None, "https://app.foxglove.dev", "http://localhost:8080", "file://", "app://lichtblick"):
            assert refused(run, origin=origin) == 101, origin
        others = ("https://example.org", "null", "https://app.foxglove.dev.example.org", "http://127.0.0.999")
        extensions = ("chrome-extension://abcdefghijklmnop", "moz-extension://0-1", "safari-web-extension://x")
        for origin in (
            *extensions,
            "file://server/share",
            "ftp://example.org",
            "data:",
            *others,
            "https://example.org",
        ):
            assert refused(run, origin=origin) == 403, origin
        run.viewer.close()
        row = run.rows()["(connections)", "out"]
        assert (row["connections"], row["refused"]) == (5, 11)
        assert "example.org" in row["why"]


def test_token_is_required_of_each_client_when_one_is_set(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {}), Admission(TOKEN)) as run:
        assert refused(run) == 401
        assert refused(run, "/?token=wrong-one", "https://app.foxglove.dev") == 401
        assert refused(run, f"/?token={TOKEN}") == 101
        assert refused(run, f"/?token={TOKEN}", "https://example.org") == 101


@pytest.mark.parametrize(
    "data", [b"", b"GET / HTTP/1.1\r\n", b"\x16\x03\x01" + b"\xff" * 300 + b"\r\n\r\n", b"x" * 70_000]
)
def test_malformed_request_does_not_stop_the_server(tmp_path: Path, data: bytes) -> None:
    with shown(spec_of(tmp_path, {})) as run:
        with socket.create_connection((run.viewer.place.host, run.viewer.place.port)) as peer:
            peer.sendall(data)
            peer.shutdown(socket.SHUT_WR)
            run.until_it_ends(peer)
        assert refused(run) == 101


def test_taken_port_is_reported(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {})) as run, pytest.raises(UsageError, match=r"--foxglove: .*give another port"):
        FoxgloveViewer(ListenPlace("127.0.0.1", run.viewer.place.port), Admission(), "other", PeerCounts())


def test_viewer_with_too_much_unread_status_is_disconnected(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {})) as run, socket.socket() as idle:
        idle.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        idle.connect(tuple(run.viewer.place))
        run.shake_hands(idle)
        (viewer,) = run.viewer._server.viewers
        for _ in range(900):
            viewer.tell(status(WARNING, "x" * 10_000))
        run.go_on()
        assert run.viewer._server.viewers == [viewer]  # the system has accepted some of it
        for _ in range(900):
            viewer.tell(status(WARNING, "x" * 10_000))
        assert run.viewer._server.viewers == [viewer]  # the server disconnects no client in the middle of a piece
        run.go_on()
        assert run.viewer._server.viewers == []
        row = run.rows()["(connections)", "out"]
        assert (row["connections"], row["ended"], row["why"]) == (1, 1, "too much is unread")


def test_number_of_watched_parameters_is_limited(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {})) as run, run.client() as client:
        for part in range(3):
            names = [f"/p{part}_{number}" for number in range(5_000)]
            client.send(op="subscribeParameterUpdates", parameterNames=names)
        client.wait_for(lambda: client.told("status"))
        assert "more than 10,000 parameters cannot be watched" in client.told("status")[0]["message"]
        assert run.rows()["(connections)", "in"]["dropped"] == 1


def test_invalid_subscription_is_reported(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {})) as run, run.client() as client:
        client.subscribe("/cfe/events")
        number, other = (client.channels[name]["id"] for name in ("/cfe/events", "/cfe/CFE_ES_HK_TLM"))
        for own, channel in ((1000, number), (number, other), (1001, 77_777)):
            client.send(op="subscribe", subscriptions=[{"id": own, "channelId": channel}])
        client.wait_for(lambda: len(client.told("status")) == 3)
        told = [each["message"].split(",")[0] for each in client.told("status")]
        assert told == ["subscription 1000", f"subscription {number}", "unknown channel 77777"]


def test_invalid_service_call_is_reported(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {"talker": TALKER})) as run, run.client() as client:
        client.call("/switch", 1, b"{}", encoding="json")
        client.services["/none"] = {"id": 4_000}
        client.call("/none", 2, b"")
        client.wait_for(lambda: len(client.told("serviceCallFailure")) == 2)
        told = {each["callId"]: each["message"] for each in client.told("serviceCallFailure")}
        assert told == {1: "the encoding of a request must be ros1, not json", 2: "unknown service"}


def test_service_without_an_answer_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sleeper = """
        import rospy
        from std_srvs.srv import Empty
        rospy.init_node("sleeper")
        rospy.Service("/sleep", Empty, lambda request: rospy.sleep(1e6))
        rospy.spin()
    """
    with shown(spec_of(tmp_path, {"sleeper": sleeper})) as run, run.client() as client:
        for number in range(33):
            client.call("/sleep", number, b"")
        client.wait_for(lambda: client.told("serviceCallFailure"))
        assert client.told("serviceCallFailure")[0]["message"] == "the limit of 32 pending calls is reached"
        monkeypatch.setattr(graph_mirror, "CALL_S", 0.0)
        client.wait_for(lambda: len(client.told("serviceCallFailure")) == 33)
        assert client.told("serviceCallFailure")[-1]["message"] == "the service has not answered"


def test_service_of_an_unknown_type_is_not_advertised(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A compiled node's, of a type that no node in Python knows."""
    short = """
        import rospy
        from std_srvs.srv import Empty
        rospy.init_node("short")
        service = rospy.Service("/short", Empty, lambda request: None)
        rospy.sleep(1)
        service.shutdown()
        rospy.spin()
    """

    def caller(graph: Graph, name: str) -> object:
        raise UsageError(f"nobody knows the type of {name}")

    monkeypatch.setattr(Graph, "caller", caller)
    with shown(spec_of(tmp_path, {"short": short})) as run, run.client() as client:
        run.until(1)
        assert run.mission.ros is not None
        assert "/short" in run.mission.ros.graph.services
        client.services["/short"] = {"id": 0}
        client.call("/short", 1, b"")
        client.wait_for(lambda: client.told("serviceCallFailure"))
        assert client.told("serviceCallFailure")[0]["message"] == "unknown service"
        run.viewer._look_at_s = 0.0
        run.go_on()  # it has been looked at
        run.until(2)
        run.viewer._look_at_s = 0.0
        run.go_on()
        assert "/short" not in run.mission.ros.graph.services
        assert client.told("unadvertiseServices") == []
