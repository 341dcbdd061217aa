"""The ranking, and its table in the report of each run."""

from __future__ import annotations

from cfepy.cli.text_table import Table
from cfepy.pilot import Results, TopicResult

SHOWN = 3  # in the report of a run


def busiest(results: Results, count: int) -> list[TopicResult]:
    """Return the topics and packets that were sent most, the busiest first."""
    sent = [topic for topic in results.topics if topic.sent]
    return sorted(sent, key=lambda topic: (-topic.sent, topic.msg_id))[:count]


def tables(results: Results) -> list[Table]:
    """Make the table for the report of a run."""
    table = Table("Busiest", ("name", "sent"), right=(1,))
    for topic in busiest(results, SHOWN):
        table.add(topic.name or f"0x{topic.msg_id:04X}", topic.sent)
    return [table]
