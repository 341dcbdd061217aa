"""message_filters for nodes: messages of several topics brought together by their stamps.

Names, arguments and results are those of ROS's message_filters 1.15; the code is cfepy's own, on top of `rospy`. It is
executed anew in each node that imports it.
"""

from __future__ import annotations

import threading

import rospy

from .cache import Cache
from .filters import SimpleFilter, Subscriber
from .synchronizers import ApproximateTimeSynchronizer, TimeSynchronizer

# As in ROS, what a star import brings has rospy and threading in it.
__all__ = [
    "ApproximateTimeSynchronizer",
    "Cache",
    "SimpleFilter",
    "Subscriber",
    "TimeSynchronizer",
    "rospy",
    "threading",
]
