"""Services between nodes and in one node: calls, errors, types, and the end of one side."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import Run, run_nodes

HEAD = """
import rospy
from std_srvs.srv import Empty, SetBool, SetBoolResponse, Trigger
from rospy_tutorials.srv import AddTwoInts, AddTwoIntsRequest
def attempt(function, *args, **kwds):
    try:
        print(function(*args, **kwds))
    except Exception as error:
        print(type(error).__name__, error)
"""


def run(tmp_path: Path, body: str) -> list[str]:
    """Return one node's output."""
    result = run_nodes(tmp_path, {"PROBE": HEAD + 'rospy.init_node("probe", log_level=rospy.FATAL)\n' + body})
    return result.printed.get("probe", result.lines)


def two(tmp_path: Path, server: str, client: str, **options: object) -> Run:
    """Run a node with a service and one that calls it."""
    scripts = {
        "SERVER": HEAD + 'rospy.init_node("server")\n' + server,
        "CLIENT": HEAD + 'rospy.init_node("client")\n' + client,
    }
    return run_nodes(tmp_path, scripts, **options)  # type: ignore[arg-type]


def test_call_between_nodes(tmp_path: Path) -> None:
    result = two(
        tmp_path,
        'rospy.Service("add", AddTwoInts, lambda r: r.a + r.b)\nrospy.spin()',
        """
rospy.wait_for_service("add", timeout=2)
add = rospy.ServiceProxy("add", AddTwoInts, persistent=True)
print(add(1, 2).sum, add(AddTwoIntsRequest(3, 4)).sum, add.call(a=5).sum)
print(add(1, 1)._connection_header["callerid"], add.resolved_name, add.request_class.__name__)
add.close()
""",
    )
    assert result.printed["client"] == ["3 7 5", "/server /add AddTwoIntsRequest"]


def test_call_takes_no_longer_than_its_handler(tmp_path: Path) -> None:
    """Short and long ones, also while another caller waits for its answer."""
    result = two(
        tmp_path,
        'rospy.Service("say", SetBool, lambda r: (True, "x" * (100_000 if r.data else 1)))\n'
        'rospy.Service("slow", Empty, lambda r: rospy.sleep(1.0) or [])\nrospy.spin()',
        """
import threading
say = rospy.ServiceProxy("say", SetBool)
rospy.sleep(0.2)
threading.Thread(target=rospy.ServiceProxy("slow", Empty)).start()
for long in (False, True):
    begin = rospy.get_time()
    print(len(say(long).message), rospy.get_time() - begin < 0.001)
""",
    )
    assert result.printed["client"] == ["1 True", "100000 True"]


def test_handler_return_values_are_converted_or_refused(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
def service(value):
    def handler(request):
        if isinstance(value, Exception):
            raise value
        return value
    offered = rospy.Service("s", SetBool, handler)
    attempt(lambda: rospy.ServiceProxy("s", SetBool)(True).message)
    offered.shutdown()
for value in (SetBoolResponse(True, "object"), (True, "tuple"), {"message": "dict"}, None, "str", [1],
              ZeroDivisionError("no"), rospy.ServiceException("why")):
    service(value)
rospy.Service("one", Trigger, lambda request: [True, "list"])
attempt(lambda: rospy.ServiceProxy("one", Trigger)().message)
""",
    )
    refused = "ServiceException service [/s] responded with an error: b"
    count = "Invalid number of arguments, args should be ['success', 'message'] args are"
    assert lines == [
        "object",
        "tuple",
        "dict",
        refused + "'service cannot process request: service handler returned None'",
        refused + f"\"service cannot process request: handler returned invalid value: {count}('str',)\"",
        refused + f'"service cannot process request: handler returned wrong number of values: {count}(1,)"',
        refused + "'error processing request: no'",
        refused + "'service cannot process request: why'",
        "list",
    ]


def test_errors_of_the_caller(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
rospy.Service("add", AddTwoInts, lambda r: 0)
attempt(rospy.ServiceProxy("nope", SetBool), True)
attempt(rospy.wait_for_service, "nope", timeout=0.3)
attempt(rospy.ServiceProxy("add", AddTwoInts), 1)
attempt(rospy.ServiceProxy("add", AddTwoInts), z=1)
attempt(rospy.ServiceProxy("add", AddTwoInts), "x", 1)
attempt(rospy.Service, "add", AddTwoInts, lambda r: 0)
attempt(lambda: rospy.ServiceProxy("add", SetBool)(True))
""",
    )
    assert lines[:6] == [
        "ServiceException service [/nope] unavailable",
        "ROSException timeout exceeded while waiting for service /nope",
        "TypeError Invalid number of arguments, args should be ['a', 'b'] args are(1,)",
        "AttributeError z is not an attribute of AddTwoIntsRequest",
        "SerializationError field a must be an integer type",
        "ServiceException service [/add] already registered",
    ]
    assert lines[6].startswith("ServiceException unable to connect to service: remote error reported: request from")


def test_missing_service_has_the_masters_error_as_its_context(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
try:
    rospy.ServiceProxy("nope", SetBool)(True)
except rospy.ServiceException as error:
    print(type(error.__context__).__module__, repr(error.__context__), error.__cause__, error.__suppress_context__)
""",
    )
    assert lines == ["rosgraph.masterapi MasterError('no provider') None False"]


def test_service_that_ends_during_a_call(tmp_path: Path) -> None:
    result = two(
        tmp_path,
        'rospy.Service("slow", Empty, lambda r: rospy.sleep(60))\nrospy.sleep(1.2)',
        'rospy.wait_for_service("slow")\nbegin = rospy.get_time()\n'
        'attempt(rospy.ServiceProxy("slow", Empty))\nprint(rospy.get_time() - begin < 1.25)',
        seconds=5,
    )
    assert result.printed["client"] == [
        "ServiceException transport error completing service call: the service has ended",
        "True",
    ]


def test_service_that_is_shut_down_answers_the_calls_in_its_handler(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
import threading
def once(request):
    service.shutdown("one shot")
    return 1
def slow(request):
    threading.Thread(target=other.shutdown).start()
    rospy.sleep(0.7)
    return 2
service = rospy.Service("once", AddTwoInts, once)
attempt(rospy.ServiceProxy("once", AddTwoInts), 1, 1)
attempt(rospy.ServiceProxy("once", AddTwoInts), 1, 1)
other = rospy.Service("slow", AddTwoInts, slow)
attempt(rospy.ServiceProxy("slow", AddTwoInts), 1, 1)
""",
    )
    assert lines == ["sum: 1", "ServiceException service [/once] unavailable", "sum: 2"]


def test_service_calls_another_service_and_publishes_errors(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
errors = []
rospy.Service("inner", AddTwoInts, lambda r: r.a * r.b)
rospy.Service("outer", AddTwoInts, lambda r: rospy.ServiceProxy("inner", AddTwoInts)(r.a, 10).sum + r.b)
rospy.Service("bad", Trigger, lambda r: 1 / 0, error_handler=lambda e, kind, value, tb: errors.append(kind.__name__))
print(rospy.ServiceProxy("outer", AddTwoInts)(4, 2).sum)
attempt(rospy.ServiceProxy("bad", Trigger))
print(errors)
""",
    )
    assert lines[0] == "42"
    assert lines[-1] == "['ZeroDivisionError']"


def test_long_requests_and_responses(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
from diagnostic_msgs.srv import AddDiagnostics
rospy.Service("big", AddDiagnostics, lambda r: (True, r.load_namespace + "!"))
for size in (32_000, 32_760, 100_000, 3_000_000):
    answer = rospy.ServiceProxy("big", AddDiagnostics)("x" * size).message
    print(len(answer) - size, set(answer[:-1]), answer[-1])
""",
    )
    assert lines == ["1 {'x'} !"] * 4


def test_handlers_run_concurrently(tmp_path: Path) -> None:
    """One handler waits for another call of the same service, and another is called from within itself."""
    lines = run(
        tmp_path,
        """
import threading
arrived = threading.Barrier(3)
def meet(request):
    return True, str(arrived.wait(5) >= 0)
rospy.Service("meet", Trigger, meet)
answers = []
call = lambda: answers.append(rospy.ServiceProxy("meet", Trigger)().message)
callers = [threading.Thread(target=call) for _ in "abc"]
[each.start() for each in callers]
[each.join() for each in callers]
print(answers)
depth = []
def again(request):
    depth.append(1)
    return True, str(len(depth)) if len(depth) > 3 else rospy.ServiceProxy("again", Trigger)().message
rospy.Service("again", Trigger, again)
print(rospy.ServiceProxy("again", Trigger)().message)
""",
    )
    assert lines == ["['True', 'True', 'True']", "4"]


def test_headers_of_a_request(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
rospy.Service("head", Trigger, lambda r: (True, str(sorted(r._connection_header.items()))))
print(rospy.ServiceProxy("head", Trigger, persistent=True, headers={"who": "me"})().message)
""",
    )
    assert "('persistent', '1')" in lines[0]
    assert "('who', 'me')" in lines[0]
    assert "('callerid', '/probe')" in lines[0]


def test_service_made_before_init_node_is_offered_after_it(tmp_path: Path) -> None:
    script = """
early = rospy.Service("early", Trigger, lambda request: (True, "here"))
attempt(rospy.Service, "early", Trigger, None)
gone = rospy.Service("gone", Trigger, None)
gone.shutdown()
attempt(rospy.wait_for_service, "early", 0.1)
rospy.init_node("probe", log_level=rospy.FATAL)
attempt(rospy.wait_for_service, "early", 1)
print(rospy.ServiceProxy("early", Trigger)().message)
attempt(rospy.wait_for_service, "gone", 0.1)
"""
    result = run_nodes(tmp_path, {"PROBE": HEAD + script})
    assert [line for lines in result.printed.values() for line in lines] == [
        "ServiceException service [/early] already registered",
        "ROSException timeout exceeded while waiting for service /early",
        "None",
        "here",
        "ROSException timeout exceeded while waiting for service /gone",
    ]


def test_response_that_cannot_be_serialized_is_an_error_of_the_handler(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
handle = lambda error, *of: print("handled", error)
rospy.Service("odd", Trigger, lambda request: (3.5, ""), error_handler=handle)
attempt(rospy.ServiceProxy("odd", Trigger))
""",
    )
    refused = "service [/odd] responded with an error: b'error processing request: field success is not a bool'"
    assert lines == ["handled field success is not a bool", f"ServiceException {refused}"]


def test_error_in_a_handler_is_logged_with_its_traceback_as_a_list(tmp_path: Path) -> None:
    result = two(
        tmp_path,
        'rospy.Service("halve", SetBool, lambda r: 1 / 0)\nrospy.spin()',
        'rospy.wait_for_service("halve")\nattempt(rospy.ServiceProxy("halve", SetBool), True)',
    )
    told, listed = result.printed["server"][:2]
    assert told.endswith("Error processing request: division by zero")
    assert listed.startswith("['Traceback (most recent call last):\\n', '  File ")
    assert listed.endswith("'ZeroDivisionError: division by zero\\n']")
