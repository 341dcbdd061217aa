"""`python -m dev.record.rosbridge PORT FILE`: sends requests to the real rosbridge_suite, and records its answers.

It needs a ROS 1 master, tests/ros_nodes/rosbridge_peer.py as a node, and two programs of rosbridge_suite (branch ros1):
rosbridge_websocket at PORT of this computer, and rosapi_node under the name rosapi.
"""

from __future__ import annotations

import argparse
import json
from base64 import b64encode
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

from dev.record.exchanges import RESPONSE, comparable, steps

QUIET_S = 0.7  # wall time after which nothing more comes


def main(port: str, file: str) -> None:
    """Record."""
    rows = []
    with connect(f"ws://127.0.0.1:{port}", max_size=None) as client:
        last: Any = {}
        for step in steps():
            for op in step:
                client.send(json.dumps({**op, "id": last["id"]} if op is RESPONSE else op))
            found = _answers(client)
            last = found[-1] if found else last
            rows.append({"sent": step, "came": [comparable(each) for each in found]})
    text = json.dumps(rows, indent=None, ensure_ascii=True)
    Path(file).write_text(text.replace('{"sent"', '\n{"sent"') + "\n", encoding="utf-8")


def _answers(client: ClientConnection) -> list[Any]:
    found: list[Any] = []
    while True:
        try:
            message = client.recv(timeout=QUIET_S)
        except TimeoutError:
            return found
        found.append(json.loads(message) if isinstance(message, str) else {"binary": b64encode(message).decode()})


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m dev.record.rosbridge", description=__doc__)
    parser.add_argument("port", metavar="PORT", help="of rosbridge_websocket on this computer")
    parser.add_argument("file", metavar="FILE", help="file for its answers")
    arguments = parser.parse_args()
    main(arguments.port, arguments.file)
