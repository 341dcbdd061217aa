"""rospkg and roslib: packages, manifests and files, also from the folders of message definitions."""

from __future__ import annotations

from pathlib import Path

from rospy_shim.types.config import NodeConfig
from tests.rospy_shim.missions import run_nodes

PACKAGE = """<?xml version="1.0"?>
<package format="2">
  <name>{name}</name><version>1.2.3</version><description>what it is</description>
  <maintainer email="a@b.c">Ann</maintainer><author>Bob</author><license>BSD</license><url>http://u</url>
  {depends}
  <export>{exports}</export>
</package>
"""


def packages(folder: Path) -> None:
    """A workspace of a few packages on ROS_PACKAGE_PATH."""
    for name, depends, exports in (
        ("arm", "<depend>hand</depend><exec_depend>std_msgs</exec_depend>", ""),
        ("hand", "<build_depend>finger</build_depend>", '<nodelet plugin="${prefix}/plugin.xml"/>'),
        ("finger", "", ""),
        ("robot", "<exec_depend>arm</exec_depend>", "<metapackage/>"),
    ):
        place = folder / "src" / name
        place.mkdir(parents=True)
        (place / "package.xml").write_text(
            PACKAGE.format(name=name, depends=depends, exports=exports), encoding="utf-8"
        )
    (folder / "src/arm/msg").mkdir()
    (folder / "src/arm/msg/Joint.msg").write_text(
        "# a joint\nint32 A=1 # one\nHeader header\nfloat64[3] angles\n", encoding="utf-8"
    )
    (folder / "src/arm/srv").mkdir()
    (folder / "src/arm/srv/Move.srv").write_text("arm/Joint goal\n---\nbool done\n", encoding="utf-8")
    (folder / "src/arm/scripts").mkdir()
    script = folder / "src/arm/scripts/run.py"
    script.write_text("", encoding="utf-8")
    script.chmod(0o755)
    (folder / "src/arm/scripts/data.txt").write_text("x", encoding="utf-8")
    old = folder / "src/old"
    (old / "src").mkdir(parents=True)
    (old / "manifest.xml").write_text(
        '<package><description brief="short">old</description><author>Cid</author><license>BSD</license>'
        '<review status="ok" notes=""/><depend package="arm"/><rosdep name="python"/></package>',
        encoding="utf-8",
    )
    (old / "src/oldcode.py").write_text("value = 5\n", encoding="utf-8")


def said(folder: Path, script: str) -> list[str]:
    """Return the output of a node that sees the packages."""
    packages(folder)
    nodes = {"NODE": NodeConfig("NODE", env={"ROS_PACKAGE_PATH": str(folder / "src"), "HOME": "/home/me"})}
    return run_nodes(folder, {"NODE": script}, seconds=1, nodes=nodes).printed["NODE"]


def test_packages(tmp_path: Path) -> None:
    script = """
        import os, rospkg
        packages = rospkg.RosPack()
        print(sorted(packages.list()), os.path.basename(packages.get_path("arm")))
        print(packages.get_depends("robot"), packages.get_depends("robot", implicit=False))
        print(sorted(packages.get_depends_on("finger")), packages.get_depends_on("finger", implicit=False))
        print(packages.get_rosdeps("robot"), packages.get_rosdeps("old", implicit=False))
        found = packages.get_manifest("arm")
        print(found.version, found.license, found.description, found.author, found.url, found.is_catkin)
        hand = packages.get_manifest("hand")
        print(hand.get_export("nodelet", "plugin") == [packages.get_path("hand") + "/plugin.xml"])
        print(hand.get_export("nodelet", "plugin", convert=False))
        old = packages.get_manifest("old")
        print(old.brief, old.status, old.author, [d.name for d in old.depends], old.rosdeps[0].name, old.is_catkin)
        for name in ("nothing", "std_msgs"):
            try:
                packages.get_path(name)
            except rospkg.ResourceNotFound as error:
                print(type(error).__name__, error.args[0], str(error).splitlines()[1].split("=")[0])
        print(rospkg.RosPack(["/nowhere"]).list(), rospkg.RosPack([packages.get_path("arm")]).list())
        print(rospkg.RosPack.get_instance() is rospkg.RosPack.get_instance())
        print(rospkg.get_package_name(packages.get_path("arm") + "/msg/x"))
        stacks = rospkg.RosStack()
        print(stacks.list(), rospkg.expand_to_packages(["arm", "none"], packages, stacks))
        print(rospkg.get_log_dir(), rospkg.get_ros_home(), rospkg.get_test_results_dir(), rospkg.get_ros_root())
        print(rospkg.on_ros_path(packages.get_path("arm")), rospkg.on_ros_path("/nowhere"))
        print(rospkg.get_ros_paths() == packages.ros_paths)
    """
    assert said(tmp_path, script) == [
        "['arm', 'finger', 'hand', 'old', 'robot'] arm",
        "['arm', 'hand', 'finger'] ['arm']",
        "['arm', 'hand', 'old', 'robot'] ['hand']",
        "['std_msgs'] ['python']",
        "1.2.3 BSD what it is Maintainer: Ann <a@b.c>, Bob http://u True",
        "True",
        "['${prefix}/plugin.xml']",
        "short ok Cid ['arm'] python False",
        "ResourceNotFound nothing ROS path [0]",
        "ResourceNotFound std_msgs ROS path [0]",
        "[] ['arm']",
        "True",
        "arm",
        "['robot'] (['arm'], ['none'])",
        "/home/me/.ros/log /home/me/.ros /home/me/.ros/test_results /opt/ros/noetic/share/ros",
        "True False",
        "True",
    ]


def test_definitions_of_packages(tmp_path: Path) -> None:
    script = """
        import rosmsg, rospkg, roslib.gentools, roslib.msgs, roslib.srvs
        print(rosmsg.get_msg_text("arm/Joint").split())
        print(repr(rosmsg.get_msg_text("arm/Joint", raw=True)))
        print(rosmsg.get_srv_text("arm/Move").splitlines()[-2:], repr(rosmsg.get_srv_text("arm/Move", raw=True)))
        print(rosmsg.list_msgs("arm"), rosmsg.list_srvs("arm"), rosmsg.list_srvs("finger"))
        found = rosmsg.iterate_packages(rospkg.RosPack(), rosmsg.MODE_MSG)
        print([package for package, place in found if place.endswith("arm/msg")])
        print(list(rosmsg.rosmsg_search(rospkg.RosPack(), rosmsg.MODE_SRV, "Move")))
        for wrong in (lambda: rosmsg.list_msgs("none"), lambda: rosmsg.get_msg_text("arm/None", raw=True)):
            try:
                wrong()
            except (rospkg.ResourceNotFound, rosmsg.ROSMsgException) as error:
                print(type(error).__name__)
        name, spec = roslib.msgs.load_by_type("arm/Joint")
        print(name, spec.fields(), spec.constants, spec.has_header(), [f.is_array for f in spec.parsed_fields()])
        needed = roslib.gentools.get_dependencies(spec, "arm", compute_files=False)
        print(needed["uniquedeps"], roslib.gentools.compute_md5(needed) == __import__("arm.msg").msg.Joint._md5sum)
        print(len(roslib.gentools.compute_full_text(needed).split("MSG: ")))
        spec = roslib.srvs.load_from_string("int8 a\\n---\\nint8 b\\n", "p", "p/S", "S")
        print(spec.request.names, spec.response.names, spec.response.full_name)
        print(rosmsg.get_yaml_for_msg(__import__("arm.msg").msg.Joint(), flow_style_=True))
    """
    header = ["std_msgs/Header", "header", "uint32", "seq", "time", "stamp", "string", "frame_id"]
    assert said(tmp_path, script) == [
        str(["int32", "A=1", *header, "float64[3]", "angles"]),
        repr("# a joint\nint32 A=1 # one\nHeader header\nfloat64[3] angles\n"),
        "['---', 'bool done'] " + repr("arm/Joint goal\n---\nbool done\n"),
        "['arm/Joint'] ['arm/Move'] []",
        "['arm']",
        "['arm/Move']",
        "ResourceNotFound",
        "ROSMsgException",
        "arm/Joint [('std_msgs/Header', 'header'), ('float64[3]', 'angles')] [int32 A=1] True [False, True]",
        "['std_msgs/Header'] True",
        "2",
        "['a'] ['b'] p/SResponse",
        "{header: {seq: 0, stamp: {secs: 0, nsecs: 0}, frame_id: ''}, angles: [0.0, 0.0, 0.0]}",
    ]


def test_files_of_packages(tmp_path: Path) -> None:
    script = """
        import os, sys, roslib, roslib.packages, roslib.names, roslib.rosenv, roslib.resources, roslib.manifest, rospkg
        place = roslib.packages.get_pkg_dir("arm")
        print(os.path.basename(place), roslib.packages.get_pkg_dir("none", required=False))
        for wrong in ("get_pkg_dir", "resource_file"):
            try:
                getattr(roslib.packages, wrong)("none", *["a", "b"][: 2 * (wrong == "resource_file")])
            except roslib.packages.InvalidROSPkgException as error:
                print(str(error).split(":")[0])
        print([os.path.relpath(path, place) for path in roslib.packages.find_node("arm", "run.py")])
        print(roslib.packages.find_node("arm", "data.txt"))
        print([os.path.relpath(path, place) for path in roslib.packages.find_resource("arm", "data.txt")])
        file = roslib.packages.resource_file("arm", "msg", "J.msg")
        print(roslib.packages.get_dir_pkg(place + "/msg")[1], file == place + "/msg/J.msg")
        print(roslib.resources.list_package_resources("arm", False, "msg"), roslib.manifest.load_manifest("old").author)
        print(roslib.names.package_resource_name("a/b"), roslib.names.resource_name("a", "b"))
        print(roslib.names.is_legal_resource_name("1"), roslib.names.is_legal_resource_name("a/b"))
        roslib.load_manifest("old")
        import oldcode
        print(oldcode.value)
        roslib.launcher.load_manifest("std_msgs")
        roslib.launcher.load_manifest("tf")
        try:
            roslib.load_manifest("a_package_that_is_not_there")
        except rospkg.ResourceNotFound as error:
            print(error.args)
        print(roslib.is_interactive(), roslib.rosenv.get_master_uri())
    """
    assert said(tmp_path, script) == [
        "arm None",
        "Cannot locate installation of package none",
        "none",
        "['scripts/run.py']",
        "[]",
        "['scripts/data.txt']",
        "arm True",
        "['Joint.msg'] Cid",
        "('a', 'b') a/b",
        "False True",
        "5",
        "('a_package_that_is_not_there',)",
        "False http://cfepy:11311",
    ]


def test_rosenv_takes_the_master_from_environment_and_arguments(tmp_path: Path) -> None:
    script = """
        from roslib.rosenv import ROSEnvException, get_master_uri
        print(get_master_uri(False, {}), get_master_uri(True, {"ROS_MASTER_URI": "http://a:1"}))
        print(get_master_uri(False, {}, ["__master:=http://b:2"]))
        for argv in ([], ["__master:=http://b:2:=c"]):
            try:
                get_master_uri(True, {}, argv)
            except ROSEnvException as error:
                print(str(error).splitlines()[0])
    """
    assert said(tmp_path, script) == [
        "None http://a:1",
        "http://b:2",
        "The ROS_MASTER_URI environment variable has not been set.",
        "__master remapping argument '__master:=http://b:2:=c' improperly specified",
    ]


def test_definitions_and_loggers(tmp_path: Path) -> None:
    (tmp_path / "S.srv").write_text("int8 a\n---\n", encoding="utf-8")
    script = f"""
        import logging, roslib.srvs, rosgraph.roslogging
        print(roslib.srvs.load_from_file({str(tmp_path / "S.srv")!r}, "p/")[0])
        rosgraph.roslogging.configure_logging("tool", logging.WARNING)
        logger = logging.getLogger("rosout")
        print([type(each).__name__ for each in logger.handlers], logger.level)
        rosgraph.roslogging.configure_logging("tool", logging.INFO)
        print(len(logger.handlers))
    """
    assert said(tmp_path, script) == ["p/S", "['RosStreamHandler'] 30", "1"]


def test_distribution_comes_from_the_environment(tmp_path: Path) -> None:
    source = """
        import os
        import rospkg.distro
        print(rospkg.distro.current_distro_codename())
        os.environ["ROS_DISTRO"] = "melodic"
        print(rospkg.distro.current_distro_codename())
    """
    assert run_nodes(tmp_path, {"NODE": source}).printed["NODE"] == ["noetic", "melodic"]


def test_exports_have_the_name_used_by_flexbe(tmp_path: Path) -> None:
    script = """
        import rospkg
        print([(each.tag, sorted(each.attrs)) for each in rospkg.RosPack()._load_manifest("hand").exports])
    """
    assert said(tmp_path, script) == ["[('nodelet', ['plugin'])]"]
