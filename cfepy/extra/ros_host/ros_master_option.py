"""`--ros-master`: a run in real time and ROS on this computer as one graph."""

from __future__ import annotations

import argparse
import contextlib
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, ClassVar

from cfepy.cli.flight_add_ons import FlightAddOn
from cfepy.cli.flight_options import HIGHEST_PORT
from cfepy.cli.parser import shared_group
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.extra.ros_host import RosHost, RosWorld
    from cfepy.io import Guest
    from cfepy.mission import Mission

OPTION = "--ros-master"
SERVE = "serve"


class RosMaster(FlightAddOn):
    """The ROS master that a command line asks for, joined or served.

    Args:
        arguments: as for `FlightAddOn`.
        name: as for `FlightAddOn`.
        tell: as for `FlightAddOn`.
    """

    OPTIONS: ClassVar = {"ros_master": OPTION}

    def __init__(self, arguments: argparse.Namespace, name: str, tell: Callable[[str], object]) -> None:
        super().__init__(arguments, name, tell)
        self._uri: str | None = arguments.ros_master
        self._open = contextlib.ExitStack()

    @classmethod
    def add(cls, parser: argparse.ArgumentParser) -> None:
        shared_group(parser, "ROS on this computer").add_argument(
            OPTION,
            type=master_of,
            metavar="URI",
            help="join ROS on this computer; requires --realtime. URI is the address of a running roscore, such as "
            "http://localhost:11311; serve or serve:PORT starts a ROS master for other nodes",
        )

    @classmethod
    def check(cls, arguments: argparse.Namespace) -> None:
        if arguments.ros_master and arguments.realtime is None:
            raise UsageError("requires --realtime, so that ROS nodes on this computer can keep pace", field=OPTION)

    def connect(self, mission: Mission, tell: Callable[[str], object]) -> Sequence[Guest]:
        if self._uri is None:
            return ()
        from cfepy.extra.ros_host import MASTER_PORT, JoinedMaster, RosHost, ServedMaster

        uri = self._uri
        word, _, port = uri.partition(":")

        def world(host: RosHost) -> RosWorld:
            if word == SERVE:
                return ServedMaster(host, int(port) if port else MASTER_PORT)
            return JoinedMaster(host, uri)

        return (self._open.enter_context(RosHost(mission, world, tell=tell)),)

    def close(self) -> None:
        self._open.close()


def master_of(text: str) -> str:
    """Parse the URI of a ROS master, or `serve` with or without a port, for argparse."""
    word, mark, port = text.partition(":")
    serves = word == SERVE and (not mark or (port.isdecimal() and int(port) <= HIGHEST_PORT))
    if serves or (word == "http" and text.count(":") > 1 and text.rstrip("/").rpartition(":")[2].isdecimal()):
        return text
    raise argparse.ArgumentTypeError(
        f"invalid ROS master {text!r}; expected a URI such as http://localhost:11311, serve or serve:11312"
    )
