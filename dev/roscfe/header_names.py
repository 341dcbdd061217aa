"""The names that a node sees behind one #include, with Debian's ROS: `python -m dev.roscfe.header_names --write`.

Nodes rely on names that headers of ROS bring along, such as std::cout behind ros/ros.h. header_names.tsv lists, for
each header, the names that Debian's ROS 1 gives (libroscpp-dev and the other packages of its headers). The interface
library must give the same, except for `REASONS`.
"""

from __future__ import annotations

import argparse
import csv
import re
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from cfepy.extra.convert.cpp_sources import collect, message_types
from cfepy.extra.convert.message_headers import Profile, write_headers
from dev.roscfe.building import CPP, INCLUDE
from rospy_shim.types.msgs import shipped

LIST = Path(__file__).with_suffix(".tsv")
_HEADERS = (
    "XmlRpcValue.h actionlib/client/simple_action_client.h actionlib/server/simple_action_server.h "
    "message_filters/subscriber.h ros/node_handle.h ros/ros.h ros/service.h tf/tf.h "
    "tf/transform_broadcaster.h tf/transform_listener.h tf2_ros/buffer.h tf2_ros/static_transform_broadcaster.h "
    "tf2_ros/transform_broadcaster.h tf2_ros/transform_listener.h"
)
HEADERS = _HEADERS.split()
"""Headers that nodes include."""
_STD = (
    "abs accumulate all_of any array atomic back_inserter bad_alloc bitset boolalpha cerr cin clamp clog complex "
    "copy cos count cout deque dec distance domain_error endl exception fabs fill fill_n find find_if fixed flush "
    "for_each forward_list function getline greater hex hypot ifstream inner_product invalid_argument iota "
    "isalpha isfinite isinf isnan istringstream left less list localtime lock_guard locale logic_error make_pair "
    "make_shared make_tuple make_unique map max max_element memcpy memset min min_element minmax_element move "
    "multimap multiset mutex nan nth_element numeric_limits ofstream optional ostream ostringstream out_of_range "
    "pair partial_sum pow priority_queue queue random_device recursive_mutex regex remove_if replace reverse "
    "round runtime_error set setfill setprecision setw shared_ptr sin size_t sort sqrt stable_sort stack strcmp "
    "strcpy string stringstream strlen strtod strtol swap thread this_thread time time_t to_string tolower "
    "toupper transform tuple unique unique_lock unique_ptr unordered_map unordered_set upper_bound valarray "
    "vector weak_ptr"
)
_GLOBAL = (
    "abs access assert_ atan2 atof atoi ceil clock_gettime close cos errno_ exit fabs fflush floor fmod fopen "
    "free getcwd getenv gettimeofday int64_t isnan localtime malloc memcpy memset nanosleep open pow pthread_t "
    "printf puts rand random read signal sin size_t sleep snprintf sprintf sqrt srand stdout_ strcmp strcpy "
    "strdup strftime strlen strtod strtol time timespec timeval tolower uint8_t usleep write"
)
_BOOST = (
    "any array bad_lexical_cast bind condition_variable enable_shared_from_this function lexical_cast make_shared "
    "mutex noncopyable recursive_mutex ref scoped_ptr shared_array shared_mutex shared_ptr thread tuple "
    "unordered_map weak_ptr const_pointer_cast dynamic_pointer_cast static_pointer_cast"
)
_ROS = (
    "AdvertiseOptions AdvertiseServiceOptions AsyncSpinner CallbackInterface CallbackQueue CallbackQueueInterface "
    "Duration Exception InvalidNameException MessageEvent MultiThreadedSpinner NodeHandle NodeHandlePtr Publisher "
    "Rate ServiceCallbackHelper ServiceClient ServiceEvent ServiceServer SingleSubscriberPublisher SteadyTime "
    "SteadyTimer Subscriber SubscribeOptions Time Timer TimerEvent TimerOptions TransportHints VoidConstPtr "
    "VoidPtr V_string M_string WallDuration WallRate WallTime WallTimer WallTimerEvent getGlobalCallbackQueue "
    "init isInitialized isShuttingDown isStarted ok requestShutdown shutdown spin spinOnce start waitForShutdown "
    "init_options::NoSigintHandler master::check master::getNodes names::append names::clean names::resolve "
    "param::get param::param param::set service::call service::exists service::waitForService this_node::getName "
    "this_node::getNamespace topic::waitForMessage console::set_logger_level console::notifyLoggerLevelsChanged"
)
_OTHERS = (
    "XmlRpc::XmlRpcException XmlRpc::XmlRpcValue tf::Matrix3x3 tf::Point tf::Pose tf::Quaternion tf::Stamped "
    "tf::StampedTransform tf::Transform tf::TransformBroadcaster tf::TransformException tf::TransformListener "
    "tf::Vector3 tf::createQuaternionFromYaw tf::createQuaternionMsgFromYaw tf::getYaw tf::poseMsgToTF "
    "tf::quaternionMsgToTF tf::resolve tf2::BufferCore tf2::LookupException tf2::Matrix3x3 tf2::Quaternion "
    "tf2::Stamped tf2::Transform tf2::TransformException tf2::Vector3 tf2::convert tf2::doTransform tf2::fromMsg "
    "tf2::getYaw tf2::toMsg tf2_ros::Buffer tf2_ros::TransformBroadcaster tf2_ros::TransformListener "
    "geometry_msgs::Point geometry_msgs::Pose geometry_msgs::PoseStamped geometry_msgs::Quaternion "
    "geometry_msgs::Transform geometry_msgs::TransformStamped geometry_msgs::Twist geometry_msgs::Vector3 "
    "std_msgs::Header std_msgs::String rosgraph_msgs::Log sensor_msgs::LaserScan sensor_msgs::PointCloud2 "
    "sensor_msgs::PointCloud tf2_msgs::TFMessage actionlib_msgs::GoalID actionlib::SimpleClientGoalState "
    "angles::normalize_angle"
)
_MACROS = (
    "M_PI NULL ROS_ASSERT ROS_INFO ROS_INFO_STREAM ROS_WARN_THROTTLE ROS_DEBUG_NAMED INT_MAX FLT_MAX DBL_MAX EOF assert"
)
NAMES = [
    *(f"std::{name}" for name in _STD.split()),
    *(f"::{name}" for name in _GLOBAL.split() if not name.endswith("_")),
    *(f"boost::{name}" for name in _BOOST.split()),
    *(f"ros::{name}" for name in _ROS.split()),
    *_OTHERS.split(),
]
"""Names that nodes use. A macro has no colon."""
MACROS = _MACROS.split()
_SMALL = "the small Boost does not have it; a node that includes its header gets this computer's Boost"
REASONS = {
    **dict.fromkeys(("boost::tuple", "boost::unordered_map"), _SMALL),
    "ros::ServiceCallbackHelper": "a class of roscpp's own implementation",
    "ros::master::getNodes": "the nodes of a mission are known to cfepy alone",
}
"""Why the interface library does not give a name."""
_FOLDERS = ("xmlrpcpp", "angles", "pluginlib", "class_loader", "rcpputils", "rcutils")
DEBIAN = (*(f"-I/usr/include/{each}" for each in _FOLDERS), "-DBOOST_BIND_GLOBAL_PLACEHOLDERS")
_ERROR = re.compile(r"^<stdin>:(\d+):\d+: (?:fatal )?error: ", re.MULTILINE)


def program(header: str) -> str:
    """Return a program that uses each name in its own line: the header is in line 1, the first name in line 2."""
    lines = [f"#include <{header}>"]
    lines += [f"namespace probe_{at} {{ using {name}; }}" for at, name in enumerate(NAMES)]
    marks = [f"#ifndef {name}\n#error\n#endif" for name in MACROS]
    return "\n".join([*lines, *marks]) + "\n"


def seen(header: str, folders: Sequence[str]) -> list[str]:
    """Return the names that a node sees behind a header; empty if there is no such header.

    Args:
        header: as it is included.
        folders: flags of the compiler.
    """
    command = [*CPP, "-std=c++17", "-w", "-fsyntax-only", "-fmax-errors=0", *folders, "-x", "c++", "-"]
    done = subprocess.run(
        command, input=program(header), capture_output=True, text=True, check=False, env={"PATH": "/usr/bin:/bin"}
    )
    wrong = {int(line) for line in _ERROR.findall(done.stderr)}
    if 1 in wrong:
        return []
    found = [name for line, name in enumerate(NAMES, 2) if line not in wrong]
    start = 2 + len(NAMES)
    return found + [name for at, name in enumerate(MACROS) if start + 3 * at + 1 not in wrong]


def our_folders(headers: Iterable[str], made: Path) -> list[str]:
    """Return the flags for the interface library, with the headers of all messages that its headers include."""
    folders = [Path(each.removeprefix("-I")) for each in INCLUDE]
    files = [folders[0] / each for each in headers]
    write_headers(message_types(collect(files, folders).missing, shipped()), made, Profile.HOST, shipped())
    return [*INCLUDE, f"-I{made}", "-DROSCFE_PROFILE_HOST"]


def listed() -> dict[str, list[str]]:
    """Return the names that Debian's ROS gives, by header."""
    with LIST.open(encoding="utf-8", newline="") as stream:
        return {row["header"]: row["names"].split() for row in csv.DictReader(stream, delimiter="\t")}


def lacking(header: str, names: Iterable[str], folders: Sequence[str]) -> list[str]:
    """Return the names that the interface library does not give behind a header, without the names in `REASONS`."""
    ours = set(seen(header, folders))
    return [name for name in names if name not in ours and name not in REASONS]


def main() -> None:
    """Compare all headers, and write the list."""
    parser = argparse.ArgumentParser(prog="python -m dev.roscfe.header_names", description=__doc__)
    parser.add_argument("--write", action="store_true", help=f"write {LIST.name} with the installed ROS")
    arguments = parser.parse_args()
    if arguments.write:
        with ThreadPoolExecutor(2) as pool:
            names = list(pool.map(lambda each: seen(each, DEBIAN), HEADERS))
        with LIST.open("w", encoding="utf-8", newline="") as stream:
            writer = csv.writer(stream, delimiter="\t", lineterminator="\n")
            writer.writerows([("header", "names"), *zip(HEADERS, map(" ".join, names), strict=True)])
    with tempfile.TemporaryDirectory() as made:
        folders = our_folders(HEADERS, Path(made))
        for header, known in listed().items():
            print(f"{header}: {len(known)} names, without {' '.join(lacking(header, known, folders)) or 'exception'}")


if __name__ == "__main__":
    main()
