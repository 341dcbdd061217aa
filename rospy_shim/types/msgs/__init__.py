"""ROS message types in memory: definitions, md5sums, generated classes, and the modules that nodes import them from.

    >>> from rospy_shim.types.msgs import message_class
    >>> message_class("std_msgs/String")(data="hello")
    data: "hello"

Inside a node the same classes are found the usual way (`from std_msgs.msg import String`), through `make_module`. Code
belongs here if it defines or encodes message types; times and the base class of messages belong to
`rospy_shim.types.genpy`, rospy's additions to messages to `rospy_shim.client.message`. The central file is
`rospy_shim/types/msgs/classes.py`.
"""

from __future__ import annotations

from types import ModuleType

from rospy_shim.types.msgs.checking import DefinitionFault, check_definitions
from rospy_shim.types.msgs.classes import MessageClass, ServiceClass
from rospy_shim.types.msgs.definition_sources import OnDisk, Shipped, Source
from rospy_shim.types.msgs.library import Library, from_full_text, library_of, shipped
from rospy_shim.types.msgs.modules import generate_dynamic, make_module
from rospy_shim.types.msgs.packages import Packages, check_package_name

__all__ = [
    "DefinitionFault",
    "Library",
    "MessageClass",
    "OnDisk",
    "Packages",
    "ServiceClass",
    "Shipped",
    "Source",
    "check_definitions",
    "check_package_name",
    "from_full_text",
    "generate_dynamic",
    "library_of",
    "load_package",
    "make_module",
    "message_class",
    "service_class",
    "shipped",
]


def message_class(full_name: str) -> MessageClass:
    """Return the class of a shipped message type, e.g. "std_msgs/String"; it is generated at first use.

    Raises:
        UsageError: there is no such type.
    """
    return shipped().message_class(full_name)


def service_class(full_name: str) -> ServiceClass:
    """Return the class of a shipped service type, e.g. "std_srvs/SetBool".

    Raises:
        UsageError: there is no such type.
    """
    return shipped().service_class(full_name)


def load_package(name: str) -> ModuleType:
    """Return a module with the message classes of a shipped package, e.g. `load_package("std_msgs").String`.

    Raises:
        ModuleNotFoundError: there is no such package.
    """
    module = make_module(f"{name}.msg")
    if module is None:
        raise ModuleNotFoundError(f"cfepy does not include the ROS package {name!r}", name=name)
    return module
