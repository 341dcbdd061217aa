"""Messages, services and actions that a user brings along, as libraries and inside a node."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

from cfepy.ground.topics import Topic
from cfepy.status import UsageError
from rospy_shim.types.config import NodeConfig
from rospy_shim.types.msgs import Library, OnDisk, Packages, message_class, service_class, shipped
from tests.rospy_shim.missions import run_nodes


def write(folder: Path, **files: str) -> None:
    """Write definitions; "msg__Drive" is msg/Drive.msg."""
    for key, text in files.items():
        kind, _, name = key.partition("__")
        (folder / kind).mkdir(parents=True, exist_ok=True)
        (folder / kind / f"{name}.{kind}").write_text(text, encoding="utf-8")


def library_of(root: Path) -> Library:
    """Return the library of a node whose packages are in a folder."""
    for folder in root.iterdir():
        (folder / "package.xml").touch()
    return Library([OnDisk(Packages(None, {"ROS_PACKAGE_PATH": str(root)}))], base=shipped())


def test_messages_and_services(tmp_path: Path) -> None:
    drive = "Header header\nWheel[] wheels\ngeometry_msgs/Point goal\n"
    write(tmp_path / "rover", msg__Wheel="float64 speed\n", msg__Drive=drive, srv__Stop="bool now\n---\nWheel last\n")
    library = library_of(tmp_path)
    wheel = library.message_class("rover/Wheel")
    made = library.message_class("rover/Drive")(wheels=[wheel(1.5), wheel(2.5)])
    assert [each.speed for each in made.__unpack__(made.__pack__()).wheels] == [1.5, 2.5]
    assert library.service_class("rover/Stop")._response_class().last.speed == 0.0
    assert library.names("rover") == ["Drive", "Wheel"]
    assert {"rover", "std_msgs"} <= set(library.packages())
    assert wheel.__module__ == "rover.msg._Wheel"


def test_action_has_the_messages_of_actionlib(tmp_path: Path) -> None:
    action = "# how far\nint32 goal # in m\n---\nint32 result\n---\nint32 feedback\n"
    write(tmp_path / "actionlib", action__Test=action)
    library = library_of(tmp_path)
    names = [f"actionlib/{name}" for name in library.names("actionlib") or ()]
    assert [name for name in names if not shipped().has(name)] == []
    assert [library.md5sum(name) for name in names] == [shipped().md5sum(name) for name in names]
    assert len(names) == 7


def test_classes_of_a_node_belong_to_the_node(tmp_path: Path) -> None:
    write(tmp_path / "rover", msg__Drive="geometry_msgs/Point goal\n")
    library = library_of(tmp_path)
    own, shared = library.message_class("nav_msgs/Odometry"), message_class("nav_msgs/Odometry")
    assert own is not shared
    assert (own._md5sum, own._full_text) == (shared._md5sum, shared._full_text)
    assert library.service_class("std_srvs/SetBool") is not service_class("std_srvs/SetBool")
    assert type(library.message_class("rover/Drive")().goal) is library.message_class("geometry_msgs/Point")
    assert type(own.__unpack__(shared().__pack__()).pose.pose.position) is library.message_class("geometry_msgs/Point")


def test_package_of_the_same_name_has_precedence_everywhere(tmp_path: Path) -> None:
    write(tmp_path / "uuid_msgs", msg__UniqueID="string text\n")
    library = library_of(tmp_path)
    way_point = library.message_class("geographic_msgs/WayPoint")
    assert way_point().id.__slots__ == ["text"]
    assert way_point._md5sum != message_class("geographic_msgs/WayPoint")._md5sum
    assert library.service_class("geographic_msgs/GetRoutePlan") is not service_class("geographic_msgs/GetRoutePlan")
    assert library.md5sum("geographic_msgs/GeoPoint") == shipped().md5sum("geographic_msgs/GeoPoint")


@pytest.mark.parametrize(
    ("files", "wanted", "place"),
    [
        ({"msg__A": "int8 x\n\nint8 X-\n"}, "A", r"msg/A\.msg:3: 'X-' is not a field name"),
        ({"msg__A": "int8 x\nNowhere y\n"}, "A", r"msg/A\.msg:2: unknown message type rover/Nowhere"),
        ({"srv__S": "int8 x\n---\nint8\n"}, "SResponse", r"srv/S\.srv:3: 'int8' is not a field"),
        ({"action__Go": "int8 x\n---\n---\nfloat y\n"}, "GoFeedback", r"action/Go\.action:4: .*rover/float"),
        (
            {"action__Go": "int8 x\n---\nint8 y\n"},
            "GoGoal",
            r"action/Go\.action:3: an action must have 3 parts .*, not 2",
        ),
        ({"action__Go": "\n---\n---\n---\n"}, "GoGoal", r"action/Go\.action:5: an action must have 3 parts .*, not 4"),
    ],
)
def test_mistakes_name_file_and_line(tmp_path: Path, files: dict[str, str], wanted: str, place: str) -> None:
    write(tmp_path / "rover", **files)
    with pytest.raises(UsageError, match=place):
        library_of(tmp_path).message_class(f"rover/{wanted}")


def test_third_part_of_a_service_is_ignored(tmp_path: Path) -> None:
    write(tmp_path / "rover", srv__S="int8 x\n--- # answer\nint8 y\n---\nint8 z\n", srv__T="int8 only\n")
    library = library_of(tmp_path)
    assert library.service_class("rover/S")._response_class.__slots__ == ["y", "z"]
    assert library.service_class("rover/T")._response_class.__slots__ == []


def test_old_encodings_are_accepted_in_comments(tmp_path: Path) -> None:
    write(tmp_path / "rover", msg__A="")
    (tmp_path / "rover" / "msg" / "A.msg").write_bytes(b"float32 heat # \xb0C\r\n")
    assert library_of(tmp_path).message_class("rover/A").__slots__ == ["heat"]


NODE = """
import copy, pickle
import rospy
from rover_msgs.msg import Drive, GoActionGoal
from rover_msgs.srv import Stop, StopResponse
import rover
from std_msgs.msg import Header
from genpy.message import get_message_class

rospy.init_node("rover")
drive = Drive(speed=2.5)
print(Drive._md5sum, Drive._type, rospy.Header is Header)
print(copy.deepcopy(drive) == drive, pickle.loads(pickle.dumps(drive)) == drive)
print(get_message_class("rover_msgs/Drive") is Drive, rover.WHEELS)
rospy.Service("stop", Stop, lambda request: StopResponse(request.hard))
rospy.Subscriber("drive", Drive, lambda message: print("got", message.speed))
publisher = rospy.Publisher("drive", Drive, queue_size=1)
rospy.sleep(0.2)
publisher.publish(drive)
print(rospy.ServiceProxy("stop", Stop)(True).done)
rospy.sleep(0.2)
"""


def test_inside_a_node(tmp_path: Path) -> None:
    workspace, mission = tmp_path / "ws", tmp_path / "mission"
    write(
        workspace / "rover_msgs", msg__Drive="Header header\nfloat64 speed\n", srv__Stop="bool hard\n---\nbool done\n"
    )
    write(workspace / "rover_msgs", action__Go="int8 a\n---\n---\n")
    code = workspace / "rover" / "src" / "rover"
    code.mkdir(parents=True)
    (code / "__init__.py").write_text("WHEELS = 6\n", encoding="utf-8")
    for package in ("rover", "rover_msgs"):
        (workspace / package / "package.xml").write_text(f"<package><name>{package}</name></package>", encoding="utf-8")
    mission.mkdir()
    nodes = {"DRIVER": NodeConfig("DRIVER", env={"ROS_PACKAGE_PATH": "../ws"})}
    run = run_nodes(mission, {"DRIVER": NODE}, nodes=nodes)
    assert run.printed["rover"] == [
        "17b1dfb61067b5181d2fbfcebd547b10 rover_msgs/Drive True",
        "True True",
        "True 6",
        "got 2.5",
        "True",
    ]


def test_package_next_to_the_node_has_code_and_messages(tmp_path: Path) -> None:
    write(tmp_path / "arm", msg__Joint="float64 angle\n")
    (tmp_path / "arm" / "__init__.py").write_text("from arm.msg import Joint\n\nhome = Joint(0.5)\n", encoding="utf-8")
    run = run_nodes(tmp_path, {"ARM": "from arm import home\nprint(home)\n"})
    assert run.printed["ARM"] == ["angle: 0.5"]


def test_mistake_ends_the_node_with_its_line(tmp_path: Path) -> None:
    write(tmp_path / "arm", msg__Joint="float64 angle\nfloat64\n")
    printed = run_nodes(tmp_path, {"ARM": "from arm.msg import Joint\n"}).printed["ARM"]
    assert "arm/msg/Joint.msg:2: 'float64' is not a field" in printed[-1]
    assert {line.split('"')[1] for line in printed if "  File " in line} == {str(tmp_path / "arm.py")}


def test_tools_read_the_topics_of_user_types(tmp_path: Path) -> None:
    write(tmp_path / "rover_msgs", msg__Drive="float64 speed\n")
    node = """
    import rospy
    from rover_msgs.msg import Drive
    rospy.init_node("rover")
    rospy.Publisher("drive", Drive, queue_size=1)
    """
    row = run_nodes(tmp_path, {"ROVER": node}).topics["/drive"]
    topic = Topic(row.name, row.msg_id, row.type, definition=row.definition)
    header = bytes.fromhex("0901c000000f") + bytes(10)
    assert topic.read(header + struct.pack("<d", 2.5)) == {"speed": 2.5}
