"""The life of a node: init_node, names, shutdown from inside and outside, and its remains on the bus."""

from __future__ import annotations

from pathlib import Path

import pytest

from rospy_shim.types.config import NodeConfig
from tests.rospy_shim.missions import Run, run_nodes


def run(tmp_path: Path, body: str, **options: object) -> Run:
    """Run one node."""
    return run_nodes(tmp_path, {"PROBE": "import rospy\nfrom std_msgs.msg import String\n" + body}, **options)  # type: ignore[arg-type]


def printed(tmp_path: Path, body: str, **options: object) -> list[str]:
    """Return one node's output."""
    result = run(tmp_path, body, **options)
    return [line for lines in result.printed.values() for line in lines] or result.lines


def test_timer_calls_once_more_and_spin_ends_at_its_next_look_after_the_shutdown(tmp_path: Path) -> None:
    lines = printed(
        tmp_path,
        """
rospy.init_node("probe")
def tick(event):
    if rospy.is_shutdown():
        print("tick")
rospy.Timer(rospy.Duration(0.02), tick)
def end(event):
    rospy.signal_shutdown("test")
    print("shut down", round(rospy.get_time() - begun, 1))
rospy.on_shutdown(lambda: print("hook"))
begun = rospy.get_time()
rospy.Timer(rospy.Duration(0.7), end, oneshot=True)
rospy.spin()
print("spun", round(rospy.get_time() - begun, 1))
""",
    )
    assert lines == ["hook", "shut down 0.7", "tick", "spun 1.0"]


def test_before_init_node(tmp_path: Path) -> None:
    lines = printed(
        tmp_path,
        """
print(rospy.get_name(), rospy.get_namespace(), rospy.get_node_uri(), rospy.core.is_initialized())
def attempt(function, *args, **kwds):
    try:
        print(function(*args, **kwds))
    except Exception as error:
        print(type(error).__name__, error)
attempt(rospy.Publisher("early", String, queue_size=1).publish, "x")
attempt(rospy.Publisher, "~early", String, queue_size=1)
attempt(rospy.get_param, "/nope", "default")
attempt(rospy.init_node, "")
attempt(rospy.init_node, "a/b")
attempt(rospy.wait_for_message, "/nope", String, timeout=0.2)
""",
    )
    assert lines == [
        "/unnamed / None False",
        "ROSException ROS node has not been initialized yet. Please call init_node() first",
        "ValueError ~name topics cannot be created before init_node() has been called",
        "default",
        "ValueError name must not be empty",
        "ValueError namespaces are not allowed in node names",
        "ROSException timeout exceeded while waiting for message on topic /nope",
    ]


def test_init_node_in_another_thread_fails_with_signals_and_works_without(tmp_path: Path) -> None:
    lines = printed(
        tmp_path,
        """
import threading
def begin(*names, **options):
    for name in names:
        try:
            rospy.init_node(name, **options)
        except Exception as error:
            print(type(error).__name__, error)
def in_thread(*names, **options):
    thread = threading.Thread(target=begin, args=names, kwargs=options)
    thread.start()
    thread.join()
    print(rospy.core.is_initialized())
in_thread("probe")
begin("other")
""",
    )
    assert lines[:2] == ["ValueError signal only works in main thread of the main interpreter", "False"]
    assert lines[2].startswith("ROSException rospy.init_node() has already been called with different arguments: ")
    lines = printed(
        tmp_path,
        """
import threading
thread = threading.Thread(target=rospy.init_node, args=("probe",), kwargs={"disable_signals": True})
thread.start()
thread.join()
print(rospy.core.is_initialized())
""",
    )
    assert lines == ["True"]


def test_topics_made_before_init_node_work_after_it(tmp_path: Path) -> None:
    lines = printed(
        tmp_path,
        """
publisher = rospy.Publisher("early", String, queue_size=1)
rospy.Subscriber("early", String, lambda m: print(m.data))
rospy.init_node("probe")
rospy.init_node("probe")
rospy.sleep(0.2)
publisher.publish("works")
rospy.sleep(0.1)
try:
    rospy.init_node("other")
except rospy.ROSException as error:
    print(str(error)[:78])
""",
    )
    assert lines == ["works", "rospy.init_node() has already been called with different arguments: ('probe', "]


def test_mission_file_gives_name_namespace_arguments_and_parameters(tmp_path: Path) -> None:
    config = NodeConfig(
        "PROBE",
        name="tuner",
        namespace="/lab",
        remap={"scan": "/front"},
        params={"gain": 2.5, "list": (1, 2)},
        args=("--fast", "_extra:=[1, a]"),
        env={"MODE": "flight"},
    )
    lines = printed(
        tmp_path,
        """
import os, sys
rospy.init_node("default_name")
print(rospy.get_name(), rospy.resolve_name("scan"), rospy.resolve_name("~x"), rospy.remap_name("scan"))
print(rospy.myargv()[1:], sys.argv[1:])
print(rospy.get_param("~gain"), rospy.get_param("~list"), rospy.get_param("~extra"), rospy.get_param("/top"))
print(os.environ["MODE"], rospy.names.get_mappings()["scan"])
""",
        nodes={"PROBE": config},
        params={"top": {"deep": True}},
    )
    assert lines == [
        "/lab/tuner /front /lab/tuner/x /front",
        "['--fast'] ['--fast', '_extra:=[1, a]', 'scan:=/front', '__name:=tuner', '__ns:=/lab']",
        "2.5 [1, 2] [1, 'a'] {'deep': True}",
        "flight /front",
    ]


def test_parameters_of_a_command_line(tmp_path: Path) -> None:
    lines = printed(
        tmp_path,
        """
from rospy.client import load_command_line_node_params as load
print(load([]), load(["a:=b", "c", "__n:=1"]), load(["_a:=1", "_b:=[x, y]", "_c:=text"]))
for bad in ("_a:=b:=c", "_a:={"):
    try:
        load([bad])
    except rospy.ROSInitException as error:
        print(str(error).partition(":")[0])
any_message = rospy.AnyMsg()
print(any_message.deserialize("text")._buff)
""",
    )
    assert lines == ["{} {} {'a': 1, 'b': ['x', 'y'], 'c': 'text'}", *["invalid command-line parameters"] * 2, "text"]


def test_anonymous_names_differ_and_repeat(tmp_path: Path) -> None:
    script = "import rospy\nrospy.init_node('worker', anonymous=True)\nprint(rospy.get_name())\n"
    runs = []
    for number in range(2):
        folder = tmp_path / str(number)
        folder.mkdir()
        result = run_nodes(folder, {"ONE": script, "TWO": script})
        runs.append(sorted(line for lines in result.printed.values() for line in lines))
    assert runs[0] == runs[1]
    assert len(set(runs[0])) == 2
    assert all(name.startswith("/worker_") for name in runs[0])


def test_order_of_shutdown_hooks(tmp_path: Path) -> None:
    lines = printed(
        tmp_path,
        """
rospy.init_node("probe")
core = rospy.core
rospy.on_shutdown(lambda: print("client", rospy.is_shutdown(), core.is_shutdown_requested()))
rospy.on_shutdown(lambda: 1 / 0)
rospy.on_shutdown(lambda: print("client 3"))
core.add_preshutdown_hook(lambda reason: print("pre", reason, rospy.is_shutdown()))
core.add_shutdown_hook(lambda reason: print("post", reason, rospy.is_shutdown()))
publisher = rospy.Publisher("p", String, queue_size=1)
rospy.signal_shutdown("my reason")
rospy.spin()
rospy.sleep(0.01)
rospy.Rate(100).sleep()
publisher.publish("x")
rospy.Publisher("after", String, queue_size=1).publish("x")
rospy.on_shutdown(lambda: print("late"))
try:
    rospy.wait_for_message("zz", String, timeout=1)
except rospy.ROSInterruptException as error:
    print(error, isinstance(error, KeyboardInterrupt))
try:
    rospy.on_shutdown(5)
except TypeError as error:
    print(error)
""",
    )
    assert [line for line in lines if not line.startswith((" ", "Traceback"))] == [
        "client False True",
        "ZeroDivisionError: division by zero",
        "client 3",
        "pre my reason False",
        "post my reason True",
        "late",
        "rospy shutdown True",
        "shutdown hook [5] must be a function or callable object: <class 'int'>",
    ]


def test_end_of_the_run_shuts_nodes_down_like_ctrl_c(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        """
rospy.init_node("probe")
rospy.on_shutdown(lambda: print("hook"))
while not rospy.is_shutdown():
    rospy.sleep(0.1)
print("loop has ended")
""",
    )
    assert result.printed["probe"] == ["hook", "loop has ended"]
    assert result.finished


def test_end_of_the_program_runs_the_hooks(tmp_path: Path) -> None:
    assert printed(tmp_path, "rospy.init_node('probe')\nrospy.on_shutdown(lambda: print('hook'))\n") == ["hook"]


def test_error_of_a_callback_or_handler_that_unwinds_is_not_logged(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        """
import threading
from std_srvs.srv import Empty
rospy.init_node("probe")
never = threading.Event()
def work(_):
    try:
        never.wait()
    except:
        raise ValueError("unwound")
rospy.Subscriber("words", String, work)
rospy.Service("serve", Empty, work)
words = rospy.Publisher("words", String, queue_size=1)
threading.Thread(target=rospy.ServiceProxy("serve", Empty), daemon=True).start()
rospy.sleep(0.2)
words.publish("word")
rospy.sleep(0.2)
""",
    )
    assert not [line for line in result.lines if "unwound" in line]


def test_own_signal_handler_sees_the_end(tmp_path: Path) -> None:
    lines = printed(
        tmp_path,
        """
import signal
rospy.init_node("probe", disable_signals=True)
signal.signal(signal.SIGINT, lambda number, frame: (print("signal", number), rospy.signal_shutdown("mine")))
rospy.spin()
print("end")
""",
    )
    assert lines == ["signal 2", "end"]


def test_handler_from_before_init_node_runs_after_the_shutdown(tmp_path: Path) -> None:
    lines = printed(
        tmp_path,
        """
import signal
signal.signal(signal.SIGINT, lambda number, frame: print("signal", number, rospy.is_shutdown()))
rospy.init_node("probe")
rospy.on_shutdown(lambda: print("hook"))
rospy.spin()
""",
    )
    assert lines == ["hook", "signal 2 True"]


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_own_signal_handler_may_exit(tmp_path: Path, tasks: str) -> None:
    script = """
import atexit, rospy, signal, sys, time
rospy.init_node("probe")
signal.signal(signal.SIGINT, lambda number, frame: sys.exit("enough"))
rospy.on_shutdown(lambda: print("hook"))
atexit.register(lambda: print("atexit"))
try:
    while True:
        time.sleep(0.3)
finally:
    print("finally")
"""
    result = run_nodes(tmp_path, {"PROBE": script}, tasks=tasks)
    assert result.printed["probe"] == ["finally", "enough", "atexit", "hook"]
    assert result.finished


def test_es_request_shuts_a_node_down(tmp_path: Path) -> None:
    app = """
def KILLER_AppMain(cfe):
    cfe.os.task_delay(1000)
    cfe.es.delete_app(cfe.es.get_app_id_by_name("PROBE"))
"""
    (tmp_path / "killer.py").write_text(app, encoding="utf-8")
    (tmp_path / "probe.py").write_text(
        """
import rospy
rospy.init_node("probe")
rospy.on_shutdown(lambda: print("hook"))
rospy.Timer(rospy.Duration(0.1), lambda event: None)
rospy.spin()
print("end")
""",
        encoding="utf-8",
    )
    from cfepy.mission import Mission
    from cfepy.writing.console import Console

    (tmp_path / "startup.scr").write_text(
        "CFE_APP, probe.py, __main__, PROBE, 100, 16384, 0x0, 1;\n"
        "CFE_APP, killer, KILLER_AppMain, KILLER, 100, 16384, 0x0, 1;\n",
        encoding="utf-8",
    )
    console = Console(quiet=True)
    with Mission(str(tmp_path), console=console) as mission:
        mission.run_for(10)
        assert mission.ros.all_finished()
    assert [line for line in console.lines if line.startswith("[probe]")] == ["[probe] hook", "[probe] end"]
    assert any("Stop Application PROBE Completed" in line for line in console.lines)


def test_node_that_ignores_the_shutdown_is_ended_with_its_threads(tmp_path: Path) -> None:
    scripts = {
        "DEAF": """
import rospy, threading
from std_msgs.msg import String
rospy.init_node("deaf")
rospy.Subscriber("t", String, lambda m: None)
threading.Thread(target=threading.Event().wait).start()
threading.Event().wait()
""",
        "KILLER": """
import rospy
rospy.init_node("killer")
rospy.sleep(1.0)
""",
    }
    result = run_nodes(tmp_path, scripts, seconds=3)
    assert not result.finished
    assert not any("Traceback" in line for line in result.lines)


def test_second_node_of_a_name_ends_the_first(tmp_path: Path) -> None:
    script = """
import rospy
rospy.sleep({delay})
rospy.init_node("twin")
rospy.core.add_shutdown_hook(lambda reason: print("{delay}", reason))
rospy.spin()
"""
    result = run_nodes(tmp_path, {"ONE": script.format(delay=0.1), "TWO": script.format(delay=1.0)})
    request = "[/twin] Reason: new node registered with same name"
    assert result.printed["twin"] == [
        f"shutdown request: {request}",
        f"0.1 external shutdown request from [/master]: [{request}]",
        "1.0 the run is over",
    ]


def test_failing_node_ends_its_application(tmp_path: Path) -> None:
    result = run(tmp_path, "rospy.init_node('probe')\nraise RuntimeError('lost')\n")
    assert "RuntimeError: lost" in result.printed["probe"]
    assert any("Exit Application PROBE" in line for line in result.lines)


def test_ended_node_leaves_no_publishers(tmp_path: Path) -> None:
    result = run_nodes(
        tmp_path,
        {
            "SHORT": "import rospy\nfrom std_msgs.msg import String\nrospy.init_node('short')\n"
            "rospy.Subscriber('t', String, print)\nrospy.sleep(0.5)\n",
            "LONG": "import rospy\nfrom std_msgs.msg import String\nrospy.init_node('long')\n"
            "p = rospy.Publisher('t', String, queue_size=1)\nrospy.sleep(0.3)\nprint(p.get_num_connections())\n"
            "rospy.sleep(0.5)\nprint(p.get_num_connections())\n",
        },
    )
    assert result.printed["long"] == ["1", "0"]


def test_polling_of_the_api_makes_time_pass(tmp_path: Path) -> None:
    lines = printed(
        tmp_path,
        """
rospy.init_node("probe")
end = rospy.get_time() + 0.01
while not rospy.is_shutdown() and rospy.get_time() < end:
    pass
print("through")
""",
    )
    assert lines == ["through"]


def test_rospy_and_rospy_shim_are_one_module(tmp_path: Path) -> None:
    lines = printed(
        tmp_path,
        """
import rospy_shim, rospy_shim.core, rospy.client, pickle
from rospy import *
from rospy.exceptions import ROSException as again
from rospy_shim import Publisher as other
print(rospy_shim is rospy, rospy_shim.core is rospy.core, again is ROSException)
print(other is Publisher, Timer is rospy.Timer, rospy.client.DEBUG == rospy.DEBUG == 1)
message = pickle.loads(pickle.dumps([String("x"), rospy.Time(5), rospy.Duration(1)]))
print(message[0].data, message[1] == rospy.Time(5), repr(message[2]))
""",
    )
    assert lines == ["True True True", "True True True", "x True rospy.Duration[1000000000]"]


def test_end_of_the_run_interrupts_a_node_with_disabled_signals(tmp_path: Path) -> None:
    script = """
import rospy, time
rospy.init_node("probe", disable_signals=True)
rospy.on_shutdown(lambda: print("hook"))
try:
    while True:
        time.sleep(0.3)
except KeyboardInterrupt:
    print("interrupted", rospy.is_shutdown())
"""
    result = run_nodes(tmp_path, {"PROBE": script})
    assert result.printed["probe"] == ["interrupted False", "hook"]


def test_remap_name_resolves_only_remapped_names(tmp_path: Path) -> None:
    config = NodeConfig("PROBE", remap={"old": "new", "new": "newest"})
    lines = printed(
        tmp_path,
        """
print([rospy.remap_name(name) for name in ("old", "/old", "other", "~own", "/far")])
rospy.init_node("node")
print([rospy.remap_name(name) for name in ("old", "/old", "other", "~own", "/far")])
""",
        nodes={"PROBE": config},
    )
    assert lines == [str(["/new", "/old", "other", "~own", "/far"])] * 2
