"""A loop that waits without a sleep or a call lets other tasks run; a loop that computes takes no virtual time."""

from __future__ import annotations

import ast
import textwrap
from collections.abc import Callable
from pathlib import Path

import pytest

from cfepy.interpreter.syntax_trees import compiled
from cfepy.nodes import Universe
from cfepy.nodes.busy_waits import FREE_TURNS, BusyWait, busy_loops
from cfepy.nodes.node_sources import code_of_file, code_of_source, doubts_of
from cfepy.pilot import pilot
from cfepy.pilot.plan import RunPlan
from cfepy.rtos import Kernel
from cfepy.trace import Trace
from tests.mission.flights import write_mission
from tests.nodes.conftest import Program

Run = Callable[..., Program]

WAITS = {
    "pass": "while not flag: pass",
    "length": "while len(seen) < 1:\n    pass",
    "continue": "while not self.x: continue",
    "none": "while self.image is None:\n    pass",
    "break": "while True:\n    if flag: break",
    "return": "def f():\n    while True:\n        if flag:\n            work()\n            return",
    "method": "while not self.ready():\n    pass",
    "clock": "while time.time() < t: pass",
    "main loop": "while True:\n    if self.image is not None:\n        show(self.image)\n        self.image = None",
    "counter": "while not done:\n    turns += 1",
    "limit": "while not done and turns < 1000000:\n    turns += 1",
    "shown": "while not done:\n    print('waiting')",
    "caught": "while True:\n    try:\n        if self.pose: break\n    except AttributeError:\n        pass",
    "inside": "while True:\n    while not go: pass\n    work()",
    "log": "while self.pose is None:\n    rospy.loginfo_throttle(1, 'no pose for %s' % self.name)",
    "other call": "while not done:\n    n = work(n)",
    "missing item": "while True:\n    try:\n        y = seen[0]\n        break\n    except IndexError: pass",
    "poll": "while True:\n    try:\n        return_to(q.get_nowait())\n        break\n    except queue.Empty: continue",
    "searching": "while True:\n    for each in things:\n        turns += 1\n    if found: break",
}
OTHERS = {
    "no condition": "while True:\n    pass",
    "method": "while not self.done:\n    self.work()",
    "argument": "while heap:\n    best = heappop(heap)",
    "element": "while queue:\n    see(queue.pop())",
    "shutdown": "while not rospy.is_shutdown():\n    if data: break",
    "rate": "while not done:\n    rate.sleep()",
    "sleeping": "while True:\n    if done: break\n    time.sleep(0.1)",
    "gcd": "while a != b:\n    if a > b:\n        a -= b\n    else:\n        b -= a",
    "count": "while i < n:\n    total += i\n    i += 1",
    "items": "while i < n:\n    if a[i] > most: most = a[i]\n    i += 1",
    "link": "while node.next is not None:\n    node = node.next",
    "field": "while self.i < 10:\n    self.i += 1",
    "walrus": "while (line := read()): pass",
    "generator": "def f():\n    while not done:\n        yield 1",
    "await": "async def f():\n    while not await done(): pass",
    "emptied": "while stack:\n    stack[0:1] = []",
}


@pytest.mark.parametrize("source", WAITS.values(), ids=WAITS.keys())
def test_wait_is_found(source: str) -> None:
    assert len(busy_loops(ast.parse(source))) == 1


@pytest.mark.parametrize("source", OTHERS.values(), ids=OTHERS.keys())
def test_loop_that_computes_is_not_found(source: str) -> None:
    assert busy_loops(ast.parse(source)) == []


IN_FUNCTION = """
    import threading, time
    class Node:
        x = None
        def set(self): self.x = time.monotonic()
    self, seen, flag = Node(), [], False
    def raise_flag():
        global flag
        flag = True
    def wait():
        while self.x is None: continue
    threading.Timer(0.5, self.set).start()
    wait()
    threading.Timer(0.25, seen.append, (1,)).start()
    while len(seen) < 1:
        pass
    threading.Timer(0.25, raise_flag).start()
    while True:
        if flag:
            break
    print(round(time.monotonic(), 3))
"""


def test_threads_run_while_a_loop_waits(run: Run) -> None:
    assert run(IN_FUNCTION).lines == ["1.0"]


def test_trace_does_not_depend_on_the_kind_of_tasks(tmp_path: Path) -> None:
    script = tmp_path / "node.py"
    script.write_text(textwrap.dedent(IN_FUNCTION), encoding="utf-8")
    digests = set()
    for context in ("thread", "greenlet", "greenlet"):
        trace = Trace()
        with Kernel(context=context, trace=trace) as kernel:
            Universe(kernel, name="node", script=script).spawn()
            kernel.run()
            digests.add((trace.digest(), kernel.now))
    assert len(digests) == 1


def test_turns_are_the_same_in_each_run(run: Run) -> None:
    program = run("""
        import threading
        turns, done = 0, []
        threading.Timer(0.001, done.append, (1,)).start()
        while not done:
            turns += 1
        print(turns)
    """)
    (line,) = program.lines
    assert FREE_TURNS < int(line) < FREE_TURNS + 1010


def test_short_loop_takes_no_time(run: Run) -> None:
    program = run("""
        import time
        begun = time.monotonic()
        left, on = 500, True
        def more():
            global left
            left -= 1
            return left
        while more():
            pass
        print(round((time.monotonic() - begun) * 1e6))
    """)
    assert program.lines == ["1"]


def test_loop_that_polls_the_clock_is_charged_once_a_turn(run: Run) -> None:
    program = run("""
        import time
        turns, end = 0, time.monotonic() + 0.005
        while time.monotonic() < end:
            turns += 1
        print(turns)
    """)
    assert program.lines == ["4999"]
    assert program.traps == []


@pytest.mark.parametrize("terms", [1500, 4000])
def test_source_that_nests_deeply_runs_as_before(terms: int) -> None:
    source = f"while not x: pass\ny = {'+'.join(['x'] * terms)}\n".encode()
    try:
        compiled(source, "node.py")
    except RecursionError:
        with pytest.raises(RecursionError):
            code_of_source(source, "node.py")
    else:
        assert code_of_source(source, "node.py").co_filename == "node.py"


def test_compiler_warns_once(tmp_path: Path) -> None:
    script = tmp_path / "node.py"
    script.write_text("x = 1\nwhile not x: pass\ny = x is 1\n", encoding="utf-8")
    assert len(doubts_of(code_of_file(str(script), False, "node.py"))) == 1


def test_each_loop_has_its_own_free_turns(run: Run) -> None:
    program = run("""
        import threading, time
        seen = []
        threading.Timer(0.01, seen.append, (1,)).start()
        while not seen: pass
        begun, left = time.monotonic(), 500
        def more():
            global left
            left -= 1
            return left
        while more(): pass
        print(round((time.monotonic() - begun) * 1e6))
    """)
    assert program.lines == ["1"]


def test_two_tasks_wait_for_each_other_in_turn(run: Run) -> None:
    program = run("""
        import threading
        turn, log = 0, []
        def play(me):
            global turn
            for _ in range(3):
                while turn != me:
                    pass
                log.append(me)
                turn = 1 - me
        other = threading.Thread(target=play, args=(1,))
        other.start()
        play(0)
        other.join()
        print(log)
    """)
    assert program.lines == ["[0, 1, 0, 1, 0, 1]"]


def test_report_names_the_loop_once(run: Run) -> None:
    program = run("""
        import threading
        for _ in range(3):
            seen = []
            threading.Timer(0.01, seen.append, (1,)).start()
            while not seen:
                pass
    """)
    (wait,) = program.traps
    assert isinstance(wait, BusyWait)
    assert (wait.who, wait.line, wait.used_ns // 10_000_000) == ("node", 6, 3)
    assert str(wait) == (
        "node: the loop at node.py:6 waits without a sleep, and used 0.030 s of CPU time; "
        "sleep in the loop (rospy.sleep(0.01)), or wait for a threading.Event"
    )


NODE = """
    import rospy_shim as rospy
    from std_msgs.msg import Int32

    class Node:
        go = None
        def on_go(self, message):
            self.go = message.data
        def on_image(self, message):
            while not self.go: continue
            print("image", message.data, "after", self.go, flush=True)

    rospy.init_node("busy")
    node = Node()
    rospy.Subscriber("/go", Int32, node.on_go)
    rospy.Subscriber("/image", Int32, node.on_image)
    rospy.Publisher("/image", Int32, queue_size=1, latch=True).publish(1)
    go = rospy.Publisher("/go", Int32, queue_size=1)
    rospy.sleep(0.2)
    go.publish(7)
    rospy.spin()
"""
APP = """
    flag = []

    def child():
        flag.append(1)

    def main(cfe):
        cfe.es.create_child_task("CHILD", child, 16384, 100)
        while not flag:
            pass
        cfe.es.write_to_sys_log("flag seen")
        while cfe.es.run_loop():
            cfe.osal.task_delay(100)
"""


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_callback_that_waits_for_another(tmp_path: Path, tasks: str) -> None:
    mission = write_mission(tmp_path, "CFE_APP, busy.py, __main__, BUSY, 100, 16384, 0x0, 0;\n!\n", busy=NODE)
    flown = pilot.fly(RunPlan((mission,), seconds=2.0, tasks=tasks))
    assert "[busy] image 1 after 7" in flown.mission.console.lines
    (line,) = flown.results.traps
    assert line.startswith("busy: the loop at busy.py:10 waits without a sleep, and used 0.1")
    assert flown.results.problems == []


def test_application_that_waits_for_its_child_task(tmp_path: Path) -> None:
    mission = write_mission(tmp_path, "CFE_APP, app.py, main, APP, 100, 16384, 0x0, 0;\n!\n", app=APP)
    flown = pilot.fly(RunPlan((mission,), seconds=1.0))
    assert any("flag seen" in line for line in flown.mission.console.lines)
    (line,) = flown.results.traps
    assert line.startswith("APP: the loop at app.py:9 waits without a sleep, and used 0.05")
