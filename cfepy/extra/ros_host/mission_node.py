"""`MissionNode`: a node of the mission, as external programs see it: a slave API and a TCPROS port of its own.

A connecting subscriber names the topic but not the publisher, so each node has its own port.
"""

from __future__ import annotations

import socket
from collections import deque
from collections.abc import Sequence
from typing import Any

from cfepy.extra.ros_host.joint import Joint
from cfepy.extra.ros_host.tcpros import LONGEST_FRAME, TcprosFrames, frame, pack_header, parse_header
from cfepy.extra.ros_host.xmlrpc_server import XmlRpcServer
from cfepy.ground import APPLICATIONS
from cfepy.io import ENDED, INTO, OUT_OF, Listening, PeerSocket, listening_socket
from cfepy.reading.input_limits import ROS_NAME
from rospy_shim.master.xmlrpc_calls import Answer, call

ANY = "*"
CHANGES = frozenset({"shutdown"})


class MissionNode:
    """The external side of a node.

    Args:
        host: knows the mission.
        name: name of the node; the node of the cFE applications is not in the mission's graph.
        inner: its URI in the mission.

    Attributes:
        uri: its slave API, for external programs.
    """

    def __init__(self, host: Joint, name: str, inner: str) -> None:
        self.name = name
        self.inner = inner
        self._host = host
        self._server = XmlRpcServer(host.selector, host.address.interface, self._answer, host.bounds)
        self._listening = Listening(host.selector, listening_socket(host.address.interface), self._accept)
        self._clients: set[OutsideClient] = set()
        self.uri = f"http://{host.address.host}:{self._server.port}/"
        self.service_uri = f"rosrpc://{host.address.host}:{self._listening.port}"

    def close(self) -> None:
        """Close the sockets of a node that is gone."""
        self._server.close()
        self._listening.close()
        for client in list(self._clients):
            client.close()

    def _accept(self, connected: socket.socket) -> None:
        self._clients.add(OutsideClient(self._host, self, connected))

    def forget(self, client: OutsideClient) -> None:
        """Remove a connection that has ended."""
        self._clients.discard(client)

    # -- the slave API -----------------------------------------------------------------------------------------------

    def _answer(self, method: str, arguments: Sequence[Any], body: bytes) -> Answer:
        host = self._host
        if method == "requestTopic" and len(arguments) == 3:
            return self._request_topic(str(arguments[1]), arguments[2])
        if method in ("publisherUpdate", "paramUpdate") and len(arguments) == 3:
            host.world.heard(self.name, method, arguments[1], arguments[2])
            return 1, "", 0
        if method == "getMasterUri":
            return 1, host.world.uri, host.world.uri
        if method in CHANGES:
            return host.ask_inside(self.name, body)
        api = None if host.ros is None else host.ros.switchboard.api_of(self.name)
        if api is None:
            return self._of_applications(method)
        return host.outer_answer(call(api, method, arguments))

    def _of_applications(self, method: str) -> Answer:
        """Answer for the node of the cFE applications or of the host itself, which are not in the graph."""
        shown = self._host.shown
        if method == "getPublications" and self.name == APPLICATIONS:
            return 1, "publications", [[topic, each.name] for topic, each in shown.types.items()]
        if method == "getSubscriptions" and self.name == APPLICATIONS:
            return 1, "subscriptions", [[topic, ANY] for topic in shown.heard]
        values: dict[str, Any] = {"getUri": self.uri, "getName": self.name, "getPid": self._host.pid}
        return 1, "", values.get(method, [])

    def _request_topic(self, topic: str, protocols: Any) -> Answer:
        host = self._host
        if host.publication(topic, self.name) is None:
            return 0, f"Not a publisher of [{topic}]", []
        if not any(each[:1] == ["TCPROS"] for each in protocols if isinstance(each, list)):
            return 0, "no supported protocol implementations", []
        value = ["TCPROS", host.address.host, self._listening.port]
        return 1, f"ready on {host.address.host}:{self._listening.port}", value


class OutsideClient:
    """An external subscriber or caller that has connected to a node of the mission.

    Args:
        host: knows the mission.
        node: the node.
        connected: the socket.
    """

    def __init__(self, host: Joint, node: MissionNode, connected: socket.socket) -> None:
        self._host = host
        self._node = node
        self._frames = TcprosFrames()
        self._header: dict[str, str] | None = None
        self._topic = self._service = ""
        self._requests: deque[bytes] = deque()
        self._number = 0  # of the call under way
        self._socket = PeerSocket(host.selector, connected, self._take, self._lost)
        host.bounds.places.take(self, host.now_s())

    @property
    def caller(self) -> str:
        """The name of the outside node."""
        return (self._header or {}).get("callerid", "")

    def close(self) -> None:
        """Close the connection from the mission's side."""
        self._socket.close()
        self._gone()

    def fail(self, why: str) -> None:
        self._socket.fail(why)

    def _take(self, data: bytes) -> None:
        if self._topic:
            return  # a subscriber sends only its header
        self._frames.add(data)
        for each in self._frames.take():
            if self._header is None:
                self._frames.longest = LONGEST_FRAME
                self._begin(parse_header(each))
            elif self._service:
                self._requests.append(each)
                self._next_request()
        if self._socket.is_open:
            self._host.bounds.room.hold(self, len(self._frames) + sum(map(len, self._requests)))

    def _begin(self, header: dict[str, str]) -> None:
        self._header = header
        error = self._connect(header)
        if error:
            where = header.get("topic") or header.get("service") or "?"
            direction = OUT_OF if "topic" in header else INTO
            count = self._host.counts.of(where[:ROS_NAME], self.caller[:ROS_NAME] or "?", direction)
            count.refused += 1
            count.why = error
            self._socket.send(pack_header({"error": error}))
            self._socket.finish()
            self._gone()
        else:
            self._host.bounds.places.keep(self)

    def _connect(self, header: dict[str, str]) -> str:
        """Set up a connection. Returns the error, or ""."""
        needed = ("topic", "md5sum") if "service" not in header else ("service", "md5sum")
        missing = [each for each in needed if not header.get(each)]
        if len(self.caller) > ROS_NAME:
            return f"the callerid has more than {ROS_NAME:,} characters"
        if missing:
            return f"Missing required '{missing[0]}' field"
        return self._serve(header) if "service" in header else self._publish(header)

    # -- a subscriber ------------------------------------------------------------------------------------------------

    def _publish(self, header: dict[str, str]) -> str:
        host, topic, md5sum = self._host, header["topic"], header["md5sum"]
        fields = host.publication(topic, self._node.name)
        if fields is None:
            return f"received a connection for a topic that is not published here: {topic}"
        if md5sum not in (ANY, fields["md5sum"]) and fields["md5sum"] != ANY:
            return f"request from [{self.caller}]: md5sums do not match: [{md5sum}] vs. [{fields['md5sum']}]"
        kind = header.get("type", ANY)
        if kind not in (ANY, fields["type"]) and fields["type"] != ANY:
            return f"topic types do not match: [{kind}] vs. [{fields['type']}]"
        self._topic = topic
        self._socket.send(pack_header(fields))
        host.add_client(topic, self._node.name, self.caller, self)
        error = host.subscribe(topic, self.caller, kind, md5sum, self._node.name)
        if error:
            host.remove_client(topic, self._node.name, self.caller, self)
            self._topic = ""
            return error
        host.counts.of(topic, self.caller, OUT_OF).connections += 1
        return ""

    def send(self, data: bytes) -> None:
        """Send a frame."""
        self._socket.send(data)

    # -- a caller ----------------------------------------------------------------------------------------------------

    def _serve(self, header: dict[str, str]) -> str:
        host, service, md5sum = self._host, header["service"], header["md5sum"]
        fields = host.offer(service, self._node.name)
        if fields is None:
            return f"received a connection for service [{service}], which is not offered here"
        if md5sum not in (ANY, fields["md5sum"]):
            return f"request from [{self.caller}]: md5sums do not match: [{md5sum}] vs. [{fields['md5sum']}]"
        self._socket.send(pack_header(fields))
        if header.get("probe") == "1":
            self._socket.finish()
            self._node.forget(self)
            self._host.bounds.places.leave(self)
            return ""
        self._service = service
        host.counts.of(service, self.caller, INTO).connections += 1
        return ""

    def _next_request(self) -> None:
        if self._number or not self._requests:
            self._hold_back()
            return
        request = self._requests.popleft()
        count = self._host.counts.of(self._service, self.caller, INTO)
        count.messages += 1
        count.size += len(request)
        self._number = self._host.begin_call(self._service, self.caller, request, self)

    def _hold_back(self) -> None:
        """Stop reading requests of a caller that does not wait for its answers."""
        if self._requests:
            self._socket.pause()
        else:
            self._socket.resume()

    def answer(self, good: bool, body: bytes) -> None:
        """Send the answer of the mission."""
        self._number = 0
        self._socket.send(bytes([good]) + frame(body))
        if (self._header or {}).get("persistent") in ("1", "true"):
            self._next_request()
        else:
            self._socket.finish()
            self._gone()

    # -- the end -----------------------------------------------------------------------------------------------------

    def _lost(self, why: str) -> None:
        if self._topic or self._number:
            count = self._host.counts.of(self._topic or self._service, self.caller, OUT_OF if self._topic else INTO)
            count.ended += 1
            if why != ENDED:
                count.why = why
        self._gone()

    def _gone(self) -> None:
        self._node.forget(self)
        self._host.bounds.places.leave(self)
        self._host.bounds.room.release(self)
        self._frames.clear()
        self._requests.clear()
        if self._topic:
            topic, self._topic = self._topic, ""
            self._host.counts.of(topic, self.caller, OUT_OF).dropped += self._socket.dropped
            self._host.remove_client(topic, self._node.name, self.caller, self)
            self._host.unsubscribe(topic, self.caller, self._node.name)
        if self._number:
            self._host.end_call(self._service, self._number, self.caller)
            self._number = 0
