"""Nodes do not share a process: a change that one of them makes for itself is invisible to others."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.mission.flights import write_mission
from tests.rospy_shim.missions import Run, run_nodes

WITNESS = """
import argparse, atexit, builtins, collections, decimal, gc, json, locale, logging, math, os, random, re, signal
import sys, threading, time, warnings
import numpy as np
import rospy, shared
from geometry_msgs.msg import Point, Pose
from std_msgs.msg import String
from std_srvs.srv import SetBool, SetBoolRequest

rospy.init_node("witness")
time.sleep(1)
shared.values.append(1)
print(len(shared.values), shared.Shared.count, hasattr(builtins, "mark"), sys.argv[1:], os.environ.get("MARK"))
print(os.getcwd() == os.path.dirname(os.path.abspath(__file__)), "vandal" in " ".join(sys.path))
print(sorted(name for name in ("fake_module",) if name in sys.modules), rospy.has_param("~private"))
print(logging.getLogger().level, logging.getLogger("rosout").level, len(logging.getLogger("lib").handlers))
print(logging.raiseExceptions, len(warnings.filters) < 9, signal.getsignal(signal.SIGTERM) is not print)
print(random.random(), np.random.rand(2), np.random.default_rng().random(), random.Random().random())
print(np.array([1 / 3]), np.geterr()["divide"], decimal.getcontext().prec, decimal.Decimal(1) / 3)
print(json.dumps({"a": 1}), math.floor(1.5), re.sub("a", "b", "aa"), np.linalg.norm([3, 4]), np.mean([1, 3]))
print(json.JSONEncoder().encode([1]), collections.OrderedDict is dict, hasattr(np, "float"), time.sleep is print)
print(gc.isenabled(), gc.get_threshold()[0], gc.callbacks, locale.setlocale(locale.LC_ALL), rospy.loginfo is print)
print(hasattr(String, "extra"), str(Point(1, 2, 3)) == "p", Pose() == Pose(), String("a") == String("b"))
print(hasattr(SetBoolRequest, "extra"), SetBool._type, type(Pose().position) is Point, Point.__slots__)
print(threading.excepthook is print, sys.excepthook is print, sys.getrecursionlimit() > 100)
print(argparse.ArgumentParser().prog, len(gc.callbacks), rospy.get_name(), threading.active_count() < 20)
"""
VANDAL = """
import argparse, atexit, builtins, collections, decimal, gc, json, locale, logging, math, os, random, re, signal
import sys, threading, time, types, warnings
import numpy as np
import rospy, shared
from geometry_msgs.msg import Point, Pose
from std_msgs.msg import String
from std_srvs.srv import SetBool, SetBoolRequest

rospy.init_node("vandal")

def spoil():
    np.set_printoptions(precision=1); np.seterr(all="raise"); decimal.getcontext().prec = 3

spoil()
rospy.Subscriber("chat", String, lambda message: spoil())
rospy.Timer(rospy.Duration(0.1), lambda event: spoil())
threading.Thread(target=spoil).start()
shared.values.append(0); shared.Shared.count = 9; builtins.mark = 1
sys.argv[1:] = ["x"]; os.environ["MARK"] = "1"; os.chdir("/"); sys.path.insert(0, "/vandal")
sys.modules["fake_module"] = types.ModuleType("fake_module"); rospy.set_param("~private", 1)
logging.getLogger().setLevel(1); logging.getLogger("rosout").setLevel(1); logging.raiseExceptions = 7
logging.getLogger("lib").addHandler(logging.NullHandler())
for _ in range(9): warnings.filterwarnings("ignore", message=str(_))
signal.signal(signal.SIGTERM, print)
random.seed(1); random.random(); np.random.seed(1); np.random.rand(9); np.random.default_rng().random()
json.dumps = math.floor = re.sub = np.linalg.norm = np.mean = lambda *args, **options: "spoilt"
json.JSONEncoder.encode = lambda self, value: "spoilt"
collections.OrderedDict = dict; np.float = float
gc.disable(); gc.set_threshold(1); gc.callbacks.append(print); locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
rospy.loginfo = time.sleep = threading.excepthook = sys.excepthook = print
String.extra = SetBoolRequest.extra = 1; Point.__str__ = lambda self: "p"; SetBool._type = "spoilt"
Pose.__eq__ = lambda self, other: False; String.__eq__ = lambda self, other: True
Point.__slots__ = []
sys.setrecursionlimit(99); argparse.ArgumentParser.__init__ = lambda self: setattr(self, "prog", "spoilt")
atexit.register(lambda: builtins.print("vandal ends"))
rospy.Publisher("chat", String, queue_size=1, latch=True).publish(data="x")
rospy.spin()
"""
SHARED = """
values = []
class Shared:
    count = 0
"""
ONE_OF_MANY = """
import collections, logging, os, random, sys, time
import numpy, rospy
from std_msgs.msg import String
rospy.init_node("node", anonymous=True)
for shared in (String, numpy, collections):
    shared.count = getattr(shared, "count", 0) + 1
os.environ["COUNT"] = os.environ.get("COUNT", "") + "1"
logging.getLogger("x").addHandler(logging.NullHandler())
time.sleep(1)
print(String.count, numpy.count, collections.count, os.environ["COUNT"], len(logging.getLogger("x").handlers),
      random.random(), numpy.random.random(), os.getpid())
"""


def fly(folder: Path, tasks: str, *names: str) -> Run:
    folder.mkdir()
    (folder / "shared.py").write_text(SHARED, encoding="utf-8")
    sources = {"WITNESS": WITNESS, "VANDAL": VANDAL}
    return run_nodes(folder, {name: sources[name] for name in names}, seconds=4, tasks=tasks)


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_changes_of_a_node_are_invisible_to_others(tmp_path: Path, tasks: str) -> None:
    alone = fly(tmp_path / "alone", tasks, "WITNESS").printed
    together = fly(tmp_path / "together", tasks, "VANDAL", "WITNESS").printed
    assert "Traceback" not in str(together)
    assert together["vandal"] == ["vandal ends"]
    assert together["witness"] == alone["witness"]
    assert len(alone["witness"]) == 14


def test_finished_mission_does_not_affect_the_next_one(tmp_path: Path) -> None:
    first = fly(tmp_path / "first", "thread", "WITNESS").printed["witness"]
    fly(tmp_path / "between", "thread", "VANDAL")  # its threads go back to a pool, and serve the next mission
    assert fly(tmp_path / "second", "thread", "WITNESS").printed["witness"] == first


@pytest.mark.slow
def test_fifty_nodes_of_one_script_share_no_state(tmp_path: Path) -> None:
    startup = "".join(f"CFE_APP, node.py, __main__, NODE{n}, 100, 16384, 0x0, 0;\n" for n in range(50))
    folder = write_mission(tmp_path, startup + "!\n", node=ONE_OF_MANY, mission_yaml="limits: {nodes: 50}\n")
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(4)
        lines = [line.partition("] ")[2].split() for line in mission.console.lines if line.startswith("[node_")]
    assert len(lines) == 50
    assert {tuple(line[:5]) for line in lines} == {("1", "1", "1", "1", "1")}
    assert [len({line[at] for line in lines}) for at in (5, 6, 7)] == [50, 50, 50]


def test_environment_does_not_depend_on_the_host(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("USER", "somebody")
    monkeypatch.setenv("ROS_MASTER_URI", "http://elsewhere:11311")
    source = """
        import os
        names = ("HOME", "LANG", "PATH", "PWD", "ROS_DISTRO", "ROS_MASTER_URI", "USER")
        print(*(os.environ[name] for name in names))
    """
    run = run_nodes(tmp_path, {"NODE": source})
    plain = f"{tmp_path} C.UTF-8 /usr/local/bin:/usr/bin:/bin {tmp_path} noetic http://cfepy:11311 ros"
    assert run.printed["NODE"] == [plain]
