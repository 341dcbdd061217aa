"""rosservice: lists services and their types, and calls one by its name (wiki.ros.org/rosservice)."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any
from urllib.parse import urlparse
from xmlrpc.client import ServerProxy

import genpy
import genpy.message
import rosgraph
import rosgraph.names
import roslib.message
import rosmsg
import rospy
from ros_tools import command_of

NAME = "rosservice"
_ID = "/rosservice"


class ROSServiceException(Exception):
    """Base of the errors of this library."""


class ROSServiceIOException(ROSServiceException):
    """The master or a node does not answer."""


def _get_master() -> rosgraph.Master:
    return rosgraph.Master(_ID)


def _no_master() -> ROSServiceIOException:
    return ROSServiceIOException("Unable to communicate with master!")


def _succeed(args: Any) -> Any:
    """Return the value of an answer.

    Raises:
        ROSServiceException: the answer is not success.
    """
    code, text, value = args
    if code != 1:
        raise ROSServiceException(f"remote call failed: {text}")
    return value


# -- which services --------------------------------------------------------------------------------------------------


def get_service_list(node: str | None = None, namespace: str | None = None, include_nodes: bool = False) -> list[Any]:
    """Return names of services, or [name, [node]] for each.

    Args:
        node: only those that it offers.
        namespace: only those in it.
        include_nodes: include the nodes that offer them.

    Raises:
        ROSServiceIOException: the master does not answer.
    """
    try:
        services = _get_master().getSystemState()[2]
    except OSError:
        raise _no_master() from None
    if namespace:
        prefix = rosgraph.names.make_global_ns(namespace)
        services = [each for each in services if each[0] == namespace or each[0].startswith(prefix)]
    if node is not None:
        services = [(name, nodes) for name, nodes in services if node in nodes]
    return services if include_nodes else [name for name, _ in services]


def get_service_node(service_name: str) -> str | None:
    """Return the name of the node that offers a service, or None."""
    found = dict(get_service_list(include_nodes=True)).get(service_name)
    return found[0] if found else None


def get_service_uri(service_name: str) -> str | None:
    """Return the URI of a service, or None.

    Raises:
        ROSServiceIOException: the master does not answer.
    """
    try:
        return str(_get_master().lookupService(service_name))
    except rosgraph.MasterException:
        return None
    except OSError:
        raise _no_master() from None


def get_service_headers(service_name: str, service_uri: str) -> dict[str, str]:
    """Return a service's description of itself: type, md5sum, types of request and response, name of its node.

    Args:
        service_name: the service.
        service_uri: `rosrpc://host:port`, as the master gives it; the service's node is asked there.

    Raises:
        ROSServiceException: an invalid URI, or the service does not exist.
        ROSServiceIOException: the node does not answer.
    """
    parts = urlparse(service_uri)
    if parts.scheme != "rosrpc" or not parts.hostname or not parts.port:
        raise ROSServiceException(f"service [{service_name}] has an invalid RPC URI [{service_uri}]")
    node: Any = ServerProxy(f"http://{parts.hostname}:{parts.port}")
    try:
        found: dict[str, str] = _succeed(node.getServiceHeader(_ID, service_name))
    except OSError:
        text = f"Unable to communicate with service [{service_name}], address [{service_uri}]"
        raise ROSServiceIOException(text) from None
    return found


def get_service_type(service_name: str) -> str | None:
    """Return the type of a service, or None.

    Raises:
        ROSServiceIOException: the master or the service's node does not answer.
    """
    uri = get_service_uri(service_name)
    return None if uri is None else get_service_headers(service_name, uri).get("type")


def rosservice_find(service_type: str) -> list[str]:
    """Return the names of the services of a type.

    Raises:
        ROSServiceIOException: the master does not answer.
    """
    found = []
    for name in get_service_list():
        try:
            kind = get_service_type(name)
        except ROSServiceIOException:
            continue
        if kind == service_type:
            found.append(name)
    return found


def get_service_class_by_name(service_name: str) -> Any:
    """Return the class of a service.

    Raises:
        ROSServiceException: the service, its type or its class cannot be found.
    """
    kind = get_service_type(service_name)
    if not kind:
        if service_name in get_service_list():
            raise ROSServiceException(f"Unable to determine type of service [{service_name}].")
        raise ROSServiceException(f"Service [{service_name}] is not available.")
    found = roslib.message.get_service_class(kind)
    if found is None:
        package = kind.partition("/")[0]
        raise ROSServiceException(f"Unable to load type [{kind}].\nHave you typed 'make' in [{package}]?")
    return found


# -- calling one -----------------------------------------------------------------------------------------------------


def has_service_args(service_name: str, service_class: Any = None) -> bool:
    """Return whether a service's request has fields."""
    return len(_class_of(service_name, service_class)._request_class.__slots__) > 0


def get_service_args(service_name: str) -> str:
    """Return the names of the fields of a service's request."""
    return str(genpy.message.get_printable_message_args(_class_of(service_name, None)._request_class))


def _class_of(service_name: str, service_class: Any) -> Any:
    name = rosgraph.names.script_resolve_name(NAME, service_name)
    return get_service_class_by_name(name) if service_class is None else service_class


def call_service(service_name: str, service_args: Sequence[Any], service_class: Any = None) -> tuple[Any, Any]:
    """Call a service. Returns the request and the response.

    Args:
        service_name: the service.
        service_args: values of the request's fields, or one dictionary of them.
        service_class: its class, if it is known.

    Raises:
        ROSServiceException: the arguments do not fit, or the call failed.
    """
    from std_msgs.msg import Header

    if not rospy.core.is_initialized():
        rospy.init_node("rosservice", anonymous=True)
    if service_class is None:
        service_class = get_service_class_by_name(service_name)
    request = service_class._request_class()
    now = rospy.get_rostime()
    try:
        genpy.message.fill_message_args(request, service_args, keys={"now": now, "auto": Header(stamp=now)})
    except genpy.MessageException as error:
        raise ROSServiceException(_misfit(error, service_args, request)) from None
    try:
        return request, rospy.ServiceProxy(service_name, service_class)(request)
    except rospy.ServiceException as error:
        raise ROSServiceException(str(error)) from None
    except (genpy.SerializationError, rospy.ROSSerializationException) as error:
        text = rosmsg.get_srv_text(service_class._type)
        raise ROSServiceException(
            f"Unable to send request. One of the fields has an incorrect type:\n  {error}\n\nsrv file:\n{text}"
        ) from None


def _misfit(error: Exception, given: Any, request: Any) -> str:
    many = given if isinstance(given, (list, tuple)) else [given]
    lines = "\n".join(f" * {each} (type {type(each).__name__})" for each in many)
    wanted = genpy.message.get_printable_message_args(request)
    return (
        f"Incompatible arguments to call service:\n{error}\nProvided arguments are:\n{lines}\n\n"
        f"Service arguments are: [{wanted}]"
    )


def rosservicemain(argv: Sequence[str] | None = None) -> None:
    """Run the command `rosservice`.

    Args:
        argv: its command line; sys.argv by default.
    """
    from rosservice._command import run

    run(list(sys.argv if argv is None else argv))


def __getattr__(name: str) -> Any:
    """Return a command by the name that tests and tools use: `_rosservice_cmd_list(argv)`."""
    return command_of("rosservice", name)
