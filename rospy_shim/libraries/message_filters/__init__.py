"""message_filters for nodes: messages of several topics brought together by their stamps.

Names, arguments and results are those of ROS's message_filters 1.15; the code is cfepy's own, on top of `rospy`. It is
executed anew in each node that imports it.
"""

from __future__ import annotations

from .cache import Cache
from .filters import SimpleFilter, Subscriber
from .synchronizers import ApproximateTimeSynchronizer, TimeSynchronizer

__all__ = ["ApproximateTimeSynchronizer", "Cache", "SimpleFilter", "Subscriber", "TimeSynchronizer"]
