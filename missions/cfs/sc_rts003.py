"""The sequence that saves power: the heater goes off, DS closes its file, and FM lists what is in /ram.

After a change, `python sc_rts003.py` writes sc_rts003.tbl anew.
"""

from __future__ import annotations

import struct

from sequences import DS_CMD, FM_CMD, POWER_CMD
from sequences import image as sequence

from cfepy.tbl import TableImage, write_beside

SET_HEATER, CLOSE_ALL, GET_DIR_LIST_FILE = 1, 18, 14


def image() -> TableImage:
    """The table."""
    listing = struct.pack("<64s64sB3x", b"/ram", b"/ram/listing.dat", 1)
    return sequence(
        3,
        [
            (1, POWER_CMD, SET_HEATER, bytes(4)),
            (2, DS_CMD, CLOSE_ALL, b""),
            (1, FM_CMD, GET_DIR_LIST_FILE, listing),
        ],
    )


if __name__ == "__main__":
    write_beside(__file__, image())
