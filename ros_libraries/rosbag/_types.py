"""The classes of the messages in a bag, made from the definitions in the bag. Imports genpy."""

from __future__ import annotations

import sys
from functools import cache
from typing import TYPE_CHECKING, Any

import genpy.dynamic
from rosbag_storage import ROSBagException

if TYPE_CHECKING:
    from rosbag_storage import Connection


def message_type(connection: Connection) -> Any:
    """Return the class of a connection's messages. As with ROS, it is not the class that `import` gives.

    Raises:
        ROSBagException: the definition in the bag is invalid.
    """
    return _made(connection.datatype, connection.md5sum, connection.msg_def)


@cache
def _made(datatype: str, md5sum: str, definition: str) -> Any:
    try:
        made = genpy.dynamic.generate_dynamic(datatype, definition)[datatype]
    except Exception as error:  # a definition in a bag may be any text
        raise ROSBagException(f"Error generating datatype {datatype}: {error}") from None
    if made._md5sum != md5sum:
        print(
            f"WARNING: For type [{datatype}] stored md5sum [{md5sum}] does not match message definition"
            f' [{made._md5sum}].\n  Try: "rosrun rosbag fix_msg_defs.py old_bag new_bag."',
            file=sys.stderr,
        )
    return made
