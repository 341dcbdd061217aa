#!/usr/bin/env python3
"""Executes a script against the node beside it, and prints all that the node does: a line "@ " and JSON for each.

It runs on ROS and on cfepy. Usage: driver.py SCRIPT.json. The lines, by their first word:

    ready     nothing: everything that the node may ask for is available
    base      the second of the first step
    message   topic, type, bytes, seconds since the first step
    answer    service, type and bytes of the response; no type and the name of an error
    served    service, type and bytes of the request
    graph     what the node publishes, subscribes to, and serves
"""

import io
import json
import threading

import genpy
import rosgraph
import roslib.message
import rospy

NODE = "/node"
PATIENCE_S = 4.0
SETTLE_S = 1.0
ANSWER_S = 2.0
OF_EVERY_NODE = ("/get_loggers", "/set_logger_level")


_saying = threading.Lock()


def say(*words):
    with _saying:  # callbacks run in other threads
        print("@ " + json.dumps(words), flush=True)


def made(kind, text, base_ns):
    """Make a message from its bytes. Its stamps become the time of its step."""
    message = kind()
    message.deserialize(bytes.fromhex(text))
    stamp(message, base_ns)
    return message


def stamp(message, now_ns):
    for name in message.__slots__:
        value = getattr(message, name)
        if isinstance(value, genpy.Time) and name == "stamp":
            setattr(message, name, genpy.Time(now_ns // 10**9, now_ns % 10**9))
        for each in value if isinstance(value, list) else [value]:
            if isinstance(each, genpy.Message):
                stamp(each, now_ns)


def written(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue().hex()


class Driver:
    def __init__(self, script):
        self.script = script
        self.base_ns = None
        self.gap_ns = round(script["gap"] * 1e9)
        for name in script["listen"]:
            rospy.Subscriber(name, rospy.AnyMsg, self.heard, callback_args=name, queue_size=1000)
        for name, (kind, answers) in script["serve"].items():
            self.serve(name, roslib.message.get_service_class(kind), answers)
        self.publishers = {
            name: rospy.Publisher(name, roslib.message.get_message_class(kind), queue_size=10)
            for name, kind in script["publish"].items()
        }

    def now_ns(self):
        return rospy.Time.now().to_nsec()

    def heard(self, message, topic):
        header = message._connection_header
        if header.get("callerid") != rospy.get_name():
            at = None if self.base_ns is None else round((self.now_ns() - self.base_ns) / 1e9, 3)
            say("message", topic, header["type"], message._buff.hex(), at)

    def serve(self, name, kind, answers):
        left = list(answers)

        def answer(request):
            say("served", name, kind._type + "Request", written(request))
            left.append(left.pop(0))
            return made(kind._response_class, left[-1], self.base_ns or 0)

        rospy.Service(name, kind, answer)

    def run(self):
        say("ready")
        self.wait_for_node()
        rospy.sleep(SETTLE_S)
        self.base_ns = self.script.get("base", self.now_ns() // 10**9 + 1) * 10**9
        say("base", self.base_ns // 10**9)
        steps = self.script["steps"]
        for number, (what, name, text) in enumerate(steps):
            at_ns = self.base_ns + number * self.gap_ns
            self.sleep_until(at_ns)
            if what == "publish":
                self.publishers[name].publish(made(self.publishers[name].data_class, text, at_ns))
            else:
                self.call(name, text, at_ns)
        self.sleep_until(self.base_ns + round(self.script["seconds"] * 1e9))
        rospy.sleep(SETTLE_S)
        say("graph", *self.graph())

    def wait_for_node(self):
        """Wait until it has subscribed to the driven topics and serves the called services."""
        end = self.now_ns() + round(PATIENCE_S * 1e9)
        while self.now_ns() < end:
            served = {name for name, _ in rosgraph.Master(rospy.get_name()).getSystemState()[2]}
            heard = all(each.get_num_connections() for each in self.publishers.values())
            if heard and served.issuperset(self.script["call"]):
                return
            rospy.sleep(0.05)

    def sleep_until(self, at_ns):
        left = at_ns - self.now_ns()
        if left > 0:
            rospy.sleep(rospy.Duration(left // 10**9, left % 10**9))

    def call(self, name, text, at_ns):
        kind = roslib.message.get_service_class(self.script["call"][name])
        request = made(kind._request_class, text, at_ns)
        thread = threading.Thread(target=self.called, args=(name, kind, request))
        thread.daemon = True
        thread.start()
        thread.join(ANSWER_S)

    def called(self, name, kind, request):
        try:
            answer = rospy.ServiceProxy(name, kind)(request)
            say("answer", name, kind._type + "Response", written(answer))
        except (rospy.ROSException, rospy.ServiceException, genpy.MessageException) as error:
            say("answer", name, "", type(error).__name__)

    def graph(self):
        master = rosgraph.Master(rospy.get_name())
        types = dict(master.getTopicTypes())
        published, subscribed, served = master.getSystemState()
        for part in (published, subscribed):
            yield {name: types.get(name, "*") for name, nodes in part if NODE in nodes and name != "/rosout"}
        yield sorted(name for name, nodes in served if NODE in nodes and not name.endswith(OF_EVERY_NODE))


if __name__ == "__main__":
    rospy.init_node("driver", log_level=rospy.ERROR)
    with open(rospy.myargv()[1], encoding="utf-8") as file:
        Driver(json.load(file)).run()
