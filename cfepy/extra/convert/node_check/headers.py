"""The origin of a header by its name alone: the closed list of includes for a convertible node.

The names of ROS's and other headers are facts of their projects. A header of the interface library is one whose file
exists.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from cfepy.extra.convert.build import library_includes
from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.source_names import includes_of, without_comments
from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import CPP_BYTES

OURS, *OUR_BOOST = library_includes()
SYSTEM = Path("/usr/include")
_NAMES = {
    "c++": "algorithm any array atomic bitset cassert ccomplex cctype cerrno cfenv cfloat charconv chrono cinttypes "
    "ciso646 climits clocale cmath codecvt complex condition_variable csetjmp csignal cstdalign cstdarg "
    "cstdbool cstddef cstdint cstdio cstdlib cstring ctgmath ctime cuchar cwchar cwctype deque exception "
    "execution filesystem forward_list fstream functional future initializer_list iomanip ios iosfwd iostream "
    "istream iterator limits list locale map memory memory_resource mutex new numeric optional ostream queue "
    "random ratio regex scoped_allocator set shared_mutex sstream stack stdexcept streambuf string "
    "string_view strstream system_error thread tuple type_traits typeindex typeinfo unordered_map "
    "unordered_set utility valarray variant vector version",
    "c": "assert complex ctype errno fenv float inttypes iso646 limits locale math memory setjmp signal stdalign "
    "stdarg stdbool stddef stdint stdio stdlib string strings tgmath time uchar values wchar wctype aio "
    "arpa/inet cpio cxxabi dirent dlfcn endian execinfo fcntl fnmatch ftw getopt glob grp ifaddrs langinfo "
    "libgen libio malloc monetary mqueue net/if net/if_arp netdb netinet/in netinet/tcp netinet/udp nl_types "
    "poll pthread pwd regex sched search semaphore spawn sys/epoll sys/eventfd sys/file sys/io sys/ioctl "
    "sys/ipc sys/mman sys/msg sys/param sys/poll sys/resource sys/select sys/sem sys/shm sys/signal "
    "sys/socket sys/stat sys/statvfs sys/sysinfo sys/time sys/timeb sys/times sys/timerfd sys/types sys/uio "
    "sys/un sys/utsname sys/wait syslog tar termio termios unistd utime wordexp linux/can linux/i2c-dev "
    "linux/i2c linux/input linux/joystick linux/serial linux/types linux/spi/spidev",
    "boost": "algorithm/clamp.hpp algorithm/string.hpp algorithm/string/classification.hpp algorithm/string/join.hpp "
    "algorithm/string/predicate.hpp algorithm/string/replace.hpp algorithm/string/split.hpp "
    "algorithm/string/trim.hpp any.hpp array.hpp asio.hpp asio/deadline_timer.hpp asio/io_service.hpp "
    "asio/serial_port.hpp assign.hpp assign/list_of.hpp assign/std/vector.hpp atomic.hpp bimap.hpp bind.hpp "
    "bind/bind.hpp chrono.hpp circular_buffer.hpp config.hpp crc.hpp date_time.hpp "
    "date_time/local_time/local_time.hpp date_time/posix_time/posix_time.hpp "
    "date_time/posix_time/posix_time_types.hpp detail/endian.hpp dynamic_bitset.hpp "
    "enable_shared_from_this.hpp endian/conversion.hpp exception/all.hpp filesystem.hpp "
    "filesystem/operations.hpp filesystem/path.hpp foreach.hpp format.hpp function.hpp functional/hash.hpp "
    "geometry.hpp heap/fibonacci_heap.hpp intrusive_ptr.hpp io/ios_state.hpp iostreams/stream.hpp "
    "interprocess/sync/scoped_lock.hpp iterator/iterator_facade.hpp lexical_cast.hpp lockfree/queue.hpp "
    "lockfree/spsc_queue.hpp make_shared.hpp math/constants/constants.hpp math/distributions/normal.hpp "
    "math/special_functions/fpclassify.hpp math/special_functions/round.hpp math/special_functions/sign.hpp "
    "mpl/and.hpp mpl/bool.hpp mpl/if.hpp multi_array.hpp multi_index_container.hpp noncopyable.hpp "
    "numeric/odeint.hpp numeric/ublas/matrix.hpp numeric/ublas/vector.hpp optional.hpp pointer_cast.hpp "
    "polygon/polygon.hpp pool/pool_alloc.hpp predef/other/endian.h program_options.hpp "
    "property_tree/ptree.hpp property_tree/xml_parser.hpp ptr_container/ptr_vector.hpp python.hpp random.hpp "
    "range/adaptor/map.hpp range/algorithm.hpp ref.hpp regex.hpp scope_exit.hpp scoped_array.hpp "
    "scoped_ptr.hpp serialization/access.hpp shared_array.hpp shared_ptr.hpp signals2.hpp signals2/signal.hpp "
    "smart_ptr.hpp spirit/include/qi.hpp static_assert.hpp system/error_code.hpp thread.hpp "
    "thread/condition.hpp thread/condition_variable.hpp thread/lock_guard.hpp thread/locks.hpp "
    "thread/mutex.hpp thread/once.hpp thread/pthread/mutex.hpp thread/recursive_mutex.hpp "
    "thread/shared_mutex.hpp thread/thread.hpp thread/thread_time.hpp thread/tss.hpp timer.hpp "
    "timer/timer.hpp tokenizer.hpp tuple/tuple.hpp type_traits.hpp type_traits/is_same.hpp typeof/typeof.hpp "
    "unordered_map.hpp unordered_set.hpp utility.hpp utility/enable_if.hpp uuid/random_generator.hpp "
    "uuid/uuid.hpp uuid/uuid_generators.hpp uuid/uuid_io.hpp variant.hpp version.hpp weak_ptr.hpp",
    "outside": "OGRE OgreVector3.h SDL btBulletDynamicsCommon.h bullet ceres cv.h ecl fcl franka gazebo geographiclib "
    "GeographicLib GL glog google gtest gsl ignition kdl ncurses.h curses.h nlopt octomap opencv opencv2 "
    "openssl pcl pcl_conversions pcl_ros pangolin phidget22.h qpOASES qpOASES.hpp sdf sdformat tinyxml.h "
    "tinyxml2.h urdf yaml-cpp zmq.hpp libfreenect libusb.h",
}
"""Names from the standards and projects; C headers without `.h`."""
STANDARD = frozenset(_NAMES["c++"].split())
"""Headers of C++17."""
C_HEADERS = frozenset(f"{name}.h" for name in _NAMES["c"].split())
"""Headers of C and of POSIX. A listed header does not mean that its functions may be called."""
ROS_LIBRARIES: dict[str, str] = {
    "actionlib": "client/action_client client/client_goal_handle_imp client/client_helpers client/comm_state "
    "client/service_client client/simple_action_client client/simple_client_goal_state client/terminal_state "
    "server/action_server server/action_server_base server/server_goal_handle server/service_server "
    "server/simple_action_server server/status_tracker action_definition client_goal_status goal_id_generator",
    "angles": "angles",
    "bondcpp": "bond",
    "camera_info_manager": "camera_info_manager",
    "class_loader": "class_loader multi_library_class_loader register_macro",
    "control_toolbox": "pid",
    "controller_interface": "controller controller_base multi_interface_controller",
    "controller_manager": "controller_manager",
    "costmap_2d": "costmap_2d costmap_2d_ros layer footprint",
    "cv_bridge": "cv_bridge",
    "diagnostic_updater": "diagnostic_updater publisher update_functions DiagnosticStatusWrapper",
    "dynamic_reconfigure": "server client config_init_mutex config_tools",
    "eigen_conversions": "eigen_msg eigen_kdl",
    "filters": "filter_base.h filter_chain.h",
    "hardware_interface": "robot_hw joint_command_interface joint_state_interface imu_sensor_interface robot_hw",
    "image_geometry": "pinhole_camera_model stereo_camera_model",
    "image_transport": "image_transport camera_publisher camera_subscriber publisher subscriber subscriber_filter",
    "interactive_markers": "interactive_marker_server menu_handler interactive_marker_client tools",
    "joint_limits_interface": "joint_limits joint_limits_interface joint_limits_rosparam joint_limits_urdf",
    "kdl_parser": "kdl_parser.hpp",
    "laser_geometry": "laser_geometry",
    "message_filters": "cache chain connection message_event null_types pass_through signal1 signal9 simple_filter "
    "subscriber sync_policies/approximate_time sync_policies/exact_time synchronizer time_sequencer "
    "time_synchronizer",
    "moveit": "move_group_interface/move_group_interface",
    "nav_core": "base_global_planner base_local_planner recovery_behavior",
    "nodelet": "nodelet loader exception nodelet_topic_tools detail/callback_queue",
    "nodelet_topic_tools": "nodelet_lazy nodelet_mux nodelet_throttle",
    "pcl_conversions": "pcl_conversions",
    "pcl_ros": "point_cloud.h transforms.h",
    "pluginlib": "class_list_macros class_list_macros.hpp class_loader class_loader.hpp",
    "realtime_tools": "realtime_publisher realtime_buffer realtime_box realtime_clock",
    "robot_state_publisher": "robot_state_publisher joint_state_listener",
    "ros": "advertise_options advertise_service_options assert builtin_message_traits callback_queue "
    "callback_queue_interface common config_comm connection connection_manager console datatypes duration exception "
    "exceptions file_log forwards header init internal_timer_manager intraprocess_publisher_link io master "
    "message message_event message_forward message_operations message_traits names network node_handle "
    "package param parameter_adapter platform poll_manager poll_set publication publisher publisher_link rate ros "
    "ros_time rosout_appender rostime_decl serialization serialized_message service service_callback_helper "
    "service_client service_client_link service_client_options service_manager service_publication service_server "
    "service_server_link service_traits single_subscriber_publisher spinner static_assert statistics steady_timer "
    "steady_timer_options subscribe_options subscriber subscriber_link subscription subscription_callback_helper "
    "subscription_queue this_node time timer timer_manager timer_options topic topic_manager transport_hints types "
    "transport/transport transport/transport_tcp transport/transport_udp wall_timer wall_timer_options xmlrpc_manager",
    "rosbag": "bag buffer bag_player exceptions message_instance player query recorder rosbag_storage stream view",
    "rosconsole": "macros_generated",
    "roslib": "",
    "rosserial_server": "serial_session tcp_server udp_socket_session",
    "sensor_msgs": "",
    "serial": "serial",
    "tf": "LinearMath/Matrix3x3 LinearMath/Quaternion LinearMath/Transform LinearMath/Vector3 exceptions "
    "message_filter tf time_cache transform_broadcaster transform_datatypes transform_listener",
    "tf2": "LinearMath/Matrix3x3 LinearMath/Quaternion LinearMath/Transform LinearMath/Vector3 buffer_core convert "
    "exceptions impl/convert impl/utils time_cache transform_datatypes transform_storage utils",
    "tf2_eigen": "tf2_eigen",
    "tf2_geometry_msgs": "tf2_geometry_msgs",
    "tf2_kdl": "tf2_kdl",
    "tf2_ros": "buffer buffer_client buffer_interface buffer_server message_filter static_transform_broadcaster "
    "transform_broadcaster transform_listener",
    "tf2_sensor_msgs": "tf2_sensor_msgs",
    "tf_conversions": "tf_eigen tf_kdl",
    "topic_tools": "shape_shifter macros parse",
    "transmission_interface": "transmission_interface transmission_interface_loader",
    "urdf": "model",
    "visualization_msgs": "",
    "xmlrpcpp": "XmlRpc XmlRpcClient XmlRpcDispatch XmlRpcException XmlRpcServer XmlRpcServerMethod XmlRpcSource "
    "XmlRpcUtil XmlRpcValue",
    "rviz": "panel display tool config",
    "rviz_visual_tools": "rviz_visual_tools",
}
"""Headers of ROS's libraries by package, without `.h`; those that the interface library lacks are refused by name."""
BOOST = tuple(_NAMES["boost"].split())
"""Headers of Boost that nodes include; those that the small Boost lacks are refused by name."""


OUTSIDE = frozenset(_NAMES["outside"].split())
"""Libraries from outside ROS that nodes use, by folder or header."""


def ros_headers() -> Iterator[str]:
    """Yield all known headers of ROS's libraries, such as "nodelet/nodelet.h"."""
    for package, names in ROS_LIBRARIES.items():
        for name in dict.fromkeys(names.split()):
            yield f"{package}/{name}" if name.endswith((".h", ".hpp")) else f"{package}/{name}.h"


def is_standard(name: str) -> bool:
    """Return True if a header belongs to C++, C or POSIX."""
    return name in STANDARD or name in C_HEADERS or name.startswith(("bits/", "asm/", "linux/"))


def is_ours(name: str) -> bool:
    """Return True if a header is the interface library's."""
    return is_file(OURS / name)


def is_small_boost(name: str) -> bool:
    """Return True if a header of Boost is in the small one of the interface library."""
    return any(is_file(folder / name) for folder in OUR_BOOST)


def has_boost(name: str, profile: Profile) -> bool:
    """Return True if a profile has a header of Boost; the host profile has all installed ones."""
    return is_small_boost(name) or (profile is Profile.HOST and is_file(SYSTEM / name))


@cache
def behind_ours(name: str) -> tuple[str, ...]:
    """Return all headers that a header of the interface library includes, with nested ones, such as message headers."""
    found: dict[str, None] = {}
    waiting = [name]
    while waiting:
        file = OURS / waiting.pop()
        text = without_comments(text_limited(file, CPP_BYTES)) if is_file(file) else ""
        new = [each for each in includes_of(text) if each not in found]
        found |= dict.fromkeys(new)
        waiting += new
    return tuple(found)


def is_eigen(name: str) -> bool:
    """Return True if a header is Eigen's, which has no parts to link."""
    return name.startswith(("Eigen/", "eigen3/Eigen/", "unsupported/Eigen/"))


def is_outside(name: str) -> bool:
    """Return True if a header belongs to a library from outside ROS: a known one, Qt, or an installed one."""
    folder = name.partition("/")[0]
    is_qt = name[:1] == "Q" and name[1:2].isupper() and "." not in name
    return folder in OUTSIDE or is_qt or folder.startswith("Qt") or is_file(SYSTEM / name)


def has_eigen() -> bool:
    """Return True if Eigen's headers are on this computer."""
    return is_file(SYSTEM / "eigen3" / "Eigen" / "Core")


def is_file(path: Path) -> bool:
    """Return True if a file exists. False if the name is not a legal path."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def refused_headers(real_boost: bool) -> dict[str, str]:
    """Return the refused headers, each with its rule: headers of ROS and Boost, known or installed here.

    Args:
        real_boost: whether the computer's Boost is used.
    """
    installed = (name for folder in _installed() for name in _headers_in(folder))
    found = {name: "ros-library" for name in (*ros_headers(), *installed) if not is_ours(name)}
    if not real_boost:
        found |= {f"boost/{name}": "boost-header" for name in BOOST if not is_small_boost(f"boost/{name}")}
    return found


def is_of_ros(folder: str) -> bool:
    """Return True if a folder of headers is a ROS package's."""
    return folder in ROS_LIBRARIES or folder.endswith(("_msgs", "_srvs")) or folder == "roscpp"


def _installed() -> list[Path]:
    """Return folders with the headers of a ROS on this computer."""
    try:
        return sorted(each for each in SYSTEM.iterdir() if is_of_ros(each.name) and each.is_dir())
    except OSError:
        return []


def _headers_in(folder: Path) -> Iterator[str]:
    for path, _, names in os.walk(folder):
        yield from (str((Path(path) / name).relative_to(SYSTEM)) for name in names if name.endswith((".h", ".hpp")))


def write_refusals(folder: Path, real_boost: bool) -> list[str]:
    """Write the headers that refuse.

    They come on the include path after the interface library, so that a ROS on this computer never fills a gap in it.

    Args:
        folder: receives them; it goes on the include path after all others.
        real_boost: whether the computer's Boost is used.

    Returns:
        Their names, sorted.
    """
    refused = refused_headers(real_boost)
    for name, rule in refused.items():
        write_refusal(folder / name, f"{name} is not supported", rule)
    return sorted(refused)


def write_refusal(file: Path, why: str, rule: str) -> None:
    """Write a header that refuses, with the rule after the text."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(refusal(why, rule), encoding="utf-8")


def refusal(why: str, rule: str) -> str:
    """Return the text of a header that refuses."""
    text = why.replace("\n", " ").replace('"', "'")
    return f'#error "roscfe: {text} [{rule}]"\n'
