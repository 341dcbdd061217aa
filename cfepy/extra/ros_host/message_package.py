"""A catkin package of the external message types of telemetry, so that ROS's tools know them by name.

A message from a connection or a bag brings its definition along. rostopic echo and nodes that subscribe need the type
to be built (wiki.ros.org/msg, wiki.ros.org/catkin/package.xml, wiki.ros.org/catkin/CMakeLists.txt).
"""

from __future__ import annotations

from collections.abc import Iterable

from cfepy.ground import PACKAGE, definitions_of
from cfepy.msg import Telemetry
from cfepy.writing.markup import escaped


def telemetry_package(telemetry: Iterable[Telemetry], mission: str) -> dict[str, str]:
    """Make the files of the package.

    Args:
        telemetry: the packets; those without fields have no type.
        mission: its name.

    Returns:
        The texts of the files by their paths in the package's folder.
    """
    messages: dict[str, str] = {}
    for each in telemetry:
        if each.payload.size:
            messages |= definitions_of(each.name, each.payload)
    names = "\n".join(f"  {name}.msg" for name in sorted(messages))
    files = {f"msg/{name}.msg": text for name, text in sorted(messages.items())}
    return {
        "package.xml": _MANIFEST.format(package=PACKAGE, mission=escaped(mission)),
        "CMakeLists.txt": _BUILD.format(package=PACKAGE, names=names),
        **files,
    }


_MANIFEST = """\
<?xml version="1.0"?>
<package format="2">
  <name>{package}</name>
  <version>0.0.0</version>
  <description>Telemetry of {mission} as ROS messages</description>
  <maintainer email="nobody@example.org">nobody</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>catkin</buildtool_depend>
  <build_depend>message_generation</build_depend>
  <build_depend>std_msgs</build_depend>
  <exec_depend>message_runtime</exec_depend>
  <exec_depend>std_msgs</exec_depend>
</package>
"""
_BUILD = """\
cmake_minimum_required(VERSION 3.0.2)
project({package})
find_package(catkin REQUIRED COMPONENTS message_generation std_msgs)
add_message_files(FILES
{names}
)
generate_messages(DEPENDENCIES std_msgs)
catkin_package(CATKIN_DEPENDS message_runtime std_msgs)
"""
