"""The node behind `cfepy rosservice call`: calls a service once, and prints the result as a line of JSON.

Its argument is a JSON list: the service, the request as YAML values, and the virtual second of the call, or null.
It is executed in a node's universe, with the node's own rospy.
"""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import rospy
import rosservice
import yaml

WAIT_S = 60.0


def plain(value: Any) -> Any:
    """Return a message as dictionaries, lists, numbers and texts."""
    names = getattr(value, "__slots__", None)
    if names is not None:
        return {name: plain(getattr(value, name)) for name in names}
    if isinstance(value, bytes):
        return list(value)
    return [plain(item) for item in value] if isinstance(value, (list, tuple)) else value


def main() -> None:
    """Call the service."""
    name, words, at_s = json.loads(sys.argv[1])
    rospy.init_node("rosservice", anonymous=True)
    if at_s is not None:
        time.sleep(max(0.0, at_s - time.monotonic()))
    try:
        rospy.wait_for_service(name, timeout=WAIT_S)
        _, response = rosservice.call_service(name, [yaml.safe_load(word) for word in words])
    except Exception as error:  # report any error to the caller
        print(json.dumps({"error": str(error)}))
        sys.exit(1)
    print(json.dumps({"at": time.monotonic(), "response": plain(response), "text": str(response)}))


main()
