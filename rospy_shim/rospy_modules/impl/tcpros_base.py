"""rospy.impl.tcpros_base: the constants of ROS's transport; messages go over the Software Bus."""

from __future__ import annotations

import logging
from errno import EAGAIN, EWOULDBLOCK
from hashlib import md5

from rospy.core import MASTER_NAME, ROSRPC
from rospy.impl.transport import BIDIRECTIONAL
from rospy.names import ANYTYPE, GLOBALNS, REMAP, SEP, SERVICE_ANYTYPE, TOPIC_ANYTYPE
from rospy.topics import DEFAULT_BUFF_SIZE

__all__ = [
    "ANYTYPE",
    "BIDIRECTIONAL",
    "DEFAULT_BUFF_SIZE",
    "EAGAIN",
    "EWOULDBLOCK",
    "GLOBALNS",
    "MASTER_NAME",
    "REMAP",
    "ROSRPC",
    "SEP",
    "SERVICE_ANYTYPE",
    "TCPROS",
    "TOPIC_ANYTYPE",
    "logger",
    "md5",
    "python3",
]

TCPROS = "TCPROS"
python3 = 1
logger = logging.getLogger("rospy.tcpros")
