"""What a mission file says about its ROS nodes and topics, as plain records.

The mission reads them, the ROS side of the house uses them; neither imports the other.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True)
class NodeConfig:
    """One ROS node: an application of the startup script whose entry symbol is `__main__`.

    `app` is its cFE name; `name` the node name it gets when the script does not insist (`__name:=`); `remap` maps
    names as on rosrun's command line; `params` are private parameters; `args` go to `sys.argv`; `env` to `os.environ`.
    """

    app: str
    name: str | None = None
    namespace: str = "/"
    remap: Mapping[str, str] = field(default_factory=dict)
    params: Mapping[str, Any] = field(default_factory=dict)
    args: tuple[str, ...] = ()
    env: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class TopicConfig:
    """One topic with a MsgId of the mission's choice.

    A `raw` topic carries whole cFE packets: its messages are std_msgs/UInt8MultiArray, and their data are the bytes
    of a packet.
    """

    name: str
    msg_id: int
    raw: bool = False


@dataclass(frozen=True, slots=True)
class RosConfig:
    """Everything about ROS in a mission file; `nodes` by cFE application name, `topics` by resolved topic name."""

    nodes: Mapping[str, NodeConfig] = field(default_factory=dict)
    topics: Mapping[str, TopicConfig] = field(default_factory=dict)
    params: Mapping[str, Any] = field(default_factory=dict)
