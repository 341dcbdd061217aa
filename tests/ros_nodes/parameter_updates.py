#!/usr/bin/env python3
"""Test node: the changes of parameters that the master reports, of the node itself and of others."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from typing import Any

import rospy
import rospy.impl.masterslave


def told(usual: Callable[..., Any]) -> Callable[..., Any]:
    """Return a `paramUpdate` that prints its call and the answer."""

    def update(*arguments: Any) -> Any:
        answer = usual(*arguments)
        print("result:", *arguments, answer)
        return answer

    return update


def main() -> None:
    rospy.init_node("parameter_updates")
    handler = next(each for each in gc.get_objects() if isinstance(each, rospy.impl.masterslave.ROSHandler))
    handler.paramUpdate = told(handler.paramUpdate)
    master = rospy.get_master().target
    for name in ("/listens/rate", "/arm", "/deep/a/b"):
        master.subscribeParam(rospy.get_caller_id(), handler.uri, name)
    rospy.get_param_cached("/kept", 0)
    for caller in (rospy.get_caller_id(), "/other"):
        for name, value in (
            ("/listens/rate", 5),
            ("/listens", {"rate": 6, "other": 1}),
            ("/kept", 1),
            ("/kept/inner", 2),
            ("/unheard", 1),
            ("/arm", {"a": {"b": 1}}),
            ("/arm/speed", 3),
            ("/listens", 5),
            ("/listens/rate", 4),
            ("/listens", {}),
            ("/deep/a/b/c", 1),
            ("/deep", {"a": 3}),
            ("/deep", {"a": {"b": {"z": 1}}}),
        ):
            print("result:", caller, "sets", name, value)
            master.setParam(caller, name, value)
            time.sleep(0.15)
        for name in ("/deep/a", "/arm/speed"):
            print("result:", caller, "deletes", name)
            master.deleteParam(caller, name)
            time.sleep(0.15)


if __name__ == "__main__":
    main()
