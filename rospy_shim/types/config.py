"""The settings of a mission file for its ROS nodes and topics, as plain records.

The mission reads them and ROS's side uses them; neither imports the other.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

ROSCORE_PARAMS: Mapping[str, Any] = {
    "rosdistro": "noetic\n",
    "rosversion": "1.16.0\n",
    "run_id": "00000000-0000-1000-8000-000000000001",  # the same in every run
}
"""The parameters that roscore and roslaunch set on the parameter server, newlines included."""


@dataclass(frozen=True, slots=True)
class NodeConfig:
    """One ROS node: an application of the startup script whose entry symbol is `__main__`.

    `app` is its cFE name. `name` is the node name it gets unless the script has `__name:=`. `remap` maps names as on
    rosrun's command line. `params` are private parameters. `args` go to `sys.argv`, `env` to `os.environ`.
    `ordered_sets`: sets in its code iterate in insertion order; None takes the mission's setting for all nodes. `keys`
    are typed at its terminal: texts, and numbers of seconds to wait; None leaves it without a terminal. `script` is its
    program, `cwd` its working directory; None takes those of the mission's folder. `near` is a file near which its
    packages are, None for the script. `respawn`: it is started again `respawn_delay_ns` after its end. `required`: its
    end ends the run. `compute` is the computing time of its callbacks for a message of a topic, and of its handler for
    a request of a service, by name, in ns of virtual CPU time. `on_disk`: it writes files on the computer, not into the
    run's own files, as a tool of the user's. `ros` is the version of ROS that it is written for, 1 or 2; None takes the
    one that its package or its imports name. `executable` is the name of the node in the setup.py beside `script`
    (console_scripts); empty runs the script itself.
    """

    app: str
    name: str | None = None
    namespace: str = "/"
    remap: Mapping[str, str] = field(default_factory=dict)
    params: Mapping[str, Any] = field(default_factory=dict)
    args: tuple[str, ...] = ()
    env: Mapping[str, str] = field(default_factory=dict)
    ordered_sets: bool | None = None
    script: Path | None = None
    near: Path | None = None
    cwd: Path | None = None
    respawn: bool = False
    respawn_delay_ns: int = 0
    required: bool = False
    keys: tuple[str | float, ...] | None = None
    on_disk: bool = False
    compute: Mapping[str, int] = field(default_factory=dict)
    ros: int | None = None
    executable: str = ""

    @property
    def is_of_startup_script(self) -> bool:
        """True if it has a line there, with an exception action; a launch file names its program instead."""
        return self.script is None


@dataclass(frozen=True, slots=True)
class CppNode:
    """One ROS node in C++, which is built before its mission boots.

    Attributes:
        app: its cFE name.
        package: package of the node.
        type: type of the node; for a nodelet, the class that pluginlib knows, such as "demo/Filter".
        folders: folders of its package; the first one takes precedence.
        near: a file near which its packages are.
        name: name without a namespace; empty to use the name in the node's own code.
        namespace: namespace with a slash at the front.
        args: its arguments, without the program's name.
        remaps: (from, to), as in the launch file.
        env: its environment; ROS_PACKAGE_PATH counts.
        required: the mission does not run without it, and its end ends the run.
        respawn: it is started again after its end.
        respawn_delay_ns: delay of that in ns.
        line: its line in `near`; 0 if it is in no file.
    """

    app: str
    package: str
    type: str
    folders: tuple[Path, ...]
    near: Path
    name: str = ""
    namespace: str = "/"
    args: tuple[str, ...] = ()
    remaps: tuple[tuple[str, str], ...] = ()
    env: Mapping[str, str] = field(default_factory=dict)
    required: bool = False
    line: int = 0
    respawn: bool = False
    respawn_delay_ns: int = 0

    @property
    def full_name(self) -> str:
        """The resolved name, "/arm/driver"."""
        return f"{self.namespace.rstrip('/')}/{self.name or self.type.rpartition('/')[2]}"


@dataclass(frozen=True, slots=True)
class TopicConfig:
    """One topic with a MsgId of the mission's choice.

    A `raw` topic carries whole cFE packets: its messages are std_msgs/UInt8MultiArray, and their data are the bytes
    of a packet.
    """

    name: str
    msg_id: int
    raw: bool = False


class BridgedPacket(NamedTuple):
    """A packet that ROS outside sees as a topic: its name or MsgId; `raw` passes it unchanged, although its fields
    are known.
    """

    packet: str
    raw: bool = False


@dataclass(frozen=True, slots=True)
class RosBridge:
    """The exchange between cFE applications and ROS nodes outside of the mission (`cfepy.extra.ros_host`).

    Attributes:
        publish: packets, by the topic under which they are shown.
        subscribe: topics that applications receive; `topics` of the mission file has their MsgIds.
        clock_hz: rate of /clock in Hz of the mission's time; 0 for never. The mission's own nodes have that time
            anyway; /use_sim_time is then for external ones.
    """

    publish: Mapping[str, BridgedPacket] = field(default_factory=dict)
    subscribe: tuple[str, ...] = ()
    clock_hz: int = 0


@dataclass(frozen=True, slots=True)
class RosConfig:
    """The ROS section of a mission file; `nodes` by cFE application name, `topics` by resolved topic name.

    `compiled` are nodes in C++, by cFE application name, too, with the handling of their ends. `ordered_sets` is for
    the nodes without a setting of their own. `locked_topics` and `locked_services` are MsgIds by name, from the
    mission's `topics.lock`, for topics that `topics` does not pin. With `spread` a topic whose MsgId is taken gets the
    next free one, in order of registration; otherwise that is an error, since the id may differ in the next run.
    `ends_with_nodes`: the run is over when all its nodes have ended. `root` is a folder that stands for the computer's
    root, for a mission from another computer (`Universe`); `absent` are paths at which that computer had no file.
    `connection_delay_ns` is the virtual time in ns until a publisher and a subscriber are connected. `bridge` describes
    the exchange of a run that is joined to ROS.
    """

    nodes: Mapping[str, NodeConfig] = field(default_factory=dict)
    topics: Mapping[str, TopicConfig] = field(default_factory=dict)
    params: Mapping[str, Any] = field(default_factory=dict)
    ordered_sets: bool = False
    ends_with_nodes: bool = False
    locked_topics: Mapping[str, int] = field(default_factory=dict)
    locked_services: Mapping[str, int] = field(default_factory=dict)
    spread: bool = False
    root: str = ""
    absent: Collection[str] = frozenset()
    connection_delay_ns: int = 0
    compiled: Mapping[str, NodeConfig] = field(default_factory=dict)
    bridge: RosBridge = field(default_factory=RosBridge)
