"""rosbag_storage: ROS's bag format 2.0 (wiki.ros.org/Bags/Format/2.0) as a library without ROS.

A bag is a header, chunks of messages each followed by its index, and finally the data of connections and chunks.
`BagFile` reads and writes one; times are integers of ns. The package replaces the C++ package of that name. It may
import the standard library, lz4 and zstandard only, so that tools outside of nodes can use it too.

`opened` also reads MCAP files (mcap.dev/spec), whose topics of ROS 1 are like those of a bag.
"""

from __future__ import annotations

from .bagfile import BagFile
from .contents import Chunk, Connection, Contents, Entry
from .errors import (
    ROSBagEncryptException,
    ROSBagEncryptNotSupportedException,
    ROSBagException,
    ROSBagFormatException,
    ROSBagUnindexedException,
)
from .mcap_file import McapFile, opened
from .mcap_records import McapSchema, RecordedChannel, RecordedMessage, channel_of_connection
from .mcap_salvage import McapSalvage
from .salvage import BROKEN, BagSalvage, Loss, Salvage

__all__ = [
    "BROKEN",
    "BagFile",
    "BagSalvage",
    "Chunk",
    "Connection",
    "Contents",
    "Entry",
    "Loss",
    "McapFile",
    "McapSalvage",
    "McapSchema",
    "ROSBagEncryptException",
    "ROSBagEncryptNotSupportedException",
    "ROSBagException",
    "ROSBagFormatException",
    "ROSBagUnindexedException",
    "RecordedChannel",
    "RecordedMessage",
    "Salvage",
    "channel_of_connection",
    "opened",
]
