"""Attachments: objects that observe or modify a mission, such as a bag, invariants or faults.

`Mission` takes any number of attachments. No part of the mission depends on them, and a run without attachments pays
nothing for them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cfepy.rtos import Kernel
    from cfepy.sb import SoftwareBus
    from cfepy.trace import Trace


class Attachment:
    """Base class of attachments; its methods do nothing, and derived classes override the ones they need."""

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        """Return the Software Bus class that this attachment needs, derived from `base`.

        Every processor gets a bus of the resulting class.

        Args:
            base: the class that the attachments before this one need.
        """
        return base

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        """Return the kernel class that this attachment needs, derived from `base`.

        The mission's kernel is an instance of the resulting class.

        Args:
            base: the class that the attachments before this one need.
        """
        return base

    def begin(self, mission: Any) -> None:
        """Handle a new mission (`cfepy.mission.Mission`), before any part of it has run."""

    def power_up(self, processor: Any) -> None:
        """Handle a new processor (`cfepy.mission.processor.Processor`), at the start and after each reset.

        No part of the processor has run yet. The first call comes after `begin`.
        """

    def conclude(self) -> None:
        """Handle the end of the run's time, just before the nodes are asked to shut down.

        It is called once, in host code.
        """

    def finish(self) -> None:
        """Handle the end of the run, after its digest was taken.

        Actions of tasks while they are being ended do not belong to the run.
        """

    def close(self) -> None:
        """Handle the end of the mission, after all its tasks have ended."""


class Recorder(Attachment):
    """An attachment that records the trace of the run; a context manager around the mission.

    Attributes:
        trace: the trace that the mission records in.
    """

    trace: Trace

    def __enter__(self) -> Any:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, where: Any) -> None:
        """Handle the end of the run; the mission may never have started."""
