"""The sequence that SC starts after power-on: LC begins to watch, and the sequence that saves power may be started.

After a change, `python sc_rts001.py` writes sc_rts001.tbl anew.
"""

from __future__ import annotations

import struct

from sequences import LC_CMD, SC_CMD
from sequences import image as sequence

from cfepy.tbl import TableImage, write_beside

SET_LC_STATE, ENABLE_RTS = 2, 7
ACTIVE, SAVE_POWER = 1, 3


def image() -> TableImage:
    """The table."""
    return sequence(
        1,
        [
            (1, LC_CMD, SET_LC_STATE, struct.pack("<HH", ACTIVE, 0)),
            (1, SC_CMD, ENABLE_RTS, struct.pack("<HH", SAVE_POWER, 0)),
        ],
    )


if __name__ == "__main__":
    write_beside(__file__, image())
