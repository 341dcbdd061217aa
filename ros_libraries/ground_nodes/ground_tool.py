"""The node behind `cfepy rosbag`, `rosmsg`, `rossrv`, `rosnode` and `tf`: runs one of ROS's command line tools.

Its argument is a JSON list: the tool, the words that follow it on a command line, and the virtual second at which to
run it, or null. The tool's output and exit status are printed as lines of JSON, to distinguish them from the output of
other nodes. It is executed in a node's universe, with the node's own libraries.
"""

from __future__ import annotations

import io
import json
import sys
import time
from collections.abc import Callable, Mapping
from typing import TextIO


def _rosbag() -> None:
    from rosbag.rosbag_main import rosbagmain

    rosbagmain(sys.argv)


def _rosmsg() -> None:
    import rosmsg

    rosmsg.rosmsgmain(rosmsg.MODE_MSG)


def _rossrv() -> None:
    import rosmsg

    rosmsg.rosmsgmain(rosmsg.MODE_SRV)


def _rosnode() -> None:
    import rosnode

    rosnode.rosnodemain(sys.argv)


def _tf() -> None:
    from ground_nodes import tf_tool

    tf_tool.main(sys.argv[1:])


TOOLS: Mapping[str, Callable[[], None]] = {
    "rosbag": _rosbag,
    "rosmsg": _rosmsg,
    "rossrv": _rossrv,
    "rosnode": _rosnode,
    "tf": _tf,
}


class Told(io.TextIOBase):
    """A stream of the tool, reported line by line.

    Args:
        stream: the stream to print to.
        key: name of the lines: "out" or "err".
    """

    def __init__(self, stream: TextIO, key: str) -> None:
        self._stream, self._key, self._begun = stream, key, ""

    def write(self, text: str) -> int:
        """Tell the lines that are whole by now."""
        *lines, self._begun = (self._begun + text).split("\n")
        for line in lines:
            self._tell(line)
        return len(text)

    def finish(self) -> None:
        """Tell a last line that was not ended."""
        if self._begun:
            self._tell(self._begun)

    def _tell(self, line: str) -> None:
        print(json.dumps({self._key: line}), file=self._stream)


def main() -> None:
    """Run the tool."""
    tool, words, at_s = json.loads(sys.argv[1])
    if at_s is not None:
        time.sleep(max(0.0, at_s - time.monotonic()))
    console = sys.stdout
    out, err = Told(console, "out"), Told(console, "err")
    sys.argv[:] = [tool, *words]
    sys.stdout, sys.stderr, sys.stdin = out, err, io.StringIO("y\n")  # confirms the prompts of tools
    try:
        TOOLS[tool]()
        status: object = 0
    except SystemExit as end:
        status = end.code or 0
    except Exception as error:  # report any error of the tool to its user
        status = f"{tool}: {type(error).__name__}: {error}"
    if not isinstance(status, int):
        print(status, file=err)
        status = 1
    out.finish()
    err.finish()
    print(json.dumps({"status": status}), file=console)


main()
