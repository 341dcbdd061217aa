"""The exceptions of rospy, with the bases that nodes rely on when they catch them (rospy.exceptions, rospy.service).

All nodes share them: they hold no state.
"""

from __future__ import annotations

from cfepy.interpreter.node_interrupt import NodeInterrupt


class ROSException(Exception):  # rospy's name
    """Base of ROS errors."""

    __module__ = "rospy.exceptions"


class ROSSerializationException(ROSException):
    """A message cannot be serialised or deserialised."""

    __module__ = "rospy.exceptions"


class ROSInitException(ROSException):
    """A call requires `init_node`, or `init_node` itself failed."""

    __module__ = "rospy.exceptions"


class ROSInterruptException(ROSException, NodeInterrupt):
    """A wait was cut short by the node's shutdown."""

    __module__ = "rospy.exceptions"


class ROSTimeMovedBackwardsException(ROSInterruptException):
    """Simulated time was set back during a sleep.

    Args:
        time: size of the jump in s.
    """

    __module__ = "rospy.exceptions"

    def __init__(self, time: float) -> None:
        self.time = time
        super().__init__("ROS time moved backwards")


class ROSInternalException(Exception):  # rospy's name
    """Base of rospy's internal errors."""

    __module__ = "rospy.exceptions"


class TransportException(ROSInternalException):
    """A connection failed."""

    __module__ = "rospy.exceptions"


class TransportTerminated(TransportException):  # rospy's name
    """A connection ended."""

    __module__ = "rospy.exceptions"


class TransportInitError(TransportException):
    """A connection could not be made."""

    __module__ = "rospy.exceptions"


class ServiceException(Exception):  # rospy's name
    """A service call failed."""

    __module__ = "rospy.service"
