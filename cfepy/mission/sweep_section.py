"""The section `sweep:` of a mission file: what a rate means in the mission, for `cfepy sweep --rate`.

sweep:
  rate: [/left/rate, /right/rate]   # parameters, or arguments of the launch file, that are rates in Hz
  topics: [/left_to_right]          # what is to come at that rate
"""

from __future__ import annotations

from dataclasses import dataclass

from cfepy.reading.marked_yaml import Marked
from cfepy.reading.mistakes import Mistakes


@dataclass(frozen=True, slots=True)
class SweepConfig:
    """The parameters that a sweep varies, and the topics that it measures.

    Attributes:
        rate: full names of parameters (with a slash) and names of launch arguments that a rate in Hz sets.
        topics: topics that then have this rate; empty for all topics of the mission.
    """

    rate: tuple[str, ...] = ()
    topics: tuple[str, ...] = ()


def read_sweep(section: Marked, mistakes: Mistakes) -> SweepConfig:
    """Return the section `sweep:`.

    Args:
        section: its value.
        mistakes: collects unknown keys and values that are not lists of names.
    """
    said: dict[str, tuple[str, ...]] = {}
    for name, entry in mistakes.fields(section, ("rate", "topics")):
        items = mistakes.items(entry)
        texts = [mistakes.attempt(item.text) for item in items]
        said[name] = tuple(text for text in texts if text)
        for item, text in zip(items, texts, strict=True):
            if name == "topics" and text and not text.startswith("/"):
                mistakes.add(item.fail(f'invalid topic name {text!r}; it must begin with "/"'))
    return SweepConfig(**said)
