"""The exceptions of rosbag; they are pickled and named as those of `rosbag.bag`. Imports nothing."""

from __future__ import annotations

from typing import Any


class ROSBagException(Exception):
    """Base class of the errors of a bag."""

    __module__ = "rosbag.bag"

    def __init__(self, value: Any = None) -> None:
        super().__init__(value)
        self.value = value

    def __str__(self) -> str:
        return str(self.value)


class ROSBagFormatException(ROSBagException):
    """The file violates the format."""

    __module__ = "rosbag.bag"

    def __init__(self, value: Any) -> None:
        super().__init__(value)


class ROSBagUnindexedException(ROSBagException):
    """The bag was not closed, so its index is missing: `reindex` makes one."""

    __module__ = "rosbag.bag"

    def __init__(self, *args: Any) -> None:
        super().__init__("Unindexed bag")


class ROSBagEncryptNotSupportedException(ROSBagException):
    """The bag is encrypted in a way that is not supported."""

    __module__ = "rosbag.bag"

    def __init__(self, value: Any) -> None:
        super().__init__(value)


class ROSBagEncryptException(ROSBagException):
    """A bag could not be encrypted or decrypted."""

    __module__ = "rosbag.bag"

    def __init__(self, value: Any) -> None:
        super().__init__(value)
