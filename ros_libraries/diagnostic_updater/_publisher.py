"""Diagnostics of a topic: its frequency, and the age of its stamps."""

from __future__ import annotations

from typing import Any

from ._diagnostic_updater import CompositeDiagnosticTask, Updater
from ._update_functions import FrequencyStatus, FrequencyStatusParam, TimeStampStatus, TimeStampStatusParam


class HeaderlessTopicDiagnostic(CompositeDiagnosticTask):
    """Watches the frequency of a topic.

    Args:
        name: name of the topic.
        diag: the updater to which it adds itself.
        freq: the acceptable frequencies.
    """

    def __init__(self, name: str, diag: Updater, freq: FrequencyStatusParam) -> None:
        super().__init__(f"{name} topic status")
        self.diag = diag
        self.freq = FrequencyStatus(freq)
        self.addTask(self.freq)
        self.diag.add(self)

    def tick(self) -> None:
        """A message was published."""
        self.freq.tick()

    def clear_window(self) -> None:
        """Begin anew."""
        self.freq.clear()


class TopicDiagnostic(HeaderlessTopicDiagnostic):
    """Watches frequency and stamps of a topic; `stamp` gives the acceptable ages."""

    def __init__(self, name: str, diag: Updater, freq: FrequencyStatusParam, stamp: TimeStampStatusParam) -> None:
        super().__init__(name, diag, freq)
        self.stamp = TimeStampStatus(stamp)
        self.addTask(self.stamp)

    def tick(self, stamp: Any) -> None:  # type: ignore[override]  # ROS's signature
        """A message with this stamp was published."""
        self.stamp.tick(stamp)
        super().tick()


class DiagnosedPublisher(TopicDiagnostic):
    """A publisher whose topic is watched; `pub` is the rospy.Publisher."""

    def __init__(self, pub: Any, diag: Updater, freq: FrequencyStatusParam, stamp: TimeStampStatusParam) -> None:
        super().__init__(pub.name, diag, freq, stamp)
        self.publisher = pub

    def publish(self, message: Any) -> None:
        """Publish a message that has a header."""
        self.tick(message.header.stamp)
        self.publisher.publish(message)
