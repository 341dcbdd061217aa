"""message_filters for nodes: matches messages of several topics by their stamps.

Names, arguments and results match ROS's message_filters 1.15; the code is cfepy's own, on top of `rospy`. It is
executed anew in each node that imports it.
"""

from __future__ import annotations

import threading

import rospy

from ._cache import Cache
from ._filters import SimpleFilter, Subscriber
from ._synchronizers import ApproximateTimeSynchronizer, TimeSynchronizer

# As in ROS, a star import includes rospy and threading.
__all__ = [
    "ApproximateTimeSynchronizer",
    "Cache",
    "SimpleFilter",
    "Subscriber",
    "TimeSynchronizer",
    "rospy",
    "threading",
]
