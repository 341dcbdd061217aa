"""`CommandGroup`: the commands of Executive Services about one thing, with their handlers."""

from __future__ import annotations

from abc import ABC, abstractmethod

from cfepy.core_app import Replies
from cfepy.es.service import ExecutiveServices
from cfepy.msg import Command, Handler

Handlers = tuple[tuple[Command, Handler], ...]


class CommandGroup(ABC):
    """The base of all groups.

    Args:
        es: the service.
        replies: how handlers answer.
    """

    def __init__(self, es: ExecutiveServices, replies: Replies) -> None:
        self._es = es
        self._replies = replies

    @abstractmethod
    def handlers(self) -> Handlers:
        """Which handler belongs to which command."""
