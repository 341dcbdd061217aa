"""rospy's reactions to invalid names, values and calls, recorded from rospy 1.15.15 with a master."""

from __future__ import annotations

import re
from pathlib import Path

from tests.rospy_shim.missions import run_nodes

_STAMP = re.compile(r" \[[0-9.]+\]:")
HEAD = """
import rospy
from std_msgs.msg import *
from geometry_msgs.msg import *
from roscpp.srv import *
from roscpp.msg import Logger
rospy.init_node("a")
def tried(function, *arguments):
    try:
        answer = function(*arguments)
        print(repr(answer) if not hasattr(answer, "_md5sum") else "answered")
    except Exception as error:
        print(f"{type(error).__name__}: {error}")
"""


def answers(tmp_path: Path, body: str, seconds: float = 5.0) -> list[str]:
    """Return a node's output, with log lines without their time."""
    lines = run_nodes(tmp_path, {"A": HEAD + body}, seconds=seconds).printed["a"]
    return [_STAMP.sub("", line) for line in lines]


def test_master_refuses_invalid_names_like_rosmaster(tmp_path: Path) -> None:
    body = """
import warnings
warnings.simplefilter("ignore")
got = []
for name in ("a b", "/", "c:d", "a-b"):
    publisher = rospy.Publisher(name, String, queue_size=1)
    subscriber = rospy.Subscriber(name, String, got.append)
    rospy.sleep(0.2)
    publisher.publish("x")
    rospy.sleep(0.2)
    print(len(got), publisher.get_num_connections())
rospy.Service("a b", Empty, print)
tried(rospy.ServiceProxy("a b", Empty))
tried(rospy.wait_for_service, "a b", 0.2)
tried(rospy.Service, "a b", Empty, print)
print(sorted(name for name, kind in rospy.get_published_topics()))
"""
    refused = "[FATAL] unable to register {} [{}] with master: ERROR: parameter [{}] {}"
    chars, root = "contains illegal chars", "cannot be the global namespace"
    expected = []
    for name, why in (("/a b", chars), ("/", root), ("/c:d", chars)):
        expected += [refused.format(what, name, "topic", why) for what in ("publication", "subscription")] + ["0 0"]
    assert answers(tmp_path, body) == [
        *expected,
        "1 1",
        refused.format("service", "/a b", "service", chars),
        "ServiceException: service [/a b] unavailable",
        "ROSException: timeout exceeded while waiting for service /a b",
        "ServiceException: service [/a b] already registered",
        "['/a-b', '/rosout']",
    ]


def test_control_characters_are_refused_in_xml(tmp_path: Path) -> None:
    body = r"""
for value in ("a\0b", ["a\0"], {"k": "x\0"}, {"k\0": 1}, "\x01", "\ud800", "\ufffe"):
    tried(rospy.set_param, "/q", value)
tried(rospy.get_param, "/q", None)
rospy.set_param("/q", "\r\n")
tried(rospy.get_param, "/q")
for function in (rospy.get_param, rospy.has_param, rospy.delete_param):
    tried(function, "a\0")
tried(rospy.set_param, "/", 1)
tried(rospy.get_param, "/q")
"""
    fault = "Fault: <Fault 1: \"<class 'xml.parsers.expat.ExpatError'>:{}\">"
    token = "not well-formed (invalid token): line {}, column {}"
    places = [(12, 16), (13, 16), (15, 16), (14, 7), (12, 15)]
    name = fault.format(token.format(9, 17))
    # A sixth and seventh text: one that is written as a reference, one that is not.
    assert answers(tmp_path, body) == [
        *(fault.format(token.format(*place)) for place in places),
        fault.format("reference to invalid character number: line 12, column 15"),
        fault.format(token.format(12, 15)),
        "None",
        "'\\n'",
        name,
        name,
        name,
        "None",
        "'\\n'",
    ]


def test_messages_of_another_type(tmp_path: Path) -> None:
    body = """
stamped = rospy.Publisher("stamped", PointStamped, queue_size=1)
for message in (Int32(1), Header()):
    tried(stamped.publish, message)
tried(rospy.Publisher("empty", Empty, queue_size=1).publish, Int32(1))
tried(rospy.Publisher("header", Header, queue_size=1).publish, Point())
tried(rospy.Publisher("any", rospy.AnyMsg, queue_size=1).publish, String("a"))
tried(rospy.AnyMsg().serialize, None)
got = []
words = rospy.Publisher("words", String, queue_size=1)
rospy.Subscriber("words", String, lambda message: got.append(message.data))
rospy.sleep(0.2)
raw = rospy.AnyMsg()
raw._buff = b"\\1\\0\\0\\0a"
words.publish(raw)
rospy.sleep(0.2)
print(got)
""".replace('"empty", Empty', '"empty", __import__("std_msgs.msg").msg.Empty')
    lines = answers(tmp_path, body)
    assert lines[0] == "TypeError: expected [std_msgs/Header] but got [std_msgs/Int32]"
    assert lines[1] == "TypeError: Invalid number of arguments, args should be ['header', 'point'] args are(seq: 0"
    assert lines[6:] == [
        "TypeError: expected [] but got [std_msgs/Int32]",
        "TypeError: expected [uint32] but got [geometry_msgs/Point]",
        "AttributeError: type object 'AnyMsg' has no attribute '_slot_types'",
        "ROSException: AnyMsg is not initialized",
        "['a']",
    ]


def test_a_publisher_without_queue_size(tmp_path: Path) -> None:
    lines = answers(tmp_path, 'rospy.Publisher("a", String)')
    assert lines[0].endswith(
        "SyntaxWarning: The publisher should be created with an explicit keyword argument 'queue_size'. Please see"
        " http://wiki.ros.org/rospy/Overview/Publishers%20and%20Subscribers for more information."
    )


SERVICE = """
calls = 0
def answer(request):
    global calls
    calls += 1
    return GetLoggersResponse([Logger("name", "x" if calls != 2 else 3)])
rospy.Service("get", GetLoggers, answer)
rospy.Service("set", SetLoggerLevel, lambda request: SetLoggerLevelResponse())
"""


def test_half_written_response_breaks_a_persistent_connection(tmp_path: Path) -> None:
    body = """
for persistent in (True, False):
    calls = 0
    proxy = rospy.ServiceProxy("get", GetLoggers, persistent=persistent)
    for _ in range(4):
        tried(proxy)
"""
    lines = [line for line in answers(tmp_path, SERVICE + body) if line == "answered" or line.startswith("ServiceExc")]
    bad = (
        "ServiceException: service [/get] responded with an error: b'error processing request: field loggers[].level"
        " must be of type bytes or an ascii string'"
    )
    spoilt = (
        "ServiceException: transport error completing service call: receive_once[/get]: DeserializationError cannot"
        " deserialize: unpack requires a buffer of 4 bytes"
    )
    assert lines == ["answered", bad, spoilt, spoilt, "answered", bad, "answered", "answered"]


def test_half_written_request_breaks_a_persistent_connection(tmp_path: Path) -> None:
    body = """
for persistent in (False, True):
    proxy = rospy.ServiceProxy("set", SetLoggerLevel, persistent=persistent)
    tried(proxy, "a", "b")
    tried(proxy, "a", 3)
    tried(proxy, "c", "d")
print(rospy.get_time() % 100 > 4)
"""
    lines = answers(tmp_path, SERVICE + body)
    bad = "SerializationError: field level must be of type bytes or an ascii string"
    assert lines[:4] == ["answered", bad, "answered", "answered"]
    assert lines[4].startswith("cfepy: a request for /set could not be serialized.")
    assert lines[5:] == [bad, "ROSInterruptException: node shutdown interrupted service call", "True"]


def test_closed_persistent_connection_is_an_error(tmp_path: Path) -> None:
    body = """
for persistent in (True, False):
    proxy = rospy.ServiceProxy("set", SetLoggerLevel, persistent=persistent)
    proxy.close()
    tried(proxy, "a", "b")
    proxy.close()
    tried(proxy, "a", "b")
    tried(proxy.wait_for_service, 1)
"""
    closed = "AttributeError: 'NoneType' object has no attribute 'tell'"
    assert answers(tmp_path, SERVICE + body) == ["answered", closed, "None", "answered", "answered", "None"]


def test_service_handler_that_is_interrupted_or_ends_its_node(tmp_path: Path) -> None:
    body = """
import roscpp.srv
def interrupted(request):
    raise rospy.ROSInterruptException("why")
def ends(request):
    rospy.signal_shutdown("from the handler")
    return roscpp.srv.EmptyResponse()
for name, handler in (("interrupted", interrupted), ("ends", ends)):
    rospy.Service(name, roscpp.srv.Empty, handler)
    tried(rospy.ServiceProxy(name, roscpp.srv.Empty))
tried(rospy.ServiceProxy("ends", roscpp.srv.Empty))
"""
    lines = [line for line in answers(tmp_path, body) if line.startswith(("ServiceExc", "answered"))]
    assert lines == [
        "ServiceException: service [/interrupted] responded with an error: b'error processing request: why'",
        "ServiceException: service [/ends] returned no response",
        "ServiceException: service [/ends] unavailable",
    ]


def test_private_name_of_a_node(tmp_path: Path) -> None:
    for name, expected in (("~y", "/unnamed/y /unnamed/ /unnamed/y/q /unnamed/q"), ("~", "/unnamed / /unnamed/q /q")):
        script = f"""
            import rospy
            rospy.init_node({name!r})
            print(rospy.get_name(), rospy.get_namespace(), rospy.resolve_name("~q"), rospy.resolve_name("q"))
        """
        folder = tmp_path / str(len(name))
        folder.mkdir()
        assert [*run_nodes(folder, {"A": script}).printed.values()] == [[expected]]


def test_times_with_a_zone_are_parameters(tmp_path: Path) -> None:
    body = """
import rosparam
rospy.set_param("/z", rosparam.load_str("a: 2001-12-14t21:59:43.10-05:00", "file")[0][0])
print(rospy.get_param("/z/a").value)
tried(rospy.set_param, "/z", rosparam.load_str("a: 2001-12-14", "file")[0][0])
"""
    assert answers(tmp_path, body) == ["20011214T21:59:43", "TypeError: cannot marshal <class 'datetime.date'> objects"]


def test_topic_name_that_xml_cannot_carry_is_tried_forever(tmp_path: Path) -> None:
    body = r"""
import threading
made = []
for name in ("a\0b", "fine"):
    thread = threading.Thread(target=lambda: made.append(rospy.Publisher(name, String, queue_size=1)), daemon=True)
    thread.start()
    thread.join(2)
    print(thread.is_alive(), made)
"""
    lines = answers(tmp_path, body, seconds=6.0)
    assert [line for line in lines if line.startswith("True")] == ["True []", "True []"]
    assert "[ERROR] Unable to immediately register with master node [http://cfepy:11311]" in "".join(lines)


def test_callback_that_calls_exit_ends_only_its_message(tmp_path: Path) -> None:
    body = """
def take(message):
    print("took", message.data)
    if message.data == 1:
        exit(4)
rospy.Subscriber("numbers", Int32, take)
numbers = rospy.Publisher("numbers", Int32, queue_size=1)
rospy.sleep(0.5)
for number in range(3):
    numbers.publish(number)
    rospy.sleep(0.3)
print(rospy.is_shutdown())
"""
    assert answers(tmp_path, body) == ["took 0", "took 1", "took 2", "False"]


ENDED_THREAD = """
import sys, threading
import roscpp.srv
def answer(request):
    if is_bad:
        raise error
    return roscpp.srv.EmptyResponse()
def call(name, times=1, **options):
    def calls():
        proxy = rospy.ServiceProxy("end", roscpp.srv.Empty, **options)
        for _ in range(times):
            try:
                proxy()
                print(name, "answered")
            except Exception as error:
                print(name, type(error).__name__, error)
    thread = threading.Thread(target=calls)
    thread.start()
    thread.join(1)
    print(name, "waits" if thread.is_alive() else "ended")
    return thread
rospy.Service("end", roscpp.srv.Empty, answer)
"""
NO_DATA = "ServiceException transport error completing service call: unable to receive data from sender, check sender's"


def test_call_whose_handler_ends_its_thread_waits_for_the_next_connection(tmp_path: Path) -> None:
    body = """
for number, error in enumerate((SystemExit(3), KeyboardInterrupt(), GeneratorExit())):
    is_bad = True
    first = call(f"{number}a")
    is_bad = False
    call(f"{number}b")
    first.join(1)
is_bad = True
last = call("c")
rospy.wait_for_service("end")
last.join(1)
call("d")
rospy.signal_shutdown("")
"""
    lines = answers(tmp_path, ENDED_THREAD + body, seconds=20.0)
    for name in "012":
        said = [line[len(name) + 2 :][: len(NO_DATA)] for line in lines if line.startswith(f"{name}a ")]
        assert said == ["waits", NO_DATA]
        assert [line for line in lines if line.startswith(f"{name}b ")] == [f"{name}b answered", f"{name}b ended"]
    assert [line[2:][: len(NO_DATA)] for line in lines if line.startswith("c ")] == ["waits", NO_DATA]
    assert next(line for line in lines if line.startswith("d ")) == "d waits"
    note = "cfepy: the handler of /end raised {}. As on ROS, the caller gets no answer, and waits until another caller"
    for kind, count in (("SystemExit", 1), ("KeyboardInterrupt", 1), ("GeneratorExit", 3)):
        assert sum(line.startswith(note.format(kind)) for line in lines) == count


def test_persistent_connection_is_lost_with_the_thread_of_its_handler(tmp_path: Path) -> None:
    body = """
error, is_bad = SystemExit(), True
calls = call("p", 4, persistent=True)
is_bad = False
call("q")
calls.join(1)
"""
    lines = [line[:70] for line in answers(tmp_path, ENDED_THREAD + body) if line[:2] in ("p ", "q ")]
    assert [line for line in lines if line.startswith("p ")] == [
        "p waits",
        f"p {NO_DATA}"[:70],
        f"p {NO_DATA}"[:70],
        "p TransportTerminated 32Broken pipe",
        "p AttributeError 'NoneType' object has no attribute 'tell'",
    ]
    assert [line for line in lines if line.startswith("q ")] == ["q answered", "q ended"]


def test_keyboard_interrupt_of_a_node_ends_its_message_its_thread_or_the_node(tmp_path: Path) -> None:
    body = """
import atexit
def take(message):
    print("took", message.data)
    if message.data == 1:
        raise KeyboardInterrupt
    if message.data == 2:
        raise GeneratorExit
rospy.Subscriber("numbers", Int32, take)
rospy.Subscriber("numbers", Int32, lambda message: print("also", message.data))
numbers = rospy.Publisher("numbers", Int32, queue_size=1)
def tick(event):
    print("tick")
    raise KeyboardInterrupt
rospy.sleep(0.5)
rospy.Timer(rospy.Duration(0.1), tick)
rospy.sleep(0.5)
for number in range(4):
    numbers.publish(number)
    rospy.sleep(0.3)
def hook():
    raise KeyboardInterrupt("hook")
for place in (rospy.on_shutdown, atexit.register):
    place(hook)
print(repr(KeyboardInterrupt), issubclass(rospy.ROSInterruptException, KeyboardInterrupt))
rospy.signal_shutdown("")
raise KeyboardInterrupt("main")
"""
    lines = [line for line in answers(tmp_path, body) if not line.startswith((" ", "Trace"))]
    assert lines == [
        "tick",
        "Exception in thread Thread-1:",
        "KeyboardInterrupt",
        *("took 0", "also 0", "took 1", "took 2", "took 3", "also 3"),
        "<class 'KeyboardInterrupt'> True",
        "KeyboardInterrupt: hook",
        "KeyboardInterrupt: main",
        *(line for line in lines if line.startswith("Exception ignored in atexit callback")),
        "KeyboardInterrupt: hook",
    ]
