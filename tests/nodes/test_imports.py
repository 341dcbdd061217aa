"""Imports of a node: its own folders, packages, given modules, the host's libraries."""

from __future__ import annotations

import importlib.util
import sys
import types

import pytest

from cfepy.nodes import Universe
from cfepy.nodes import module_origins as sharing
from cfepy.rtos import Kernel


@pytest.fixture
def package(tmp_path):
    """Return a package `robot` beside the script, with relative imports and a circular import."""
    folder = tmp_path / "robot"
    (folder / "parts").mkdir(parents=True)
    (folder / "__init__.py").write_text(
        "from .arm import Arm\nfrom . import parts\n__all__ = ['arm', 'leg']\n", encoding="utf-8"
    )
    (folder / "arm.py").write_text(
        "import robot\nfrom .parts.joint import LIMIT\nclass Arm:\n    limit = LIMIT\n", encoding="utf-8"
    )
    (folder / "leg.py").write_text("from robot import arm\nname = __name__\n", encoding="utf-8")
    (folder / "parts" / "__init__.py").write_text("", encoding="utf-8")
    (folder / "parts" / "joint.py").write_text("from .. import arm as above\nLIMIT = 5\n", encoding="utf-8")
    return folder


def test_packages_and_relative_imports(run, package):
    program = run("""
        import importlib, robot.parts.joint, sys
        from robot import *
        from robot import leg as again
        print(robot.Arm.limit, leg.name, again is leg, arm is sys.modules["robot.arm"], robot.parts.joint.above is arm)
        print(importlib.import_module("robot.leg") is leg, importlib.import_module(".leg", "robot") is leg)
        print(importlib.util.find_spec("robot.leg") is not None, importlib.util.find_spec("nothing"))
        print(robot.__file__.endswith("__init__.py"), robot.__package__, leg.__package__, leg.__spec__.name)
    """)
    assert program.lines == ["5 robot.leg True True True", "True True", "True None", "True robot robot robot.leg"]


@pytest.mark.parametrize(
    ("body", "error"),
    [
        ("import nothing", "ModuleNotFoundError: No module named 'nothing'"),
        ("import robot.nothing", "ModuleNotFoundError: No module named 'robot.nothing'"),
        ("import robot.leg.toe", "ModuleNotFoundError: No module named 'robot.leg.toe'; 'robot.leg' is not a package"),
        ("from robot import nothing", "ImportError: cannot import name 'nothing' from 'robot'"),
        ("from . import leg", "ImportError: attempted relative import with no known parent package"),
        ("import json.nothing", "ModuleNotFoundError: No module named 'json.nothing'"),
    ],
)
def test_failed_imports(run, package, body, error):
    assert any(line.startswith(error) for line in run(body).lines)


def test_missing_module_is_reported_with_advice(run):
    program = run("""
        try:
            import nothing
        except ImportError as error:
            print(error)
        import nothing.more
    """)
    assert program.lines[0] == "No module named 'nothing'"
    assert program.lines[-1].startswith("(put its source near the node or on ROS_PACKAGE_PATH, or install it")


def test_failed_import_leaves_no_module(run, tmp_path):
    (tmp_path / "bad.py").write_text("1 / 0\n", encoding="utf-8")
    program = run("""
        import sys
        for _ in range(2):
            try:
                import bad
            except ZeroDivisionError:
                print("bad" in sys.modules)
    """)
    assert program.lines == ["False", "False"]


def test_search_paths_given_and_added(run, tmp_path):
    for folder in ("given", "added"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / f"from_{folder}.py").write_text("import time\nclock = time\n", encoding="utf-8")
    program = run(
        """
        import os, sys, time
        sys.path.insert(0, os.path.join(os.path.dirname(__file__), "added"))
        import from_given, from_added
        print(from_given.clock is time, from_added.clock is time)
        """,
        search_paths=[tmp_path / "given"],
    )
    assert program.lines == ["True True"]


def test_module_next_to_the_script_is_preferred_to_a_library(run, tmp_path):
    (tmp_path / "queue.py").write_text("mine = True\n", encoding="utf-8")
    (tmp_path / "yaml.py").write_text("mine = True\n", encoding="utf-8")
    assert run("import queue, yaml\nprint(queue.mine, yaml.mine)").lines == ["True True"]


def test_plain_folders_are_packages_but_hide_no_module(run, tmp_path):
    for folder in ("models", "logging", "yaml"):
        (tmp_path / folder).mkdir()
    (tmp_path / "models" / "car.py").write_text("wheels = 4\n", encoding="utf-8")
    program = run("""
        import logging, models.car, yaml
        from models import car
        print(car.wheels, logging.INFO, yaml.safe_load("1"))
    """)
    assert program.lines == ["4 20 1"]


def test_edited_modules_are_read_again(start, tmp_path):
    for value in (1, 22):
        (tmp_path / "edited.py").write_text(f"value = {value}\n", encoding="utf-8")
        program = start("import edited\nprint(edited.value)", name=f"node{value}")
        program.kernel.run()
        assert program.lines == [str(value)]


def test_reload(run, tmp_path):
    (tmp_path / "counted.py").write_text("count = globals().get('count', 0) + 1\n", encoding="utf-8")
    program = run("""
        import counted, importlib
        print(importlib.reload(counted) is counted, counted.count)
    """)
    assert program.lines == ["True 2"]


def test_spec_from_file_location_executes_in_the_node(run, tmp_path):
    (tmp_path / "odd-name.py").write_text("import time\nclock = time\n", encoding="utf-8")
    program = run("""
        import importlib.util, os, time
        file = os.path.join(os.path.dirname(__file__), "odd-name.py")
        spec = importlib.util.spec_from_file_location("odd", file)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        print(module.clock is time)
    """)
    assert program.lines == ["True"]


def test_given_modules_and_packages(run):
    def rospy(universe: Universe) -> types.ModuleType:
        module = types.ModuleType("rospy")
        module.__path__ = []
        module.node = universe.name
        return module

    def messages(name):
        if not name.startswith("std_msgs"):
            return None

        def factory(universe: Universe) -> types.ModuleType:
            module = types.ModuleType(name)
            module.__path__ = []
            module.String = str
            return module

        return factory

    program = run(
        """
        import rospy, std_msgs.msg
        import rospy_shim as other
        import rospy.exceptions
        from std_msgs.msg import String
        print(rospy.node, other.node, String, std_msgs.msg.String)
        """,
        modules={"rospy": rospy, "rospy_shim": rospy, "rospy.exceptions": rospy},
        find_module=messages,
    )
    assert program.lines == ["node node <class 'str'> <class 'str'>"]


def test_load_file_makes_a_package_of_the_universe(tmp_path, run):
    folder = tmp_path / "elsewhere" / "shim"
    folder.mkdir(parents=True)
    (folder / "__init__.py").write_text("import threading\nfrom .part import value\n", encoding="utf-8")
    (folder / "part.py").write_text("value = 8\n", encoding="utf-8")

    def shim(universe):
        return universe.importer.load_file("shim", str(folder / "__init__.py"), str(folder))

    program = run(
        "import shim, threading\nprint(shim.value, shim.threading is threading)",
        modules={"shim": shim},
    )
    assert program.lines == ["8 True"]


def test_installed_packages_are_fresh_when_pure_and_shared_when_not(run):
    import numpy

    program = run("""
        import markdown_it, numpy as np, yaml, sys
        import numpy.linalg
        module, array = markdown_it, np.zeros(3)
        print(yaml.safe_load("a: [1]"), np.linalg.norm([3.0, 4.0]), sys.modules["numpy"] is np)
    """)
    assert program.lines == ["{'a': [1]} 5.0 True"]
    assert isinstance(program.global_("array"), numpy.ndarray)
    assert program.global_("module") is not sys.modules.get("markdown_it")


def test_numpy_generator_without_a_seed_is_seeded_anew_by_the_node(start):
    source = """
        import numpy as np
        np.random.seed(5)
        np.random.seed()
        own = np.random.RandomState(5)
        own.seed()
        drawn = [np.random.rand(), own.rand()]
    """
    runs = [start(source, name=name) for name in ("a", "a", "b")]
    runs[0].kernel.run()
    one, again, other = [run.global_("drawn") for run in runs]
    assert one == again
    assert len({*one, *other, 0.22199317108973948}) == 5  # the last one is the first number after seed(5)


def test_numpy_random_is_the_nodes_own(start):
    import numpy

    source = """
        import numpy as np
        from numpy.random import randn
        first = np.random.rand(3).tolist() + randn(2).tolist()
        first += [np.random.default_rng().random(), np.random.RandomState().rand()]
        first += [np.random.Generator(np.random.PCG64()).random()]
        np.random.seed(3)
        seeded = np.random.normal()
    """
    before = numpy.random.get_state()[1].tolist()
    runs = [start(source, name=name, seed=seed) for name, seed in (("a", 1), ("a", 1), ("b", 1), ("a", 2))]
    runs[0].kernel.run()
    draws = [program.global_("first") for program in runs]
    assert draws[0] == draws[1]
    assert draws[0] != draws[2] != draws[3] != draws[0]
    assert {program.global_("seeded") for program in runs} == {numpy.random.RandomState(3).normal()}
    assert numpy.random.get_state()[1].tolist() == before


def test_the_host_is_not_patched(run):
    import logging
    import os
    import queue
    import random
    import threading
    import time

    watched = (threading, time, queue, random, os, logging, sys)
    before = {(module.__name__, name): value for module in watched for name, value in vars(module).items()}
    modules, path = dict(sys.modules), list(sys.path)
    random.seed(5)
    state = random.getstate()
    run("""
        import concurrent.futures, datetime, logging, os, pickle, queue, random, socket, sys, threading, time, uuid
        os.environ["X_OF_NODE"] = "1"
        sys.path.append("/nowhere"); sys.setrecursionlimit(77)
        logging.getLogger().setLevel(1)
        threading.Thread(target=random.random).start()
    """)
    after = {(module.__name__, name): value for module in watched for name, value in vars(module).items()}
    assert {key for key in before if before[key] is not after.get(key)} == set()
    assert random.getstate() == state
    assert sys.path == path
    assert {name for name in modules if sys.modules.get(name) is not modules[name]} == set()
    assert "X_OF_NODE" not in os.environ
    assert sys.getrecursionlimit() > 100


def test_modules_executed_for_each_node_can_be_imported(run):
    names = sorted(name for name in sharing.FRESH if importlib.util.find_spec(name) is not None)
    program = run(f"""
        import importlib
        for name in {names!r}:
            try:
                importlib.import_module(name)
            except ImportError as error:
                print(name, error)
    """)
    assert program.universe.exit_status == 0, program.text
    assert program.text == ""


def test_a_universe_can_be_used_from_the_host_without_a_script():
    with Kernel(context="thread") as kernel:
        universe = Universe(kernel, name="tool")
        queue = universe.importer.load("queue").Queue()
        queue.put(1)
        assert queue.get_nowait() == 1
        with pytest.raises(RuntimeError, match="only tasks of the node can wait"):
            queue.get(timeout=1)
        with pytest.raises(RuntimeError, match="only a task can sleep"):
            universe.importer.load("time").sleep(1)


def test_pkg_resources_reads_versions(run):
    pytest.importorskip("pkg_resources", reason="setuptools is not installed, or is one without it")
    source = "import pkg_resources\nprint(pkg_resources.parse_version('1.10') > pkg_resources.parse_version('1.9'))"
    assert run(source).lines[-1] == "True"


@pytest.mark.parametrize("first", ["_pickle", "pickle"])
def test_the_fast_half_of_pickle_is_pickle(run, first):
    source = f"""
        import {first}
        import _pickle, pickle
        class Own:
            value = 3
        print(_pickle.loads(_pickle.dumps(Own())).value, _pickle.Pickler is pickle.Pickler)
        """
    assert run(source).lines == ["3 True"]
