"""dynamic_reconfigure for nodes: parameters that other nodes can change at run time.

Names, arguments, topics and services match ROS's dynamic_reconfigure 1.7; the code is cfepy's own, on top of
`rospy`. The modules `<package>.cfg.<Name>Config` are made from a package's cfg/<Name>.cfg when they are imported.
"""

from __future__ import annotations

from typing import Any


class DynamicReconfigureException(Exception):  # ROS's name
    """Base of the errors of this package."""


class DynamicReconfigureParameterException(DynamicReconfigureException):
    """A parameter that is unknown or cannot have a value."""


class DynamicReconfigureCallbackException(DynamicReconfigureException):
    """A server's callback failed."""


def find_reconfigure_services() -> list[str]:
    """Return the names of the servers that can be reconfigured, sorted."""
    import rosservice

    ending = "/set_parameters"
    return sorted(name.removesuffix(ending) for name in rosservice.get_service_list() if name.endswith(ending))


def get_parameter_names(descr: Any) -> Any:
    """Return the names of the parameters of a `...Config` module."""
    return descr.defaults.keys()
