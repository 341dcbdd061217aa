"""The limits of a mission: cFE's defaults, the board's limits, and the mission file's `limits:`.

The board is hardware, so its numbers are the upper limits: a mission file can lower them, never raise them. A mission
can raise a limit that the board does not set. If RAM is not limited, a mission with ROS nodes also gets room for their
parameters and their long messages.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial

from cfepy.config.platform import IDENTITIES, PlatformConfig
from cfepy.config.versions import DEFAULT_RELEASE, RELEASES
from cfepy.ids import SERIAL_MAX
from cfepy.msg import HIGHEST_VALID_MSG_ID
from cfepy.psp import LIMIT_NAMES, BoardProfile, Limit, read_limit
from cfepy.reading.marked_yaml import Marked
from cfepy.reading.mistakes import Mistakes, each_of
from cfepy.status import UsageError

NODES = "nodes"
"""The key under `limits:` for all limits at once: room for a number of ROS nodes."""

MOST_NODES = 4000

ROS_ROOM: Mapping[str, int] = {
    "es_cds_size": 409_600,
    "os_max_modules": 42,
    "os_max_tasks": 512,
    "sb_buf_memory_bytes": 64 << 20,
    "tbl_buf_memory_bytes": 1 << 20,
}
"""The room in cFE for ROS parameters (which are critical tables), for threads, for images in transit, and for
the code of as many nodes as there can be applications and libraries.
"""

_PER_NODE: Mapping[str, int] = {
    "es_max_applications": 1,
    "os_max_tasks": 16,
    "os_max_queues": 16,
    "os_max_bin_semaphores": 4,
    "os_max_count_semaphores": 4,
    "os_max_mutexes": 4,
    "os_max_timers": 1,
    "os_max_modules": 1,
    "sb_max_pipes": 16,
    "sb_max_msg_ids": 8,
    "sb_max_dest_per_pkt": 1,
    "sb_buf_memory_bytes": 65_536,
}
"""The needs of a larger ROS node: threads, topics on both sides, services, messages in transit."""

_WORKSTATION: Mapping[str, int] = {"os_queue_max_depth": 10_000, "sb_buf_memory_bytes": 1 << 28}
"""The resources of a ROS node on a PC, where unread messages wait in sockets and lists."""

_MOST: Mapping[str, int] = {"sb_max_msg_ids": HIGHEST_VALID_MSG_ID, "sb_buf_memory_bytes": (1 << 31) - 1}


@dataclass(frozen=True, slots=True)
class MissionLimits:
    """The section `limits:` of a mission file.

    Attributes:
        values: values of `PlatformConfig`, by field name.
        nodes: number of ROS nodes to make room for; 0 for cFE's defaults.
        yields: whether `nodes` was counted and not set by the user: then a board's own limits hold, even if they are
            too low, and nodes get a PC's resources if RAM is not limited.
        places: the position in the file of each, for errors.
    """

    values: Mapping[str, Limit] = field(default_factory=dict)
    nodes: int = 0
    yields: bool = False
    places: Mapping[str, Marked] = field(default_factory=dict)

    def config(self, board: BoardProfile, has_nodes: bool, release: str = DEFAULT_RELEASE) -> PlatformConfig:
        """Return the platform configuration of a mission.

        Args:
            board: the board of the mission.
            has_nodes: whether it has ROS nodes.
            release: name of the release of cFE, whose limits are the defaults.

        Raises:
            UsageError: if the mission needs more than the board has.
        """
        try:
            base = PlatformConfig().with_limits(RELEASES[release].limits)
        except KeyError as error:
            raise UsageError(f"unknown limit {error} in the file of the release {release}") from None
        base = base.with_limits(ROS_ROOM if has_nodes and not board.sram_size else {})
        room = {name: max(value, getattr(base, name)) for name, value in limits_for(self.nodes).items()}
        if self.yields:
            more = {} if board.sram_size else _WORKSTATION
            room = {name: value for name, value in {**room, **more}.items() if name not in board.limits}
        own = {**_at_least(room, board), **self.values}
        each_of(partial(self._check, name, value, board) for name, value in own.items())
        return board.config(base).with_limits(own)

    def _check(self, name: str, value: Limit, board: BoardProfile) -> None:
        most = board.limits.get(name)
        if name in IDENTITIES or not isinstance(most, int) or not isinstance(value, int) or value <= most:
            return
        if name in self.values:
            text = f"must be at most {most} on the board {board.name}, not {value}; lower it, or use another board"
            raise self._error(name, text)
        text = f"is {self.nodes}, which requires {name}: {value}, but the board {board.name} has {most}"
        raise self._error(NODES, text)

    def _error(self, name: str, text: str) -> UsageError:
        place = self.places.get(name)
        return UsageError(text, field=f"limits.{name}") if place is None else place.fail(text)


def read_limits(section: Marked, mistakes: Mistakes) -> MissionLimits:
    """Return the section `limits:`.

    Args:
        section: its value.
        mistakes: collects unknown names and invalid values.
    """
    values: dict[str, Limit] = {}
    places: dict[str, Marked] = {}
    nodes = 0
    for name, entry in mistakes.fields(section, (NODES, *LIMIT_NAMES)):
        if name == NODES:
            nodes = mistakes.attempt(partial(entry.integer, 1, MOST_NODES)) or 0
        else:
            value = mistakes.attempt(partial(read_limit, name, entry))
            if value is None:
                continue
            values[name] = value
        places[name] = entry
    return MissionLimits(values, nodes, places=places)


def limits_for(nodes: int) -> dict[str, int]:
    """Return limits with room for a number of ROS nodes, in addition to cFE's defaults.

    Args:
        nodes: number of nodes, at most 4000.

    Returns:
        Values for `MissionLimits`; empty for 0 nodes.

    >>> limits_for(500)["es_max_applications"]
    533
    """
    if nodes == 0:
        return {}
    defaults = PlatformConfig()
    more = {"es_max_applications": 1, "os_max_tasks": 1, "os_max_modules": 1}  # ROS's own application
    return {
        name: min(getattr(defaults, name) + nodes * each + more.get(name, 0), _MOST.get(name, SERIAL_MAX - 1))
        for name, each in _PER_NODE.items()
    }


def _at_least(wanted: Mapping[str, Limit], board: BoardProfile) -> dict[str, Limit]:
    """Return the wanted limits, without those that the board already exceeds."""
    return {
        name: value
        for name, value in wanted.items()
        if not isinstance(most := board.limits.get(name), int) or not isinstance(value, int) or most < value
    }
