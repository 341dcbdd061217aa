"""Attachments: objects that watch a mission or change its course, such as a bag, invariants, or faults.

`Mission` takes any number of attachments. None of its parts knows of them, and a run without any pays nothing for them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cfepy.rtos import Kernel
    from cfepy.sb import SoftwareBus
    from cfepy.trace import Trace


class Attachment:
    """Does nothing; derived classes override what they need."""

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        """The class of Software Bus that it needs, made of another one; every processor gets a bus of it.

        Args:
            base: what the attachments before this one need.
        """
        return base

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        """The class of kernel that it needs, made of another one; the mission's kernel is of it.

        Args:
            base: what the attachments before this one need.
        """
        return base

    def begin(self, mission: Any) -> None:
        """The mission (`cfepy.mission.Mission`) was made, and nothing of it has run."""

    def power_up(self, processor: Any) -> None:
        """A processor (`cfepy.mission.processor.Processor`) was made, at the beginning and after each reset.

        Nothing of it has run. The first one comes after `begin`.
        """

    def conclude(self) -> None:
        """The time of the run is over; the nodes are about to be asked to shut down. Called in the host, once."""

    def finish(self) -> None:
        """The run is over, and its digest is taken: what tasks do while they are ended is no part of it."""

    def close(self) -> None:
        """The mission is over, and all its tasks have ended."""


class Recorder(Attachment):
    """An attachment that takes the trace of the run; a context manager around the mission.

    Attributes:
        trace: what the mission records in.
    """

    trace: Trace

    def __enter__(self) -> Any:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, where: Any) -> None:
        """The run is over, or there was none."""
