"""Topics of a run that connect to nothing: a misspelt name, another type, no subscriber, or a queue that loses most.

None of these is a problem of the run, because a node may offer more than a mission uses. But each of them is often the
reason why a node does nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from cfepy.mission import Mission, Traffic
from cfepy.reading.suggestions import like, listed

if TYPE_CHECKING:
    from rospy_shim.graph.graph import TopicRow

MOST_NAMED = 5
FEWEST_SENT = 10  # messages before a loss is worth a line
OF_ROS = ("/rosout", "/rosout_agg", "/clock", "/statistics")
OF_ACTIONS = ("/goal", "/cancel", "/status", "/feedback", "/result")
"""Endings of the topics of an action; a client or server rarely uses all."""


def loose_ends(mission: Mission) -> list[str]:
    """Return a line for each loose end of the mission's topics; empty without ROS nodes."""
    by_id = mission.record.topics | {row.msg_id: row for row in mission.processor.topics()}
    rows = [row for row in by_id.values() if row.name not in OF_ROS and not row.name.endswith(OF_ACTIONS)]
    if not rows:
        return []
    traffic = mission.record.traffic(mission.cfe.sb, mission.processor.topics())
    silent = [row for row in rows if row.subscribers and not row.publishers and not _sent(row, traffic)]
    unheard = [row for row in rows if row.publishers and not (row.subscribers or row.mistyped) and row.unsent]
    meant = {row.name: _meant(row, unheard) for row in silent}
    return [
        *_mistyped(rows),
        *(_misspelt(row, meant[row.name]) for row in silent if meant[row.name]),
        *_unheard([row for row in unheard if row.name not in meant.values()]),
        *_losing(rows, traffic),
    ]


def _sent(row: TopicRow, traffic: Mapping[int, Traffic]) -> int:
    count = traffic.get(row.msg_id)
    return 0 if count is None else count.sent


def _mistyped(rows: list[TopicRow]) -> Iterator[str]:
    for row in rows:
        for node, kind in row.mistyped:
            yield f"{row.name}: {node} has the type {kind}, but the topic has {row.type}, so it is not connected"


def _meant(row: TopicRow, unheard: list[TopicRow]) -> str:
    """Return the topic without subscribers that a subscriber probably means; empty if there is none.

    That is one with a similar name, or with the same name in another namespace and the same type.
    """
    fitting = [each for each in unheard if each.type == row.type or "*" in (each.type, row.type) or not row.type]
    last = row.name.rpartition("/")[2]
    elsewhere = [each.name for each in fitting if each.name.rpartition("/")[2] == last]
    return next(iter([*like(row.name, [each.name for each in fitting]), *elsewhere]), "")


def _misspelt(row: TopicRow, meant: str) -> str:
    return f"{row.name}: {listed(row.subscribers, 'and')} subscribed, but no node publishes; did you mean {meant}?"


def _unheard(rows: list[TopicRow]) -> Iterator[str]:
    if rows:
        named = [f"{row.name} of {listed(row.publishers, 'and')}" for row in rows[:MOST_NAMED]]
        more = f" and {len(rows) - MOST_NAMED} more" if len(rows) > MOST_NAMED else ""
        yield f"published without a subscriber: {', '.join(named)}{more}"


def _losing(rows: list[TopicRow], traffic: Mapping[int, Traffic]) -> Iterator[str]:
    for row in rows:
        count = traffic.get(row.msg_id)
        if count is None or count.sent < FEWEST_SENT:
            continue
        lost = count.dropped_pipe_full + count.dropped_limit
        if lost > count.delivered:
            yield (
                f"{row.name}: {lost:,} messages lost and {count.delivered:,} delivered, because subscribers are slower "
                f"than {listed(row.publishers, 'and') or 'the publishers'}; publish less often, or raise queue_size"
            )
