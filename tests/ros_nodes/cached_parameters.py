#!/usr/bin/env python3
"""Test node: the cache of parameters behind `rospy.get_param_cached`, and `rospy.get_param`, which reads it."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import rospy
import rospy.impl.paramserver


class Evasive:
    """A default that is unlike nothing, so that rospy takes it for none."""

    def __repr__(self) -> str:
        return "evasive"

    def __ne__(self, other: object) -> bool:
        return False


class Undecided:
    """A default whose comparison has no truth value, such as an array's."""

    def __repr__(self) -> str:
        return "undecided"

    def __ne__(self, other: object) -> Any:
        return self

    def __bool__(self) -> bool:
        raise ValueError("ambiguous")


def tell(what: str, act: Callable[..., Any], *arguments: Any) -> None:
    """Print the result or the error of a call."""
    try:
        outcome = repr(act(*arguments))
    except Exception as error:
        outcome = f"{type(error).__name__} {error}"
    print(f"result: {what} {arguments}: {outcome}")


def put(name: str, value: Any) -> None:
    """Set a parameter, and wait for the master's updates."""
    tell("set", rospy.set_param, name, value)
    time.sleep(0.2)


def remove(name: str) -> None:
    tell("delete", rospy.delete_param, name)
    time.sleep(0.2)


def get(*arguments: Any) -> None:
    tell("get", rospy.get_param, *arguments)


def cached(*arguments: Any) -> None:
    tell("cached", rospy.get_param_cached, *arguments)


def show() -> None:
    print("result: cache", rospy.impl.paramserver.get_param_server_cache().d)


def namespaces() -> None:
    put("/arm", {"a": 1, "b": 2, "s": {"x": 1, "y": 2}})
    cached("/arm/a")
    for name in ("/arm", "/arm/b", "/arm/s", "/"):
        get(name)
    cached("/arm")
    cached("/none")
    get("/none")
    put("/none", 5)
    get("/none")
    cached("/late", 3)
    get("/late", 4)
    show()


def deletions() -> None:
    remove("/arm/a")
    for name in ("/arm/a", "/arm"):
        get(name)
        cached(name)
    tell("has", rospy.has_param, "/arm/a")
    put("/arm/a", 7)
    get("/arm")
    put("/arm/a", (1, 2))
    get("/arm/a")
    put("/arm/a", None)
    get("/arm/a")
    remove("/arm")
    get("/arm")
    show()


def roots() -> None:
    put("/", {"z": 1})
    show()
    get("/")
    get("/z")
    cached("/")
    put("/", {"z": 2})
    get("/")
    put("/q", 2)
    get("/q")
    show()


def texts() -> None:
    put("/text", "hello")
    cached("/text")
    put("/text/he", 2)
    get("/text/he")
    get("/text")
    cached("/text/he")
    show()


def same_objects() -> None:
    value: dict[str, Any] = {"k": [1]}
    put("/same", value)
    rospy.get_param_cached("/same")["new"] = 1
    get("/same")
    put("/same", value)
    value["later"] = 2
    get("/same")
    cached("~own", 1)
    tell("search", rospy.search_param, "own")
    show()


def defaults() -> None:
    get("/missing", Undecided())
    cached("/missing", Undecided())
    get("/missing", Evasive())
    master = rospy.get_master()
    put("/plain", 1)
    for act in (master.__getitem__, master.get_param_cached, master.__delitem__, master.__contains__):
        tell("master", act, "/plain")
    master["/plain"] = 9
    get("/plain")


def main() -> None:
    rospy.init_node("cached_parameters")
    for part in (namespaces, deletions, roots, texts, same_objects, defaults):
        part()
    rospy.signal_shutdown("end")
    put("/plain", 10)
    cached("/plain")
    get("/plain")


if __name__ == "__main__":
    main()
