"""rosbag for nodes: messages in files, in ROS's bag format 2.0.

Names, arguments, results and bytes match ROS's rosbag 1.15. The code is cfepy's own, on top of `rospy` and of
`rosbag_storage`, which implements the format. It is executed anew in each node that imports it.
"""

from __future__ import annotations

from .bag import Bag, Compression, ROSBagException, ROSBagFormatException, ROSBagUnindexedException
from .rosbag_main import rosbagmain

__all__ = [
    "Bag",
    "Compression",
    "ROSBagException",
    "ROSBagFormatException",
    "ROSBagUnindexedException",
    "rosbagmain",
]
