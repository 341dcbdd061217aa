"""dynamic_reconfigure: a server and its clients in a mission, and the results of .cfg scripts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.ros_libraries.world import universe
from tests.rospy_shim.missions import Run, run_nodes

CFG = """
from dynamic_reconfigure.parameter_generator_catkin import *
gen = ParameterGenerator()
size = gen.enum([gen.const("Small", int_t, 0, "a"), gen.const("Large", int_t, 2, "b")], "sizes")
gen.add("size", int_t, 1, "its size", 0, 0, 3, edit_method=size)
gen.add("rate", double_t, 2, "how often", 1, -2, 10)
gen.add("label", str_t, 4, "text", "foo")
gen.add("on", bool_t, 8, "switch", False)
more = gen.add_group("More of it", state=False)
more.add("deep", int_t, 16, "inside", 7)
sys.exit(gen.generate("pan_tilt", "node", "Head"))
"""

SERVER = """
import rospy
from dynamic_reconfigure.server import Server
from pan_tilt.cfg import HeadConfig

rospy.init_node("head")
def changed(config, level):
    print("level", level, config.rate, config["size"], config.groups.groups.More_of_it.state)
    config.label += "!"
    return config
server = Server(HeadConfig, changed)
{rest}
rospy.spin()
"""


def fly(folder: Path, *, rest: str = "", params: dict[str, Any] | None = None, **clients: str) -> Run:
    """Return a mission with the package pan_tilt, its server and some clients."""
    (folder / "pan_tilt" / "cfg").mkdir(parents=True)
    (folder / "pan_tilt" / "package.xml").write_text("<package><name>pan_tilt</name></package>", encoding="utf-8")
    (folder / "pan_tilt" / "cfg" / "Head.cfg").write_text(CFG, encoding="utf-8")
    return run_nodes(folder, {"HEAD": SERVER.format(rest=rest), **clients}, seconds=6.0, params=params)


def test_server_and_client(tmp_path: Path) -> None:
    client = """
        import rospy
        from dynamic_reconfigure.client import Client
        rospy.init_node("client")
        told = []
        client = Client("/head", timeout=5, config_callback=lambda config: told.append(config["rate"]))
        print(sorted(client.get_configuration(timeout=5)))
        got = client.update_configuration({"size": "large", "rate": "99", "on": "yes"})
        print(got["size"], got["rate"], got["on"], got["label"], got["groups"]["groups"]["More_of_it"]["deep"])
        rospy.sleep(0.5)
        print(told, rospy.get_param("/head/label"))
        print([each["name"] for each in client.get_parameter_descriptions()])
        client.close()
    """
    run = fly(tmp_path, CLIENT=client)
    assert run.printed["head"] == ["level -1 1.0 0 False", "level 11 10.0 2 False"]
    assert run.printed["client"] == [
        "['deep', 'groups', 'label', 'on', 'rate', 'size']",
        "2 10.0 True foo!! 7",
        "[1.0, 10.0] foo!!",
        "['size', 'rate', 'label', 'on', 'deep']",
    ]


def test_values_and_groups_that_are_refused(tmp_path: Path) -> None:
    client = """
        import rospy
        from dynamic_reconfigure import DynamicReconfigureCallbackException, DynamicReconfigureParameterException
        from dynamic_reconfigure.client import Client
        rospy.init_node("client")
        client = Client("/head")
        for changes in ({"nope": 1}, {"size": "huge"}):
            try:
                client.update_configuration(changes)
            except DynamicReconfigureParameterException as error:
                print(error)
        try:
            client.update_configuration({"groups": {"More_of_it": True}})
        except DynamicReconfigureCallbackException as error:  # as on ROS, whose servers take no groups inside others
            print(error)
        try:
            Client("/nobody", timeout=0.5)
        except rospy.ROSException:
            print("nobody there")
    """
    run = fly(tmp_path, CLIENT=client)
    assert run.printed["client"] == [
        "don't know parameter: nope",
        "can't set parameter 'size' of <class 'int'>: invalid literal for int() with base 10: 'huge'",
        "service call failed",
        "nobody there",
    ]
    assert "Error processing request: 'list' object has no attribute 'items'" in "\n".join(run.printed["head"])


def test_parameters_set_beforehand_count_and_are_clamped(tmp_path: Path) -> None:
    run = fly(tmp_path, params={"head": {"rate": -5.0, "size": 1}}, rest="print(rospy.get_param('~rate'))")
    assert run.printed["head"] == ["level -1 -2.0 1 False", "-2.0"]


def test_server_can_change_its_own_configuration(tmp_path: Path) -> None:
    run = fly(tmp_path, rest="print(server.update_configuration({'size': 9})['size'])")
    assert run.printed["head"] == ["level -1 1.0 0 False", "level 1 1.0 3 False", "3"]


def test_callback_must_return_a_configuration(tmp_path: Path) -> None:
    rest = """
from dynamic_reconfigure import DynamicReconfigureCallbackException
try:
    Server(HeadConfig, lambda config, level: None, "other")
except DynamicReconfigureCallbackException as error:
    print(error)
"""
    run = fly(tmp_path, rest=rest)
    assert run.printed["head"][-1] == "Reconfigure callback should return a possibly updated configuration."


def test_module_of_a_configuration(tmp_path: Path) -> None:
    reader = """
        import math
        from pan_tilt.cfg import HeadConfig as config
        print(config.Head_Large, config.all_level, config.level["deep"], config.type["rate"])
        print(config.defaults, config.min["rate"], config.max["deep"])
        print(config.config_description["groups"][0]["class"], config.inf == math.inf)
        try:
            import pan_tilt.cfg.NeckConfig
        except ImportError as error:
            print(error)
    """
    run = fly(tmp_path, READER=reader)
    assert run.printed["READER"] == [
        "2 31 16 double",
        "{'size': 0, 'rate': 1.0, 'label': 'foo', 'on': False, 'deep': 7} -2.0 2147483647",
        "DEFAULT::MORE_OF_IT True",
        "No module named 'pan_tilt.cfg.NeckConfig'",
    ]


def test_script_that_generates_another_name(tmp_path: Path) -> None:
    script = tmp_path / "Arm.cfg"
    script.write_text(CFG, encoding="utf-8")
    contents_of = universe().importer.load("dynamic_reconfigure._cfg_script").contents_of
    with pytest.raises(ImportError, match=r"Arm\.cfg did not call generate"):
        contents_of(str(script), "Arm")


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ('gen.add("a b", "int", 0, "")', "does not follow the ROS naming conventions"),
        ('gen.add("a", "str", 0, "", "", max="z")', "Max or min specified for a, which is of 'str' type"),
        ('gen.add("a", "int", 0, "", 1.5)', "'a' has type int, but default is 1.5"),
        ('gen.const("a", "int", 1, "don\'t")', "quotes not allowed"),
        ('gen.enum([gen.const("a", "int", 1, ""), gen.const("b", "str", "", "")], "")', "Inconsistent types"),
    ],
)
def test_mistakes_in_scripts_are_reported(line: str, problem: str) -> None:
    gen = universe().importer.load("dynamic_reconfigure.parameter_generator").ParameterGenerator()
    with pytest.raises(Exception, match=problem):
        eval(line, {"gen": gen})


def test_config_is_a_dict_with_attributes() -> None:
    import copy

    world = universe()
    encoding = world.importer.load("dynamic_reconfigure.encoding")
    config = encoding.Config(a=1, groups=encoding.Config(b=2))
    config.c = 3
    twin = copy.deepcopy(config)
    twin.groups.b = 9
    assert (config, twin["c"]) == ({"a": 1, "groups": {"b": 2}, "c": 3}, 3)
    assert encoding.decode_config(encoding.encode_config({"a": 1, "b": True, "c": "x", "d": 0.5, "e": None})) == {
        "a": 1,
        "b": True,
        "c": "x",
        "d": 0.5,
    }


def test_groups_without_an_outermost_one_are_refused_as_on_ros(tmp_path: Path) -> None:
    reads = """
        from dynamic_reconfigure.encoding import get_tree
        from dynamic_reconfigure.msg import Config, GroupState
        try:
            get_tree(Config(groups=[GroupState("a", True, 1, 0)]))
        except AttributeError as error:
            print(error)
        print(get_tree(Config(groups=[GroupState("one", True, 0, 0), GroupState("two", True, 0, 0)]))["name"])
    """
    run = run_nodes(tmp_path, {"READS": reads})
    assert run.printed["READS"] == ["'NoneType' object has no attribute 'id'", "two"]
