"""rosparam: reading and writing parameters, one by one or as YAML files (wiki.ros.org/rosparam)."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import Any

import rosgraph
from rosgraph.names import GLOBALNS, get_ros_namespace, make_caller_id, make_global_ns, ns_join

from rosparam._documents import (
    RosParamException,
    construct_angle_degrees,
    construct_angle_radians,
    construct_yaml_binary,
    documents,
    represent_xml_binary,
    text_of,
)

__all__ = [
    "NAME",
    "NS",
    "RosParamException",
    "RosParamIOException",
    "construct_angle_degrees",
    "construct_angle_radians",
    "construct_yaml_binary",
    "delete_param",
    "dump_params",
    "get_param",
    "get_param_server",
    "list_params",
    "load_file",
    "load_str",
    "print_params",
    "represent_xml_binary",
    "set_param",
    "set_param_raw",
    "upload_params",
    "yamlmain",
]

NAME = "rosparam"
NS = "_ns"


class RosParamIOException(RosParamException):
    """The parameter server does not answer."""


def _no_master() -> RosParamIOException:
    return RosParamIOException("Unable to communicate with master!")


def get_param_server() -> rosgraph.Master:
    """Return the parameter server."""
    return rosgraph.Master(make_caller_id(f"rosparam-{os.getpid()}"))


# -- from files ------------------------------------------------------------------------------------------------------


def load_file(filename: str, default_namespace: str | None = None, verbose: bool = False) -> list[tuple[Any, str]]:
    """Return the documents of a YAML file, each with its namespace. Nothing is set; see `upload_params`.

    Args:
        filename: the file; `-` or nothing for stdin.
        default_namespace: namespace of documents without one (`_ns`).
        verbose: print the file name and the documents' namespaces.

    Raises:
        RosParamException: there is no such file.
    """
    if not filename or filename == "-":
        if verbose:
            print("reading parameters from stdin")
        return load_str(sys.stdin.read(), filename, default_namespace, verbose)
    if not os.path.isfile(filename):
        raise RosParamException(f"file [{filename}] does not exist")
    if verbose:
        print(f"reading parameters from [{filename}]")
    with open(filename, encoding="utf-8") as file:
        return load_str(file.read(), filename, default_namespace, verbose)


def load_str(
    str: str, filename: str, default_namespace: str | None = None, verbose: bool = False
) -> list[tuple[Any, str]]:
    """Return the same as `load_file`, from a text.

    Args:
        str: the text.
        filename: its origin.
        default_namespace: namespace of documents without one (`_ns`).
        verbose: print the namespaces that documents give.
    """
    found = []
    default = default_namespace or get_ros_namespace()
    for document in documents(str):
        namespace = default
        if NS in document:
            namespace = ns_join(default, document.pop(NS))
            if verbose:
                print(f"reading parameters into namespace [{namespace}]")
        found.append((document, namespace))
    return found


def dump_params(filename: str | None, param: str, verbose: bool = False) -> None:
    """Write a parameter or a namespace to a YAML file.

    Args:
        filename: the file; nothing for stdout.
        param: its name.
        verbose: print the values as well.

    Raises:
        RosParamIOException: the parameter server does not answer.
    """
    tree = get_param(param)
    if verbose:
        print_params(tree, param)
    if not filename:
        sys.stdout.write(text_of(tree))
        return
    with open(filename, "w", encoding="utf-8") as file:
        file.write(text_of(tree))


def upload_params(ns: str, values: Any, verbose: bool = False) -> None:
    """Set all parameters of a document.

    Args:
        ns: namespace of the document.
        values: the document.
        verbose: print the values.

    Raises:
        RosParamException: a single value for the root, or a name that is not a text.
        RosParamIOException: the parameter server does not answer.
    """
    if ns == GLOBALNS and type(values) is not dict:
        raise RosParamException("global / can only be set to a dictionary")
    if verbose:
        print_params(values, ns)
    set_param_raw(ns, values)


# -- one by one ------------------------------------------------------------------------------------------------------


def get_param(param: str) -> Any:
    """Return the value of a parameter, or a namespace.

    Raises:
        rosgraph.MasterError: it is not set.
        RosParamIOException: the parameter server does not answer.
    """
    try:
        return get_param_server().getParam(param)
    except OSError:
        raise _no_master() from None


def set_param(param: str, value: str, verbose: bool = False) -> None:
    """Set a parameter to a value given in YAML; see `set_param_raw`."""
    for document in documents(value):
        set_param_raw(param, document, verbose)


def set_param_raw(param: str, value: Any, verbose: bool = False) -> None:
    """Set a parameter. A dictionary sets its own names and keeps the others of the namespace.

    Args:
        param: its name.
        value: its value.
        verbose: print the name and the new value.

    Raises:
        RosParamException: a name that is not a text.
        OverflowError: an integer of more than 32 bits.
        RosParamIOException: the parameter server does not answer.
    """
    if type(value) is dict:
        for key, each in value.items():
            if not isinstance(key, str):
                raise RosParamException(f"YAML dictionaries must have string keys. Invalid dictionary is:\n{value}")
            set_param_raw(ns_join(param, key), each, verbose)
        return
    try:
        get_param_server().setParam(param, value)
    except OSError:
        raise _no_master() from None
    if verbose:
        print(f"set parameter [{param}] to [{value}]")


def delete_param(param: str, verbose: bool = False) -> None:
    """Remove a parameter, or a namespace; with "/" all of them.

    Raises:
        rosgraph.MasterError: it is not set.
        RosParamIOException: the parameter server does not answer.
    """
    try:
        if param == GLOBALNS:
            get_param_server().setParam(GLOBALNS, {})
        else:
            get_param_server().deleteParam(param)
    except OSError:
        raise _no_master() from None
    if verbose:
        print("deleted ENTIRE parameter server" if param == GLOBALNS else f"deleted parameter [{param}]")


def list_params(ns: str) -> list[str]:
    """Return the names of the parameters in a namespace, sorted.

    Raises:
        RosParamIOException: the parameter server does not answer.
    """
    prefix = make_global_ns(ns)
    try:
        names = get_param_server().getParamNames()
    except OSError:
        raise _no_master() from None
    return sorted(name for name in names if name.startswith(prefix))


def print_params(params: Any, ns: str) -> None:
    """Print parameters, a line each."""
    if type(params) is not dict:
        print(params)
        return
    for key, value in params.items():
        if type(value) is dict:
            print_params(value, ns_join(ns, key))
        else:
            print(f"{ns_join(ns, key)}={value}")


def yamlmain(argv: Sequence[str] | None = None) -> None:
    """Run the command `rosparam`.

    Args:
        argv: its command line; sys.argv by default.
    """
    from rosparam._command import run

    run(list(sys.argv if argv is None else argv))


def _fullusage() -> None:
    """Say how the command is used, and end the program."""
    from rosparam._command import print_usage

    print_usage()
