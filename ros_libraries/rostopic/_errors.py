"""The errors of rostopic."""

from __future__ import annotations


class ROSTopicException(Exception):
    """Base of the errors of this library."""


class ROSTopicIOException(ROSTopicException):
    """The master or a node does not answer."""


for _error in (ROSTopicException, ROSTopicIOException):
    _error.__module__ = "rostopic"
